"""G17 to G21, G70, G71, G90, G91, G98, G99, G200: how words are read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.fast import Sets
from openacr.cnc.codes.table import Group, Limit, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.state.modal import INCH, METRIC

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode = ACROMILL.gcode
READING = Limit("F", 0, 2, "E222", is_needed=True, is_whole=True)


@gcode(17, 18, 19, step=Step.PLANE, group=Group.PLANE, fast=Sets("plane", is_barred=True))
def plane(run: Run, b: BlockContext) -> None:
    """The plane of arcs, compensation, rotation and cycles: XY, ZX, YZ."""
    if run.modal.plane == b.number:
        return
    run.offset_path.refuse(b, "E311")
    if run.modal.cycle != 80:
        run.warn(b, "W213")
        run.modal.cycle = 80
    run.modal.plane = int(b.number)


@gcode(20, 70, step=Step.UNIT, group=Group.UNIT, fast=Sets("unit", INCH, is_alone=True))
def inch(run: Run, b: BlockContext) -> None:
    """Words are inches and inches per minute."""
    run.modal.unit = INCH
    run.path.set_unit()


@gcode(21, 71, step=Step.UNIT, group=Group.UNIT, fast=Sets("unit", METRIC, is_alone=True))
def metric(run: Run, b: BlockContext) -> None:
    """Words are millimetres and millimetres per minute."""
    run.modal.unit = METRIC
    run.path.set_unit()


@gcode(90, 91, step=Step.DISTANCE, group=Group.DISTANCE, fast=Sets("distance"))
def distance(run: Run, b: BlockContext) -> None:
    """G90: axis words are positions; G91: distances from the last position."""
    run.modal.distance = int(b.number)


@gcode(98, 99, step=Step.RETURN_LEVEL, group=Group.RETURN_LEVEL, fast=Sets("return_level"))
def return_level(run: Run, b: BlockContext) -> None:
    """Cycles end at the initial level (G98) or at R (G99)."""
    run.modal.return_level = int(b.number)


@gcode(200, step=Step.CENTRES, group=Group.CENTRES, takes="F", limits=(READING,))
def centres(run: Run, b: BlockContext) -> None:
    """How I, J, K are read: F0 start minus centre, F1 centre minus start, F2 absolute."""
    run.modal.centres = b.whole("F")
