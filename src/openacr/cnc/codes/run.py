"""What a code may use of the interpreter that runs it.

A handler takes a `Run` and the `BlockContext` of its block: it changes the modal state, makes
moves through the path, writes cells, and hands entries without motion to `tell`. Nothing else
of an interpreter is known to a code.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

from openacr.cnc.canonical import Entry, Source
from openacr.cnc.codes.active import Context, Curve, Drilling, ModalMacro
from openacr.cnc.geometry.path import Path
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.program.flow import Flow, Frame
from openacr.cnc.program.program import Node, Program
from openacr.cnc.reading.grammar import Grammar
from openacr.cnc.state.hosts import Cells, Machine
from openacr.cnc.state.modal import Modal
from openacr.cnc.state.parameters import Parameters

Motions = dict[
    float, Callable[["Run", BlockContext], "Iterator[Entry] | None"]
]  # by the number of the G code


class RunOptions(Protocol):
    """How the program is run, as codes need to know it."""

    @property
    def is_dry(self) -> bool:
        """DRY RUN: spindle, coolant and outputs stay as they are."""

    @property
    def has_block_ends(self) -> bool:
        """Whether a `BlockEnd` follows every block with an effect."""

    @property
    def collects_errors(self) -> bool:
        """Whether the program is only checked: reading goes on after errors of the geometry."""


class Language(Protocol):
    """What differs between the dialects where one code serves both."""

    @property
    def has_own_cycles(self) -> bool:
        """Whether canned cycles are there without `$I CYCLES.TXT`."""

    @property
    def rises_first(self) -> bool:
        """Whether a series of cycles has one initial level and goes up to R first."""

    @property
    def cycle_labels(self) -> dict[int, int]:
        """What is added to the labels of cycles that are its own."""

    @property
    def clearance_inch(self) -> float | None:
        """Clearance of G73 and G83 in inches; None: as in the store."""

    @property
    def has_spirals(self) -> bool:
        """Whether arcs may have two radii."""

    @property
    def grammar(self) -> Grammar:
        """Operators, keywords and comments."""

    @property
    def centre_codes(self) -> dict[int, str]:
        """How a program chooses each reading of I, J and K."""


class AxisLetters(Protocol):
    """The axes that the machine has."""

    @property
    def axes(self) -> dict[str, int]:
        """Axis numbers by letter."""


class Compensation(Protocol):
    """Cutter radius compensation, as codes switch it."""

    def switch(self, b: BlockContext, code: int) -> None:
        """G40, G41, G42."""

    def refuse(self, b: BlockContext, code: str) -> None:
        """Raise an error of this code while compensation is on."""


class Calls(Protocol):
    """Calls of labels, macros and subroutines."""

    @property
    def node(self) -> Node | None:
        """The line that is executed."""

    def call(self, frame: Frame, start: Node, values: list[float]) -> Iterator[Entry]:
        """Run a text from a line to its return, with these values as #1 and up."""


class Subroutines(Protocol):
    """The O-words of the program."""

    context: Context | None  # the modal state that this call keeps

    def call(self, name: str, column: int, arguments: list[float]) -> Iterator[Entry]:
        """Run the subroutine of a name."""


class Run(Protocol):
    """One program in progress."""

    modal: Modal
    path: Path
    parameters: Parameters
    drilling: Drilling | None
    curve: Curve  # G5, G5.2
    macro: ModalMacro | None  # G66
    motions: Motions  # what G0 to G3 do now
    is_ended: bool

    @property
    def program(self) -> Program:
        """What runs."""

    @property
    def cells(self) -> Cells:
        """The cells of the store."""

    @property
    def machine(self) -> Machine:
        """The machine, to be asked at rest only."""

    @property
    def motion_code(self) -> float:
        """The G code of motion that is active: 80 without one."""

    @property
    def has_length(self) -> bool:
        """Whether a tool length is in effect."""

    @property
    def flow(self) -> Flow:
        """Which line comes next."""

    @property
    def options(self) -> RunOptions:
        """How the program is run."""

    @property
    def dialect(self) -> Language:
        """The language of the program."""

    @property
    def planner(self) -> AxisLetters:
        """The axes the program may name."""

    @property
    def offset_path(self) -> Compensation:
        """Cutter radius compensation."""

    @property
    def execution(self) -> Calls:
        """Calls of other lines."""

    @property
    def o_words(self) -> Subroutines:
        """Subroutines by name."""

    def move(self, entry: Entry) -> None:
        """Add an entry that moves or waits."""

    def tell(self, entry: Entry) -> None:
        """Add an entry without motion, in its place between two moves."""

    def end_block(self, source: Source) -> None:
        """Add an entry that marks the end of a block."""

    def flush(self) -> Iterator[Entry]:
        """Hand out the entries so far."""

    def sync(self, source: Source) -> Iterator[Entry]:
        """Hand out everything and wait for rest."""

    def warn(
        self, b: BlockContext, code: str, letter: str = "", detail: str = "", hint: str = ""
    ) -> None:
        """Note something doubtful about a block."""

    def reload_offsets(self) -> None:
        """Take over offsets that were written."""

    def offsets_changed(self, cell: int = 0) -> None:
        """Let the program position follow offsets that were written."""

    def finish(self, source: Source, *, is_by_code: bool) -> None:
        """End the program."""
