"""The tree of one line: expressions, statements, blocks.

Nodes say what was written, nothing about how it is executed; every node is immutable,
compares by content and can be pickled.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from openacr.basic.language.registry import Command, Function


class LocalKind(IntEnum):
    """The numeric storage kinds of a program's own variables and arrays."""

    LONG = 0
    SINGLE = 1
    DOUBLE = 2


class Op(Enum):
    """Operators; the value is what is written."""

    POWER = "**"
    TIMES = "*"
    DIVIDE = "/"
    MOD = "MOD"
    PLUS = "+"
    MINUS = "-"
    LEFT = "<<"
    RIGHT = ">>"
    EQUAL = "="
    UNEQUAL = "<>"
    LESS = "<"
    GREATER = ">"
    LESS_EQUAL = "<="
    GREATER_EQUAL = ">="
    NOT = "NOT"
    AND = "AND"
    NAND = "NAND"
    OR = "OR"
    NOR = "NOR"
    XOR = "XOR"
    XNOR = "XNOR"


@dataclass(frozen=True, slots=True)
class Number:
    """A literal: an int is a LONG constant, a float anything else."""

    value: int | float


@dataclass(frozen=True, slots=True)
class String:
    """A string literal."""

    text: str


@dataclass(frozen=True, slots=True)
class Parameter:
    """`Pn` or `P(expr)`: a system parameter or a global variable."""

    index: Expr


@dataclass(frozen=True, slots=True)
class Flag:
    """`BITn` or `BIT(expr)`."""

    index: Expr


@dataclass(frozen=True, slots=True)
class Local:
    """`LVn`, `SVn`, `DVn`."""

    kind: LocalKind
    index: Expr


@dataclass(frozen=True, slots=True)
class Element:
    """`LAn(i)`, `SAn(i)`, `DAn(i)`."""

    kind: LocalKind
    array: Expr
    index: Expr


@dataclass(frozen=True, slots=True)
class StringLocal:
    """`$Vn`."""

    index: Expr


@dataclass(frozen=True, slots=True)
class StringElement:
    """`$An(i)`."""

    array: Expr
    index: Expr


@dataclass(frozen=True, slots=True)
class Alias:
    """A word given by #DEFINE, with what it stood for when the line was read."""

    name: str
    target: Expr


@dataclass(frozen=True, slots=True)
class Unary:
    """`-x`, `+x`, `NOT x`."""

    op: Op
    operand: Expr


@dataclass(frozen=True, slots=True)
class Binary:
    """`left op right`."""

    op: Op
    left: Expr
    right: Expr
    joins_text: bool = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Ask each operand once: asked anew at every level, a long sum would take minutes."""
        joins = self.op is Op.PLUS and (is_text(self.left) or is_text(self.right))
        object.__setattr__(self, "joins_text", joins)


@dataclass(frozen=True, slots=True)
class Apply:
    """A function with its arguments."""

    function: Function
    arguments: tuple[Expr, ...]


Expr: TypeAlias = (
    Number
    | String
    | Parameter
    | Flag
    | Local
    | Element
    | StringLocal
    | StringElement
    | Alias
    | Unary
    | Binary
    | Apply
)
Target: TypeAlias = Parameter | Flag | Local | Element | StringLocal | StringElement


def is_text(node: Expr) -> bool:
    """Whether the value of an expression is a string."""
    match node:
        case String() | StringLocal() | StringElement():
            return True
        case Alias(_, target):
            return is_text(target)
        case Apply(function):
            return function.gives_text
        case Binary():
            return node.joins_text
    return False


def resolved(node: Expr) -> Expr:
    """What an alias stands for; any other node itself."""
    return node.target if isinstance(node, Alias) else node


@dataclass(frozen=True, slots=True)
class AxisRef:
    """An axis as it was written: a name of the program, or `AXISn` with its number."""

    name: str
    number: Expr | None = None


@dataclass(frozen=True, slots=True)
class Prefix:
    """`AXISn` or `MASTERm` in front of a command."""

    word: str
    number: Expr


@dataclass(frozen=True, slots=True)
class Statement:
    """One command with its arguments, as its grammar read them."""

    command: Command
    arguments: tuple[object, ...] = ()
    indices: tuple[Expr, ...] = ()
    prefix: Prefix | None = None
    column: int = 1

    @property
    def is_bare(self) -> bool:
        """Whether nothing was written that says what it acts on: no argument, object or switch."""
        is_alone = all(argument is None for argument in self.arguments)
        return is_alone and not (self.indices or self.prefix or self.command.is_switch)


@dataclass(frozen=True, slots=True)
class Move:
    """All targets of one block: they form one coordinated move, issued at the block end."""

    parts: tuple[Statement, ...]
    column: int = 1


Block: TypeAlias = tuple["Statement | Move", ...]


@dataclass(frozen=True, slots=True)
class LineTree:
    """One line: its label if it has one, and the blocks between colons."""

    label: str | None = None
    blocks: tuple[Block, ...] = ()
    remark: str | None = None

    @property
    def is_empty(self) -> bool:
        """Whether nothing but a comment or colons was written."""
        return self.label is None and self.remark is None and not any(self.blocks)
