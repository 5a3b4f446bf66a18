"""The timeline: samples and differences of branches, by living through them in a process."""

import tempfile
from pathlib import Path
from typing import Annotated

from msgspec import Meta
from starlette.background import BackgroundTask
from starlette.responses import FileResponse

from openacr.client.names import named
from openacr.errors import UserError
from openacr.map import parameters
from openacr.panel.control.engineer.sampling import row_of, value_in
from openacr.panel.control.engineer.scope import name_of
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Call, Query, endpoint
from openacr.timeline import Course

MOST_PARAMETERS = 8
MOST_SAMPLES = 20_000
MOST_TICKS = 1_000_000  # of one interval
MOST_DIFFERENCES = 200
Number = Annotated[int, Meta(ge=0, lt=1 << 31)]
Tick = Annotated[int, Meta(ge=0, lt=1 << 62)]


class Samples(Query, frozen=True):
    """Parameters or flags by name or number, with commas; an interval of a branch in ticks."""

    branch: Number
    parameters: Annotated[str, Meta(max_length=1000)]
    first: Tick
    last: Tick
    count: Annotated[int, Meta(ge=2, le=MOST_SAMPLES)] = 1000


class Interval(Query, frozen=True):
    """An interval of a branch in ticks."""

    branch: Number
    first: Tick
    last: Tick


class Compared(Query, frozen=True):
    """Two branches and a tick of both."""

    branch: Number
    other: Number
    tick: Tick


class OfBranch(Query, frozen=True):
    """A branch."""

    branch: Number


@endpoint("GET", "/timeline/samples", query=Samples)
async def samples(call: Call) -> object:
    """Samples of up to eight parameters or flags over an interval of a branch of the history.

    The interval is lived through again beside the machine, which goes on.
    """
    query: Samples = call.query
    chosen = [named(word) for word in _words(query.parameters)]
    if not 1 <= len(chosen) <= MOST_PARAMETERS:
        raise UserError(f"{len(chosen)} parameters: 1 to {MOST_PARAMETERS} are sampled")
    length_tk = query.last - query.first
    if not 1 <= length_tk <= MOST_TICKS:
        raise UserError(f"an interval of {length_tk} ticks: 1 to {MOST_TICKS} are sampled")
    every_tk = max(1, length_tk // (query.count - 1))
    count = length_tk // every_tk + 1
    course = await _course(call, query.branch, query.first, query.last)
    rows = await call.panel.histories.run(
        Course.samples, course, list(map(row_of, chosen)), query.first, every_tk, count
    )
    return {
        "first": query.first,
        "every": every_tk,
        "names": list(map(name_of, chosen)),
        "channels": [
            [value_in(each, row) for row in values]
            for each, values in zip(chosen, rows, strict=True)
        ],
    }


@endpoint("GET", "/timeline/lanes", query=Interval)
async def lanes(call: Call) -> object:
    """When axes moved and programs ran, as spans in ticks; as seen every 20 ms of card time."""
    query: Interval = call.query

    def look(station: Station) -> list[dict[str, object]]:
        history = station.times.history
        name = station.installation.axis_name
        found = history.lanes.between(query.branch, query.first, query.last, history.unmarked)
        return [
            {
                "name": name(each.number) if each.kind == "axis" else f"PROG{each.number}",
                "kind": each.kind,
                "spans": each.spans,
            }
            for each in found
        ]

    return {"lanes": await call.panel.ask(look)}


@endpoint("GET", "/timeline/differences", query=Compared)
async def differences(call: Call) -> object:
    """What differs between two branches at the same tick: parameters with both values."""
    query: Compared = call.query
    known = parameters()
    numbers = list(known)
    both = [
        await call.panel.histories.run(Course.values, course, numbers, query.tick)
        for course in [
            await _course(call, branch, query.tick, query.tick)
            for branch in (query.branch, query.other)
        ]
    ]
    found = [
        {"number": number, "name": known[number].name, "values": values}
        for number, *values in zip(numbers, *both, strict=True)
        if values[0] != values[1]
    ]
    return {"count": len(found), "differences": found[:MOST_DIFFERENCES]}


@endpoint(
    "GET", "/timeline/journal", Role.SERVICE, query=OfBranch, gives="application/octet-stream"
)
async def journal(call: Call) -> object:
    """A branch as a journal, for `openacr replay`; it takes its time."""
    course = await _course(call, call.query.branch, None, None)
    with tempfile.NamedTemporaryFile(suffix=".journal", delete=False) as file:
        path = Path(file.name)
    try:
        await call.panel.histories.run(Course.save, course, path)
    except BaseException:
        path.unlink(missing_ok=True)
        raise
    return FileResponse(
        path,
        media_type="application/octet-stream",
        filename=f"branch-{call.query.branch}.journal",
        background=BackgroundTask(path.unlink, missing_ok=True),
    )


async def _course(call: Call, branch: int, first_tk: int | None, last_tk: int | None) -> Course:
    """A branch as plain data, taken in the control thread; UserError for an unknown moment."""
    return await call.panel.ask(
        lambda station: station.times.history.timeline.course(branch, first_tk, last_tk)
    )


def _words(text: str) -> list[str]:
    """Names with commas or semicolons between them: no name has either."""
    return [word.strip() for word in text.replace(";", ",").split(",") if word.strip()]
