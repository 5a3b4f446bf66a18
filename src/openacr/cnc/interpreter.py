"""The interpreter: a loaded program to canonical entries.

The entries are pulled. A block is checked as a whole before anything of it acts; what it
says acts in the order of the dialect. Where a value depends on the machine, a `Sync` is
handed out first: when the reader asks for the entry behind it, the machine is at rest.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from openacr.cnc import dialects as _dialects  # noqa: F401  registers the languages
from openacr.cnc.arcs import Bow
from openacr.cnc.blocks import Message
from openacr.cnc.canonical import (
    BlockEnd,
    Dwell,
    End,
    Entry,
    Motion,
    Pace,
    Point,
    Say,
    Source,
    Stop,
    Sync,
    WaitBit,
)
from openacr.cnc.codes import DIALECTS, Dialect
from openacr.cnc.compensation import Watch
from openacr.cnc.coordinates import ORIGIN
from openacr.cnc.findings import BlockError, CodeError, Finding, found
from openacr.cnc.flow import Flow, Frame, Level
from openacr.cnc.formulas import LOCALS
from openacr.cnc.gcodes.cycles import CLEARANCE, RETRACT, Drilling
from openacr.cnc.gcodes.macros import ModalMacro
from openacr.cnc.gcodes.motion import MOTIONS, Motions
from openacr.cnc.hosts import Cells, Machine
from openacr.cnc.load import planner_of
from openacr.cnc.modal import Modal, reset
from openacr.cnc.ngc.owords import OWords
from openacr.cnc.offset_path import OffsetPath
from openacr.cnc.parameters import RADIUS_CELLS, NotAtRestError, Parameters
from openacr.cnc.path import Path
from openacr.cnc.plan import Planner
from openacr.cnc.program import Node, Part, Program
from openacr.cnc.ready import Quick, Ready, ready, values_of
from openacr.cnc.scanning import Scanner
from openacr.cnc.statements import shown
from openacr.cnc.turn import Turn

MOST_IDLE = 100_000
_PARAMETER = re.compile(r"([#Pp])(\d{1,7})")
_WAITS = Motion | Dwell | WaitBit | Stop
_ARITHMETIC = (ArithmeticError, ValueError)
OFF = 40
INVERSE_TIME = 93
LENGTH_CELLS = (4000, 4001)
RADIUS, RADIUS_WEAR = RADIUS_CELLS
RADIUS_WITHOUT_D = 100_020
LIBRARY_CENTRES = 250_004
MACRO = "MACRO"


@dataclass(slots=True)
class Options:
    """How a program is run."""

    is_dry: bool = False  # DRY RUN: standard M codes do nothing
    has_block_ends: bool = False  # BlockEnd behind every block with effect
    is_service: bool = False  # system parameters may be assigned
    is_library_part: bool = False  # I, J, K by the setting for library parts
    collects_errors: bool = False  # go on behind errors of the geometry, to find them all
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
        self.parameters = (self.dialect.parameters or Parameters)(self)
        self.o_words = OWords(self)
        self.offset_path = OffsetPath(self)
        self.scanner = Scanner(self)
        self.errors: list[Finding] = []  # where they are collected
        self.macro: ModalMacro | None = None  # G66
        self.drilling: Drilling | None = None
        self.motions: Motions = MOTIONS
        self.is_rested = True
        self.is_ended = False
        self.is_arrived = False
        self._until = 0  # the line a replay ends at
        self._idle_cnt = 0
        self._node: Node | None = None
        self.power_up()

    @property
    def is_replaying(self) -> bool:
        """Whether lines in front of a start line are being replayed."""
        return self._until != 0

    @property
    def position(self) -> Point:
        """The program position, default units."""
        return self.path.program

    # --- entries ----------------------------------------------------------------------

    def entries(self) -> Iterator[Entry]:
        """The program from its first line to its end, once."""
        self.begin()
        return self._guarded(self._blocks(None))

    def entries_until(self, line: int) -> Iterator[Entry]:
        """The program up to the first arrival at a line of its main text."""
        self.begin()
        self._until = line
        self.is_arrived = False
        yield from self._guarded(self._blocks(None))
        self._until = 0

    def go_on(self) -> Iterator[Entry]:
        """The program from where it is."""
        return self._guarded(self._blocks(None))

    def single(self, node: Node) -> Iterator[Entry]:
        """One block that belongs to no program, and what it calls (MDI)."""
        self._node = node
        self.is_ended = self.is_rested = False
        self._idle_cnt = 0
        self.flow.leave()
        self.path.begin(self.machine.position() or self.path.target)
        before = self.modal.copy()
        try:
            yield from self._guarded(self._single(node))
        except BlockError:
            self.modal.take(before)
            self.path.refresh()
            raise

    def _single(self, node: Node) -> Iterator[Entry]:
        block = ready(node, self)
        if not block.is_empty:
            yield from self._block(node, block)
            yield from self.flush()
        if self.flow.frames and not self.is_ended:
            yield from self._blocks(self.flow.frames[0])
        self.offset_path.flush()
        yield from self.flush()

    def _guarded(self, entries: Iterator[Entry]) -> Iterator[Entry]:
        try:
            yield from entries
        except CodeError as fault:
            raise self._error(fault) from None
        except RecursionError:
            raise self._error(CodeError("E260")) from None

    def _error(self, fault: CodeError) -> BlockError:
        self.out.clear()
        node = self._node
        if node is None:
            return BlockError(fault.at(self.program.main.text.name, 1, ""))
        return BlockError(fault.at(node.part.text.name, node.line, node.raw))

    def move(self, entry: Entry) -> None:
        """An entry that moves or waits."""
        self.out.append(entry)
        self.is_rested = False
        self._idle_cnt = 0

    def tell(self, entry: Entry) -> None:
        """An entry without motion."""
        if self.path.elements is not None:
            self.offset_path.hold(entry)
            self.is_rested = False
        else:
            self.out.append(entry)
            self.is_rested &= isinstance(entry, Say)
        if isinstance(entry, _WAITS):
            self._idle_cnt = 0

    def flush(self) -> Iterator[Entry]:
        """Hand out what has come together."""
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

    def warn(self, b: Turn, code: str, letter: str = "", detail: str = "") -> None:
        """Note something doubtful about a block."""
        node = b.node
        name, column = node.part.text.name, b.plan.column(letter)
        finding = found(code, name, node.line, column, detail, "", node.raw)
        if finding not in self.warnings:
            self.warnings.append(finding)

    def complain(self, code: str, text: str, source: Source) -> None:
        """Something about the geometry: a warning is noted, an error ends the program."""
        finding = Finding(code, text, source.file, source.line, 1, "", source.text)
        if not finding.is_error:
            self.warnings.append(finding)
        elif self.options.collects_errors:
            self.errors.append(finding)
        else:
            raise BlockError(finding)

    # --- state ------------------------------------------------------------------------

    def power_up(self) -> None:
        """Nothing chosen, nothing active; the machine stands where it is."""
        self._reset()
        self.path.begin(self.machine.position() or ORIGIN)

    def begin(self) -> None:
        """The start set, at the first line."""
        self._reset()
        if self.options.is_library_part:
            self.modal.centres = int(self.cells.read(LIBRARY_CENTRES))
        self.is_ended = False
        self.is_rested = False
        self._idle_cnt = 0
        self.out.clear()
        self.offset_path.begin()
        self.path.begin(self.machine.position() or self.path.target)
        self.flow.start()

    def _reset(self, *, is_abort: bool = False) -> None:
        reset(self.modal, self.cells, is_abort=is_abort)
        self.macro = None
        self.drilling = None
        self.motions = MOTIONS
        self.path.shape = None
        self.parameters.reset()
        for name, value in self.dialect.start.items():
            setattr(self.modal, name, value)
        self.path.coordinates.scale = self.path.coordinates.rotation = None
        self.path.coordinates.added = ORIGIN
        for cell in (RADIUS_WEAR, *LENGTH_CELLS):
            self.cells.write(cell, 0.0)
        self.cells.write(RADIUS, self.cells.read(RADIUS_WITHOUT_D))
        if not is_abort:
            for axis in range(8):
                self.cells.write(990 + axis, 0.0)
        self.path.set_unit()
        self.path.change_pace()
        self.path.refresh()

    def abort(self) -> None:
        """The state behind ABORT and emergency stop."""
        self.offset_path.begin()
        self._reset(is_abort=True)
        self.flow.start()
        self.out.clear()

    def reload_offsets(self) -> None:
        """Offsets were written: those in use are taken over."""
        modal = self.modal
        for target, source, n in (
            (LENGTH_CELLS[0], 2000, modal.length_number),
            (LENGTH_CELLS[1], 3000, modal.length_number),
            (RADIUS, 1000, modal.radius_number),
            (RADIUS_WEAR, 1500, modal.radius_number),
        ):
            if n:
                self.cells.write(target, self.cells.read(source + n))
        self.offset_path.change_radius()
        self.offsets_changed()

    def offsets_changed(self, cell: int = 0) -> None:
        """Offsets were written: the machine stays, the program position follows."""
        if cell in RADIUS_CELLS:
            self.offset_path.change_radius()
        else:
            self.path.refresh()

    def finish(self, source: Source, *, is_by_code: bool) -> None:
        """End the program."""
        self.offset_path.stop()
        self.tell(End(source, is_by_code))
        self._reset()
        self.is_ended = True

    # --- blocks -----------------------------------------------------------------------

    def _blocks(self, frame: Frame | None) -> Iterator[Entry]:
        """Run block after block until the frame is left or the program has ended."""
        out = self.out
        while not self.is_ended and (frame is None or not frame.is_done):
            while self._scan():
                yield from out
                out.clear()
            node = self._fetch()
            if node is None:
                return
            block = node.ready
            if block is None:  # the end of the text
                yield from self.flush()
                return
            if block.quick is not None:
                if not self._is_quick(node, block.quick):
                    yield from self.sync(node.source)
                    self._is_quick(node, block.quick)
            elif block.is_plain and (b := self._turn(node, block)) is not None:
                for code in block.acts:
                    if code.letter == MACRO and self.macro is None:
                        continue
                    b.number = code.number
                    waiting = code.act(self, b)
                    if waiting is not None:
                        yield from waiting
                        if self.is_ended:
                            break
            else:
                yield from self._block(node, block)
            is_cycle = frame is not None and frame.level is Level.CYCLE
            if self.options.has_block_ends and not is_cycle:
                self.tell(BlockEnd(node.source))
            if out:
                yield from out
                out.clear()

    def _scan(self) -> bool:
        """Take the plain lines that come next; False where there are none."""
        flow = self.flow
        if flow.next is not None or not self.scanner.is_free:
            return False
        place = flow.ahead()
        if place is None:
            return False
        polyline, behind = self.scanner.take(place)
        if behind is place:
            return False
        flow.go_place(behind)
        if polyline is not None:
            self.move(polyline)
        return True

    def _fetch(self) -> Node | None:
        """The next line with an effect; None where a replay has arrived.

        Behind the last line the program has ended, and the line says nothing.
        """
        flow = self.flow
        while True:
            node = flow.following()
            if node is None:
                source = self._node.source if self._node else Source("", 1, "")
                self.finish(source, is_by_code=False)
                return Node(self.program.main, source.line, "", 0)
            self._node = node
            if node.line == self._until and node.part is self.program.main:
                self.is_arrived = True
                return None
            block = node.ready
            if block is None:
                block = node.ready = ready(node, self)
            flow.pass_by(node)
            if block.is_empty:
                continue
            if block.plan.block.is_skippable and self.machine.is_block_skip_on():
                continue
            self._idle_cnt += 1
            if self._idle_cnt > MOST_IDLE:
                raise CodeError("A62", 1)
            return node

    def _is_quick(self, node: Node, work: Quick) -> bool:
        """Do it at once; False where a value needs the machine at rest."""
        try:
            work.now(node)
        except NotAtRestError:
            return False
        except _ARITHMETIC as error:
            raise CodeError("E210", 1, str(error)) from None
        return True

    def _turn(self, node: Node, block: Ready) -> Turn | None:
        """The words as numbers; None where a value needs the machine at rest."""
        try:
            return Turn(node, block.plan, block.plan.numbers or values_of(block))
        except NotAtRestError:
            return None
        except _ARITHMETIC as error:
            raise CodeError("E210", 1, str(error)) from None

    def _block(self, node: Node, block: Ready) -> Iterator[Entry]:
        """One block: read and check everything, then act."""
        for message in block.plan.block.messages:
            yield from self._say(node.source, message)
        done = 0
        words: dict[str, float] = {}
        while True:
            try:
                while done < len(block.assigns):
                    block.assigns[done](node)
                    done += 1
                if block.statement is not None:
                    waiting = block.statement(node)
                    if waiting is not None:
                        yield from waiting
                elif block.acts:
                    words = values_of(block)
                for act in block.late:
                    act(node)
                break
            except NotAtRestError:
                yield from self.sync(node.source)
            except _ARITHMETIC as error:
                raise CodeError("E210", 1, str(error)) from None
        if block.acts:
            yield from self._act(Turn(node, block.plan, words), block)

    def _act(self, b: Turn, block: Ready) -> Iterator[Entry]:
        for code in block.acts:
            if code.letter == MACRO and self.macro is None:
                continue
            b.number = code.number
            waiting = code.act(self, b)
            if waiting is not None:
                yield from waiting
                if self.is_ended:
                    return

    def _say(self, source: Source, message: Message) -> Iterator[Entry]:
        """Show a text; values in it are those of the moment."""
        text = message.text
        while message.has_values:
            try:
                text = _PARAMETER.sub(self._value, message.text)
                break
            except NotAtRestError:
                yield from self.sync(source)
        self.tell(Say(source, text))

    def _value(self, found: re.Match[str]) -> str:
        read = self.parameters.read_hash if found[1] == "#" else self.parameters.read_p
        return shown(read(float(found[2])))

    # --- what codes need --------------------------------------------------------------

    def feed_pace(self, b: Turn, end: Point, bow: Bow | None) -> Pace:
        """How a feed move to a program point runs."""
        if self.modal.feed_mode != INVERSE_TIME:
            return self.path.pace(b)
        if "F" not in b.words:
            raise b.fault("E222", detail="F missing in G93")
        length = self.path.distance(end, bow, self.modal.plane_axes)
        return replace(self.path.pace(b), feed_upm=b.words["F"] * length)

    def check_radii(self, b: Turn, bow: Bow) -> None:
        """Radii of an arc may differ as far as the dialect allows."""
        allowed = self.dialect.radius_tolerance
        if allowed is None:
            return
        apart = abs(bow.end_radius - bow.start_radius)
        inch, share = allowed
        if apart > max(self.path.inches(inch), share * bow.start_radius):
            raise b.fault("E230", detail=f"{bow.start_radius:.5g} and {bow.end_radius:.5g}")

    def refuse_compensation(self, b: Turn, code: str) -> None:
        """An error while cutter radius compensation is on.

        Behind a G40 that nothing has moved after, the program goes on from where the tool is.
        """
        if self.modal.compensation != OFF:
            raise b.fault(code)
        self.offset_path.stop()

    def switch_compensation(self, b: Turn, code: int) -> None:
        """G40, G41, G42."""
        self.offset_path.switch(b, code)

    def clearances(self) -> tuple[float, float]:
        """Retract of G73 and clearance of G83."""
        inch = self.dialect.clearance_inch
        if inch is not None:
            return self.path.inches(inch), self.path.inches(inch)
        return self.cells.read(RETRACT), self.cells.read(CLEARANCE)

    def language(self, part: Part) -> tuple[Dialect, Planner]:
        """In what a text is written: cycles have their own."""
        if part.is_cycles and self.dialect.has_own_cycles:
            return self._cycle_language
        return self.dialect, self.planner

    def check_cycles(self, b: Turn) -> None:
        """An error without the text of the cycles."""
        if not (self.program.has_cycles or self.dialect.has_own_cycles):
            raise b.fault("E251", hint="$I CYCLES.TXT behind M2")

    def cycle_start(self, label: int, b: Turn) -> Node:
        """The first line of a cycle."""
        return self.flow.find(label, self.program.cycles, b.plan.column(""))

    # --- calls ------------------------------------------------------------------------

    def call(self, frame: Frame, start: Node, values: list[float]) -> Iterator[Entry]:
        """Run lines until RET leaves the frame; `values` are its locals."""
        flow, parameters = self.flow, self.parameters
        flow.enter(frame)
        back, here = flow.following(), self._node
        kept = parameters.swap([1.0, *values[1:]])
        flow.go(start)
        yield from self.flush()
        yield from self._blocks(frame)
        parameters.swap(kept)
        if not self.is_ended:
            self._node = here
            flow.resume(back)


def no_values() -> list[float]:
    """Locals of a call without arguments."""
    return [0.0] * (LOCALS + 1)


__all__ = ["Interpreter", "Options", "no_values", "shown"]
