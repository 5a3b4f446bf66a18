"""Commands of MDI and TEACH."""

from typing import Annotated

from msgspec import Meta

from openacr.errors import UserError
from openacr.mill.manual.teaching import teach
from openacr.mill.session import MillSession
from openacr.panel.commands.motion import indices
from openacr.panel.commands.registry import command
from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.operator.typed import Typed
from openacr.panel.helps import Page
from openacr.panel.roles import Role

Line = Annotated[str, Meta(max_length=256)]
Lines = Annotated[tuple[Line, ...], Meta(max_length=10_000)]


@command(
    "mdi.execute",
    is_motion=True,
    en="EXECUTE",
    de="AUSFÜHREN",
    page=Page(
        "mdi",
        "MDI",
        "Blocks run one by one; what they switch on stays on. While BUFFER is on, the text keeps"
        " what was executed; it can be edited and stored as a program.",
        de=(
            "MDI",
            "Sätze laufen einer nach dem anderen; was sie einschalten, bleibt ein."
            " Solange PUFFER ein ist, behält der Text, was ausgeführt wurde; er kann"
            " geändert und als Programm gespeichert werden.",
        ),
    ),
)
def execute(typed: Typed, *, line: Line = "", lines: Lines = (), kept: bool = False) -> None:
    """EXECUTE: run a block that was typed, or several one after the other.

    `kept`: the text of MDI has them.
    """
    blocks = [each for each in (line, *lines) if each.strip()]
    if not blocks:
        raise UserError("no block was typed")
    typed.put(blocks, is_shown=not kept)


@command("mdi.buffer", needs_control=False)
def buffer(
    typed: Typed, *, lines: Lines | None = None, on: bool | None = None
) -> dict[str, object]:
    """Read the text of MDI, or replace it, or switch its buffer.

    `on`: what is executed becomes part of it.
    """
    if lines is not None:
        typed.text = list(lines)
    if on is not None:
        typed.is_buffer_on = on
    return {"lines": list(typed.text), "on": typed.is_buffer_on}


@command(
    "teach.work",
    Role.SETUP,
    page=Page(
        "teach",
        "TEACH",
        "The present machine position becomes the zero of a work system, on the chosen axes; or"
        " that of Z the length of a tool. Nothing moves.",
        de=(
            "TEACH",
            "Die jetzige Maschinenposition wird der Nullpunkt eines Werkstücksystems,"
            " für die gewählten Achsen; oder die von Z die Länge eines Werkzeugs. Nichts"
            " bewegt sich.",
        ),
    ),
)
def teach_work(
    machine: MillSession, interlocks: Interlocks, *, system: str, axes: str = ""
) -> None:
    """TEACH: where the machine is becomes the zero of a work system."""
    machine.runner.alarms.require_none()
    if interlocks.is_moved:
        raise UserError("the machine is moving: a work system can be taught only at rest")
    here = machine.runner.stream.host.position()
    teach(machine.cells, machine.runner.settings, system, here, indices(machine, axes))
