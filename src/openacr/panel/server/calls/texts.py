"""Texts of controller files while they are edited: questions to the engine of editors."""

from collections.abc import Iterable
from typing import Annotated, Literal

from msgspec import Meta

from openacr.client import Level
from openacr.client.effects import Op
from openacr.client.stored import ListedLine, listing
from openacr.client.talk import Talk
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.panel.server.api import Body, Call, endpoint
from openacr.panel.server.calls.on_card import talked
from openacr.panel.work.comparing import compared
from openacr.panel.work.desk import Change, State
from openacr.panel.work.text_questions import About, answer

MOST_TEXT = 2_000_000  # characters
SLOW = frozenset(("findings", "formatted", "stored"))  # in a process of their own

Place = Annotated[int, Meta(ge=0, le=10_000_000)]
Program = Annotated[str, Meta(pattern="^(PROG(\\d|1[0-5])|PLC[0-7])$")]
Text = Annotated[str, Meta(max_length=MOST_TEXT)]


class Edited(Body, frozen=True):
    """A text by the mark of its browser, brought up to date whole or by changes of `base`."""

    mark: Annotated[str, Meta(pattern="^[0-9a-z-]{8,40}$")]
    name: Annotated[str, Meta(pattern=r"^[^/\\:\x00-\x1f]{1,100}\.8[kK]$")]
    version: Place
    base: Place = 0
    text: Text | None = None
    changes: tuple[Change, ...] = ()
    setup: Text = ""

    @property
    def state(self) -> State:
        """The same for the process that holds it."""
        return State(
            self.mark, self.name, self.version, self.base, self.text, self.changes, self.setup
        )


class Asked(Edited, frozen=True, kw_only=True):
    """A question about a text, at a place or about lines; columns in 16-bit units, all from 0."""

    ask: Literal[
        "colors", "hints", "values", "hover", "complete", "signature", "definitions", "references",
        "renamable", "rename", "outline", "folds", "formatted", "findings", "stored",
    ]  # fmt: skip
    line: Place = 0
    column: Place = 0
    last: Place = 0
    word: Annotated[str, Meta(max_length=80)] = ""


class Compared(Edited, frozen=True, kw_only=True):
    """A text that is compared with these programs and PLCs of the card (PROG3, PLC0)."""

    programs: Annotated[tuple[Program, ...], Meta(max_length=24)]


class Kept(Body, frozen=True):
    """A text that a command then sends to the card."""

    text: Text


@endpoint("POST", "/text", body=Asked)
async def ask_text(call: Call) -> object:
    """Answer a question about a text that is edited: colours, findings, completion, names ...

    `stale` where the text is not known in the version that the changes begin from.
    """
    body: Asked = call.body
    pool = call.panel.checks if body.ask in SLOW else call.panel.texts
    about = About(body.line, body.column, body.last, body.word)
    return await pool.run(answer, body.state, body.ask, about)


@endpoint("POST", "/text/compare", body=Compared)
async def compare_text(call: Call) -> object:
    """A text beside what the card holds: lines that mean the same are opposite each other."""
    body: Compared = call.body
    levels = [Level.of_line(name) or Level() for name in body.programs]
    found = await talked(call.panel, lambda talk: _listings(talk, levels))
    return await call.panel.checks.run(compared, body.state, found)


def _listings(talk: Talk, levels: Iterable[Level]) -> Op[dict[str, list[ListedLine]]]:
    found = {}
    for level in levels:
        found[str(level)] = yield from listing(talk, level)
    return found


@endpoint("POST", "/text/parked", Role.SERVICE, body=Kept)
async def park_text(call: Call) -> object:
    """Keep a text for the command `card.send` or `card.download`, which names it by `parked`."""

    def park(station: Station) -> str:
        return station.on_card.parked.put(call.body.text)

    return {"parked": await call.panel.ask(park)}
