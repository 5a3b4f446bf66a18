"""Blank of a part program: the box of material that the cutting sizes of the store describe."""

from collections.abc import Sequence
from contextlib import suppress

from openacr.cnc.canonical import Arc, Line, Polyline
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import axes_of
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.mill.plan.pictures.stock import Blank
from openacr.sysvar import Store
from openacr.sysvar.tabs import CONTROL

SIZES = (CONTROL.x_axis_cutting_size, CONTROL.y_axis_cutting_size, CONTROL.z_axis_cutting_size)
LEAST = 1e-6  # thickness of a blank


def has_sizes(cells: Store) -> bool:
    """Whether the store has a size of the blank."""
    return any(_sizes(cells))


def blank_of(cells: Store, low: Sequence[float], high: Sequence[float], zero: float) -> Blank:
    """The blank around a box of cuts: as large as its sizes in the store, else as that box.

    Along X and Y its middle is that of the box. Its top is `zero`, the height of program Z0, or
    Z0 is its bottom if all cuts are above.
    """
    given, low, high = _sizes(cells), list(low), list(high)
    for k in (0, 1):
        half = 0.5 * (given[k] or max(high[k] - low[k], LEAST))
        middle = 0.5 * (low[k] + high[k])
        low[k], high[k] = middle - half, middle + half
    if low[2] < zero:
        low[2], high[2] = (zero - given[2] if given[2] else low[2]), zero
    else:
        high[2] = zero + given[2] if given[2] else max(high[2], zero + LEAST)
        low[2] = zero
    return Blank((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def heights_of_zero(program: Program, cells: Store, dialect: str) -> tuple[float, float]:
    """Height of program Z0 at the first cut, of the tip and of the spindle, machine coordinates.

    They differ by the length of the tool. A program that cuts nothing has those of its end.
    """
    options = Options(collects_errors=True)
    run = Interpreter(program, Shadow(cells), VirtualMachine(is_probed=True), dialect, options)
    run.path.refresh()
    with suppress(BlockError):  # what comes before an error is shown
        for entry in run.entries():
            if isinstance(entry, (Line, Arc, Polyline)):
                break
    z = axes_of(cells)["Z"]
    spindle = run.path.coordinates.to_machine((0.0,) * 8)[z]
    return spindle - run.path.coordinates.offsets(run.modal)[z], spindle


def _sizes(cells: Store) -> list[float]:
    """The sizes in the store; 0 for those it does not have."""
    return [cells.read(cell) if cells.is_set(cell) else 0.0 for cell in SIZES]
