"""Records of the scope as Parquet files; the samples come from the browser that shows them."""

import io
import json
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from openacr.errors import UserError
from openacr.panel.control.engineer.scope import CHANNELS, MOST_SAMPLES
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.roles import Role
from openacr.panel.server.api import Call, Query, endpoint, limited

MOST_COLUMNS = CHANNELS + 1  # and the maths channel
MOST_BYTES = 8 * MOST_COLUMNS * MOST_SAMPLES
TYPE = "application/vnd.apache.parquet"
TIME = "time_s"


class OfRecord(Query, frozen=True):
    """Names of the columns as a JSON list, the time between two samples and of the first one."""

    names: Annotated[str, Meta(max_length=2000)]
    period_s: Annotated[float, Meta(gt=0.0, le=1e6)]
    begin_s: Annotated[float, Meta(ge=-1e9, le=1e9)] = 0.0


@endpoint(
    "POST", "/scope/parquet", Role.SERVICE, query=OfRecord,
    takes="application/octet-stream", gives=TYPE,
)  # fmt: skip
async def parquet(call: Call) -> object:
    """A record as Parquet: 64-bit numbers, column by column, become a file with the time in s."""
    query: OfRecord = call.query
    names = names_of(query.names)
    data = await limited(call.request, MOST_BYTES)
    if len(data) % (8 * len(names)):
        raise PanelError("bad", f"{len(data)} bytes are no {len(names)} columns of equal length")
    columns = np.frombuffer(data, "<f8").reshape(len(names), -1)
    content = await run_in_threadpool(_file, names, columns, query)
    return Response(content, media_type=TYPE)


def names_of(text: str) -> list[str]:
    """Names of columns from a JSON list; PanelError unless they are different texts."""
    try:
        names = json.loads(text)
    except ValueError:
        names = None
    if not isinstance(names, list) or not all(isinstance(each, str) for each in names):
        raise PanelError("bad", "names: a JSON list of texts is needed")
    if not 1 <= len(names) <= MOST_COLUMNS or len({*names, TIME}) != len(names) + 1:
        raise PanelError("bad", f"names: 1 to {MOST_COLUMNS} different ones, none {TIME}")
    return names


def _file(names: list[str], columns: NDArray[np.float64], time: OfRecord) -> bytes:
    """A Parquet file; missing samples (NaN) are null. UserError without pyarrow."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise UserError("Parquet needs pyarrow: pip install 'openacr[sweep]'") from None
    arrays = {TIME: pyarrow.array(time.begin_s + np.arange(columns.shape[1]) * time.period_s)}
    for name, values in zip(names, columns, strict=True):
        arrays[name] = pyarrow.array(values, mask=np.isnan(values))
    target = io.BytesIO()
    pyarrow.parquet.write_table(pyarrow.table(arrays), target)
    return target.getvalue()
