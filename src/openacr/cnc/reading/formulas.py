"""Expressions as trees: their values, and the same as Python source.

A tree is evaluated directly at first; a formula that is used often is written as one
Python expression and compiled, which makes it several times faster. Both forms call the
same functions, so that they give the same number.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol

from msgspec import Struct

from openacr.cnc.reading.functions import NAMES, Function

LOCALS = 33  # parameters of a call
NEAR = 1e-4  # tolerance of whole numbers
HOT = 16  # uses after which a formula is compiled


class Sources(Protocol):
    """Where the operands of formulas come from."""

    def read_p(self, n: float) -> float:
        """Parameter Pn."""

    def read_hash(self, n: float) -> float:
        """Parameter #n: a local of the macro, or Pn."""

    def read_named(self, name: str) -> float:
        """A named parameter."""

    def has_named(self, name: str) -> bool:
        """Whether a named parameter exists."""

    def read_input(self, n: float) -> float:
        """The state of an input."""

    def read_output(self, n: float) -> float:
        """The state of an output."""

    def read_bit(self, n: float) -> float:
        """The state of a card flag."""


class Names(Sources, Protocol):
    """Sources of operands for compiled formulas."""

    @property
    def last_local(self) -> int:
        """The last of the locals #1, #2, ... of the present call; 0 outside calls."""

    def is_plain_cell(self, n: float, *, is_hash: bool) -> bool:
        """Whether a parameter is nothing but a cell of the store."""

    def is_card_cell(self, n: float, *, is_hash: bool) -> bool:
        """Whether a parameter is a variable of the card that programs may write."""

    def names_of_formulas(self) -> dict[str, object]:
        """Functions that compiled formulas call by name."""


class Node(Protocol):
    """A part of a formula."""

    def value(self, at: Sources) -> float:
        """The value now."""

    def source(self, at: Names) -> str:
        """The expression as Python source; operands come from `at`."""

    @property
    def is_constant(self) -> bool:
        """Whether the value never changes."""


@dataclass(frozen=True, slots=True)
class Number:
    """A number as written; `at` is where it stands in the line, -1 elsewhere."""

    number: float
    at: int = field(default=-1, compare=False)

    def value(self, at: Sources) -> float:
        """Itself."""
        return self.number

    def source(self, at: Names) -> str:
        """Itself."""
        return repr(self.number)

    @property
    def is_constant(self) -> bool:
        """Always."""
        return True


class Parameter(Struct, frozen=True):
    """`P n` or `#n`; the index is a formula of its own."""

    index: Node
    is_hash: bool

    def value(self, at: Sources) -> float:
        """What is in the cell."""
        index = self.index.value(at)
        return at.read_hash(index) if self.is_hash else at.read_p(index)

    def source(self, at: Names) -> str:
        """A read of the cell."""
        index = self.index.source(at)
        if isinstance(self.index, Number):
            n = self.index.number
            if self.is_hash and 1 <= n <= at.last_local:
                return f"(values[{int(n)}] if values[0] else {_read(n, at, self.is_hash)})"
            return _read(n, at, self.is_hash)
        return f"{'read_hash' if self.is_hash else 'read_p'}({index})"

    @property
    def is_constant(self) -> bool:
        """Never."""
        return False


def _read(n: float, at: Names, is_hash: bool) -> str:
    """The fastest Python expression that reads a parameter."""
    if at.is_plain_cell(n, is_hash=is_hash):
        return f"cell({int(n)})"
    if at.is_card_cell(n, is_hash=is_hash):
        return f"card({int(n)})"
    return f"read_hash({n!r})" if is_hash else f"read_p({n!r})"


class Named(Struct, frozen=True):
    """`#<name>`, or `EXISTS[#<name>]`."""

    name: str
    is_test: bool = False

    def value(self, at: Sources) -> float:
        """The value, or with EXISTS whether the name is defined."""
        return float(at.has_named(self.name)) if self.is_test else at.read_named(self.name)

    def source(self, at: Names) -> str:
        """A read by name."""
        name = repr(self.name)
        return f"float(has_named({name}))" if self.is_test else f"read_named({name})"

    @property
    def is_constant(self) -> bool:
        """Never."""
        return False


class State(Struct, frozen=True):
    """`INP(n)`, `OUT(n)`, `BIT(n)`: a state of the machine, 0 or 1."""

    kind: str
    index: Node

    def value(self, at: Sources) -> float:
        """The state now."""
        read: Callable[[float], float] = getattr(at, _READS[self.kind])
        return read(self.index.value(at))

    def source(self, at: Names) -> str:
        """A read of the state, as Python."""
        return f"{_READS[self.kind]}({self.index.source(at)})"

    @property
    def is_constant(self) -> bool:
        """Never."""
        return False


_READS = {"INP": "read_input", "OUT": "read_output", "BIT": "read_bit"}


class Call(Struct, frozen=True):
    """A function or operator of one or two operands."""

    function: Function
    operands: tuple[Node, ...]

    def value(self, at: Sources) -> float:
        """The result for the operands as they are now."""
        return self.function.work(*[operand.value(at) for operand in self.operands])

    def source(self, at: Names) -> str:
        """The same in Python."""
        return self.function.template.format(*[operand.source(at) for operand in self.operands])

    @property
    def is_constant(self) -> bool:
        """When all operands are."""
        return all(operand.is_constant for operand in self.operands)


class Formula:
    """A formula that counts its uses and is compiled after `HOT` of them."""

    __slots__ = ("_at", "_uses", "node", "now")

    def __init__(self, node: Node, at: Names) -> None:
        self.node = node
        self._at = at
        self._uses = 0
        self.now: Callable[[], float] = self._first
        if isinstance(node, Number):
            number = node.number
            self.now = lambda: number

    def _first(self) -> float:
        self._uses += 1
        if self._uses == HOT:
            self.now = compiled(self.node, self._at)
        return self.node.value(self._at)


def compiled(node: Node, at: Names) -> Callable[[], float]:
    """Compile a formula into one Python function without arguments."""
    work: Callable[[], float] = eval(f"lambda: {node.source(at)}", names_for(at))
    return work


def names_for(at: Names) -> dict[str, Any]:
    """All functions that compiled formulas call by name."""
    return NAMES | at.names_of_formulas()
