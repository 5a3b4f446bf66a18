"""Which lines of AcroBASIC were executed, and where their branches went, and what PLCs scanned.

A card in trace mode says before every line that is executed which one it is; for a test run that
goes into a table instead of to the terminal. A line that decides (IF without THEN, ELSEIF, WHILE,
NEXT) has two branches: the lines that were executed after it. Each IF with THEN has two branches,
too: its condition was true, or false.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import OWNERS, StoredLine
from openacr.basic.vm.code import BEGINS_LINE, CONDITIONS_SHIFT, IS_AFTER_THEN, IS_CONDITION
from openacr.controller import Controller
from openacr.lang.lexer import Token, TokenKind
from openacr.scenario.card_view import has_failed
from openacr.testing.covered_lines import Condition, Line, Place
from openacr.testing.plc_coverage import PlcNotes, plc_line

_DECIDES = frozenset(("IF", "ELSEIF", "WHILE", "NEXT"))
_SILENT = frozenset(("PROGRAM", "ENDP", "REM", "ENDIF", "ELSE"))


class Coverage:
    """The lines of all programs and PLCs of the cards of a run, by file and line."""

    def __init__(self) -> None:
        self.lines: dict[Place, Line] = {}
        self._card: Controller | None = None
        self._plcs: PlcNotes | None = None
        self._last: dict[int, Place] = {}
        self._deciding: dict[int, Condition] = {}  # by program, until its outcome is known

    def prepare(self, card: Controller) -> None:
        """Have programs followed that the card starts, or takes over from a snapshot."""
        card.system.listeners.follower = self

    def begin(self, card: Controller) -> None:
        """Follow a card from now on."""
        self._card, self._last, self._deciding = card, {}, {}
        for owner in range(OWNERS):
            for stored in card.system.programs.texts[owner].values():
                self._know(card, owner, stored)
            card.control.trace(owner, True)
        self._plcs = PlcNotes(card, self.lines)
        self.prepare(card)

    def _know(self, card: Controller, owner: int, stored: StoredLine) -> None:
        place = card.origin(owner, stored.number)
        line = basic_line(stored) if owner < PROGRAMS else plc_line(stored.tree)
        if place is not None and line is not None:
            self.lines.setdefault(place, line)

    def reached(self, program: int, line: int, marks: int) -> None:
        """A statement is executed next: the first of its line, a condition, one after THEN."""
        self._deciding.pop(program, None)
        place = self._card.origin(program, line) if self._card is not None else None
        if marks & BEGINS_LINE:
            self._begin_line(program, place)
        found = self.lines.get(place) if place is not None else None
        if found is None:
            return
        number = marks >> CONDITIONS_SHIFT
        if marks & IS_AFTER_THEN:
            found.conditions[number - 1].true += 1
        if marks & IS_CONDITION:
            found.conditions[number].computed += 1
            self._deciding[program] = found.conditions[number]

    def ended(self, program: int) -> None:
        """A program has ended: no line follows, and a condition that failed was not computed."""
        self._last.pop(program, None)
        condition = self._deciding.pop(program, None)
        if condition is not None and self._card is not None:
            condition.computed -= has_failed(self._card.memory, program)

    def plc_changes(self, plc: int) -> None:
        """A PLC is about to have other code: what its scans have noted is taken."""
        if self._plcs is not None:
            self._plcs.code_changes(plc)

    def _begin_line(self, program: int, place: Place | None) -> None:
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
        if self._plcs is not None:
            self._plcs.end()
        self._card = self._plcs = None

    def files(self) -> dict[str, dict[int, Line]]:
        """The lines of each file in their order."""
        found: dict[str, dict[int, Line]] = {}
        for (file, number), line in sorted(self.lines.items()):
            found.setdefault(file, {})[number] = line
        return found


def basic_line(stored: StoredLine) -> Line | None:
    """A line of AcroBASIC to be covered; None for labels, remarks and frames."""
    words = [str(token.value) for token in stored.tokens if token.kind is TokenKind.WORD]
    if not is_executable(stored, words):
        return None
    leads_on = "THEN" not in words and bool(_DECIDES & set(words))
    return Line(leads_on, tuple(Condition() for _ in range(conditions(stored.tokens))))


def is_executable(stored: StoredLine, words: Iterable[str]) -> bool:
    """Whether a line is executed: labels, remarks and frames are not."""
    first = next(iter(words), "REM")
    return first not in _SILENT and any(t.kind is TokenKind.WORD for t in stored.tokens)


def conditions(tokens: Sequence[Token]) -> int:
    """The count of IF with THEN on a line; one with nothing but a remark decides nothing."""
    return sum(
        token.kind is TokenKind.WORD
        and token.value == "THEN"
        and after.kind is not TokenKind.REMARK
        for token, after in pairwise(tokens)
    )
