"""Turn trees into byte code of the VM.

A program is compiled as a whole when it is started: labels, line numbers and the levels
of IF, FOR and WHILE are tied together then, and what does not fit together is reported
with its line. A line typed at a prompt takes the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TypeAlias

from openacr.basic import opcodes_cy as vm
from openacr.basic.arith_cy import (
    FN_NEGATE,
    FN_NOT,
    OP_ADD,
    OP_AND,
    OP_DIVIDE,
    OP_EQUAL,
    OP_GREATER,
    OP_GREATER_EQUAL,
    OP_LESS,
    OP_LESS_EQUAL,
    OP_MOD,
    OP_MULTIPLY,
    OP_NAND,
    OP_NOR,
    OP_OR,
    OP_POWER,
    OP_SHIFT_LEFT,
    OP_SHIFT_RIGHT,
    OP_SUBTRACT,
    OP_UNEQUAL,
    OP_XNOR,
    OP_XOR,
)
from openacr.basic.code import Chunk
from openacr.basic.levels import CompileError, Level, Levels, unclosed
from openacr.basic.nodes import (
    Alias,
    Apply,
    Binary,
    Block,
    Element,
    Expr,
    Flag,
    Line,
    Local,
    LocalKind,
    Move,
    Number,
    Op,
    Parameter,
    Statement,
    Unary,
    is_text,
    resolved,
)
from openacr.map.memory import kind_table
from openacr.map.numbers import FLAG_LAST, KIND_FP32, KIND_LONG, KIND_NONE, PUBLIC_COUNT
from openacr.messages import (
    DUPLICATE_LABEL,
    INVALID_BIT,
    INVALID_PARAMETER,
    LABEL_NOT_FOUND,
    LINE_NOT_FOUND,
    STACK_OVERFLOW,
    TYPE_MISMATCH,
    Message,
)

DEEPEST_EXPRESSION = 90
FLAG_WORDS = 4096
HIGHEST_INDEX = 2147483646

OPERATORS = {
    Op.PLUS: OP_ADD, Op.MINUS: OP_SUBTRACT, Op.TIMES: OP_MULTIPLY, Op.DIVIDE: OP_DIVIDE,
    Op.MOD: OP_MOD, Op.POWER: OP_POWER,
    Op.EQUAL: OP_EQUAL, Op.UNEQUAL: OP_UNEQUAL, Op.LESS: OP_LESS, Op.GREATER: OP_GREATER,
    Op.LESS_EQUAL: OP_LESS_EQUAL, Op.GREATER_EQUAL: OP_GREATER_EQUAL,
    Op.AND: OP_AND, Op.NAND: OP_NAND, Op.OR: OP_OR, Op.NOR: OP_NOR, Op.XOR: OP_XOR,
    Op.XNOR: OP_XNOR, Op.LEFT: OP_SHIFT_LEFT, Op.RIGHT: OP_SHIFT_RIGHT,
}  # fmt: skip
_KINDS = kind_table()


@dataclass(slots=True)
class Place:
    """A place in the code that operations may refer to before it is known."""

    at: int = -1
    users: list[int] = field(default_factory=list)


Word: TypeAlias = int | Place


@dataclass(slots=True, eq=False)
class CodeLevel(Level):
    """A level with the places of its code."""

    start: Place = field(default_factory=Place)
    stop: Place = field(default_factory=Place)
    next_branch: Place | None = None
    data: Expr | None = None  # the variable of a FOR


def compile_program(lines: Iterable[tuple[int, Line]]) -> Chunk:
    """The code of a whole program; CompileError if its structure is wrong."""
    emitter = Emitter()
    for number, line in lines:
        emitter.line(number, line)
    return emitter.finish()


def compile_line(line: Line) -> Chunk:
    """The code of a line typed at a prompt."""
    emitter = Emitter()
    emitter.blocks(line.blocks)
    return emitter.finish()


class Emitter:
    """Writes byte code; commands with `emit=` in their row use it."""

    def __init__(self, chunk: Chunk | None = None) -> None:
        self.chunk = chunk or Chunk()
        self.line_number = 0
        self.levels = Levels[CodeLevel]()
        self._labels: dict[str, Place] = {}
        self._lines: dict[int, Place] = {}
        self._is_first = True
        self._depth = 0

    # lines and statements

    def line(self, number: int, line: Line) -> None:
        """One stored line."""
        self.line_number = number
        self._is_first = True
        self.put(self._lines.setdefault(number, Place()))
        self.chunk.starts[number] = len(self.chunk.code)
        if line.label is not None:
            place = self._labels.setdefault(line.label, Place())
            if place.at >= 0:
                raise self.error(DUPLICATE_LABEL, line.label)
            self.put(place)
        self.blocks(line.blocks)

    def blocks(self, blocks: Iterable[Block]) -> None:
        """Blocks one after the other."""
        for block in blocks:
            for statement in block:
                self.statement(statement)

    def statement(self, statement: Statement | Move) -> None:
        """One statement: its own code, or a trap to the handler of its command."""
        self.begin_statement()
        if isinstance(statement, Move) or statement.command.emit is None:
            self.trap(statement)
        else:
            statement.command.emit(self, statement)

    def begin_statement(self) -> None:
        """Mark the beginning of a statement: slices, pauses and steps stop there."""
        self.op(vm.DO_STATEMENT, self.line_number, int(self._is_first))
        self._is_first = False

    def trap(self, statement: Statement | Move) -> None:
        """Leave a statement to Python."""
        self.op(vm.DO_TRAP, len(self.chunk.statements))
        self.chunk.statements.append(statement)

    def finish(self) -> Chunk:
        """Tie up all loose ends; CompileError if a level is still open."""
        if self.levels.innermost is not None:
            raise unclosed(self.levels.innermost)
        self.op(vm.DO_END)
        for label, place in self._labels.items():
            if place.at < 0:
                self._fail_at(place, LABEL_NOT_FOUND, len(self.chunk.names))
                self.chunk.names.append(label)
        for number, place in self._lines.items():
            if place.at < 0:
                self._fail_at(place, LINE_NOT_FOUND, number)
        self._write_line_table()
        return self.chunk

    def _fail_at(self, place: Place, message: Message, detail: int) -> None:
        self.put(place)
        self.op(vm.DO_FAIL, message.number, detail)

    def _write_line_table(self) -> None:
        self.chunk.lines_at = len(self.chunk.code)
        self.chunk.lines_count = len(self.chunk.starts)
        for number in sorted(self.chunk.starts):
            self.op(number, self.chunk.starts[number])

    def error(self, message: Message, detail: object = "") -> CompileError:
        """The error to raise for the present line."""
        return CompileError(message, self.line_number, detail)

    # code

    def op(self, *words: Word) -> None:
        """Append an operation with its operands."""
        for word in words:
            if isinstance(word, Place):
                word.users.append(len(self.chunk.code))
                self.chunk.code.append(word.at)
            else:
                self.chunk.code.append(word)

    def put(self, place: Place) -> None:
        """Fix a place: it is here."""
        place.at = len(self.chunk.code)
        for user in place.users:
            self.chunk.code[user] = place.at

    def place(self) -> Place:
        """A place that is not known yet."""
        return Place()

    def open(self, kind: int) -> CodeLevel:
        """Begin a level of IF, FOR or WHILE."""
        level = CodeLevel(kind, self.line_number)
        self.levels.enter(level)
        return level

    def label(self, name: str) -> Place:
        """The place of a label."""
        return self._labels.setdefault(name, Place())

    def numbered(self, line: int) -> Place:
        """The place of a line."""
        return self._lines.setdefault(line, Place())

    def fail(self, message: Message) -> None:
        """An error that is raised when execution gets here."""
        self.op(vm.DO_FAIL, message.number, 0)

    def push(self, value: float) -> None:
        """Push a constant."""
        self._grow(1)
        nums = self.chunk.nums
        self.op(vm.DO_PUSH, len(nums))
        nums.append(float(value))

    def _grow(self, count: int) -> None:
        self._depth += count
        if self._depth > DEEPEST_EXPRESSION:
            raise self.error(STACK_OVERFLOW)

    # expressions

    def expression(self, node: Expr) -> None:
        """Code that pushes the value of a numeric expression."""
        match node:
            case Number(value):
                self.push(value)
            case Alias(_, target):
                self.expression(target)
            case Unary(Op.PLUS, operand):
                self.expression(operand)
            case Unary(op, Number(value)) if op is Op.MINUS:
                self.push(-value if value else 0.0)
            case Unary(op, operand):
                self.expression(operand)
                self.op(vm.DO_FUNCTION, FN_NEGATE if op is Op.MINUS else FN_NOT)
            case Binary(op, left, right) if not is_text(left):
                self._binary(op, left, right)
            case Apply(function, (argument,)) if function.code is not None:
                self.expression(argument)
                self.op(vm.DO_FUNCTION, function.code)
            case Binary() | Apply():
                self._grow(1)
                self.op(vm.DO_CALL, len(self.chunk.operands))
                self.chunk.operands.append(node)
            case _:
                self._load(node)

    def _binary(self, op: Op, left: Expr, right: Expr) -> None:
        self.expression(left)
        self.expression(right)
        self._depth -= 1
        if op is Op.PLUS:
            self.op(vm.DO_ADD)
        elif op is Op.LESS:
            self.op(vm.DO_LESS)
        else:
            self.op(vm.DO_OPERATOR, OPERATORS[op])

    def _load(self, node: Expr) -> None:
        match node:
            case Parameter(index):
                self._parameter(index, None)
            case Flag(index):
                self._flag(index, None)
            case Local(kind, index):
                self._local(kind, index, None)
            case Element(kind, array, index):
                self.expression(array)
                self.expression(index)
                self._depth -= 1
                self.op(vm.DO_LOAD_ELEMENT, kind)
            case _:
                raise self.error(TYPE_MISMATCH)

    def store(self, target: Expr, value: Callable[[], None]) -> None:
        """Code that stores into a variable what the code written by `value` pushes."""
        match resolved(target):
            case Parameter(index):
                self._parameter(index, value)
            case Flag(index):
                self._flag(index, value)
            case Local(kind, index):
                self._local(kind, index, value)
            case Element(kind, array, index):
                self.expression(array)
                self.expression(index)
                value()
                self._depth -= 3
                self.op(vm.DO_STORE_ELEMENT, kind)
            case _:
                raise self.error(TYPE_MISMATCH)

    def drop(self, count: int) -> None:
        """Note that the operation just written takes `count` numbers from the stack."""
        self._depth -= count

    def _parameter(self, index: Expr, value: Callable[[], None] | None) -> None:
        number = _literal(index)
        if number is None:
            self._indexed(vm.DO_LOAD_PARAMETER, vm.DO_STORE_PARAMETER, index, value)
            return
        kind = _KINDS[number] if number < PUBLIC_COUNT else KIND_NONE
        if kind == KIND_NONE:
            self.fail(INVALID_PARAMETER)
        elif kind == KIND_LONG:
            self._direct(vm.DO_LOAD_LONG, vm.DO_STORE_LONG, (number,), value)
        elif kind == KIND_FP32:
            self._direct(vm.DO_LOAD_SINGLE, vm.DO_STORE_SINGLE, (number,), value)
        else:
            self._direct(vm.DO_LOAD_USER, vm.DO_STORE_USER, (number,), value)

    def _flag(self, index: Expr, value: Callable[[], None] | None) -> None:
        number = _literal(index)
        if number is None:
            self._indexed(vm.DO_LOAD_FLAG, vm.DO_STORE_FLAG, index, value)
        elif number > FLAG_LAST:
            self.fail(INVALID_BIT)
        else:
            word, bit = divmod(number, 32)
            mask = 1 << bit if bit < 31 else -(1 << 31)
            self._direct(vm.DO_LOAD_BIT, vm.DO_STORE_BIT, (FLAG_WORDS + word, mask), value)

    def _local(self, kind: LocalKind, index: Expr, value: Callable[[], None] | None) -> None:
        number = _literal(index)
        if kind is LocalKind.LONG and number is not None:
            self._direct(vm.DO_LOAD_LV, vm.DO_STORE_LV, (number,), value)
        else:
            self._indexed(vm.DO_LOAD_LOCAL, vm.DO_STORE_LOCAL, index, value, kind)

    def _direct(
        self, load: int, store: int, operands: tuple[int, ...], value: Callable[[], None] | None
    ) -> None:
        if value is None:
            self._grow(1)
            self.op(load, *operands)
        else:
            value()
            self.op(store, *operands)
            self._depth -= 1

    def _indexed(
        self, load: int, store: int, index: Expr, value: Callable[[], None] | None, *operands: int
    ) -> None:
        self.expression(index)
        if value is None:
            self.op(load, *operands)
        else:
            value()
            self.op(store, *operands)
            self._depth -= 2


def _literal(index: Expr) -> int | None:
    """The number of a literal index that can stand in the code."""
    node = resolved(index)
    if isinstance(node, Number) and 0 <= node.value <= HIGHEST_INDEX:
        return int(node.value)
    return None


def compile_expression(chunk: Chunk, node: Expr) -> int:
    """Append the code that computes an expression to a chunk; where it begins."""
    emitter = Emitter(chunk)
    at = len(chunk.code)
    emitter.expression(node)
    emitter.op(vm.DO_RESULT)
    return at
