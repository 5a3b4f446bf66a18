"""Where the programs of a card stand: lines, routines that were called, why they wait."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

from openacr.basic.vm.flow_cy import FLOW_FOR, FLOW_GOSUB, FLOW_IF, FLOW_WHILE
from openacr.basic.vm.scheduler_cy import THREAD_HELD, THREAD_IDLE, THREAD_READY, THREAD_WAITING
from openacr.client.program_states import held_by
from openacr.controller.controller import Controller
from openacr.map.rows import programs as program_rows
from openacr.map.rows import threads as thread_rows
from openacr.map.words import pf

PROGRAMS = program_rows.COUNT

_STATES = {
    THREAD_IDLE: "ended",
    THREAD_READY: "running",
    THREAD_WAITING: "waiting",
    THREAD_HELD: "held before a line",
}
_LEVELS = {FLOW_IF: "IF", FLOW_FOR: "FOR", FLOW_WHILE: "WHILE", FLOW_GOSUB: "GOSUB"}


@dataclass(frozen=True, slots=True)
class Frame:
    """A line of a program or PLC (16-23): the present one, or one that has called a routine."""

    owner: int
    line: int
    path: str = ""  # of the project file, with its line; without one: the listing of the card
    file_line: int = 0


def is_running(card: Controller, program: int) -> bool:
    """Whether a program executes, waits or is held."""
    return card.executor.is_running(program)


def state_of(card: Controller, program: int) -> str:
    """What a program does, in words."""
    if held := held_by(card.memory.I[pf.word[program]]):
        return held
    return _STATES[card.executor.threads.row(program, thread_rows.state)]


@dataclass(frozen=True, slots=True)
class OpenLevel:
    """An IF, FOR, WHILE or GOSUB that has begun and has not ended, and its line."""

    word: str
    line: int

    def __str__(self) -> str:
        return f"{self.word} line {self.line}"


def levels_of(card: Controller, program: int) -> list[OpenLevel]:
    """The flow stack of a program, the outermost level first."""
    threads = card.executor.threads
    found = []
    for level in range(threads.row(program, thread_rows.depth) if is_running(card, program) else 0):
        kind = threads.row(program, thread_rows.flow_kind, level)
        is_call = kind == FLOW_GOSUB
        row = thread_rows.flow_back if is_call else thread_rows.flow_start
        line = _line_at(card, program, threads.row(program, row, level))
        found.append(OpenLevel(_LEVELS[kind], line))
    return found


def depth_of(card: Controller, program: int) -> int:
    """How many routines (GOSUB) of a program are open."""
    return sum(1 for _ in _returns(card, program))


def frames_of(card: Controller, program: int) -> list[Frame]:
    """The line that a program executes next or waits in, then those that called it."""
    if not is_running(card, program):
        return []
    present = card.executor.threads.row(program, thread_rows.line)
    if card.announced_program == program:
        present = card.executor.threads.next_line(program)
    callers = [_line_at(card, program, place) for place in _returns(card, program)]
    return [frame_of(card, program, line) for line in (present, *reversed(callers))]


def _returns(card: Controller, program: int) -> Iterator[int]:
    threads = card.executor.threads
    for level in range(threads.row(program, thread_rows.depth)):
        if threads.row(program, thread_rows.flow_kind, level) == FLOW_GOSUB:
            yield threads.row(program, thread_rows.flow_back, level)


def _line_at(card: Controller, program: int, place: int) -> int:
    """The line whose code holds the place after a GOSUB."""
    starts = sorted(
        (start, line) for line, start in card.executor.threads.space.chunks[program].starts.items()
    )
    return starts[bisect_right(starts, (place - 1, 1 << 31)) - 1][1]


def frame_of(card: Controller, owner: int, line: int) -> Frame:
    """A stored line, with its place in the project."""
    path, file_line = card.origin(owner, line) or ("", 0)
    return Frame(owner, line, path, file_line)


def owners(card: Controller) -> list[int]:
    """The programs and PLCs (16-23) that have a text."""
    programs = card.system.programs
    return [owner for owner in card.system.owners() if not programs.is_empty(owner)]


def name_of(owner: int) -> str:
    """What the manuals call a program or PLC."""
    return f"PROG{owner}" if owner < PROGRAMS else f"PLC{owner - PROGRAMS}"


def listing(card: Controller, owner: int) -> list[str]:
    """The lines of a program or PLC as they were stored, each with its number."""
    return [f"{line.number} {line.text.strip()}" for line in card.system.programs.lines(owner)]
