"""Parse statements: the keyword and what follows it.

IF condition THEN GOTO n     GOTO n     GOSUB n     RET
PRINT item; item             INPUT "text", Pn       $I file
"""

from __future__ import annotations

from collections.abc import Callable

from openacr.cnc.reading.blocks import (
    Block,
    Gosub,
    Goto,
    If,
    Include,
    Input,
    InputTest,
    Message,
    Print,
    Return,
    Statement,
)
from openacr.cnc.reading.expressions import ExpressionReader
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import Call, Node, Number, Parameter
from openacr.cnc.reading.functions import EQUAL

INPUTS = 32


class StatementReader(ExpressionReader):
    """Reads statements and comments."""

    def remark(self, block: Block) -> None:
        """Read a comment; `(MSG, text)` and the like are messages."""
        text = self.comment()
        kind, comma, rest = text.partition(",")
        kind = kind.strip().upper()
        if comma and kind in ("MSG", "DEBUG", "PRINT", "LOG"):
            block.messages.append(Message(rest.strip(), kind != "MSG"))

    def statement(self, block: Block) -> bool:
        """Read a statement, if one comes next; it has to be alone in its block."""
        if self.text[self.pos] not in _FIRST_LETTERS:
            return False
        for keyword, read in _STATEMENTS:
            if keyword in self.grammar.statements and self.text.startswith(keyword, self.pos):
                if block.words or block.assignments:
                    raise self.fault("E108", hint="a statement has to be alone in its block")
                at = self.column
                self.pos += len(keyword)
                block.statement = read(self, at)
                self.end(block)
                return True
        return False

    def end(self, block: Block) -> None:
        """Refuse anything but comments after a statement."""
        while self.peek() == "(":
            self.remark(block)
        if self.peek() not in ("", ";"):
            raise self.fault("E108")

    def target(self) -> Node:
        """The label of GOTO and GOSUB."""
        if self.peek() == self.open:
            return self.bracketed()
        if not self.peek().isdecimal():
            raise self.fault("E108")
        return self.counted()

    def goto(self, at: int) -> Goto:
        """What follows GOTO."""
        return Goto(self.target(), at)

    def gosub(self, at: int) -> Gosub:
        """What follows GOSUB."""
        return Gosub(self.target(), at)

    def back(self, at: int) -> Return:
        """What follows RET."""
        return Return(at)

    def if_(self, at: int) -> If:
        """What follows IF."""
        is_bare = self.peek() == "#"
        condition = self.expression()
        test = _input_test(condition) if is_bare else None
        if not self.match("THEN"):
            raise self.fault("E108", hint="IF condition THEN GOTO n")
        self.blanks()
        start = self.column
        for keyword, read in (("GOTO", StatementReader.goto), ("GOSUB", StatementReader.gosub)):
            if self.match(keyword):
                return If(condition, read(self, start), at, test)
        if self.match("RET"):
            return If(condition, Return(start), at, test)
        raise self.fault("E108", hint="THEN GOTO n, THEN GOSUB n or THEN RET")

    def print_(self, at: int) -> Print:
        """What follows PRINT."""
        items: list[str | Node] = []
        while self.peek() not in ("", ";"):
            items.append(self.quoted() if self.peek() == '"' else self._printed())
            self.gap()
            if not self.match(";"):
                break
        return Print(tuple(items), at)

    def _printed(self) -> Node:
        start = self.column
        try:
            return self.expression()
        except CodeError as fault:
            code = "E109" if fault.code == "E104" else fault.code
            raise CodeError(code, fault.column if code != "E109" else start) from None

    def quoted(self) -> str:
        """A text in quotes."""
        if self.peek() != '"':
            raise self.fault("E109")
        end = self.raw.find('"', self.pos + 1)
        if end < 0:
            raise self.fault("E109")
        text = self.raw[self.pos + 1 : end]
        self.pos = end + 1
        return text

    def input_(self, at: int) -> Input:
        """What follows INPUT."""
        text = self.quoted()
        if not self.match(","):
            raise self.fault("E108")
        if not self.peek() or self.peek() not in self.grammar.parameters:
            raise self.fault("E108")
        is_hash = self.text[self.pos] == "#"
        self.pos += 1
        return Input(text, self.index(), at, is_hash)

    def include(self, at: int) -> Include:
        """What follows $I."""
        name = self.raw[self.pos :].split(";")[0].split("(")[0].strip()
        if not name:
            raise self.fault("E108", hint="$I file")
        self.pos = len(self.raw)
        return Include(name.strip('"'), at)


_STATEMENTS: tuple[tuple[str, Callable[[StatementReader, int], Statement]], ...] = (
    ("IF", StatementReader.if_),
    ("GOTO", StatementReader.goto),
    ("GOSUB", StatementReader.gosub),
    ("RET", StatementReader.back),
    ("PRINT", StatementReader.print_),
    ("INPUT", StatementReader.input_),
    ("$I", StatementReader.include),
)


_FIRST_LETTERS = frozenset(keyword[0] for keyword, _ in _STATEMENTS)


def _input_test(condition: Node) -> InputTest | None:
    """The condition as `#n = 0|1` with n an input."""
    if not isinstance(condition, Call) or condition.function is not EQUAL:
        return None
    left, right = condition.operands
    if not (isinstance(left, Parameter) and left.is_hash and isinstance(left.index, Number)):
        return None
    if not isinstance(right, Number) or right.number not in (0.0, 1.0):
        return None
    number = int(left.index.number)
    return InputTest(number, int(right.number)) if number < INPUTS else None
