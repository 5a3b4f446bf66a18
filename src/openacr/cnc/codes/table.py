"""The codes of the languages: one decorated function each.

A row says what a code is called, to which group it belongs, when in a block it acts,
which words it uses and between which values. Checks, the order of action and the tables
in the reference are derived from these rows.

    @gcode(4, step=Step.DWELL, takes="F", limits=(Limit("F", 0.1, 999.9, "E240"),))
    def dwell(run: Run, b: BlockContext) -> None:
        \"\"\"Rest for F seconds.\"\"\"

A row may have a fast form (`fast.py`) beside its handler; without it the code is only slower. Codes
that only set values of the modal state have no other handler (`Table.sets`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from enum import Enum, auto
from typing import TYPE_CHECKING, TypedDict, Unpack

from msgspec import Struct, field
from msgspec.structs import replace

from openacr.cnc.codes.fast import FastForms, Forms, Sets, forms_of
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import NEAR
from openacr.cnc.reading.grammar import Grammar

if TYPE_CHECKING:
    from openacr.cnc.canonical import Entry
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext
    from openacr.cnc.state.modal import Rule
    from openacr.cnc.state.parameters import Parameters

Handler = Callable[["Run", "BlockContext"], "Iterator[Entry] | None"]


class Step(Enum):
    """When something of a block acts; the order stands in the dialect."""

    FEED = auto()
    SPEED = auto()
    TOOL = auto()
    RADIUS = auto()
    LENGTH_NUMBER = auto()
    FEED_MODE = auto()
    UNIT = auto()
    PLANE = auto()
    DISTANCE = auto()
    RETURN_LEVEL = auto()
    CENTRES = auto()
    PATH = auto()
    CYCLE_OFF = auto()
    MACRO_OFF = auto()
    WORK = auto()
    LOCAL = auto()
    SCALE = auto()
    ROTATION = auto()
    ZERO = auto()
    LENGTH = auto()
    FIXTURE = auto()
    COMPENSATION = auto()
    DATA = auto()
    TRANSFER = auto()
    TOOL_CHANGE = auto()
    SPINDLE = auto()
    COOLANT = auto()
    SWITCHES = auto()
    DWELL = auto()
    MOTION = auto()
    MACRO_CALL = auto()
    SPINDLE_OFF = auto()
    COOLANT_OFF = auto()
    STOP = auto()
    KEEP = auto()


class Group(Enum):
    """Codes that replace each other; of each one group a block has at most one."""

    MOTION = 1
    PLANE = 2
    DISTANCE = 3
    UNIT = 6
    COMPENSATION = 7
    LENGTH = 8
    CYCLE = 9
    RETURN_LEVEL = 10
    SCALE = 11
    WORK = 12
    MACRO = 14
    PATH = 15
    ROTATION = 16
    CENTRES = 17
    FEED_MODE = 5
    ZERO = 18


class Axes(Enum):
    """What a code does with the axis words of its block."""

    NONE = auto()
    DATA = auto()  # takes them: no motion
    MOVE = auto()  # takes them and moves
    MODAL = auto()  # they belong to the motion that is active
    BARRED = auto()  # there may be none


class Limit(Struct, frozen=True):
    """Values a word of a code may have, and the error otherwise."""

    letter: str
    low: float
    high: float
    error: str
    is_needed: bool = False
    is_whole: bool = False

    @property
    def reach(self) -> str:
        """The values, as a hint."""
        return f"{self.letter} {self.low:g} to {self.high:g}"


def check_limit(limit: Limit, value: float, column: int) -> None:
    """Refuse a value outside its limits."""
    if limit.is_whole and abs(value - round(value)) > NEAR:
        raise CodeError("E204", column, limit.letter)
    if not limit.low <= value <= limit.high:
        raise CodeError(limit.error, column, f"{limit.letter}{value:g}", limit.reach)


class Code(Struct, frozen=True):
    """One G or M code, or the letter of a word that acts by itself."""

    letter: str
    number: float
    step: Step
    act: Handler
    group: Group | None = None
    words: str = ""  # letters it uses beside axis words
    takes: str = ""  # of these, letters that do not act by themselves beside it
    axes: Axes = Axes.NONE
    limits: tuple[Limit, ...] = ()
    acts_dry: bool = True  # also in DRY RUN
    takes_all: bool = False  # every other word is an argument
    fast: Forms | None = None  # None: only the handler knows what it does
    is_polar: bool = False  # @ and ^ may take the place of X and Y

    @property
    def name(self) -> str:
        """As written."""
        return f"{self.letter}{self.number:g}"

    @property
    def summary(self) -> str:
        """What it does, in one sentence."""
        return (self.act.__doc__ or "").strip().split("\n")[0]


class Row(TypedDict, total=False):
    """What is said of a code beside its numbers and its step: fields of `Code`.

    `words` are here those that act by themselves beside it; those it takes are added.
    """

    group: Group
    words: str
    takes: str
    axes: Axes
    limits: tuple[Limit, ...]
    acts_dry: bool
    takes_all: bool
    is_polar: bool


# What takes over a value after which moves differ in more than their ends.
_FOLLOWS: dict[str, Callable[[Run], None]] = {
    "unit": lambda run: run.path.set_unit(),
    "path": lambda run: run.path.change_pace(),
}


def _sets_of(forms: FastForms, number: float) -> list[Sets]:
    """What a code sets, each with its value."""
    found = [form for form in forms_of(forms, number) or () if isinstance(form, Sets)]
    return [form if form.value is not None else replace(form, value=int(number)) for form in found]


def _setter(changes: Mapping[float, list[Sets]], summary: str) -> Handler:
    """The handler of codes that only set values."""

    def act(run: Run, b: BlockContext) -> None:
        for form in changes[b.number]:
            setattr(run.modal, form.field, form.value)
            if form.is_alone:
                _FOLLOWS[form.field](run)

    act.__doc__ = summary
    return act


class Table(Struct):
    """Codes by number, letters by name; ValueError for a name registered twice."""

    gcodes: dict[float, Code] = field(default_factory=dict)
    mcodes: dict[float, Code] = field(default_factory=dict)
    letters: dict[str, Code] = field(default_factory=dict)

    def add(self, code: Code) -> None:
        """One more row."""
        rows = {"G": self.gcodes, "M": self.mcodes}.get(code.letter)
        if rows is None:
            if code.letter in self.letters:
                raise ValueError(f"{code.letter} is registered twice")
            self.letters[code.letter] = code
        elif code.number in rows:
            raise ValueError(f"{code.name} is registered twice")
        else:
            rows[code.number] = code

    def gcode(
        self, *numbers: float, step: Step, fast: FastForms | None = None, **row: Unpack[Row]
    ) -> Callable[[Handler], Handler]:
        """Register a function as G codes."""
        return self._register("G", numbers, step, fast, row)

    def mcode(
        self, *numbers: float, step: Step, fast: FastForms | None = None, **row: Unpack[Row]
    ) -> Callable[[Handler], Handler]:
        """Register a function as M codes."""
        return self._register("M", numbers, step, fast, row)

    def letter(
        self, letter: str, *, step: Step, fast: FastForms | None = None, **row: Unpack[Row]
    ) -> Callable[[Handler], Handler]:
        """Register a function as a word that acts by itself."""
        return self._register(letter, (0.0,), step, fast, {"words": letter, **row})

    def sets(self, summary: str, *numbers: float, forms: FastForms, words: str = "") -> None:
        """Register G codes that do nothing but what their fast forms say.

        Their step and group have the name of the first field they set.
        """
        changes = {number: _sets_of(forms, number) for number in numbers}
        name = changes[numbers[0]][0].field.upper()
        register = self.gcode(*numbers, step=Step[name], group=Group[name], words=words, fast=forms)
        register(_setter(changes, summary))

    def _register(
        self, letter: str, numbers: tuple[float, ...], step: Step, fast: FastForms | None, row: Row
    ) -> Callable[[Handler], Handler]:
        row["words"] = row.get("words", "") + row.get("takes", "")

        def register(act: Handler) -> Handler:
            for number in numbers:
                self.add(Code(letter, number, step, act, fast=forms_of(fast, number), **row))
            return act

        return register

    def include(
        self,
        other: Table,
        *,
        gcodes: tuple[float, ...] = (),
        mcodes: tuple[float, ...] = (),
        letters: str = "",
    ) -> None:
        """Include rows of another table unchanged."""
        for number in gcodes:
            self.add(other.gcodes[number])
        for number in mcodes:
            self.add(other.mcodes[number])
        for letter in letters.split():
            self.add(other.letters[letter])


class Dialect(Struct, frozen=True):
    """A language: grammar, codes, order of action and the state it starts with."""

    name: str
    grammar: Grammar
    table: Table
    order: tuple[Step, ...]
    start: dict[str, Rule] = field(default_factory=dict)  # of Modal, before the start set
    assigns_last: bool = False  # assignments act after the block is read
    labels: bool = True  # N words are targets
    parameters: type[Parameters] | None = None  # where numbers mean something else
    has_own_cycles: bool = False  # without $I
    rises_first: bool = False  # a series of cycles has one initial level and goes up to R first
    cycle_labels: dict[int, int] = field(default_factory=dict)  # added for cycles of its own
    clearance_inch: float | None = None  # of G73 and G83; None: as in the store
    has_spirals: bool = True  # arcs whose radii differ
    has_entry_arcs: bool = False  # compensation may begin with an arc
    centre_codes: dict[int, str] = field(default_factory=dict)  # how to choose readings of I, J
    has_custom: bool = True  # M codes from files


DIALECTS: dict[str, Dialect] = {}
