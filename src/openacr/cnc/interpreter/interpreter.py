"""The interpreter: a loaded program to canonical entries.

The entries are pulled. A block is checked as a whole before anything of it acts; what it
says acts in the order of the dialect (`execution.py`). Where a value depends on the machine,
a `Sync` is handed out first: when the reader asks for the entry after it, the machine is at
rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from msgspec import Struct

from openacr.cnc.canonical import (
    AXES,
    BlockEnd,
    Dwell,
    End,
    Entry,
    Motion,
    Point,
    Say,
    Source,
    Stop,
    Sync,
    WaitBit,
)
from openacr.cnc.codes import dialects as _dialects  # noqa: F401  registers the languages
from openacr.cnc.codes.active import Curve, Drilling, ModalMacro
from openacr.cnc.codes.block_plan import BlockPlanner
from openacr.cnc.codes.gcodes.motion import MOTIONS, NO_CYCLE
from openacr.cnc.codes.ngc.owords import OWords
from openacr.cnc.codes.ngc.splines import OPEN
from openacr.cnc.codes.run import Motions
from openacr.cnc.codes.table import DIALECTS, Dialect
from openacr.cnc.compensation import Watch
from openacr.cnc.geometry.coordinates import ORIGIN
from openacr.cnc.geometry.path import Path
from openacr.cnc.interpreter.by_block.loops import Loops
from openacr.cnc.interpreter.by_block.offset_path import OFF, OffsetPath
from openacr.cnc.interpreter.execution import Execution
from openacr.cnc.loading.load import planner_of
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.program.flow import Flow
from openacr.cnc.program.labels import Part
from openacr.cnc.program.program import Node, Program
from openacr.cnc.reading.findings import MOST, BlockError, CodeError, Finding, found
from openacr.cnc.rows import results
from openacr.cnc.rows.room import Memory
from openacr.cnc.state.cells import (
    CMP_RAD,
    LENGTH,
    LENGTH_WEAR,
    LENGTH_WEARS,
    LENGTHS,
    LIBRARY_CENTRES,
    LOCAL,
    RADII,
    RADIUS,
    RADIUS_WEAR,
    RADIUS_WEARS,
)
from openacr.cnc.state.hosts import Cells, Machine
from openacr.cnc.state.modal import Modal, reset
from openacr.cnc.state.parameters import Parameters

NO_LENGTH = 49
_WAITS = Motion | Dwell | WaitBit | Stop


class Options(Struct):
    """How a program is run."""

    is_dry: bool = False  # DRY RUN: standard M codes do nothing
    has_block_ends: bool = False  # BlockEnd after every block with effect
    is_service: bool = False  # system parameters may be assigned
    is_library_part: bool = False  # I, J, K by the setting for library parts
    has_batches: bool = False  # moves of many blocks come as `Moves`; the reader takes them
    # The reader looks at offsets at each entry: a code that changes them ends a run of lines.
    is_followed: bool = False
    collects_errors: bool = False  # continue after errors of the geometry, to find them all
    # Called before a block acts; blocks are then read one by one.
    attend: Callable[[Node], None] | None = None
    watch: Watch | None = None  # sees compensated contours; else, collecting, they are checked


class Interpreter:
    """Runs one program on cells and a machine."""

    def __init__(
        self,
        program: Program,
        cells: Cells,
        machine: Machine,
        dialect: str = "acromill",
        options: Options | None = None,
    ) -> None:
        self.memory = Memory(results.SIZE)
        self.program = program
        self.cells = cells
        self.machine = machine
        self.dialect = DIALECTS[dialect]
        self.options = options or Options()
        self.modal = Modal()
        self.warnings: list[Finding] = []
        self.planner = planner_of(cells, self.dialect, program)
        own = DIALECTS["acromill"]
        self._cycle_language = own, planner_of(cells, own)
        self.flow = Flow(program)
        self.out: list[Entry] = []
        letters = self.planner.axes
        self.path = Path(cells, self.modal, letters, self.move)
        self.parameters: Parameters = (self.dialect.parameters or Parameters)(self)
        self.o_words = OWords(self)
        self.offset_path = OffsetPath(self)
        self.execution = Execution(self)
        self.errors: list[Finding] = []  # where they are collected
        self.macro: ModalMacro | None = None  # G66
        self.drilling: Drilling | None = None
        self.curve = Curve()
        self.motions: Motions = MOTIONS
        self.is_rested = True
        self.is_ended = False
        self.ended_cnt = 0  # block ends since the start of the program
        self.loops = Loops(self, self.o_words) if self.options.collects_errors else None
        if self.loops is not None:
            self.flow.jumped = self.loops.jumped
        self.power_up()

    @property
    def is_replaying(self) -> bool:
        """Whether lines before a start line are being replayed."""
        return self.execution.until != 0

    @property
    def motion_code(self) -> float:
        """The G code of motion or cycle that is active; 80 without one."""
        return self.modal.cycle if self.modal.cycle != NO_CYCLE else self.modal.motion

    @property
    def has_length(self) -> bool:
        """Whether a tool length is in effect."""
        return self.modal.length != NO_LENGTH or any(self.path.coordinates.added)

    @property
    def position(self) -> Point:
        """The program position, default units."""
        return self.path.program

    # --- entries ----------------------------------------------------------------------

    def entries(self) -> Iterator[Entry]:
        """The program from its first line to its end, once."""
        self.begin()
        return self._guarded(self.execution.blocks())

    def entries_until(self, line: int) -> Iterator[Entry]:
        """The program up to the first arrival at a line of its main text."""
        self.begin()
        self.execution.until = line
        self.execution.is_arrived = False
        yield from self._guarded(self.execution.blocks())
        self.execution.until = 0

    def go_on(self) -> Iterator[Entry]:
        """The program from where it is."""
        return self._guarded(self.execution.blocks())

    def single(self, node: Node) -> Iterator[Entry]:
        """One block that belongs to no program, and what it calls (MDI)."""
        self.is_ended = self.is_rested = False
        self.flow.leave()
        self.path.begin(self.machine.position() or self.path.target)
        modal, parameters = self.modal.copy(), self.parameters
        kept = self.motions, self.macro, self.drilling, parameters.names
        values = list(parameters.values)
        try:
            yield from self._guarded(self.execution.single(node))
        except BlockError:
            self.modal.restore(modal)
            self.motions, self.macro, self.drilling, parameters.names = kept
            parameters.swap(values)
            self.o_words.reset()
            if self.modal.compensation == OFF:
                self.offset_path.begin()
            self.path.change_pace()
            self.path.refresh()
            raise

    def _guarded(self, entries: Iterator[Entry]) -> Iterator[Entry]:
        try:
            yield from entries
        except CodeError as fault:
            raise self._error(fault) from None
        except RecursionError:
            raise self._error(CodeError("E260")) from None

    def _error(self, fault: CodeError) -> BlockError:
        self.out.clear()
        node = self.execution.node
        if node is None:
            return BlockError(fault.at(self.program.main.text.name, 1, ""))
        return BlockError(fault.at(node.part.text.name, node.line, node.raw))

    def move(self, entry: Entry) -> None:
        """An entry that moves or waits."""
        self.out.append(entry)
        self.is_rested = False
        self.execution.idle_cnt = 0

    def tell(self, entry: Entry) -> None:
        """An entry without motion."""
        if self.path.elements is not None:
            self.offset_path.hold(entry)
            self.is_rested = False
        else:
            self.out.append(entry)
            self.is_rested &= isinstance(entry, Say)
        if isinstance(entry, _WAITS):
            self.execution.idle_cnt = 0

    def end_block(self, source: Source) -> None:
        """An entry that marks the end of a block."""
        self.ended_cnt += 1
        self.tell(BlockEnd(source))

    def flush(self) -> Iterator[Entry]:
        """Hand out the collected entries."""
        yield from self.out
        self.out.clear()

    def sync(self, source: Source) -> Iterator[Entry]:
        """Hand out everything and wait for rest."""
        if self.path.elements is not None:
            self.offset_path.flush()
        if self.is_rested and not self.out:
            return
        yield from self.flush()
        yield Sync(source)
        self.is_rested = True

    def warn(
        self, b: BlockContext, code: str, letter: str = "", detail: str = "", hint: str = ""
    ) -> None:
        """Note something doubtful about a block."""
        self.doubt(b.node, code, b.plan.column(letter), detail, hint)

    def doubt(self, node: Node, code: str, column: int, detail: str = "", hint: str = "") -> None:
        """Note something doubtful at a column of a line, once."""
        finding = found(code, node.part.text.name, node.line, column, detail, hint, node.raw)
        if sum(each.code == code for each in self.warnings) < MOST and finding not in self.warnings:
            self.warnings.append(finding)

    def complain(self, code: str, text: str, source: Source) -> None:
        """Report a finding of the geometry: a warning is noted, an error ends the program."""
        finding = Finding(code, text, source.file, source.line, 1, "", source.text)
        if not finding.is_error:
            self.warnings.append(finding)
        elif self.options.collects_errors:
            self.errors.append(finding)
        else:
            raise BlockError(finding)

    # --- state ------------------------------------------------------------------------

    def power_up(self) -> None:
        """Set the state of power-up; the machine keeps its position."""
        self._reset()
        self.path.begin(self.machine.position() or ORIGIN)

    def begin(self) -> None:
        """Set the state at the start of a program, at its first line."""
        self._reset()
        if self.options.is_library_part:
            self.modal.centres = int(self.cells.read(LIBRARY_CENTRES))
        self.is_ended = False
        self.is_rested = False
        self.ended_cnt = 0
        self.execution.idle_cnt = 0
        self.out.clear()
        self.offset_path.begin()
        self.path.begin(self.machine.position() or self.path.target)
        self.flow.start()
        self.o_words.reset()

    def _reset(self, *, is_abort: bool = False) -> None:
        reset(self.modal, self.cells, is_abort=is_abort)
        self.macro = None
        self.drilling = None
        self.curve = Curve()
        self.motions = MOTIONS
        self.path.shape = None
        self.parameters.reset()
        for name, rule in self.dialect.start.items():
            setattr(self.modal, name, rule(self.cells))
        self.path.coordinates.clear()
        for cell in (RADIUS_WEAR, LENGTH, LENGTH_WEAR):
            self.cells.write(cell, 0.0)
        self.cells.write(RADIUS, self.cells.read(CMP_RAD))
        if not is_abort:
            for axis in range(AXES):
                self.cells.write(LOCAL + axis, 0.0)
        self.path.set_unit()
        self.path.change_pace()
        self.path.refresh()

    def abort(self) -> None:
        """Set the state after ABORT and emergency stop."""
        self.offset_path.begin()
        self._reset(is_abort=True)
        self.flow.start()
        self.out.clear()

    def reload_offsets(self) -> None:
        """Apply offsets that were written."""
        modal = self.modal
        for target, source, n in (
            (LENGTH, LENGTHS, modal.length_number),
            (LENGTH_WEAR, LENGTH_WEARS, modal.length_number),
            (RADIUS, RADII, modal.radius_number),
            (RADIUS_WEAR, RADIUS_WEARS, modal.radius_number),
        ):
            if n:
                self.cells.write(target, self.cells.read(source + n))
        self.offset_path.change_radius()
        self.offsets_changed()

    def offsets_changed(self, cell: int = 0) -> None:
        """Recompute the program position after offsets were written."""
        if cell in (RADIUS, RADIUS_WEAR):
            self.offset_path.change_radius()
        else:
            self.path.refresh()

    def finish(self, source: Source, *, is_by_code: bool) -> None:
        """End the program."""
        if self.curve.points:
            raise CodeError("E235", 1, hint=OPEN)
        self.offset_path.stop()
        self.tell(End(source, is_by_code))
        self._reset()
        self.is_ended = True

    def language(self, part: Part) -> tuple[Dialect, BlockPlanner]:
        """The dialect and planner of a text; the cycles have their own."""
        if part.is_cycles and self.dialect.has_own_cycles:
            return self._cycle_language
        return self.dialect, self.planner
