"""The long record of the scope: any part of it as columns, measures, or a file."""

import io
import math
import tempfile
from collections.abc import Iterator
from csv import writer
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import numpy as np
from msgspec import Meta
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response, StreamingResponse

from openacr.panel.control.engineer.pyramid import Pyramid
from openacr.panel.control.engineer.records import Record
from openacr.panel.control.operator.orders import PanelError
from openacr.panel.roles import Role
from openacr.panel.server.api import Call, Query, endpoint
from openacr.panel.server.calls.scope import TIME, TYPE, names_of, written

MOST_COLUMNS = 65_536  # a part whose samples are computed with comes sample by sample
AT_ONCE = 65_536  # samples of a file that are read at once
BINARY = "application/octet-stream"
Sample = Annotated[int, Meta(ge=0, lt=1 << 53)]


class OfRecord(Query, frozen=True):
    """A record."""

    number: Annotated[int, Meta(ge=1)]


class OfPart(OfRecord, frozen=True):
    """A part of a record: its first sample and the one after its last."""

    first: Sample
    last: Sample


class View(OfPart, frozen=True):
    """A part of a record in at most `most` columns."""

    most: Annotated[int, Meta(ge=2, le=MOST_COLUMNS)] = 1000


class Measured(OfPart, frozen=True):
    """A part of a record, and samples whose values are wanted, with commas between them."""

    at: Annotated[str, Meta(max_length=200)] = ""


class File(OfPart, frozen=True):
    """A part of a record as a file: names of the columns as a JSON list."""

    names: Annotated[str, Meta(max_length=2000)]


async def _record(call: Call) -> Record:
    """The record that is asked for; UserError if it is another one by now."""
    return await call.panel.ask(lambda station: station.records.require(call.query.number))


@endpoint("GET", "/record", Role.SERVICE, query=OfRecord)
async def record(call: Call) -> object:
    """How much of a record is kept: its first sample and the one after the last, bytes of files."""
    found = (await _record(call)).samples
    return {"first": found.first, "next": found.next, "bytes": found.size_bytes}


@endpoint("GET", "/record/view", Role.SERVICE, query=View, gives=BINARY)
async def view(call: Call) -> object:
    """A part of a record: numbers of 64 bits, low byte first.

    Six for the whole: first sample and samples of a column, columns, channels, first sample that
    is kept and the one after the last. Then, channel by channel, the lowest values of all columns;
    where a column has more than one sample, the highest ones follow. Missing samples are NaN. A
    part beyond what is kept is cut.
    """
    found, query = (await _record(call)).samples, call.query
    return Response(await run_in_threadpool(_viewed, found, query), media_type=BINARY)


def _viewed(found: Pyramid, query: View) -> bytes:
    first, last = found.first, found.next
    begin, end = max(first, query.first), min(last, query.last)
    if begin >= end:
        head = [begin, 1.0, 0.0, found.channels, first, last]
        return np.array(head, "<f8").tobytes()
    columns = found.columns(begin, end, query.most)
    head = [columns.first, columns.width, columns.low.shape[1], found.channels, first, last]
    parts = [columns.low] if columns.width == 1 else [columns.low, columns.high]
    return b"".join(np.asarray(each, "<f8").tobytes() for each in (head, *parts))


@endpoint("GET", "/record/measures", Role.SERVICE, query=Measured)
async def measures(call: Call) -> object:
    """Count, min, max, mean and rms of a part by channel; values at samples. Null is missing."""
    found, query = (await _record(call)).samples, call.query
    summaries = await run_in_threadpool(found.summaries, query.first, query.last)
    places = [int(each) for each in query.at.split(",") if each.strip().isdecimal()]
    return {
        "measures": [_known(asdict(each)) for each in summaries],
        "at": [_known(_values_at(found, place)) for place in places],
    }


def _values_at(found: Pyramid, place: int) -> dict[str, float]:
    if not found.first <= place < found.next:
        return {}
    values = found.samples(place, place + 1)[:, 0].tolist()
    return {str(channel): value for channel, value in enumerate(values)}


@endpoint("GET", "/record/csv", Role.SERVICE, query=File, gives="text/csv")
async def csv(call: Call) -> object:
    """A part of a record as CSV: the time in s from its beginning, then a column for each channel.

    A missing sample is empty.
    """
    found, names = await _part(call)
    headers = {"Content-Disposition": f'attachment; filename="{_name(call.query)}.csv"'}
    lines = _lines(found, call.query, names)
    return StreamingResponse(lines, media_type="text/csv", headers=headers)


@endpoint("GET", "/record/parquet", Role.SERVICE, query=File, gives=TYPE)
async def parquet(call: Call) -> object:
    """A part of a record as Parquet, with the columns of its CSV; missing samples are null."""
    found, names = await _part(call)
    with tempfile.NamedTemporaryFile(suffix=".parquet", delete=False) as file:
        path = Path(file.name)
    try:
        await run_in_threadpool(_store, path, found, call.query, names)
    except BaseException:
        path.unlink(missing_ok=True)
        raise
    return FileResponse(
        path,
        media_type=TYPE,
        filename=f"{_name(call.query)}.parquet",
        background=BackgroundTask(path.unlink, missing_ok=True),
    )


async def _part(call: Call) -> tuple[Record, list[str]]:
    """The record with names of its columns; refused before a file of the part begins."""
    found, query = await _record(call), call.query
    names = names_of(query.names)
    if len(names) != len(found.channels):
        raise PanelError(
            "bad", f"{len(names)} names: the record has {len(found.channels)} channels"
        )
    found.samples.samples(query.last - 1, query.last)
    found.samples.samples(query.first, query.first + 1)
    return found, names


def _name(query: File) -> str:
    return f"record-{query.number}-{query.first}-{query.last}"


def _store(path: Path, found: Record, query: File, names: list[str]) -> None:
    with written(path, names) as write:
        for begin in range(query.first, query.last, AT_ONCE):
            end = min(begin + AT_ONCE, query.last)
            times = found.period_s * np.arange(begin - query.first, end - query.first)
            write(times, found.samples.samples(begin, end))


def _lines(found: Record, query: File, names: list[str]) -> Iterator[str]:
    head = io.StringIO()
    writer(head, lineterminator="\n").writerow([TIME, *names])
    yield head.getvalue()
    for begin in range(query.first, query.last, AT_ONCE):
        end = min(begin + AT_ONCE, query.last)
        rows = found.samples.samples(begin, end).T.tolist()
        times = (found.period_s * (place - query.first) for place in range(begin, end))
        pairs = zip(times, rows, strict=True)
        yield "".join(f"{time:.12g},{','.join(map(_text, row))}\n" for time, row in pairs)


def _text(value: float) -> str:
    """The shortest text that is this number; empty where it is missing."""
    return "" if math.isnan(value) else repr(value).removesuffix(".0")


def _known(values: dict[str, float]) -> dict[str, float | None]:
    return {name: None if math.isnan(value) else value for name, value in values.items()}
