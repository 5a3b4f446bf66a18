"""The tree of one line: expressions, statements, blocks.

Nodes say what was written, nothing about how it is executed; every node is immutable,
compares by content and can be pickled.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, TypeAlias

from msgspec import Struct
from msgspec.structs import force_setattr

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


class Number(Struct, frozen=True):
    """A literal: an int is a LONG constant, a float anything else."""

    value: int | float


class String(Struct, frozen=True):
    """A string literal."""

    text: str


class Parameter(Struct, frozen=True):
    """`Pn` or `P(expr)`: a system parameter or a global variable."""

    index: Expr


class Flag(Struct, frozen=True):
    """`BITn` or `BIT(expr)`."""

    index: Expr


class Local(Struct, frozen=True):
    """`LVn`, `SVn`, `DVn`."""

    kind: LocalKind
    index: Expr


class Element(Struct, frozen=True):
    """`LAn(i)`, `SAn(i)`, `DAn(i)`."""

    kind: LocalKind
    array: Expr
    index: Expr


class StringLocal(Struct, frozen=True):
    """`$Vn`."""

    index: Expr


class StringElement(Struct, frozen=True):
    """`$An(i)`."""

    array: Expr
    index: Expr


class Alias(Struct, frozen=True):
    """A word given by #DEFINE, with what it stood for when the line was read."""

    name: str
    target: Expr


class Unary(Struct, frozen=True):
    """`-x`, `+x`, `NOT x`."""

    op: Op
    operand: Expr


class Binary(Struct, frozen=True):
    """`left op right`."""

    op: Op
    left: Expr
    right: Expr
    joins_text: bool = False  # whatever is given: it follows from the operands

    def __post_init__(self) -> None:
        """Ask each operand once: asked anew at every level, a long sum would take minutes."""
        joins = self.op is Op.PLUS and (is_text(self.left) or is_text(self.right))
        force_setattr(self, "joins_text", joins)


class Apply(Struct, frozen=True):
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


def parts(node: object) -> Iterator[object]:
    """What a node, or a tuple of them, directly consists of; nothing of anything else."""
    if isinstance(node, tuple):
        yield from node
    elif isinstance(node, Struct):
        for name in node.__struct_fields__:
            yield getattr(node, name)


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


class AxisRef(Struct, frozen=True):
    """An axis as it was written: a name of the program, or `AXISn` with its number."""

    name: str
    number: Expr | None = None


class Prefix(Struct, frozen=True):
    """`AXISn` or `MASTERm` in front of a command."""

    word: str
    number: Expr


class Statement(Struct, frozen=True):
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


class Move(Struct, frozen=True):
    """All targets of one block: they form one coordinated move, issued at the block end."""

    parts: tuple[Statement, ...]
    column: int = 1


Block: TypeAlias = tuple["Statement | Move", ...]


class LineTree(Struct, frozen=True):
    """One line: its label if it has one, and the blocks between colons."""

    label: str | None = None
    blocks: tuple[Block, ...] = ()
    remark: str | None = None

    @property
    def is_empty(self) -> bool:
        """Whether nothing but a comment or colons was written."""
        return self.label is None and self.remark is None and not any(self.blocks)
