"""A parsed block: words, assignments, a statement and messages, each with its column."""

from dataclasses import dataclass, field

from openacr.cnc.reading.formulas import Node


@dataclass(frozen=True, slots=True)
class Word:
    """A letter and its value; `parameter` is the index in `T P3`, where the value is bare."""

    letter: str
    value: Node
    column: int
    parameter: Node | None = None


@dataclass(frozen=True, slots=True)
class Assignment:
    """`P5 = 1`, `#5 = 1`, `#<name> = 1`, `OUT(1) = 1`, `BIT(128) = 0`."""

    kind: str  # P, #, <, OUT, BIT
    index: Node | str
    value: Node
    column: int


@dataclass(frozen=True, slots=True)
class Message:
    """`(MSG, text)`; with `has_values` the parameters in it are replaced."""

    text: str
    has_values: bool


@dataclass(frozen=True, slots=True)
class Goto:
    """GOTO: continue at a label."""

    label: Node
    column: int


@dataclass(frozen=True, slots=True)
class Gosub:
    """GOSUB: call a label."""

    label: Node
    column: int


@dataclass(frozen=True, slots=True)
class Return:
    """RET: return to the line after the call."""

    column: int


@dataclass(frozen=True, slots=True)
class InputTest:
    """`#n = 0|1` as the whole condition of an IF."""

    number: int
    wanted: int


@dataclass(frozen=True, slots=True)
class If:
    """IF: execute a jump or call if a condition holds."""

    condition: Node
    then: Goto | Gosub | Return
    column: int
    test: InputTest | None = None


@dataclass(frozen=True, slots=True)
class Print:
    """PRINT: show texts and values."""

    items: tuple[str | Node, ...]
    column: int


@dataclass(frozen=True, slots=True)
class Input:
    """INPUT: ask the operator for the value of a parameter."""

    text: str
    parameter: Node
    column: int
    is_hash: bool = False  # in a macro, #1 to #33 are its locals


@dataclass(frozen=True, slots=True)
class Include:
    """`$I file`: include a file."""

    name: str
    column: int


@dataclass(frozen=True, slots=True)
class OWord:
    """`O100 sub`, `O<name> while [..]`: structure of the rs274ngc dialect."""

    name: str
    kind: str
    values: tuple[Node, ...]
    column: int
    number: Node | None = None  # the name where it is computed: `O#1 call`


Statement = Goto | Gosub | Return | If | Print | Input | Include | OWord


@dataclass(slots=True)
class Block:
    """One line of a part program."""

    label: int | None = None
    is_skippable: bool = False
    is_percent: bool = False
    title: str = ""
    title_number: int = 0
    words: list[Word] = field(default_factory=list)
    assignments: list[Assignment] = field(default_factory=list)
    statement: Statement | None = None
    messages: list[Message] = field(default_factory=list)
    warnings: list[tuple[str, int]] = field(default_factory=list)

    @property
    def is_empty(self) -> bool:
        """Whether the block has nothing but a label, a title or comments."""
        return not (self.words or self.assignments or self.statement or self.messages)
