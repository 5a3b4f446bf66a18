"""Files of a project and lines of its programs, in both directions."""

from __future__ import annotations

from pathlib import Path

from openacr.controller.controller import Controller
from openacr.debugger.calls import owners


class Sources:
    """Where the stored lines of a card come from.

    Lines that were typed, or changed since, have no file: a listing of the program on the card
    stands for it.
    """

    def __init__(self, card: Controller) -> None:
        self._card = card

    def lines_of(self, path: str) -> dict[int, tuple[int, int]]:
        """The lines of a file that are stored: file line to program (or PLC, 16-23) and line."""
        wanted = Path(path).resolve()
        found = {}
        for owner in owners(self._card):
            for stored in self._card.system.programs.lines(owner):
                origin = self._card.origin(owner, stored.number)
                if origin is not None and Path(origin[0]).resolve() == wanted:
                    found[origin[1]] = owner, stored.number
        return found

    def has_statement(self, owner: int, number: int) -> bool:
        """Whether a line of a program is executed: labels and remarks alone are not."""
        lines = self._card.system.programs.lines(owner)
        return any(any(stored.tree.blocks) for stored in lines if stored.number == number)

    def lines_listed(self, owner: int) -> dict[int, tuple[int, int]]:
        """The same for the listing of a program: its first line is 1."""
        lines = self._card.system.programs.lines(owner)
        return {place: (owner, stored.number) for place, stored in enumerate(lines, 1)}

    def listed_place(self, owner: int, line: int) -> int:
        """The place of a stored line in the listing of its program, from 1."""
        numbers = [stored.number for stored in self._card.system.programs.lines(owner)]
        return numbers.index(line) + 1 if line in numbers else 1
