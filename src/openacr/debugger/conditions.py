"""What breakpoints ask: conditions, counts of hits, texts with values."""

from __future__ import annotations

import re
from collections.abc import Callable

from openacr.debugger.breakpoints import LineBreakpoint
from openacr.errors import UserError

_EMBEDDED = re.compile(r"\{([^{}]*)\}")  # an expression in a text to be printed


class Conditions:
    """Conditions and texts of breakpoints.

    `answer` gives the value of an expression at a place (a program, a block); `show` gets the
    texts of breakpoints that print, and conditions that fail.
    """

    def __init__(self, answer: Callable[[int, str], str], show: Callable[[str], None]) -> None:
        self._answer, self._show = answer, show

    def are_met(self, breakpoint: LineBreakpoint, place: int) -> bool:
        """Whether a breakpoint stops; it counts its hits, and one with a text prints it instead."""
        if not self.holds(place, breakpoint.condition):
            return False
        breakpoint.met += 1
        if breakpoint.met < breakpoint.hits:
            return False
        if breakpoint.log:
            self._show(self._filled(place, breakpoint.log) + "\n")
            return False
        return True

    def holds(self, place: int, condition: str) -> bool:
        """Whether a condition is met; one that cannot be computed stops, with a note."""
        if not condition:
            return True
        try:
            return self._number(place, condition) != 0.0
        except UserError as error:
            self._show(f"{error}\n")
            return True

    def _number(self, place: int, condition: str) -> float:
        text = self._answer(place, condition)
        try:
            return float(text)
        except ValueError:
            raise UserError(f"{condition}: {text} is not a number") from None

    def _filled(self, place: int, text: str) -> str:
        """A text with its expressions in braces replaced by their values."""

        def value(found: re.Match[str]) -> str:
            try:
                return self._answer(place, found[1])
            except UserError as error:
                return f"<{error}>"

        return _EMBEDDED.sub(value, text)
