"""G52 to G59.2 and G92: work systems, local shift, floating zero."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import AXES, ROTARY
from openacr.cnc.codes.fast import Does
from openacr.cnc.codes.table import Axes, Group, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.state.cells import FLOATING, LOCAL
from openacr.sysvar.tabs import CELLS

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
SYSTEMS = {54: 1, 55: 2, 56: 3, 57: 4, 58: 5, 59: 6, 59.1: 7, 59.2: 8, 59.3: 9}
FLOATING_ON, FLOATING_WORD = CELLS.floating_zero_active, CELLS.floating_zero_word[0]
FLOATING_BEFORE, FLOATING_AT = CELLS.floating_zero_before[0], CELLS.floating_zero_position[0]


@gcode(*list(SYSTEMS)[:8], step=Step.WORK, group=Group.WORK, fast=Does.SHIFTS)
def work_system(run: Run, b: BlockContext) -> None:
    """Work system 1 to 8; a local shift ends."""
    select(run, SYSTEMS[b.number])
    run.modal.has_work = True


@gcode(53, step=Step.WORK, group=Group.WORK, fast=Does.SHIFTS)
def machine_system(run: Run, b: BlockContext) -> None:
    """Machine coordinates, until another system is chosen."""
    run.offset_path.refuse(b, "E310")
    select(run, 0)
    run.modal.has_work = False


def select(run: Run, system: int) -> None:
    """Make a system active; the local shift ends."""
    run.modal.work = system
    with run.cells.transaction(is_durable=False):
        for axis in range(AXES):
            run.cells.write(LOCAL + axis, 0.0)
    run.path.refresh()


@gcode(52, step=Step.LOCAL, axes=Axes.DATA)
def local_shift(run: Run, b: BlockContext) -> None:
    """Shift the zero of the active work system."""
    if not run.modal.has_work:
        raise b.fault("E245", hint="after G54 to G59.2 only")
    with run.cells.transaction(is_durable=False):
        for axis, letter, value in b.axes:
            run.cells.write(LOCAL + axis, length_of(run, letter, value))
    run.path.refresh()


def length_of(run: Run, letter: str, value: float) -> float:
    """The value of an axis word in default units."""
    return value if letter in ROTARY else run.path.length(value)


@gcode(92, step=Step.ZERO, axes=Axes.DATA)
def floating_zero(run: Run, b: BlockContext) -> None:
    """The present point reads the words from now on; without words all axes read 0."""
    if run.modal.work == 0:
        raise b.fault("E245", hint="not with G53")
    named = {axis: length_of(run, letter, value) for axis, letter, value in b.axes}
    preset_zero(run, named or dict.fromkeys(run.planner.axes.values(), 0.0))


def preset_zero(run: Run, named: dict[int, float]) -> None:
    """Set the shift so that the present point reads these values."""
    path, write = run.path, run.cells.write
    wanted = list(path.program)
    for axis, value in named.items():
        wanted[axis] = value
    missed = path.coordinates.scaled(tuple(wanted))
    unturned = path.coordinates.unturned(path.placed)
    with run.cells.transaction(is_durable=False):
        for axis, value in named.items():
            before = run.cells.read(FLOATING + axis)
            write(FLOATING_BEFORE + axis, before)
            write(FLOATING_WORD + axis, value)
            write(FLOATING_AT + axis, path.target[axis])
            write(FLOATING + axis, before + unturned[axis] - missed[axis])
        show_zero(run)


def show_zero(run: Run) -> None:
    """P800 says whether a shift is active."""
    shifts = [run.cells.read(FLOATING + axis) for axis in range(AXES)]
    run.cells.write(FLOATING_ON, float(any(shifts)))
    run.path.refresh()


def clear_zero(run: Run) -> None:
    """CLR ZERO: no floating zero."""
    with run.cells.transaction(is_durable=False):
        for axis in range(AXES):
            run.cells.write(FLOATING + axis, 0.0)
        show_zero(run)
