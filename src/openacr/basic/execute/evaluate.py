"""Strings in expressions: what the VM leaves to Python.

Numbers inside are computed by the VM, so every operator on numbers has one definition.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from openacr.basic.execute.threads import Threads
from openacr.basic.language.nodes import (
    Alias,
    Apply,
    Binary,
    Expr,
    Number,
    Op,
    String,
    StringElement,
    StringLocal,
    is_text,
)
from openacr.basic.memory.string_storage import LONGEST_STRING, ProgramStrings
from openacr.basic.vm.printed import printed
from openacr.basic.vm.run import Wait
from openacr.errors import CardError
from openacr.map.rows import threads as thread_rows
from openacr.messages import NOT_VALID_AT_THIS_LEVEL, SUBSCRIPT_OUT_OF_RANGE, TYPE_MISMATCH

RELATIONS = {
    Op.EQUAL: str.__eq__,
    Op.UNEQUAL: str.__ne__,
    Op.LESS: str.__lt__,
    Op.GREATER: str.__gt__,
    Op.LESS_EQUAL: str.__le__,
    Op.GREATER_EQUAL: str.__ge__,
}


class Blocked(Exception):  # noqa: N818 - no error, the statement is tried again
    """An operand is not there yet (GETCH): the statement is executed again after the wait."""

    def __init__(self, wait: Wait) -> None:
        super().__init__(wait)
        self.wait = wait


class Operands:
    """Computes what contains strings, for one thread at a time."""

    def __init__(self, threads: Threads, value: Callable[[int, Expr], float]) -> None:
        """`value` computes the number of an expression with the variables of a thread."""
        self._threads, self._compute = threads, value

    def text(self, thread: int, node: Expr) -> str:
        """The value of a string expression."""
        match node:
            case String(text):
                return text
            case Alias(_, target):
                return self.text(thread, target)
            case StringLocal(index):
                number = self._index(thread, index)
                return self._strings(thread).variable(number).read(number)
            case StringElement(array, index):
                block = self._strings(thread).array(self._index(thread, array))
                return block.read(self._index(thread, index))
            case Binary(Op.PLUS, left, right):
                return (self.text(thread, left) + self.text(thread, right))[:LONGEST_STRING]
            case Apply(function) if function.gives_text:
                return str(self._apply(thread, node))[:LONGEST_STRING]
        raise CardError(TYPE_MISMATCH)

    def number(self, thread: int, node: Expr) -> float:
        """The value of a numeric operand whose own operands are strings."""
        match node:
            case Number(value):
                return value
            case Binary(op, left, right) if op in RELATIONS:
                return -float(RELATIONS[op](self.text(thread, left), self.text(thread, right)))
            case Apply():
                return float(self._apply(thread, node))
        raise CardError(TYPE_MISMATCH)

    def assign_text(self, thread: int, target: Expr, text: str) -> None:
        """Store into a string variable."""
        match target:
            case StringLocal(index):
                number = self._index(thread, index)
                self._strings(thread).variable(number).write(number, text)
            case StringElement(array, index):
                block = self._strings(thread).array(self._index(thread, array))
                block.write(self._index(thread, index), text)
            case _:
                raise CardError(TYPE_MISMATCH)

    def _apply(self, thread: int, node: Apply) -> Any:
        function = node.function
        if function.apply is None:
            raise CardError(TYPE_MISMATCH)
        if function.takes == "p":
            return function.apply(printed(self._threads.run_of(thread), *node.arguments))
        arguments = [
            self.text(thread, argument) if is_text(argument) else self._value(thread, argument)
            for argument in node.arguments
        ]
        if function.wants_run:
            result = function.apply(self._threads.run_of(thread), *arguments)
            if isinstance(result, Wait):
                raise Blocked(result)
            return result
        return function.apply(*arguments)

    def _value(self, thread: int, node: Expr) -> float:
        return node.value if isinstance(node, Number) else self._compute(thread, node)

    def _index(self, thread: int, node: Expr) -> int:
        value = self._value(thread, node)
        if not -(2.0**63) < value < 2.0**63:
            raise CardError(SUBSCRIPT_OUT_OF_RANGE)
        return int(value)

    def _strings(self, thread: int) -> ProgramStrings:
        memory = self._threads.memory
        program = memory.I[thread_rows.locals[thread]]
        if program < 0:
            raise CardError(NOT_VALID_AT_THIS_LEVEL)
        return self._threads.system.storage.locals.strings[program]
