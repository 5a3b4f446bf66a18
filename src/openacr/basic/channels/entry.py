"""Entering programs: numbered lines, and PROGRAM ... ENDP."""

from __future__ import annotations

import re
from typing import Protocol

from openacr.basic.language.parser import LEVEL_WORDS
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.basic.memory.known_lines import KnownLines
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import (
    ProgramStore,
    StoredLine,
    line_number,
    opens_capture,
)
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind, plain, tokens
from openacr.lang.shape import shape
from openacr.messages import PROGRAM_IS_RUNNING, SYNTAX_ERROR, UNKNOWN_COMMAND

_REMARK = re.compile(r":|REM(?![A-Za-z])", re.IGNORECASE)


class Running(Protocol):
    """Who knows which programs run."""

    def is_running(self, owner: int) -> bool:
        """Whether a program (0-15) or PLC (16-23) executes, waits or is held."""


class Texts(Protocol):
    """What entering lines needs of the language side of the card."""

    @property
    def programs(self) -> ProgramStore:
        """The stored lines."""

    @property
    def known_lines(self) -> KnownLines:
        """Shapes of lines that have been accepted."""

    @property
    def control(self) -> Running:
        """Who runs programs."""

    def scope(self, level: Level, program: int | None, *, stored: bool) -> Scope:
        """What a line of a program, or one typed at its prompt, may refer to."""

    def read_stored(
        self, owner: int, number: int, text: str, *, found: list[Token] | None = None
    ) -> StoredLine | None:
        """A line to be stored; None if there is nothing to store."""


class Entering(Protocol):
    """The channel on which lines are entered."""

    capture: int | None  # owner whose text is being entered with PROGRAM

    @property
    def owner(self) -> int | None:
        """The program (0-15) or PLC (16-23) of the level; None at SYS."""


class Entry:
    """Decides whether a line typed on a channel is stored."""

    def __init__(self, system: Texts, session: Entering) -> None:
        self.system = system
        self.session = session
        self.store = system.programs

    def take(self, text: str) -> list[Token] | None:
        """Store the line if it is one to be stored; else its tokens, to be executed."""
        owner = self.session.capture
        if owner is not None:
            return self._captured(owner, text)
        found = tokens(text)
        if found[0].kind is TokenKind.NUMBER:
            self._numbered(self._level_owner(), found, text)
        elif (rest := opens_capture(text)) is not None:
            self._open(self._level_owner(), rest)
        else:
            return found
        return None

    def _level_owner(self) -> int:
        owner = self.session.owner
        if owner is None:
            raise CardError(UNKNOWN_COMMAND)
        return owner

    def _numbered(self, owner: int, found: list[Token], text: str) -> None:
        """A number in front: store the rest under it, or delete the line."""
        number = line_number(found[0])
        if found[1].kind is TokenKind.END:
            self.store.delete(owner, number)
        else:
            begin = found[0].column - 1 + len(found[0].text)
            self._store(owner, number, " " * begin + plain(text)[begin:], found[1:])

    def _open(self, owner: int, rest: str) -> None:
        """PROGRAM: erase the old text and store everything from here on."""
        if self.system.control.is_running(owner):
            raise CardError(PROGRAM_IS_RUNNING)
        has_label = rest.startswith("_")
        if rest and not has_label and not rest.startswith("'") and not _REMARK.match(rest):
            raise CardError(SYNTAX_ERROR)
        self.store.erase(owner)
        self.session.capture = owner
        self._append(owner, "PROGRAM" if has_label else f"PROGRAM {rest}")
        if has_label:
            self._append(owner, rest)

    def _captured(self, owner: int, text: str) -> list[Token] | None:
        """A line between PROGRAM and ENDP: stored, unless it ends the capture."""
        kind = shape(text)
        if owner < PROGRAMS and self._store_known(owner, text, kind):
            return None
        found = tokens(text)
        first = next((token for token in found if token.value != ":"), found[-1])
        word = first.value if first.kind is TokenKind.WORD else ""
        if word in LEVEL_WORDS:
            self.session.capture = None
            self._append(owner, "ENDP")
            return found
        if word == "ENDP":
            self.session.capture = None  # also where no room is left to store it
        if found[0].kind is TokenKind.NUMBER:
            self._numbered(owner, found, text)
        elif found[0].kind is not TokenKind.END and self._append(owner, text, found):
            self._learn(owner, kind, text, found, word)
        return None

    def _store_known(self, owner: int, text: str, kind: str) -> bool:
        """Store a line whose shape has been accepted before."""
        scope = self.system.scope(Level.PROG, owner, stored=True)
        cost_bytes = self.system.known_lines.cost(scope, kind, text)
        if cost_bytes is None:
            return False
        number = self.store.next_number(owner)
        self.store.put(owner, StoredLine(number, plain(text), scope, cost_bytes))
        return True

    def _learn(self, owner: int, kind: str, text: str, found: list[Token], word: object) -> None:
        """Remember a shape; labels are left out, their length is limited."""
        if owner < PROGRAMS and word != "ENDP" and found[0].kind is not TokenKind.LABEL:
            scope = self.system.scope(Level.PROG, owner, stored=True)
            self.system.known_lines.learn(scope, kind, text, found)

    def _append(self, owner: int, text: str, found: list[Token] | None = None) -> bool:
        found = tokens(text) if found is None else found
        return self._store(owner, self.store.next_number(owner), plain(text), found)

    def _store(self, owner: int, number: int, text: str, found: list[Token]) -> bool:
        """Store a line; False if there was nothing to store."""
        line = self.system.read_stored(owner, number, text, found=found)
        if line is None:
            return False
        self.store.put(owner, line)
        return True


def split_at_level(found: list[Token]) -> tuple[list[Token], list[Token]]:
    """A typed line up to its first SYS, PROG n or PLC n, and what follows it.

    Such a command begins a block; after THEN it is a part of the IF.
    """
    begins_block = True
    for place, token in enumerate(found):
        if token.value == "THEN":
            break
        if begins_block and token.kind is TokenKind.WORD and token.value in LEVEL_WORDS:
            rest = _after_level(found, place)
            if found[rest].kind is not TokenKind.END:
                return [*found[:rest], found[-1]], found[rest:]
        begins_block = token.kind is TokenKind.OPERATOR and token.value == ":"
    return found, []


def _after_level(found: list[Token], place: int) -> int:
    """Index of the first token after a level command: PROG and PLC have a number, or `(expr)`."""
    rest = place + 1
    if found[place].value == "SYS":
        return rest
    depth = 0
    while found[rest].kind is not TokenKind.END:
        depth += (found[rest].value == "(") - (found[rest].value == ")")
        rest += 1
        if depth <= 0:
            break
    return rest
