"""A parsed block: words, assignments, a statement and messages, each with its column."""

from msgspec import Struct, field

from openacr.cnc.reading.formulas import Node


class Word(Struct, frozen=True):
    """A letter and its value; `parameter` is the index in `T P3`, where the value is bare."""

    letter: str
    value: Node
    column: int
    parameter: Node | None = None


class Assignment(Struct, frozen=True):
    """`P5 = 1`, `#5 = 1`, `#<name> = 1`, `OUT(1) = 1`, `BIT(128) = 0`."""

    kind: str  # P, #, <, OUT, BIT
    index: Node | str
    value: Node
    column: int


class Message(Struct, frozen=True):
    """`(MSG, text)`; with `has_values` the parameters in it are replaced."""

    text: str
    has_values: bool


class Goto(Struct, frozen=True):
    """GOTO: continue at a label."""

    label: Node
    column: int


class Gosub(Struct, frozen=True):
    """GOSUB: call a label."""

    label: Node
    column: int


class Return(Struct, frozen=True):
    """RET: return to the line after the call."""

    column: int


class InputTest(Struct, frozen=True):
    """`#n = 0|1` as the whole condition of an IF."""

    number: int
    wanted: int


class If(Struct, frozen=True):
    """IF: execute a jump or call if a condition holds."""

    condition: Node
    then: Goto | Gosub | Return
    column: int
    test: InputTest | None = None


class Print(Struct, frozen=True):
    """PRINT: show texts and values."""

    items: tuple[str | Node, ...]
    column: int


class Input(Struct, frozen=True):
    """INPUT: ask the operator for the value of a parameter."""

    text: str
    parameter: Node
    column: int
    is_hash: bool = False  # in a macro, #1 to #33 are its locals


class Include(Struct, frozen=True):
    """`$I file`: include a file."""

    name: str
    column: int


class OWord(Struct, frozen=True):
    """`O100 sub`, `O<name> while [..]`: structure of the rs274ngc dialect."""

    name: str
    kind: str
    values: tuple[Node, ...]
    column: int
    number: Node | None = None  # the name where it is computed: `O#1 call`


Statement = Goto | Gosub | Return | If | Print | Input | Include | OWord


class Block(Struct):
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
