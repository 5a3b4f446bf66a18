"""Breakpoints of the programs of a card in this process: each program is held alone, as by PAUSE.

The card stops before the line and gets PAUSE of the program there, which holds its motion by a
feedhold. PAUSE alone would let the program run until the path rests, so its mode is set with it.
Everything else runs on, RESUME releases the program, and the history has both as inputs.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from openacr.controller import Controller
from openacr.debugger import questions
from openacr.debugger.breakpoints import LineBreakpoint
from openacr.debugger.calls import is_running, name_of
from openacr.debugger.line_stops import LineStops
from openacr.debugger.stops import Reason
from openacr.errors import UserError
from openacr.map import numbers as at
from openacr.map.words import pf

MOST = 64
MODE_FLAG = 32 * (pf.word[0] - at.FLAG_WORD_BASE) + pf.PAUSE_MODE.bit_length() - 1  # of PROG0


@dataclass(frozen=True, slots=True)
class Held:
    """Before which line a program is held, and why; `hits` counts the holds."""

    line: int
    reason: str
    hits: int


class Breakpoints:
    """The breakpoints of one card, and the programs that they hold."""

    def __init__(self, card: Controller, is_live: Callable[[], bool]) -> None:
        """`is_live`: whether what happens now is new; the past is never held anew."""
        self._card, self._is_live = card, is_live
        self.on_note: Callable[[str], None] = lambda _text: None  # a condition that fails
        self._stops = LineStops(card, lambda text: self.on_note(text.strip()))
        self._reached: dict[int, tuple[int, Reason]] = {}  # by program, within the present tick
        self._held: dict[int, Held] = {}
        self._hits = 0

    # --- what stops -------------------------------------------------------------------

    def set(self, program: int, line: int, condition: str = "") -> None:
        """Hold a program before a line, if a condition is not 0; UserError without a statement."""
        stored = self._card.system.programs.lines(program)
        if not any(each.number == line and any(each.tree.blocks) for each in stored):
            raise UserError(
                f"{name_of(program)} line {line}: nothing is executed there; a breakpoint belongs"
                " to a line with a statement, not to a label or remark alone"
            )
        places = self._stops.lines
        if (program, line) not in places and len(places) >= MOST:
            raise UserError(f"{MOST} breakpoints are set: remove one first")
        places[program, line] = LineBreakpoint(program, line, condition.strip())
        self.arm()

    def clear(self, program: int | None = None, line: int | None = None) -> None:
        """Remove the breakpoint of a line, all of a program, or all there are."""
        kept = [
            each
            for each in self._stops.lines.values()
            if program not in (None, each.program) or line not in (None, each.line)
        ]
        self._stops.set_lines(kept)
        self.arm()

    def step(self, program: int, *, into: bool, out: bool) -> None:
        """Hold a program again before its next line; the caller lets it go on. UserError."""
        self._stops.begin_step(program, into=into, out=out)
        self.arm()

    def unstep(self, program: int) -> None:
        """Take a step back that was not begun."""
        self._stops.steps.pop(program, None)
        self.arm()

    def arm(self) -> None:
        """Have the card ask before the lines that count."""
        programs = self._stops.programs()
        mask = sum(1 << program for program in programs)
        self._card.announce_lines(mask, self._ask if programs else None)

    # --- the card reaches one ---------------------------------------------------------

    def _ask(self, program: int, line: int) -> bool:
        """Whether the card stops before a line."""
        self._held.pop(program, None)
        flags = self._card.memory.I[pf.word[program]]
        if flags & (pf.BLOCK_MODE | pf.PAUSE_MODE) or not self._is_live():
            return False  # STEP has brought it here, and it is held by itself
        stop = self._stops.reason(program, line)
        if stop is not None:
            self._reached[program] = line, stop.reason
        return stop is not None

    def attend(self) -> None:
        """The card has stopped: hold the program whose line was reached."""
        for program, (line, reason) in self._reached.items():
            self._card.bit[MODE_FLAG + 32 * program] = True
            questions.typed(self._card, program, f"PAUSE {name_of(program)}")
            self._hits += 1
            self._held[program] = Held(line, reason.value, self._hits)
            self._stops.steps.pop(program, None)
        if self._reached:
            self._reached.clear()
            self.arm()

    # --- what is shown ----------------------------------------------------------------

    def data(self) -> dict[str, Any]:
        """All breakpoints, and the programs that are held, for the screens."""
        for program in [each for each in self._stops.steps if not is_running(self._card, each)]:
            self.unstep(program)  # it has ended
        return {
            "breakpoints": [
                {"program": each.program, "line": each.line, "condition": each.condition}
                for _, each in sorted(self._stops.lines.items())
            ],
            "held": [
                {"program": program, "line": held.line, "why": held.reason, "hit": held.hits}
                for program, held in sorted(self._held.items())
                if self._is_held(program, held)
            ],
        }

    def _is_held(self, program: int, held: Held) -> bool:
        return (
            is_running(self._card, program)
            and bool(self._card.memory.I[pf.word[program]] & pf.PAUSE_MODE)
            and self._card.executor.threads.next_line(program) == held.line
        )
