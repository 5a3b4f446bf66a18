"""Where the programs of a virtual card stop: breakpoints of lines, and steps to the next line."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from openacr.controller.controller import Controller
from openacr.debugger import questions
from openacr.debugger.breakpoints import LineBreakpoint
from openacr.debugger.calls import depth_of, is_running, name_of
from openacr.debugger.conditions import Conditions
from openacr.debugger.stops import Reason, Stop
from openacr.errors import UserError


class LineStops:
    """The lines before which programs (0-15) stop; `steps` has the depth of those that step.

    A step ends before the next line in at most that many open routines (None: in any).
    """

    def __init__(self, card: Controller, show: Callable[[str], None]) -> None:
        """`show` gets the texts of breakpoints that print, and conditions that fail."""
        self._card = card
        self.conditions = Conditions(partial(questions.answer, card), show)
        self.lines: dict[tuple[int, int], LineBreakpoint] = {}  # by program and line
        self.steps: dict[int, int | None] = {}

    def set_lines(self, breakpoints: Iterable[LineBreakpoint]) -> None:
        """Stop before these lines, and no others."""
        self.lines = {(each.program, each.line): each for each in breakpoints}

    def begin_step(self, program: int, *, into: bool = False, out: bool = False) -> None:
        """Stop before the next line of a program; UserError if it does not run.

        Routines that it calls are passed over unless `into`; with `out`, the rest of its own.
        """
        if not is_running(self._card, program):
            raise UserError(f"{name_of(program)} does not run: only a running program can step")
        depth = depth_of(self._card, program)
        self.steps[program] = None if into else depth - 1 if out else depth

    def programs(self, *, only_steps: bool = False) -> set[int]:
        """The programs whose lines have to be announced."""
        return {*self.steps, *(() if only_steps else (program for program, _ in self.lines))}

    def reason(self, program: int, line: int) -> Stop | None:
        """Why the card stops before a line, None if it does not."""
        if program in self.steps:
            depth = self.steps[program]
            if depth is None or depth_of(self._card, program) <= depth:
                return Stop(Reason.STEP, program)
        found = self.lines.get((program, line))
        if found is not None and self.conditions.are_met(found, program):
            return Stop(Reason.BREAKPOINT, program)
        return None
