"""Which lines of AcroBASIC were executed, and where their branches went.

A card in trace mode says before every line that is executed which one it is; for a test run that
goes into a table instead of to the terminal. A line that decides (IF without THEN, ELSEIF, WHILE,
NEXT, and IF THEN with a jump) has two branches: the lines that were executed after it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from openacr.basic.memory.program_store import StoredLine
from openacr.controller import Controller
from openacr.lang.lexer import TokenKind
from openacr.map import numbers as at

BRANCHES = 2
_DECIDES = frozenset(("ELSEIF", "WHILE", "NEXT"))
_LEAVES = frozenset(("GOTO", "GOSUB", "RETURN", "END", "BREAK"))
_SILENT = frozenset(("PROGRAM", "ENDP", "REM", "ENDIF", "ELSE"))
Place = tuple[str, int]  # file and line


@dataclass(slots=True)
class Line:
    """A line of a file: how often it was executed, and the lines executed next."""

    has_branches: bool = False
    count: int = 0
    next: set[Place] = field(default_factory=set)

    @property
    def taken(self) -> int:
        """How many of its branches were taken."""
        return min(len(self.next), BRANCHES) if self.has_branches else 0


class Coverage:
    """The lines of all programs of the cards of a run, by file and line."""

    def __init__(self) -> None:
        self.lines: dict[Place, Line] = {}
        self._card: Controller | None = None
        self._last: dict[int, Place] = {}
        self._places: dict[tuple[int, int], Place | None] = {}

    def begin(self, card: Controller) -> None:
        """Follow a card from now on."""
        self._card, self._last, self._places = card, {}, {}
        for program in range(at.PROG_COUNT):
            for stored in card.system.programs.texts[program].values():
                self._know(card, program, stored)
            card.control.trace(program, True)
        card.system.listeners.follower = self._executed

    def _know(self, card: Controller, program: int, stored: StoredLine) -> None:
        place = card.origin(program, stored.number)
        words = [str(token.value) for token in stored.tokens if token.kind is TokenKind.WORD]
        if place is not None and is_executable(stored, words):
            self.lines.setdefault(place, Line(has_branches=decides(words)))

    def _executed(self, program: int, number: int) -> None:
        key = program, number
        if key not in self._places:
            self._places[key] = self._card.origin(program, number) if self._card else None
        place = self._places[key]
        if place is None:
            self._last.pop(program, None)
        elif place in self.lines:  # ELSE and ENDIF lead to the line after them
            self.lines[place].count += 1
            if program in self._last:
                self.lines[self._last[program]].next.add(place)
            self._last[program] = place

    def end(self, card: Controller) -> None:
        """Follow a card no longer."""
        card.system.listeners.follower = None
        self._card = None

    def files(self) -> dict[str, dict[int, Line]]:
        """The lines of each file in their order."""
        found: dict[str, dict[int, Line]] = {}
        for (file, number), line in sorted(self.lines.items()):
            found.setdefault(file, {})[number] = line
        return found


def is_executable(stored: StoredLine, words: Iterable[str]) -> bool:
    """Whether a line is executed: labels, remarks and frames are not."""
    first = next(iter(words), "REM")
    return first not in _SILENT and any(t.kind is TokenKind.WORD for t in stored.tokens)


def decides(words: list[str]) -> bool:
    """Whether different lines may follow a line."""
    if "THEN" in words:
        return bool(_LEAVES & set(words[words.index("THEN") :]))
    return "IF" in words or bool(_DECIDES & set(words))
