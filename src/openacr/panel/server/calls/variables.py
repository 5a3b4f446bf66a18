"""What a program works with: variables, the parameters and flags in its text, its flow stack."""

from collections.abc import Sequence
from typing import Annotated

from msgspec import Meta, to_builtins
from starlette.concurrency import run_in_threadpool

from openacr.client.program_variables import dimensioned, variables
from openacr.client.stored import ListedLine, listing
from openacr.debugger.calls import is_running, levels_of, state_of
from openacr.debugger.variables import local_text
from openacr.editing.controller.marks import marks_of
from openacr.editing.marks import Kind, Mark
from openacr.errors import UserError
from openacr.map import Flag, Parameter, flags, parameters
from openacr.panel.control.station import Station
from openacr.panel.server.api import Call, endpoint
from openacr.panel.server.calls.card import data_of
from openacr.panel.server.calls.on_card import OfProgram, talked

MOST_USED = 200
NAMES = r"^[LSD$][VA]\d{1,4}(\(\d{1,6}\))?(;[LSD$][VA]\d{1,4}(\(\d{1,6}\))?){0,59}$"
NO_STACK = (
    "a card over a link does not show its flow stack: LISTEN and TRON show the lines it executes"
)


@endpoint("GET", "/card/variables", query=OfProgram)
async def card_variables(call: Call) -> object:
    """The variables of a program, what it waits for and its flow stack, the outermost level first.

    `levels` and `state` are those of a card in this process; of another card `why` says so.
    """
    number = _program(call)
    found = await talked(call.panel, lambda talk: variables(talk, number))

    def read(station: Station) -> dict[str, object]:
        card = station.installation.controller
        if card is None:
            return {"state": "", "levels": [], "why": NO_STACK}
        state = state_of(card, number) if is_running(card, number) else ""
        return {
            "state": state,
            "levels": list(map(to_builtins, levels_of(card, number))),
            "why": "",
        }

    place = await call.panel.ask(read)
    return {"name": f"PROG{number}", "variables": list(map(to_builtins, found)), **place}


class Locals(OfProgram, frozen=True, kw_only=True):
    """Variables and elements of a program, as LV0;LA0(3)."""

    names: Annotated[str, Meta(max_length=2000, pattern=NAMES)]


@endpoint("GET", "/card/values", query=Locals)
async def card_values(call: Call) -> object:
    """The values of variables and elements of a program; those it has not dimensioned are absent.

    Those of a card in this process are read from its memory, also where its time is still.
    """
    number, names = _program(call), call.query.names.split(";")

    def read(station: Station) -> dict[str, str] | None:
        card = station.installation.controller
        if card is None:
            return None
        held = {each: local_text(card, number, each) for each in names}
        return {name: text for name, text in held.items() if text is not None}

    found = await call.panel.ask(read)
    if found is None:
        found = await talked(call.panel, lambda talk: dimensioned(talk, number, names))
    return {"values": found}


@endpoint("GET", "/card/used", query=OfProgram)
async def card_used(call: Call) -> object:
    """The parameters and flags that the text of a program names by number."""
    number = _program(call)
    lines = await talked(call.panel, lambda talk: listing(talk, call.query.level))
    return {"name": f"PROG{number}", "items": await run_in_threadpool(used, lines)}


def _program(call: Call) -> int:
    level = call.query.level
    if level.word != "PROG":
        raise UserError(f"{level}: only programs have variables of their own")
    return int(level.number)


def used(lines: Sequence[ListedLine]) -> list[dict[str, object]]:
    """The parameters and flags that lines name, in the order of their numbers."""
    marks = [
        mark
        for line in lines
        for mark in marks_of(line.text, frozenset(), frozenset(), is_plc=False)
    ]
    known: list[Parameter | Flag | None] = []
    known += [parameters().get(number) for number in _numbers(marks, Kind.PARAMETER)]
    known += [flags().get(number) for number in _numbers(marks, Kind.FLAG)]
    return [data_of(each) for each in known if each is not None][:MOST_USED]


def _numbers(marks: Sequence[Mark], kind: Kind) -> list[int]:
    """The numbers of one kind; the user's P variables are parameters, those of programs are not."""
    return sorted(
        {
            mark.number
            for mark in marks
            if mark.kind is kind
            or (kind is Kind.PARAMETER and mark.kind is Kind.VARIABLE and mark.name.startswith("P"))
        }
    )
