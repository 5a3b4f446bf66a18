"""Records of the scope as Parquet files; the samples come from the browser that shows them."""

import io
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Annotated, Any, TypeAlias

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
Write: TypeAlias = Callable[[NDArray[np.floating[Any]], NDArray[np.float64]], None]


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
    target = io.BytesIO()
    with written(target, names) as write:
        write(time.begin_s + np.arange(columns.shape[1]) * time.period_s, columns)
    return target.getvalue()


@contextmanager
def written(target: IO[bytes] | Path, names: list[str]) -> Iterator[Write]:
    """Write a Parquet file, part after part: the times and the samples of each channel.

    Missing samples (NaN) are null. UserError without pyarrow.
    """
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise UserError("Parquet needs pyarrow: pip install 'openacr[sweep]'") from None
    schema = pyarrow.schema([(name, pyarrow.float64()) for name in (TIME, *names)])
    with pyarrow.parquet.ParquetWriter(target, schema) as file:

        def write(times: NDArray[np.floating[Any]], columns: NDArray[np.float64]) -> None:
            known = [pyarrow.array(values, mask=np.isnan(values)) for values in columns]
            file.write_table(pyarrow.table([pyarrow.array(times), *known], schema=schema))

        yield write
