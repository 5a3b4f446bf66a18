"""Formulas as byte code for `formulas_cy`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from openacr.cnc.interpreter.by_line import formulas_cy as vm
from openacr.cnc.reading import functions as f
from openacr.cnc.reading.formulas import Call, Node, Number, Parameter
from openacr.cnc.rows import values

if TYPE_CHECKING:
    from openacr.cnc.state.parameters import Parameters

OPERATIONS = {
    f.NEGATE: vm.DO_NEGATE, f.NOT: vm.DO_NOT, f.SIN: vm.DO_SIN, f.COS: vm.DO_COS,
    f.TAN: vm.DO_TAN, f.ATAN: vm.DO_ATAN, f.ASIN: vm.DO_ASIN, f.ACOS: vm.DO_ACOS,
    f.SQRT: vm.DO_SQRT, f.ABS: vm.DO_ABS, f.INT: vm.DO_INT, f.ROUND: vm.DO_ROUND,
    f.FIX: vm.DO_FIX, f.FUP: vm.DO_FUP, f.LN: vm.DO_LN, f.EXP: vm.DO_EXP,
    f.ADD: vm.DO_ADD, f.SUBTRACT: vm.DO_SUBTRACT, f.MULTIPLY: vm.DO_MULTIPLY,
    f.DIVIDE: vm.DO_DIVIDE, f.LESS: vm.DO_LESS, f.MORE: vm.DO_MORE, f.EQUAL: vm.DO_EQUAL,
    f.AT_MOST: vm.DO_AT_MOST, f.AT_LEAST: vm.DO_AT_LEAST, f.UNEQUAL: vm.DO_UNEQUAL,
    f.AND: vm.DO_AND, f.OR: vm.DO_OR, f.XOR: vm.DO_XOR, f.MOD: vm.DO_MOD,
    f.MOD_UP: vm.DO_MOD_UP, f.POWER: vm.DO_POWER, f.ATAN2: vm.DO_ATAN2,
}  # fmt: skip


class NoCodeError(Exception):
    """A formula that only its tree can compute."""


class FormulaWriter:
    """Writes the code of the formulas of one line; `numbers` are those in it, by their place."""

    def __init__(self, parameters: Parameters, numbers: dict[int, tuple[int, float]]) -> None:
        self._parameters = parameters
        self._numbers = numbers
        self._depth = 0
        self.is_computed = False  # whether the number of a parameter was a formula

    def code(self, node: Node) -> list[int]:
        """The code of a formula; NoCodeError where there is none."""
        self._depth = 0
        written: list[int] = []
        self._write(node, written)
        return [*written, vm.DO_RESULT]

    def target(self, index: Node) -> list[int]:
        """The code of the number of a parameter that is assigned."""
        if isinstance(index, Number) and self.is_of_the_shape(index):
            return [vm.DO_WHOLE, int(index.number), vm.DO_RESULT]
        self.is_computed = True
        return self.code(index)

    def store(self, kind: str) -> int:
        """How a parameter is assigned."""
        if kind == "P":
            return values.STORE_CELL
        if kind != "#":
            raise NoCodeError
        return values.STORE_HASH if self._parameters.own is None else values.STORE_OWN

    def _write(self, node: Node, written: list[int]) -> None:
        match node:
            case Number():
                written += self._number(node)
                self._push()
            case Parameter(Number() as index, is_hash) if self.is_of_the_shape(index):
                written += self._parameter(int(index.number), is_hash=is_hash)
                self._push()
            case Parameter(index, is_hash):
                self._write(index, written)
                written.append(self._any(is_hash=is_hash))
            case Call(function, operands) if function in OPERATIONS:
                for operand in operands:
                    self._write(operand, written)
                self._depth -= len(operands) - 1
                written.append(OPERATIONS[function])
            case _:
                raise NoCodeError

    def is_of_the_shape(self, index: Number) -> bool:
        """Whether all lines of the shape have this number: that of `#5`, not that of `#[5]`."""
        return index.at not in self._numbers

    def _parameter(self, n: int, *, is_hash: bool) -> tuple[int, int]:
        parameters = self._parameters
        if is_hash and parameters.own is not None:
            if 1 <= n <= values.LAST_OWN:
                return vm.DO_LOCAL if n <= values.OWN_LOCALS else vm.DO_OWN, n
        elif is_hash and 1 <= n <= values.LOCALS:
            return vm.DO_HASH, n
        elif parameters.is_plain_cell(n, is_hash=is_hash):
            return vm.DO_CELL, n
        raise NoCodeError

    def _any(self, *, is_hash: bool) -> int:
        """The read of a parameter whose number is computed."""
        self.is_computed = True
        if not is_hash:
            return vm.DO_ANY_CELL
        return vm.DO_ANY_HASH if self._parameters.own is None else vm.DO_ANY_OWN

    def _push(self) -> None:
        self._depth += 1
        if self._depth > values.MOST_OPERANDS:
            raise NoCodeError

    def _number(self, node: Number) -> tuple[int, int]:
        """A number of the line, which another line of its shape has another value for."""
        found = self._numbers.get(node.at)
        if found is None:
            raise NoCodeError
        place, value = found
        for operation, wanted in ((vm.DO_NUMBER, value), (vm.DO_NEGATED, -value)):
            if node.number == wanted and math.copysign(1, node.number) == math.copysign(1, wanted):
                return operation, place
        raise NoCodeError
