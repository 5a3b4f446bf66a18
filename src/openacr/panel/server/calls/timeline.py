"""The timeline: samples and differences of branches, by living through them in a process."""

import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated, NamedTuple

from msgspec import Meta
from starlette.background import BackgroundTask
from starlette.responses import FileResponse

from openacr.client.names import named
from openacr.errors import UserError
from openacr.map import Flag, parameters
from openacr.map.memory import flag_place
from openacr.map.numbers import FLAG_WORD_BASE
from openacr.panel.control.engineer.sampling import row_of, value_in
from openacr.panel.control.engineer.scope import name_of
from openacr.panel.control.machine.lanes import AXES, BITS
from openacr.panel.control.machine.line_names import LineNames
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Call, Query, endpoint
from openacr.timeline import Course
from openacr.timeline.details import change_of, line_of
from openacr.timeline.differing import ALL_PROGRAMS, Difference, Seen, apart_tk, first_differences

MOST_PARAMETERS = 8
MOST_SAMPLES = 20_000
MOST_TICKS = 1_000_000  # of one interval
MOST_DIFFERENCES = 200
SEARCHED_S, FIRST_SEARCHED_S = 300.0, 5.0  # of card time
LIVED_S = 5.0  # of two branches that are compared, tick by tick
Number = Annotated[int, Meta(ge=0, lt=1 << 31)]
Tick = Annotated[int, Meta(ge=0, lt=1 << 62)]


class Samples(Query, frozen=True):
    """Parameters or flags by name or number, with commas; an interval of a branch in ticks."""

    branch: Number
    parameters: Annotated[str, Meta(max_length=1000)]
    first: Tick
    last: Tick
    count: Annotated[int, Meta(ge=2, le=MOST_SAMPLES)] = 1000


class Sought(Query, frozen=True):
    """What is looked for from a tick on: a flag by name or number, or a line of a program."""

    branch: Number
    tick: Tick
    back: bool = False
    flag: Annotated[str, Meta(max_length=80)] = ""
    program: Annotated[int, Meta(ge=0, le=15)] = 0
    line: Annotated[int, Meta(ge=0, le=999_999)] = 0


class Two(Query, frozen=True):
    """Two branches."""

    branch: Number
    other: Number


class Compared(Two, frozen=True):
    """Two branches and a tick of both."""

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


@endpoint("GET", "/timeline/first-difference", query=Two)
async def first_difference(call: Call) -> object:
    """Where two branches differ first: outputs, positions of axes, lines of programs.

    The first difference of each kind within a few seconds, in order: its tick, what it is of, and
    both values. UserError where there is none within five minutes after the first input that they
    do not share. `apart` is the tick of that input. Both are lived through beside the machine.
    """
    query: Two = call.query

    def look(station: Station) -> Pair:
        history, installation = station.times.history, station.installation
        branches = history.timeline.branches
        one, other = branches.named(query.branch), branches.named(query.other)
        return Pair(
            apart_tk(one, other),
            max(one.first.tick, other.first.tick),
            min(one.last.tick, other.last.tick),
            history.period_s,
            Seen(history.lanes.outputs, ALL_PROGRAMS & ~sum(1 << n for n in history.unmarked)),
            [installation.axis_name(axis) for axis in AXES],
            LineNames(history.aliases, installation.store),
        )

    pair = await call.panel.ask(look)
    same = f"branches {query.branch} and {query.other} do the same"
    if pair.apart is None or pair.apart > pair.last:
        raise UserError(f"{same} as far as both are known")
    begin = first = max(pair.first, pair.apart)
    end = min(pair.last, begin + round(SEARCHED_S / pair.period_s))
    while True:
        last = min(end, first + round(LIVED_S / pair.period_s))
        courses = [await _course(call, each, first, last) for each in (query.branch, query.other)]
        found = await call.panel.histories.run(first_differences, *courses, first, last, pair.seen)
        if found:
            break
        if last == end:
            until_s = end * pair.period_s
            raise UserError(f"{same} from their first different input to {until_s:.4g} s")
        first = last
    return {
        "apart": begin,
        "differences": [{**each._asdict(), "name": pair.name_of(each)} for each in found],
    }


class Pair(NamedTuple):
    """What two branches have in common, and what their differences are named by."""

    apart: int | None  # the first input that they do not share
    first: int
    last: int
    period_s: float
    seen: Seen
    axes: list[str]
    lines: LineNames

    def name_of(self, difference: Difference) -> str:
        """What differs."""
        if difference.kind == "line":
            return f"PROG{difference.number}"
        if difference.kind != "output":
            return self.axes[difference.number]
        word, bit = divmod(difference.number, BITS)
        name, card = self.lines.of("output", (self.seen.words[word] - FLAG_WORD_BASE) * BITS + bit)
        return f"{name} ({card})" if name else card


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
