"""Commands of breakpoints: set, removed, and the programs that are held there let go."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.client import Level
from openacr.client.program_states import ROWS, program_states
from openacr.debugger.calls import PROGRAMS
from openacr.errors import UserError
from openacr.map.words import pf
from openacr.panel.commands.programs import Plc, Program, begin, level_of, required
from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.on_card import OnCard
from openacr.panel.control.station import Station
from openacr.panel.roles import Role

Line = Annotated[int, Meta(ge=1, le=9_999_999)]
Condition = Annotated[str, Meta(max_length=80, pattern=r"^[ -~]*$")]


@command("break.set", Role.SERVICE)
def set_breakpoint(
    station: Station,
    *,
    program: Program | None = None,
    plc: Plc | None = None,
    line: Line,
    condition: Condition = "",
) -> None:
    """Hold a program before a line of it, from now on; with a condition, where that is not 0.

    The condition is an expression of AcroBASIC, computed at the prompt of the program. The program
    is held as by PAUSE, its motion by a feedhold; everything else runs on. A PLC is held after a
    scan that changes a coil of the line: it scans no more, its outputs stay as they are.
    """
    station.on_card.stops.set(owner(required(station, program, plc)), line, condition)


@command("break.clear", Role.SERVICE)
def clear_breakpoints(
    on_card: OnCard,
    *,
    program: Program | None = None,
    plc: Plc | None = None,
    line: Line | None = None,
) -> None:
    """Remove the breakpoint of a line, all of a program or PLC, or all of the card.

    What is held stays so.
    """
    if (program, plc) == (None, None):
        if line is not None:
            raise UserError(f"line {line}: name the program or PLC that has it")
        on_card.stops.clear()
    else:
        on_card.stops.clear(owner(level_of(program, plc)), line)


def owner(level: Level) -> int:
    """How the card counts programs (0-15) and PLCs (16-23)."""
    return int(level.number) + (PROGRAMS if level.word == "PLC" else 0)


@command("card.go", Role.SERVICE, is_motion=True)
def go(
    station: Station,
    *,
    program: Program | None = None,
    plc: Plc | None = None,
    how: Literal["on", "over", "into", "out"] = "on",
) -> None:
    """Let a program that is held run on, or to its next line; a PLC scan on.

    `over` passes routines that the line calls, `into` stops in them, `out` runs to the end of its
    own. Its motion is released with it, and held with it again.
    """
    level = required(station, program, plc)
    if program is None:
        if how != "on":
            raise UserError(f"{level}: a PLC is scanned as a whole; it has no steps, only GO ON")
        station.on_card.stops.go_on(owner(level))
        return
    state = program_states(station.link.read(list(ROWS)))[program]
    if not state.is_running:
        raise UserError(f"{level} does not run: RUN starts it")
    held = [
        word
        for word, flag in (("AUT", pf.BLOCK_CONTROL), ("RESUME", pf.PAUSE_CONTROL))
        if state.flags & flag
    ]
    stops = None if how == "on" else station.on_card.stops
    if stops is not None:
        stops.step(program, into=how == "into", out=how == "out")
    try:
        for word in held:
            begin(station, word, level)
    except Exception:
        if stops is not None:
            stops.unstep(program)
        raise
