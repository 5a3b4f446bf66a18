"""G27 to G30: reference points."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Check, Confirm, Entry, Point
from openacr.cnc.codes.table import Axes, Limit, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.sysvar.tabs import CELLS, IO

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
_POINT = Limit("P", 2, 4, "E242", is_whole=True)
REFERENCES = (
    CELLS.reference_point_1,
    CELLS.reference_point_2,
    CELLS.reference_point_3,
    CELLS.reference_point_4,
)


@gcode(27, step=Step.MOTION, axes=Axes.MOVE)
def check_reference(run: Run, b: BlockContext) -> Iterator[Entry]:
    """To reference point 1, wait for its switch, then to the commanded position."""
    _refuse(run, b)
    if run.cells.read(IO.g27_input) < 0.0 or not b.plan.axes:
        raise b.fault("E242", hint="G27 Input and axis words are needed")
    end = run.path.end(b)
    axes = tuple(axis for axis, _ in b.plan.axes)
    _to_reference(run, b, 1, axes)
    run.tell(Confirm(b.source, Check.REFERENCE_INPUT, axes, _reference(run, 1)))
    yield from run.sync(b.source)
    run.path.rapid(b, end)


@gcode(28, step=Step.MOTION, axes=Axes.MOVE)
def to_reference(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Through the intermediate point to reference point 1; the point is remembered."""
    return _through(run, b, 1)


@gcode(30, step=Step.MOTION, takes="P", axes=Axes.MOVE, limits=(_POINT,))
def to_other_reference(run: Run, b: BlockContext) -> Iterator[Entry]:
    """As G28 with reference point P 2, 3 or 4; only homed axes."""
    for axis, letter in b.plan.axes:
        if not run.machine.is_homed(axis):
            raise b.fault("A33", letter, letter)
    return _through(run, b, b.whole("P", 2))


def _through(run: Run, b: BlockContext, n: int) -> Iterator[Entry]:
    _refuse(run, b)
    end = run.path.coordinates.to_machine(run.path.end(b))
    memory = run.modal.memory
    for axis, _ in b.plan.axes:
        memory[axis] = end[axis]
        run.cells.write(CELLS.intermediate_point[axis], end[axis])
    if not memory:
        raise b.fault("E242", hint="no intermediate point yet")
    run.cells.write(CELLS.intermediate_mask, float(sum(1 << axis for axis in memory)))
    run.path.go_machine(b, _at_memory(run))
    axes = tuple(sorted(memory))
    _to_reference(run, b, n, axes)
    run.tell(Confirm(b.source, Check.AT_REFERENCE, axes, _reference(run, n)))
    yield from run.sync(b.source)


@gcode(29, step=Step.MOTION, axes=Axes.MOVE)
def from_reference(run: Run, b: BlockContext) -> None:
    """Through the intermediate point of the last G28 or G30 to the commanded position."""
    _refuse(run, b)
    if not run.modal.memory:
        raise b.fault("E242", hint="no G28 or G30 before")
    run.path.go_machine(b, _at_memory(run))
    run.path.rapid(b, run.path.end(b))


def _refuse(run: Run, b: BlockContext) -> None:
    run.offset_path.refuse(b, "E312")
    if not run.path.coordinates.is_plain:
        raise b.fault("E242", hint="not with scaling or rotation")


def _at_memory(run: Run) -> Point:
    """Where the machine is, with the remembered axes at their intermediate values."""
    return tuple(run.modal.memory.get(axis, x) for axis, x in enumerate(run.path.target))


def _reference(run: Run, n: int) -> Point:
    return tuple(run.cells.read(cell) for cell in REFERENCES[n - 1])


def _to_reference(run: Run, b: BlockContext, n: int, axes: tuple[int, ...]) -> None:
    """Length and fixture offsets that are on are added: the check will miss the point."""
    point, offsets = _reference(run, n), run.path.coordinates.offsets(run.modal)
    target = list(run.path.target)
    for axis in axes:
        target[axis] = point[axis] + offsets[axis]
    run.path.go_machine(b, tuple(target))
