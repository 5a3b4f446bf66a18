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

gcode, sets = ACROMILL.gcode, ACROMILL.sets
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


sets("Words are inches and inches per minute.", 20, 70, forms=Sets("unit", INCH, is_alone=True))
sets(
    "Words are millimetres and millimetres per minute.",
    *(21, 71),
    forms=Sets("unit", METRIC, is_alone=True),
)
sets(
    "G90: axis words are positions; G91: distances from the last position.",
    *(90, 91),
    forms=Sets("distance"),
)
sets("Cycles end at the initial level (G98) or at R (G99).", 98, 99, forms=Sets("return_level"))


@gcode(200, step=Step.CENTRES, group=Group.CENTRES, takes="F", limits=(READING,))
def centres(run: Run, b: BlockContext) -> None:
    """How I, J, K are read: F0 start minus centre, F1 centre minus start, F2 absolute."""
    run.modal.centres = b.whole("F")
