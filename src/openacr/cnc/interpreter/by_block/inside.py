"""What the parts of an interpreter share: a block that is ready, and what they use of the whole.

That is more than codes may use (`codes/run.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

from msgspec import Struct

from openacr.cnc.canonical import Entry, Moves, Point, Source
from openacr.cnc.codes.block_plan import BlockPlanner, Plan
from openacr.cnc.codes.ngc.owords import OWords
from openacr.cnc.codes.run import Calls, Compensation, Run, RunOptions
from openacr.cnc.codes.table import Code, Dialect, Limit
from openacr.cnc.compensation import Watch
from openacr.cnc.interpreter.by_block.loops import Loops
from openacr.cnc.program.labels import Part
from openacr.cnc.program.program import Node
from openacr.cnc.reading.formulas import Formula
from openacr.cnc.rows.room import Memory

Assign = Callable[[Node], None]
Act = Callable[[Node], Iterator[Entry] | None]


class Ready(Struct):
    """What is done when a block is reached."""

    plan: Plan
    is_empty: bool
    assigns: tuple[Assign, ...]
    late: tuple[Assign, ...]  # where assignments act after the block is read
    statement: Act | None
    values: tuple[tuple[str, Formula], ...]
    limits: tuple[Limit, ...]  # of words that are formulas
    acts: tuple[Code, ...]
    quick: Quick | None  # the block is assignments, or a statement that never waits
    bare: Quick | None  # the same, where it shows nothing and no switch skips it
    is_plain: bool  # the block is words and nothing else


class Quick(Protocol):
    """Something that is done by a call."""

    @property
    def now(self) -> Callable[[Node], object]:
        """Do it."""


class ReadingOptions(RunOptions, Protocol):
    """How the program is read."""

    @property
    def has_batches(self) -> bool:
        """Whether moves of many blocks come as `Moves`."""

    @property
    def is_followed(self) -> bool:
        """Whether the reader looks at offsets at each entry."""

    @property
    def attend(self) -> Callable[[Node], None] | None:
        """Called before a block acts."""

    @property
    def watch(self) -> Watch | None:
        """What sees compensated contours."""


class Contours(Compensation, Protocol):
    """Cutter radius compensation, as lines use it."""

    @property
    def is_following(self) -> bool:
        """Whether every move is an element of a contour."""

    def add_many(self, contour: Moves, start: Point) -> None:
        """Add moves from a machine point on, while `is_following`."""

    def flush(self) -> None:
        """Issue everything that waits."""


class Lines(Calls, Protocol):
    """The lines that are executed."""

    idle_cnt: int  # since the last entry that moves or waits

    def execute(self, node: Node, block: Ready) -> Iterator[Entry]:
        """Let a prepared line act."""


class Inside(Run, Protocol):
    """An interpreter, as its parts see it."""

    out: list[Entry]  # not handed out yet
    is_rested: bool

    @property
    def memory(self) -> Memory:
        """Its rows, as lines read them that are executed together."""

    @property
    def dialect(self) -> Dialect:
        """The language of the program."""

    @property
    def planner(self) -> BlockPlanner:
        """What makes plans of blocks."""

    @property
    def options(self) -> ReadingOptions:
        """How the program is read."""

    @property
    def o_words(self) -> OWords:
        """Subroutines and structures by name."""

    @property
    def offset_path(self) -> Contours:
        """Cutter radius compensation."""

    @property
    def execution(self) -> Lines:
        """The lines that are executed."""

    @property
    def loops(self) -> Loops | None:
        """What notices loops without an end, where the program is only checked."""

    @property
    def is_replaying(self) -> bool:
        """Whether lines before a start line are being replayed."""

    def language(self, part: Part) -> tuple[Dialect, BlockPlanner]:
        """The dialect and planner of a text."""

    def doubt(self, node: Node, code: str, column: int, detail: str = "", hint: str = "") -> None:
        """Note something doubtful at a column of a line, once."""

    def complain(self, code: str, text: str, source: Source) -> None:
        """Report a finding of the geometry."""
