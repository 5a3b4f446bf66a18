"""Which IF, FOR and WHILE are open at a place of a program, and what closes them.

The compiler and the check of a file follow the same rules here; the compiler alone keeps
places of code in its levels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from openacr.basic.vm import flow_cy as flow
from openacr.errors import CardError
from openacr.messages import (
    BREAK_WITHOUT_LOOP,
    ELSE_WITHOUT_IF,
    ENDIF_WITHOUT_IF,
    FOR_WITHOUT_NEXT,
    IF_WITHOUT_ENDIF,
    NEXT_WITHOUT_FOR,
    WEND_WITHOUT_WHILE,
    WHILE_WITHOUT_WEND,
    Message,
)

UNCLOSED = {
    flow.FLOW_IF: IF_WITHOUT_ENDIF,
    flow.FLOW_FOR: FOR_WITHOUT_NEXT,
    flow.FLOW_WHILE: WHILE_WITHOUT_WEND,
}
UNOPENED = {
    flow.FLOW_IF: ENDIF_WITHOUT_IF,
    flow.FLOW_FOR: NEXT_WITHOUT_FOR,
    flow.FLOW_WHILE: WEND_WITHOUT_WHILE,
}

STRUCTURE = frozenset((*UNCLOSED.values(), *UNOPENED.values(), ELSE_WITHOUT_IF, BREAK_WITHOUT_LOOP))


class CompileError(CardError):
    """A structure error, with the number of the line it was found in."""

    def __init__(self, message: Message, line: int, detail: object = "") -> None:
        super().__init__(message, detail)
        self.line = line


@dataclass(slots=True, eq=False)
class Level:
    """An IF, FOR or WHILE whose end has not been met yet, and the level around it."""

    kind: int
    line: int
    outer: Level | None = None
    has_else: bool = False


OneLevel = TypeVar("OneLevel", bound=Level)


class Levels(Generic[OneLevel]):
    """All levels that are open, the innermost one last."""

    def __init__(self) -> None:
        self.open: list[OneLevel] = []

    @property
    def innermost(self) -> OneLevel | None:
        """The level that a statement here belongs to."""
        return self.open[-1] if self.open else None

    def enter(self, level: OneLevel) -> None:
        """IF, FOR, WHILE."""
        level.outer = self.innermost
        self.open.append(level)

    def branch(self, line: int, *, is_last: bool) -> OneLevel:
        """ELSEIF, ELSE: the level they belong to."""
        level = self._expected(flow.FLOW_IF, line, ELSE_WITHOUT_IF)
        if level.has_else:
            raise CompileError(ELSE_WITHOUT_IF, line)
        level.has_else = is_last
        return level

    def leave(self, kind: int, line: int) -> OneLevel:
        """ENDIF, NEXT, WEND: the level they close."""
        level = self._expected(kind, line, UNOPENED[kind])
        self.open.pop()
        return level

    def loop(self, line: int) -> OneLevel:
        """BREAK: the loop it leaves."""
        for level in reversed(self.open):
            if level.kind != flow.FLOW_IF:
                return level
        raise CompileError(BREAK_WITHOUT_LOOP, line)

    def _expected(self, kind: int, line: int, otherwise: Message) -> OneLevel:
        """The innermost level, of this kind; what is open inside of one lacks its end."""
        if not any(level.kind == kind for level in self.open):
            raise CompileError(otherwise, line)
        if self.open[-1].kind != kind:
            raise unclosed(self.open[-1])
        return self.open[-1]


def unclosed(level: Level) -> CompileError:
    """The error for a level whose end is missing."""
    return CompileError(UNCLOSED[level.kind], level.line)
