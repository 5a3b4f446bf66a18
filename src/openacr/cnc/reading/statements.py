"""Statements, a function each: the keyword and what follows it.

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


def remark(reader: ExpressionReader, block: Block) -> None:
    """Read a comment; `(MSG, text)` and the like are messages."""
    text = reader.comment()
    kind, comma, rest = text.partition(",")
    kind = kind.strip().upper()
    if comma and kind in ("MSG", "DEBUG", "PRINT", "LOG"):
        block.messages.append(Message(rest.strip(), kind != "MSG"))


def statement(reader: ExpressionReader, block: Block) -> bool:
    """Read a statement, if one comes next; it has to be alone in its block."""
    if reader.text[reader.pos] not in _FIRST_LETTERS:
        return False
    for keyword, read in _STATEMENTS:
        if keyword in reader.grammar.statements and reader.text.startswith(keyword, reader.pos):
            if block.words or block.assignments:
                raise reader.fault("E108", hint="a statement has to be alone in its block")
            at = reader.column
            reader.pos += len(keyword)
            block.statement = read(reader, at)
            end(reader, block)
            return True
    return False


def end(reader: ExpressionReader, block: Block) -> None:
    """Refuse anything but comments after a statement."""
    while reader.peek() == "(":
        remark(reader, block)
    if reader.peek() not in ("", ";"):
        raise reader.fault("E108")


def target(reader: ExpressionReader) -> Node:
    """The label of GOTO and GOSUB."""
    if reader.peek() == reader.open:
        return reader.bracketed()
    if not reader.peek().isdecimal():
        raise reader.fault("E108")
    return reader.counted()


def goto(reader: ExpressionReader, at: int) -> Goto:
    """What follows GOTO."""
    return Goto(target(reader), at)


def gosub(reader: ExpressionReader, at: int) -> Gosub:
    """What follows GOSUB."""
    return Gosub(target(reader), at)


def back(reader: ExpressionReader, at: int) -> Return:
    """What follows RET."""
    return Return(at)


def if_(reader: ExpressionReader, at: int) -> If:
    """What follows IF."""
    is_bare = reader.peek() == "#"
    condition = reader.expression()
    test = _input_test(condition) if is_bare else None
    if not reader.match("THEN"):
        raise reader.fault("E108", hint="IF condition THEN GOTO n")
    reader.blanks()
    start = reader.column
    for keyword, read in (("GOTO", goto), ("GOSUB", gosub)):
        if reader.match(keyword):
            return If(condition, read(reader, start), at, test)
    if reader.match("RET"):
        return If(condition, Return(start), at, test)
    raise reader.fault("E108", hint="THEN GOTO n, THEN GOSUB n or THEN RET")


def print_(reader: ExpressionReader, at: int) -> Print:
    """What follows PRINT."""
    items: list[str | Node] = []
    while reader.peek() not in ("", ";"):
        items.append(quoted(reader) if reader.peek() == '"' else _printed(reader))
        reader.gap()
        if not reader.match(";"):
            break
    return Print(tuple(items), at)


def _printed(reader: ExpressionReader) -> Node:
    start = reader.column
    try:
        return reader.expression()
    except CodeError as fault:
        code = "E109" if fault.code == "E104" else fault.code
        raise CodeError(code, fault.column if code != "E109" else start) from None


def quoted(reader: ExpressionReader) -> str:
    """A text in quotes."""
    if reader.peek() != '"':
        raise reader.fault("E109")
    end = reader.raw.find('"', reader.pos + 1)
    if end < 0:
        raise reader.fault("E109")
    text = reader.raw[reader.pos + 1 : end]
    reader.pos = end + 1
    return text


def input_(reader: ExpressionReader, at: int) -> Input:
    """What follows INPUT."""
    text = quoted(reader)
    if not reader.match(","):
        raise reader.fault("E108")
    if not reader.peek() or reader.peek() not in reader.grammar.parameters:
        raise reader.fault("E108")
    is_hash = reader.text[reader.pos] == "#"
    reader.pos += 1
    return Input(text, reader.index(), at, is_hash)


def include(reader: ExpressionReader, at: int) -> Include:
    """What follows $I."""
    name = reader.raw[reader.pos :].split(";")[0].split("(")[0].strip()
    if not name:
        raise reader.fault("E108", hint="$I file")
    reader.pos = len(reader.raw)
    return Include(name.strip('"'), at)


_STATEMENTS: tuple[tuple[str, Callable[[ExpressionReader, int], Statement]], ...] = (
    ("IF", if_),
    ("GOTO", goto),
    ("GOSUB", gosub),
    ("RET", back),
    ("PRINT", print_),
    ("INPUT", input_),
    ("$I", include),
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
