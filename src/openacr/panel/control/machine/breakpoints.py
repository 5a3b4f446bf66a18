"""Breakpoints of the programs of a card in this process: each program is held alone, as by PAUSE.

The card stops before the line and gets PAUSE of the program there, which holds its motion by a
feedhold. PAUSE alone would let the program run until the path rests, so its mode is set with it.
Everything else runs on, RESUME releases the program, and the history has both as inputs.
Those of PLCs are in `plc_stops.py`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from openacr.controller import Controller
from openacr.debugger import questions
from openacr.debugger.breakpoints import MASTERS, LineBreakpoint
from openacr.debugger.calls import PROGRAMS, is_running, name_of
from openacr.debugger.line_stops import LineStops
from openacr.debugger.stops import Reason
from openacr.engine.watches import WATCHES, Watch
from openacr.errors import UserError
from openacr.map import numbers as at
from openacr.map.words import pf
from openacr.panel.control.machine.plc_stops import PlcStops

MOST = 64
MOST_COILS = WATCHES - PROGRAMS - MASTERS  # ends of programs and kills are watched, too
MODE_FLAG = 32 * (pf.word[0] - at.FLAG_WORD_BASE) + pf.PAUSE_MODE.bit_length() - 1  # of PROG0


@dataclass(frozen=True, slots=True)
class Held:
    """Before which line a program is held (a PLC: after a change), and why; `hits` counts."""

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
        self.on_watches: Callable[[], None] = lambda: None  # other coils are to be watched
        self._plcs = PlcStops(card, self._stops.conditions)
        self._reached: dict[int, tuple[int, Reason]] = {}  # by program, within the present tick
        self._held: dict[int, Held] = {}
        self._hits = 0

    # --- what stops -------------------------------------------------------------------

    def set(self, program: int, line: int, condition: str = "") -> None:
        """Hold a program before a line, if a condition is not 0; UserError without a statement.

        A PLC (16-23) is held after a scan that changes a coil of the line.
        """
        places, rungs = self._stops.lines, self._plcs.lines
        if (program, line) not in {*places, *rungs} and len(places) + len(rungs) >= MOST:
            raise UserError(f"{MOST} breakpoints are set: remove one first")
        if program >= PROGRAMS:
            self._plcs.set(program, line, condition.strip(), MOST_COILS)
            self.on_watches()
            return
        stored = self._card.system.programs.lines(program)
        if not any(each.number == line and any(each.tree.blocks) for each in stored):
            raise UserError(
                f"{name_of(program)} line {line}: nothing is executed there; a breakpoint belongs"
                " to a line with a statement, not to a label or remark alone"
            )
        places[program, line] = LineBreakpoint(program, line, condition.strip())
        self.arm()

    def clear(self, program: int | None = None, line: int | None = None) -> None:
        """Remove the breakpoint of a line, all of a program, or all there are."""

        def is_kept(each: LineBreakpoint) -> bool:
            return program not in (None, each.program) or line not in (None, each.line)

        self._stops.set_lines(filter(is_kept, self._stops.lines.values()))
        plcs = self._plcs.lines
        self._plcs.lines = {place: each for place, each in plcs.items() if is_kept(each)}
        self.on_watches()
        self.arm()

    def go_on(self, plc: int) -> None:
        """Let a PLC (16-23) that is held scan on; UserError for any other."""
        self._plcs.go_on(plc)

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

    def watches(self) -> list[Watch]:
        """The coils of PLCs that the engine watches; `fired` gets the places of this list."""
        return self._plcs.watches()

    def fired(self, places: list[int]) -> None:
        """Coils have changed in this tick: hold their PLCs."""
        for plc, line in (self._plcs.hold(places) if self._is_live() else {}).items():
            self._hits += 1
            self._held[plc] = Held(line, Reason.BREAKPOINT.value, self._hits)

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
        if self._plcs.is_stale:
            self.on_watches()
        return {
            "breakpoints": [
                {**_named(owner), "line": line, "condition": each.condition}
                for (owner, line), each in sorted({**self._stops.lines, **self._plcs.lines}.items())
            ],
            "held": [
                {**_named(program), "line": held.line, "why": held.reason, "hit": held.hits}
                for program, held in sorted(self._held.items())
                if self._is_held(program, held)
            ],
        }

    def _is_held(self, program: int, held: Held) -> bool:
        if program >= PROGRAMS:
            return self._plcs.is_held(program)
        return (
            is_running(self._card, program)
            and bool(self._card.memory.I[pf.word[program]] & pf.PAUSE_MODE)
            and self._card.executor.threads.next_line(program) == held.line
        )


def _named(owner: int) -> dict[str, int]:
    return {"program": owner} if owner < PROGRAMS else {"plc": owner - PROGRAMS}
