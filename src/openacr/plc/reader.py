"""Read a line of a PLC: any number of instructions, separated by blanks or colons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from msgspec import Struct

from openacr.errors import CardError
from openacr.lang.lexer import Token, TokenKind
from openacr.lang.source import Span
from openacr.messages import (
    INVALID_ARGUMENT,
    INVALID_BIT,
    NOT_VALID_AT_THIS_LEVEL,
    SYNTAX_ERROR,
    UNDEFINED_SYMBOL,
    UNKNOWN_COMMAND,
    Message,
)
from openacr.plc.instructions import (
    BY_WORDS,
    HIGHEST_FLAG,
    LONGEST,
    OBJECT_WORDS,
    OBJECTS,
    Instruction,
    Operand,
    output_flag,
)


class PlcError(CardError):
    """A PLC line that cannot be read, with the position of the error."""

    def __init__(self, message: Message, span: Span) -> None:
        super().__init__(message)
        self.span = span


class Names(Protocol):
    """The meaning of words that do not belong to the PLC language."""

    def number(self, name: str) -> int | None:
        """The flag or whole number of an alias."""

    def is_command(self, word: str) -> bool:
        """Whether the word is an AcroBASIC command."""


class Step(Struct, frozen=True):
    """One instruction with its operand: a flag, or the number of a timer, counter or latch."""

    instruction: Instruction
    number: int = 0
    preload: int | None = None
    written: str = ""  # the operands as LIST shows them

    @property
    def spelled(self) -> str:
        """The instruction as LIST shows it."""
        return f"{self.instruction.name} {self.written}".rstrip()


class PlcLine(Struct, frozen=True):
    """The instructions of one line; `spelled` is the line as LIST shows it."""

    steps: tuple[Step, ...]
    spelled: str

    @property
    def count(self) -> int:
        """Instructions that take memory."""
        return sum(not step.instruction.is_frame for step in self.steps)


def read_line(found: Sequence[Token], names: Names) -> PlcLine | None:
    """Parse the tokens of a line; None if there is nothing to store."""
    return _Reader(found, names).line()


class _Reader:
    """A cursor over the tokens of one line."""

    def __init__(self, found: Sequence[Token], names: Names) -> None:
        self.tokens = found
        self.names = names
        self.position = 0

    @property
    def token(self) -> Token:
        return self.tokens[self.position]

    def take(self) -> Token:
        token = self.token
        self.position += 1
        return token

    def accept(self, text: str) -> bool:
        """Accept the operator `text` if it is the next token."""
        if self.token.kind is not TokenKind.OPERATOR or self.token.value != text:
            return False
        self.position += 1
        return True

    def line(self) -> PlcLine | None:
        steps: list[Step] = []
        parts: list[str] = []
        while self.token.kind is not TokenKind.END:
            if self.token.kind is TokenKind.REMARK:
                parts.append(f"REM{self.take().value}")
            elif self.accept(":"):
                parts.append(":")
            else:
                steps.append(self.step())
                parts.append(steps[-1].spelled)
        return PlcLine(tuple(steps), " ".join(parts)) if parts else None

    def step(self) -> Step:
        row = self.instruction()
        if row.operand is Operand.NONE:
            return Step(row)
        if row.operand is Operand.FLAG:
            number, written = self.flag()
            return Step(row, number, written=written)
        number = self.object_number()
        preload = self.preload() if row.operand.takes_preload else None
        return Step(row, number, preload, f"{number}" if preload is None else f"{number} {preload}")

    def instruction(self) -> Instruction:
        """The longest sequence of words that is an instruction."""
        if self.token.kind is not TokenKind.WORD:
            raise self.error(SYNTAX_ERROR)
        ahead = self.tokens[self.position : self.position + LONGEST]
        words = tuple(str(token.value) for token in ahead if token.kind is TokenKind.WORD)
        for count in range(len(words), 0, -1):
            row = BY_WORDS.get(words[:count])
            if row is not None:
                self.position += count
                return row
        is_known = self.names.is_command(words[0])
        raise self.error(NOT_VALID_AT_THIS_LEVEL if is_known else UNKNOWN_COMMAND)

    def flag(self) -> tuple[int, str]:
        """A flag by number, as BITn, by alias, or the output of a timer, counter or latch."""
        token = self.token
        if token.kind is TokenKind.WORD and token.value == "BIT":
            self.take()
            number = self.bracketed(INVALID_BIT)
            return self.checked(number, HIGHEST_FLAG, INVALID_BIT, token), f"BIT {number}"
        if token.kind is TokenKind.WORD and token.value in OBJECT_WORDS:
            operand = OBJECT_WORDS[str(self.take().value)]
            number = self.object_number()
            return output_flag(operand, number), f"{operand.value}{number}"
        number = self.number(INVALID_BIT)
        written = token.text if token.kind is TokenKind.WORD else str(number)
        return self.checked(number, HIGHEST_FLAG, INVALID_BIT, token), written

    def object_number(self) -> int:
        token = self.token
        return self.checked(self.number(INVALID_ARGUMENT), OBJECTS - 1, INVALID_ARGUMENT, token)

    def preload(self) -> int | None:
        return self.number(INVALID_ARGUMENT) if self.token.kind is TokenKind.NUMBER else None

    def bracketed(self, message: Message) -> int:
        """A number, with or without parentheses."""
        if not self.accept("("):
            return self.number(message)
        number = self.number(message)
        if not self.accept(")"):
            raise self.error(SYNTAX_ERROR)
        return number

    def number(self, message: Message) -> int:
        """A whole number, written or by alias; `message` refuses any other value."""
        token = self.token
        value: object = token.value
        if token.kind is TokenKind.WORD:
            value = self.names.number(token.text)
            if value is None:
                raise self.error(UNDEFINED_SYMBOL)
        elif token.kind is not TokenKind.NUMBER:
            raise self.error(SYNTAX_ERROR)
        if not isinstance(value, int) or value < 0:
            raise self.error(message)
        self.take()
        return value

    def checked(self, number: int, highest: int, message: Message, token: Token) -> int:
        if number > highest:
            raise PlcError(message, token.span)
        return number

    def error(self, message: Message) -> PlcError:
        return PlcError(message, self.token.span)
