"""What a command handler works with: its thread, its program, the card and its arguments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Protocol

from msgspec import Struct

from openacr.basic.language.grammar.values import Axis
from openacr.basic.language.nodes import AxisRef, Expr, Number, Prefix, Statement
from openacr.basic.language.registry import Level
from openacr.errors import CardError
from openacr.map.words import pf
from openacr.messages import (
    INVALID_ARGUMENT,
    NO_MASTER_ATTACHED,
    NOT_VALID_AT_THIS_LEVEL,
    UNDEFINED_SYMBOL,
)

if TYPE_CHECKING:
    from openacr.motion.card import Card


LINE_END = "\r\n"


class WaitKind(IntEnum):
    """What a command of Python waits for; the numbers are those of waits_cy."""

    ROW_ABOVE = 6  # a 32-bit row of the memory, by its index in the I view; strictly
    ROW_BELOW = 7
    NEXT_SLICE = 8  # try the statement again each slice


class Show(IntEnum):
    """Which program flag is set while a thread waits."""

    NOTHING = 0
    INHIBITED = pf.PROGRAM_INHIBITED
    MOVE_PENDING = pf.MOVE_PENDING


class Wait(Struct, frozen=True):
    """Why a statement is not finished yet.

    `operand` is the row, `value` what it is compared with. With `retry` the statement is
    executed again when the wait is over, else the next one follows.
    """

    kind: WaitKind
    operand: int = 0
    value: float = 0.0
    retry: bool = False
    show: Show = Show.NOTHING


class Evaluator(Protocol):
    """Who computes expressions: the executor of the thread."""

    def value(self, thread: int, node: Expr) -> float:
        """The number of a numeric expression."""

    def text(self, thread: int, node: Expr) -> str:
        """The string of a string expression."""

    def assign(self, thread: int, target: Expr, value: float | str) -> None:
        """Store into a variable, with its conversion."""

    def execute(self, run: Run, statement: Statement) -> Wait | None:
        """Execute one command for a handler that contains it."""


@dataclass(slots=True)
class Run:
    """The context of one executing command.

    `program` is the program whose axes and locals are meant (None at SYS), `stored`
    whether that program itself executes the command (otherwise it was typed).
    """

    card: Card
    thread: int
    program: int | None
    level: Level
    stored: bool
    evaluator: Evaluator
    write: Callable[[str], None]
    prefix: Prefix | None = None
    channel: Any = None  # the session on which it was typed, None in a program
    system: Any = None  # the language side of the card, basic.system.System

    def print(self, text: str) -> None:
        """Send a line of output."""
        self.write(text + LINE_END)

    # arguments

    def value(self, node: Expr) -> float:
        """The number of an expression."""
        if isinstance(node, Number):
            return node.value
        return self.evaluator.value(self.thread, node)

    def integer(self, node: Expr) -> int:
        """The number of an expression truncated toward zero; `Invalid argument` beyond 64 bits."""
        return whole(self.value(node))

    def text(self, node: Expr) -> str:
        """The string of an expression."""
        return self.evaluator.text(self.thread, node)

    def assign(self, target: Expr, value: float | str) -> None:
        """Store into a variable, parameter or flag."""
        self.evaluator.assign(self.thread, target, value)

    def execute(self, statement: Statement) -> Wait | None:
        """Execute a command that is an argument of this one."""
        return self.evaluator.execute(self, statement)

    # what is meant by names

    def axis(self, ref: AxisRef) -> Axis:
        """The axis that is meant; `Undefined symbol` if the program has none of that name."""
        if ref.number is not None:
            number = self.integer(ref.number)
            if not 0 <= number < self.card.model.axes:
                raise CardError(INVALID_ARGUMENT)
            return Axis(number, f"AXIS{number}")
        if self.program is None:
            raise CardError(UNDEFINED_SYMBOL)
        found = self.card.attachments.axis(self.program, ref.name)
        if found is None:
            raise CardError(UNDEFINED_SYMBOL)
        return Axis(found, ref.name)

    def axes(self) -> tuple[Axis, ...]:
        """All axes of the program in slave order."""
        named = self.card.attachments.axes(self.needed_program())
        return tuple(Axis(number, name) for name, number in named)

    def master(self) -> int:
        """The master that is meant: by the prefix MASTERm, else that of the program."""
        if self.prefix is not None and self.prefix.word == "MASTER":
            number = self.integer(self.prefix.number)
            if not 0 <= number < self.card.model.masters:
                raise CardError(INVALID_ARGUMENT)
            return number
        found = self.card.attachments.master(self.needed_program())
        if found is None:
            raise CardError(NO_MASTER_ATTACHED)
        return found

    def needed_program(self) -> int:
        """The program; `Not valid at this level` where there is none."""
        if self.program is None:
            raise CardError(NOT_VALID_AT_THIS_LEVEL)
        return self.program


def whole(value: float) -> int:
    """The value truncated toward zero; `Invalid argument` beyond 64 bits."""
    if not -(2.0**63) < value < 2.0**63:
        raise CardError(INVALID_ARGUMENT)
    return int(value)
