"""Programs and PLCs of the card: a list with states, listings, the ladder of a PLC."""

import asyncio
import re
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from typing import Annotated, TypeVar

from msgspec import Meta, to_builtins
from starlette.concurrency import run_in_threadpool

from openacr.client import Level
from openacr.client.backup import surroundings
from openacr.client.card_axes import attached
from openacr.client.drives import BARS, said
from openacr.client.effects import Op
from openacr.client.names import item_names
from openacr.client.program_states import PLCS, PROGRAMS
from openacr.client.stored import ListedLine, Room, aliases, listing, rooms, version_of
from openacr.client.talk import Talk
from openacr.errors import CardError
from openacr.lang.lexer import tokens
from openacr.panel.commands.programs import level_of, owner_of
from openacr.panel.control.engineer.card_programs import State, read_states
from openacr.panel.control.engineer.conversations import Talks, answer_of
from openacr.panel.control.station import Station
from openacr.panel.server.api import Call, Query, endpoint
from openacr.panel.server.panel import Panel
from openacr.plc.diagram import pictures
from openacr.plc.reader import PlcLine, read_line
from openacr.timeline import Course

T = TypeVar("T")
_NUMBER = re.compile(r"(BIT\s*)?(\d+)", re.IGNORECASE)


class OfPlc(Query, frozen=True):
    """A PLC."""

    plc: Annotated[int, Meta(ge=0, lt=len(PLCS))]


class OfProgram(Query, frozen=True):
    """A program, or a PLC."""

    program: Annotated[int, Meta(ge=0, lt=len(PROGRAMS))] | None = None
    plc: Annotated[int, Meta(ge=0, lt=len(PLCS))] | None = None

    @property
    def level(self) -> Level:
        """What is named; UserError unless it is exactly one."""
        return level_of(self.program, self.plc)


class _Aliases:
    """The aliases of the card in the lines of a PLC: what #DEFINE gives a flag or number."""

    def __init__(self, targets: Mapping[str, str]) -> None:
        found = {name: _NUMBER.fullmatch(text) for name, text in targets.items()}
        self.numbers = {name: int(each[2]) for name, each in found.items() if each}
        self.flags = {int(each[2]): name for name, each in found.items() if each and each[1]}

    def number(self, name: str) -> int | None:
        return self.numbers.get(name)

    def is_command(self, word: str) -> bool:
        return False


async def talked(panel: Panel, talks: Talks[T]) -> T:
    """The result of a conversation that only asks, beside the session.

    A card whose time is still, or at a moment of its history, is asked by a copy of it: its
    programs are those of the moment.
    """
    future: Future[T] = Future()

    def begin(station: Station) -> Course | None:
        if station.link.is_still or station.link.is_away:
            return station.times.history.moment()
        station.on_card.aside.begin(talks, future)
        return None

    moment = await panel.ask(begin)
    if moment is not None:
        return await run_in_threadpool(answer_of, moment, talks)
    return await asyncio.wrap_future(future)


@endpoint("GET", "/card/programs")
async def card_programs(call: Call) -> object:
    """The programs and PLCs of the card: state, line, memory, and which belong to the machine.

    States: running, halted, paused, waits for STEP, waits for room (in the move buffer), dwells,
    inhibited. Changes of state are the topic `programs` of the WebSocket.
    """

    def read(station: Station) -> tuple[list[State], dict[str, str]]:
        states = read_states(station.link.read)
        levels = [*map(Level.program, PROGRAMS), *map(Level.plc, PLCS)]
        return states, {str(level): owner_of(station, level) for level in levels}

    states, owners = await call.panel.ask(read)
    memory = {str(level): room for level, room in (await talked(call.panel, rooms)).items()}
    return {
        "programs": [
            {**state, **_memory(memory.get(state["name"])), "owner": owners[state["name"]]}
            for state in states
        ]
    }


def _memory(room: Room | None) -> dict[str, int]:
    return (
        {"bytes": room.total, "used": room.total - room.free} if room else {"bytes": 0, "used": 0}
    )


@endpoint("GET", "/card/axes")
async def attached_axes(call: Call) -> object:
    """The axes that programs of the card move, with the names that they give them."""
    found = {each.axis: each.name for each in await talked(call.panel, attached)}
    return {"axes": [{"index": index, "name": found[index]} for index in sorted(found)]}


@endpoint("GET", "/card/drives")
async def card_drives(call: Call) -> object:
    """The drives of the axes that programs of the card have, with what is wrong with each.

    Lengths are in units of the axis, outputs in V. `wrong` has a key and a text for each cause, the
    first ones (`bars`) keep the drive from being switched on.
    """

    def read(station: Station) -> list[dict[str, object]]:
        installation, settings = station.installation, station.times.settings
        own = {} if settings is None else {each.index: each.name for each in settings.axes}
        names = {each.axis: each.name for each in reversed(installation.attached)}
        return [
            {
                **to_builtins(drive),
                "name": own.get(drive.axis, f"AXIS{drive.axis}"),
                "title": own.get(drive.axis, f"{names[drive.axis]} (AXIS{drive.axis})"),
                "is_homed": settings.is_homed(drive.axis)
                if settings is not None and drive.axis in own and not station.link.is_away
                else drive.is_homed,
                "wrong": [
                    {"key": key, "text": said(key, drive.axis), "bars": key in BARS}
                    for key in drive.wrong
                ],
            }
            for drive in station.drives.look()
        ]

    return {"drives": await call.panel.ask(read)}


@endpoint("GET", "/card/bus")
async def card_bus(call: Call) -> object:
    """The bus of the machine with its devices, drives and counters.

    `report` is null while it is not known, `is_open` false where the panel has opened none.
    """
    bus = call.panel.installation.bus
    return {"is_open": bus is not None, "report": None if bus is None else bus.report}


@endpoint("GET", "/card/listing", query=OfProgram)
async def card_listing(call: Call) -> object:
    """The text of a program or PLC as the card lists it, each line with its number."""
    level = call.query.level
    lines = await talked(call.panel, lambda talk: listing(talk, level))
    return await run_in_threadpool(
        lambda: {"name": str(level), "version": version_of(lines), **_listed(lines)}
    )


@endpoint("GET", "/card/surroundings", query=OfProgram)
async def card_surroundings(call: Call) -> object:
    """The memory, aliases and axes that a program or PLC finds on the card, as set-up code."""
    level = call.query.level
    return {"setup": await talked(call.panel, lambda talk: surroundings(talk, level))}


def _listed(lines: Sequence[ListedLine]) -> dict[str, object]:
    return {"lines": [to_builtins(line) for line in lines]}


@endpoint("GET", "/card/aliases")
async def card_aliases(call: Call) -> object:
    """What #DEFINE calls flags and parameters: the alias of BIT36, P12290."""
    return {"aliases": item_names(await talked(call.panel, aliases))}


@endpoint("GET", "/card/ladder", query=OfPlc)
async def card_ladder(call: Call) -> object:
    """A PLC as a ladder: symbols and wires on a grid, with the nets that carry power together.

    Net 0 is the left rail; a symbol passes power from `source` (a counter or latch: `reset`) to
    `sink`. Where it cannot be drawn, `rungs` is empty and `why` says so; the text is always there.
    `names` has the aliases of flags by their numbers.
    """
    query: OfPlc = call.query
    level = Level.plc(query.plc)

    def read(talk: Talk) -> Op[tuple[list[ListedLine], dict[str, str]]]:
        lines = yield from listing(talk, level)
        return lines, (yield from aliases(talk))

    lines, targets = await talked(call.panel, read)

    def drawn() -> object:
        rungs, why = ladder(lines, targets)
        names = {str(flag): name for flag, name in _Aliases(targets).flags.items()}
        return {"name": str(level), **_listed(lines), "rungs": rungs, "why": why, "names": names}

    return await run_in_threadpool(drawn)


def ladder(
    lines: Sequence[ListedLine], targets: Mapping[str, str]
) -> tuple[list[dict[str, object]], str]:
    """The rungs of a listing, and why there are no rungs; `targets` has what aliases stand for."""
    names = _Aliases(targets)
    read: list[tuple[int, PlcLine]] = []
    number = 0
    try:
        for number, text in ((line.number, line.text) for line in lines):
            found = read_line(tokens(text), names)
            if found is not None:
                read.append((number, found))
        number = 0
        return [to_builtins(picture) for picture in pictures(read)], ""
    except CardError as error:
        return [], f"line {number}: {error}" if number else str(error)
