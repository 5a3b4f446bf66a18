"""What the programs and PLCs of a card do, by their flags and line numbers."""

from collections.abc import Sequence

from msgspec import Struct

from openacr.client.requests import Level
from openacr.client.values import Number
from openacr.map.rows import programs as program_rows
from openacr.map.words import pf, plf

PROGRAMS = range(program_rows.COUNT)
PLCS = range(len(plf.word))
ROWS = (*pf.word, *program_rows.line_number, *plf.word)  # what `program_states` is made of
RUNS, HALTED = "running", "halted"
# The first that holds is what a running program does.
_DOES = (
    (pf.PAUSE_MODE, "paused"),
    (pf.BLOCK_MODE_WAITING, "waits for STEP"),
    (pf.MOVE_PENDING, "waits for room"),
    (pf.PROGRAM_DWELLING, "dwells"),
    (pf.PROGRAM_INHIBITED, "inhibited"),
)


class ProgramState(Struct, frozen=True):
    """A program or PLC: its flags, and of a program the line that it executed last."""

    level: Level
    flags: int
    line: int = 0

    @property
    def is_running(self) -> bool:
        """Whether a program executes, waits or is held, or a PLC is scanned."""
        running = plf.PLC_RUNNING if self.level.word == "PLC" else pf.PROGRAM_RUNNING
        return bool(self.flags & running)

    @property
    def does(self) -> str:
        """What it does, in words."""
        if not self.is_running:
            return HALTED
        if self.level.word == "PLC":
            return RUNS
        return held_by(self.flags) or RUNS


def held_by(flags: int) -> str:
    """What a running program waits for, by its flags; empty where it waits for nothing of them."""
    return next((does for mask, does in _DOES if flags & mask), "")


def program_states(values: Sequence[Number]) -> list[ProgramState]:
    """The programs, then the PLCs, by the values of ROWS."""
    numbers = list(map(int, values))
    flags, numbers = numbers[: len(PROGRAMS)], numbers[len(PROGRAMS) :]
    lines, plc_flags = numbers[: len(PROGRAMS)], numbers[len(PROGRAMS) :]
    programs = [
        ProgramState(Level.program(n), word, line)
        for n, word, line in zip(PROGRAMS, flags, lines, strict=True)
    ]
    return programs + [
        ProgramState(Level.plc(n), word) for n, word in zip(PLCS, plc_flags, strict=True)
    ]
