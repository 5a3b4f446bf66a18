"""The timeline: samples and differences of branches, by living through them in a process."""

import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, NamedTuple

from msgspec import Meta
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse

from openacr.client.names import item_names, named
from openacr.errors import UserError
from openacr.journal.entries import Entered, JournalEntry
from openacr.map import Flag, flags, parameters
from openacr.map.memory import flag_place
from openacr.panel.control.engineer.sampling import row_of, value_in
from openacr.panel.control.engineer.scope import name_of
from openacr.panel.control.machine.blocks import Block, part_lanes
from openacr.panel.control.machine.lanes import AXES, NEAR, Lane
from openacr.panel.control.machine.lanes import Course as Happened
from openacr.panel.control.machine.traffic import Writes, arrived, traffic
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Call, Query, endpoint
from openacr.sysvar import Store
from openacr.sysvar.tabs import OFFSETS
from openacr.timeline import Course
from openacr.timeline.details import change_of, details, line_of

MOST_PARAMETERS = 8
MOST_SAMPLES = 20_000
MOST_TICKS = 1_000_000  # of one interval
MOST_DIFFERENCES = 200
MOST_DETAILS_S = 20.0
SEARCHED_S, FIRST_SEARCHED_S = 300.0, 5.0  # of card time
# Names of lanes by their kind; all others are named by their axis.
NAMES = {
    "master": "MASTER{}",
    "hold": "MASTER{}",
    "program": "PROG{}",
    "pause": "PROG{}",
    "plc": "PLC{}",
}
LINES = {"input": OFFSETS.input_name, "output": OFFSETS.output_name}  # names of a machine
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


class Detailed(Interval, frozen=True):
    """A part of a branch, with the columns that its picture has."""

    columns: Annotated[int, Meta(ge=2, le=4000)] = 500


class Sought(Query, frozen=True):
    """What is looked for from a tick on: a flag by name or number, or a line of a program."""

    branch: Number
    tick: Tick
    back: bool = False
    flag: Annotated[str, Meta(max_length=80)] = ""
    program: Annotated[int, Meta(ge=0, le=15)] = 0
    line: Annotated[int, Meta(ge=0, le=999_999)] = 0


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
    """What moved, ran, was on, arrived or was sent in a part of a branch: spans, to the tick.

    With each lane how long it was on in all (ticks), and how often it changed.
    """
    query: Interval = call.query

    def look(station: Station) -> tuple[Happened, Seen]:
        history = station.times.history
        names = [station.installation.axis_name(axis) for axis in AXES]
        branch = history.timeline.branches.named(query.branch)
        came = branch.between(query.first, query.last)
        blocks = history.blocks.between(query.branch, query.first, query.last)
        aliases = {n: at.text for n, at in history.card.system.aliases.nodes.written.items()}
        sent = history.sent.between(query.branch, query.first, query.last)
        store = station.installation.store
        seen = Seen(history.unmarked, came, sent, blocks, names, aliases, store)
        return history.lanes.of(query.branch), seen

    return await run_in_threadpool(_lanes, query, *await call.panel.ask(look))


class Seen(NamedTuple):
    """What lanes are made of beside the changes of the card."""

    hidden: frozenset[int]
    came: list[JournalEntry]
    sent: Writes
    blocks: list[Block]
    names: list[str]  # of axes
    aliases: Mapping[str, str]  # with what they stand for
    store: Store


def _named(lane: Lane, seen: Seen, aliases: Mapping[str, str]) -> dict[str, str]:
    """The name of a lane, and what the card calls it where that is another name.

    An input or output has its alias, else the name that the machine gives it.
    """
    if lane.flag is None or lane.kind not in LINES:
        axis = seen.names[lane.number % len(AXES)]
        return {"name": NAMES.get(lane.kind, axis).format(lane.number), "card": ""}
    flag = flags()[lane.flag]
    board = f"XIO {flag.index} " if flag.object.startswith("XIO") else ""
    own = LINES[lane.kind]
    name = aliases.get(f"BIT{flag.number}") or (
        seen.store.read_text(own[flag.number]) if flag.number < len(own) else ""
    )
    card = f"{board}{flag.name}"
    return {"name": name or card, "card": card if name else ""}


def _lanes(query: Interval, course: Happened, seen: Seen) -> dict[str, object]:
    """The lanes as they are sent."""
    near = (query.last - query.first) // NEAR
    aliases = item_names(seen.aliases)
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
                    **_named(each, seen, aliases),
                    "flag": each.flag,
                    "spans": each.spans,
                    "on": each.on_tk,
                    "changes": each.changes,
                }
                for each in found
            ),
        ],
        "hosts": [each._asdict() for each in traffic(came, near)],
        "sent": [each._asdict() for each in traffic(seen.sent, near)],
    }


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


@endpoint("GET", "/timeline/find", query=Sought)
async def find(call: Call) -> object:
    """The tick of the next or previous change of a flag, or of the next line of a program.

    UserError where there is none within five minutes of card time.
    """
    query: Sought = call.query
    if query.flag:
        flag = named(query.flag)
        if not isinstance(flag, Flag):
            raise UserError(f"{query.flag} is no flag: write BIT516 or its name")
        word, mask = flag_place(flag.number)
        what = f"BIT{flag.number} does not change"
        search: Callable[..., int | None] = partial(change_of, word=word, mask=mask)
    else:
        what = f"PROG{query.program} does not come to line {query.line}"
        search = partial(line_of, program=query.program, line=query.line)
    branch, period_s = await call.panel.ask(
        lambda station: (
            station.times.history.timeline.branches.named(query.branch),
            station.times.history.period_s,
        )
    )
    begin, left_s, length_s = query.tick, SEARCHED_S, FIRST_SEARCHED_S
    while left_s > 0.0:
        length_tk = round(length_s / period_s)
        if query.back:
            first, last = max(branch.first.tick, begin - length_tk), begin
        else:
            first, last = begin, min(branch.last.tick, begin + length_tk)
        if first >= last:
            break
        course = await _course(call, query.branch, first, last)
        reach = last - 1 if query.back and last == query.tick else last
        found = await call.panel.histories.run(
            partial(search, course, first_tk=first, last_tk=reach, is_last=query.back)
        )
        if found is not None:
            return {"tick": found}
        begin = first if query.back else last
        left_s -= length_s
        length_s *= 2.0
    where = "before" if query.back else "after"
    raise UserError(f"{what} within {SEARCHED_S:g} s {where} this moment, or the branch ends")


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
