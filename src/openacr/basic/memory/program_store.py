"""Stored programs and PLCs: numbered lines of tokens, with the rules of entering them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from openacr.basic.language.cursor import StatementError
from openacr.basic.language.parser import Parser
from openacr.basic.language.scope import Scope
from openacr.basic.memory.memory_cost import line_bytes
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.storage import Storage
from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind, spelled, tokens
from openacr.map.rows import storage as storage_rows
from openacr.map.words import pf
from openacr.messages import (
    INVALID_PASSWORD,
    OUT_OF_MEMORY,
    PROGRAM_IS_PROTECTED,
    SYNTAX_ERROR,
)

OWNERS = 24  # programs 0-15, PLCs 16-23
HIDDEN_STEP = 10
HIGHEST_LINE_NUMBER = 999999

# `PROGRAM0_start` is a published misprint for two lines: the number means nothing, the
# label belongs to the next line.
_PROGRAM = re.compile(r"[\s:]*PROGRAM(?![A-Za-z])\s*\d*\s*(.*)", re.IGNORECASE)


class StoredLine:
    """One line of a program or PLC: its number, its text without that, and what it may refer to.

    `text` has one character per byte and is blank where the number stood. What the line means
    (`tree`: a `Line`, or PLC instructions) and what it costs is read from the text when it is
    needed, unless `read` (tokens and tree) is given; then `text` may be None.
    """

    __slots__ = ("_cost_bytes", "_read", "_text", "_tokens", "nesting", "number", "scope")

    def __init__(
        self,
        number: int,
        text: str | None,
        scope: Scope,
        cost_bytes: int | None = None,
        read: tuple[tuple[Token, ...], Any] | None = None,
    ) -> None:
        self.number, self.scope = number, scope
        self._text, self._cost_bytes, self._read = text, cost_bytes, read
        self._tokens: tuple[Token, ...] | None = None
        self.nesting: int | None = None  # blocks it opens less those it closes, once LIST knows

    @property
    def text(self) -> str:
        """The line without its number, as it was typed."""
        if self._text is None:
            self._text = spelled(self.tokens)
        return self._text

    @property
    def tokens(self) -> tuple[Token, ...]:
        """The line without its number; cheaper than its meaning."""
        if self._read is not None:
            return self._read[0]
        if self._tokens is None:
            self._tokens = tuple(self._cut())
        return self._tokens

    @property
    def is_unread(self) -> bool:
        """Whether nothing has asked for its meaning yet: a line of AcroBASIC, never of a PLC."""
        return self._read is None

    @property
    def tree(self) -> Any:
        """What the line means."""
        return self._parts[1]

    @property
    def cost_bytes(self) -> int:
        """User memory that the line takes."""
        if self._cost_bytes is None:
            self._cost_bytes = line_bytes(list(self.tokens))
        return self._cost_bytes

    @property
    def _parts(self) -> tuple[tuple[Token, ...], Any]:
        if self._read is None:
            found = self._cut()
            tree = Parser(found, self.scope).line()
            self._read = tuple(found), tree
        return self._read

    def _cut(self) -> list[Token]:
        return tokens((self._text or "").encode("latin-1"))

    @property
    def first_word(self) -> str:
        """The word the line begins with, in upper case."""
        for token in self.tokens:
            if token.value != ":":
                return str(token.value) if token.kind is TokenKind.WORD else ""
        return ""


@dataclass(slots=True)
class ProgramStore:
    """The text of all programs and PLCs."""

    storage: Storage
    texts: list[dict[int, StoredLine]] = field(default_factory=lambda: [{} for _ in range(OWNERS)])
    password: str | None = None
    changed: set[int] = field(default_factory=set)  # owners, for who stores their text
    on_put: Callable[[int, StoredLine], None] | None = None  # owner and line, while files load
    on_empty_start: Callable[[int, int], None] | None = None  # owner, thread of the command
    _last: list[int] = field(default_factory=lambda: [0] * OWNERS)  # no line has a higher number

    def lines(self, owner: int) -> list[StoredLine]:
        """The lines of a program in the order of their numbers."""
        text = self.texts[owner]
        return [text[number] for number in sorted(text)]

    def is_empty(self, owner: int) -> bool:
        """Whether nothing is stored."""
        return not self.texts[owner]

    def is_startable(self, owner: int, thread: int) -> bool:
        """Whether there are lines to start; the card says nothing where there are none."""
        is_empty = self.is_empty(owner)
        if is_empty and self.on_empty_start is not None:
            self.on_empty_start(owner, thread)
        return not is_empty

    def put(self, owner: int, line: StoredLine) -> None:
        """Store a line, replacing the one of its number; `Out of memory` stores nothing."""
        if owner >= PROGRAMS and not self.storage.size(owner):
            raise CardError(OUT_OF_MEMORY)
        old = self.texts[owner].get(line.number)
        self._account(owner, line.cost_bytes - (old.cost_bytes if old else 0))
        self.texts[owner][line.number] = line
        self._last[owner] = max(self._last[owner], line.number)
        self._mark_modified(owner)
        if self.on_put is not None:
            self.on_put(owner, line)

    def delete(self, owner: int, number: int) -> None:
        """Remove the line of this number, if there is one."""
        old = self.texts[owner].pop(number, None)
        if old is not None:
            self._account(owner, -old.cost_bytes)
            self._last[owner] = max(self.texts[owner], default=0)
        self._mark_modified(owner)

    def erase(self, owner: int) -> None:
        """NEW: remove all lines."""
        self._clear(owner)
        self.storage.set_code_bytes(owner, 0)
        self._mark_modified(owner)

    def forget(self, owner: int) -> None:
        """Remove all lines, as a loss of memory does: nothing is accounted or marked."""
        self._clear(owner)
        self.changed.add(owner)

    def _clear(self, owner: int) -> None:
        self.texts[owner].clear()
        self._last[owner] = 0

    def next_number(self, owner: int) -> int:
        """The hidden number of the next line of free-form text."""
        last = self._last[owner]
        return last - last % HIDDEN_STEP + HIDDEN_STEP

    def starts_by_itself(self, owner: int) -> bool:
        """Whether the first statement, PROGRAM not counted, is PBOOT."""
        lines = self.lines(owner)
        if lines and lines[0].first_word == "PROGRAM":
            lines = lines[1:]
        return bool(lines) and lines[0].first_word == "PBOOT"

    def protect(self, password: str) -> None:
        """PASSWORD ON: LIST is refused from now on; another text changes no password."""
        self._check_password(password)
        self.password = password

    def unprotect(self, password: str) -> None:
        """PASSWORD OFF: needs the same text."""
        self._check_password(password)
        self.password = None

    def _check_password(self, password: str) -> None:
        if self.password not in (None, password):
            raise CardError(INVALID_PASSWORD)

    def check_readable(self) -> None:
        """Refuse to show program text while a password protects it."""
        if self.password is not None:
            raise CardError(PROGRAM_IS_PROTECTED)

    def restore(self, texts: Iterable[Iterable[StoredLine]], password: str | None) -> None:
        """Take over the texts of a snapshot; what they cost stands in the map."""
        self.texts = [{line.number: line for line in text} for text in texts]
        self.password = password
        self._last = [max(text, default=0) for text in self.texts]
        self.changed.update(range(OWNERS))

    def _account(self, owner: int, growth: int) -> None:
        row = self.storage.heap.row(owner, storage_rows.code_bytes)
        self.storage.set_code_bytes(owner, row + growth)

    def _mark_modified(self, owner: int) -> None:
        self.changed.add(owner)
        if owner < PROGRAMS:
            self.storage.memory.I[pf.word[owner]] |= pf.PROGRAM_MODIFIED


def line_number(token: Token) -> int:
    """The number in front of a stored line; others than whole ones up to 999999 are refused."""
    if not token.text.isdigit() or not 1 <= int(token.text) <= HIGHEST_LINE_NUMBER:
        raise StatementError(SYNTAX_ERROR, token.span)
    return int(token.text)


def opens_capture(text: str) -> str | None:
    """The rest after PROGRAM on a line that opens free-form entry; None for other lines."""
    match = _PROGRAM.fullmatch(text.strip())
    return match[1] if match else None
