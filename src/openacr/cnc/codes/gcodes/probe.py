"""G31: a move that ends where the probe trips."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from openacr.cnc.canonical import ROTARY, Entry, Pace, PathMode, Point, Probe
from openacr.cnc.codes.table import Axes, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.sysvar.tabs import CELLS

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
TRIPPED = CELLS.g31_tripped


@gcode(31, step=Step.MOTION, axes=Axes.MOVE)
def probe(run: Run, b: BlockContext) -> Iterator[Entry]:
    """Move at feed until the probe trips; P101 to P108 say where that was."""
    run.offset_path.refuse(b, "E243")
    if not run.machine.has_probe():
        raise b.fault("E243", hint="no probe input")
    yield from run.sync(b.source)
    yield from probed(run, b)


def probed(run: Run, b: BlockContext, *, is_away: bool = False) -> Iterator[Entry]:
    """The move, and what it found."""
    path, machine = run.path, run.machine
    end = path.end(b)
    target = path.coordinates.to_machine(path.coordinates.forward(end))
    pace = Pace(run.modal.feed, PathMode.EXACT)
    b.has_moved = True
    run.move(Probe(b.source, target, pace, is_away))
    yield from run.sync(b.source)
    trip = machine.tripped()
    with run.cells.transaction(is_durable=False):
        run.cells.write(TRIPPED, float(trip is not None))
        if trip is None:
            path.stand(target)
            return
        path.stand(trip)
        keep(run, trip)


def keep(run: Run, trip: Point) -> None:
    """Store the trip position: machine and program coordinates, active unit."""
    rotary = {axis for letter, axis in run.planner.axes.items() if letter in ROTARY}
    program = run.path.program
    for axis, value in enumerate(trip):
        is_length = axis not in rotary
        run.cells.write(CELLS.g31_trip[axis], run.path.shown(value) if is_length else value)
        read = program[axis]
        run.cells.write(
            CELLS.g31_program_position[axis], run.path.shown(read) if is_length else read
        )
