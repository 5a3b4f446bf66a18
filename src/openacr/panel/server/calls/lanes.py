"""What the picture of the timeline shows: lanes of a branch, and details of a short part."""

from typing import Annotated, NamedTuple

from msgspec import Meta
from starlette.concurrency import run_in_threadpool

from openacr.errors import UserError
from openacr.journal.entries import Entered, JournalEntry
from openacr.panel.control.machine.blocks import Block, part_lanes
from openacr.panel.control.machine.lanes import AXES, NEAR, Lane
from openacr.panel.control.machine.lanes import Course as Happened
from openacr.panel.control.machine.line_names import NAMES as LINES
from openacr.panel.control.machine.line_names import LineNames
from openacr.panel.control.machine.traffic import Writes, arrived, traffic
from openacr.panel.control.station import Station
from openacr.panel.server.api import Call, Query, endpoint
from openacr.timeline import Course
from openacr.timeline.details import details

# Names of lanes by their kind; all others are named by their axis.
NAMES = {
    "master": "MASTER{}",
    "hold": "MASTER{}",
    "program": "PROG{}",
    "pause": "PROG{}",
    "plc": "PLC{}",
}
MOST_DETAILS_S = 20.0
Number = Annotated[int, Meta(ge=0, lt=1 << 31)]
Tick = Annotated[int, Meta(ge=0, lt=1 << 62)]


class Interval(Query, frozen=True):
    """An interval of a branch in ticks."""

    branch: Number
    first: Tick
    last: Tick


class Detailed(Interval, frozen=True):
    """A part of a branch, with the columns that its picture has."""

    columns: Annotated[int, Meta(ge=2, le=4000)] = 500


@endpoint("GET", "/timeline/lanes", query=Interval)
async def lanes(call: Call) -> object:
    """What moved, ran, was on, arrived or was sent in a part of a branch: spans, to the tick.

    With each lane how long it was on in all (ticks), and how often it changed. `is_own` of what
    arrived or was sent: on a stream of the panel itself, not of another host.
    """
    query: Interval = call.query

    def look(station: Station) -> tuple[Happened, Seen]:
        history = station.times.history
        names = [station.installation.axis_name(axis) for axis in AXES]
        branch = history.timeline.branches.named(query.branch)
        came = branch.between(query.first, query.last)
        blocks = history.blocks.between(query.branch, query.first, query.last)
        sent = history.sent.between(query.branch, query.first, query.last)
        lines = LineNames(history.aliases, station.installation.store)
        seen = Seen(history.unmarked, came, sent, blocks, names, lines, history.own_streams)
        return history.lanes.of(query.branch), seen

    return await run_in_threadpool(_lanes, query, *await call.panel.ask(look))


class Seen(NamedTuple):
    """What lanes are made of beside the changes of the card."""

    hidden: frozenset[int]
    came: list[JournalEntry]
    sent: Writes
    blocks: list[Block]
    names: list[str]  # of axes
    lines: LineNames
    own: frozenset[int]  # streams of the panel


def _named(lane: Lane, seen: Seen) -> dict[str, str]:
    """The name of a lane, and what the card calls it where that is another name."""
    if lane.flag is None or lane.kind not in LINES:
        axis = seen.names[lane.number % len(AXES)]
        return {"name": NAMES.get(lane.kind, axis).format(lane.number), "card": ""}
    name, card = seen.lines.of(lane.kind, lane.flag)
    return {"name": name or card, "card": card if name else ""}


def _lanes(query: Interval, course: Happened, seen: Seen) -> dict[str, object]:
    """The lanes as they are sent."""
    near = (query.last - query.first) // NEAR
    found = course.lanes(query.first, query.last, seen.hidden)
    parts = part_lanes(seen.blocks, query.first, query.last, course.end, near)
    came = arrived([entry for entry in seen.came if entry.what is Entered.BYTES])
    return {
        "first": query.first,
        "last": query.last,
        "lanes": [
            *parts,
            *(
                {
                    "kind": each.kind,
                    "number": each.number,
                    **_named(each, seen),
                    "flag": each.flag,
                    "spans": each.spans,
                    "on": each.on_tk,
                    "changes": each.changes,
                }
                for each in found
            ),
        ],
        "hosts": _traffic(came, near, seen.own),
        "sent": _traffic(seen.sent, near, seen.own),
    }


def _traffic(writes: Writes, near: int, own: frozenset[int]) -> list[dict[str, object]]:
    return [{**each._asdict(), "is_own": each.stream in own} for each in traffic(writes, near)]


@endpoint("GET", "/timeline/details", query=Detailed)
async def shown_details(call: Call) -> object:
    """Curves and distances of the axes, and the lines of programs, of at most 20 s of a branch.

    The part, as far as the branch has it, is lived through again beside the machine, which goes on.
    """
    query: Detailed = call.query

    def look(station: Station) -> tuple[Course, int, int, float]:
        history = station.times.history
        branch = history.timeline.branches.named(query.branch)
        first = max(query.first, branch.first.tick)
        last = min(query.last, branch.last.tick)
        course = history.timeline.course(query.branch, first, last)
        return course, first, last, history.period_s

    course, first, last, period_s = await call.panel.ask(look)
    length_s = (last - first) * period_s
    if not 0.0 < length_s <= MOST_DETAILS_S:
        raise UserError(f"details of {length_s:g} s: at most {MOST_DETAILS_S:g} s are shown")
    found = await call.panel.histories.run(details, course, first, last, query.columns)
    return {"first": first, "last": last, **found}
