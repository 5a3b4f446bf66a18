"""G4, G9 and G61 to G64: dwell, exact stop and how moves join."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import Dwell
from openacr.cnc.codes.fast import Does, Sets
from openacr.cnc.codes.table import Axes, Limit, Step
from openacr.cnc.codes.tables import ACROMILL

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

gcode, sets = ACROMILL.gcode, ACROMILL.sets
SECONDS = Limit("F", 0.1, 999.9, "E240", is_needed=True)


@gcode(4, step=Step.DWELL, takes="F", axes=Axes.BARRED, limits=(SECONDS,), fast=Does.RESTS)
def dwell(run: Run, b: BlockContext) -> None:
    """Rest for F seconds; the feed stays what it was."""
    run.tell(Dwell(b.source, b.words["F"]))


@gcode(9, step=Step.PATH)
def confirm(run: Run, b: BlockContext) -> None:
    """The move of this block ends at rest, in position."""
    b.is_confirmed = True


sets(
    "G61 exact stops, G62 slow at corners, G63 without feed override, G64 without slowing.",
    *(61, 62, 63, 64),
    forms=Sets("path", is_alone=True),
)
