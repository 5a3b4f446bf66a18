"""Code of expressions and of stores into variables."""

from __future__ import annotations

from collections.abc import Callable

from openacr.basic.language.nodes import (
    Alias,
    Apply,
    Binary,
    Element,
    Expr,
    Flag,
    Local,
    LocalKind,
    Number,
    Op,
    Parameter,
    Unary,
    is_text,
    resolved,
)
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.arith_cy import (
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
from openacr.basic.vm.assembly import Assembler
from openacr.basic.vm.functions_cy import FN_NEGATE, FN_NOT
from openacr.map.kinds_cy import is_read_only
from openacr.map.memory import flag_place, kind_table
from openacr.map.numbers import (
    FLAG_LAST,
    KIND_FP32,
    KIND_LONG,
    KIND_NONE,
    PUBLIC_COUNT,
)
from openacr.messages import INVALID_BIT, INVALID_PARAMETER, TYPE_MISMATCH

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


class ExpressionEmitter(Assembler):
    """Writes the code that computes values and stores them."""

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

    def _parameter(self, index: Expr, value: Callable[[], None] | None) -> None:
        number = _literal(index)
        if number is None or is_read_only(number):
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
            self._direct(vm.DO_LOAD_BIT, vm.DO_STORE_BIT, flag_place(number), value)

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
