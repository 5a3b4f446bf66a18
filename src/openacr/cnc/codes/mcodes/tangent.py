"""M595 to M599: an axis that follows the direction of the path."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.table import Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.codes.tangent import Tangent

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.block_context import BlockContext

mcode = ACROMILL.mcode
OFFSETS_DEG = {595: 0.0, 597: -90.0, 598: 90.0}
ENDS = {596: (595,), 599: (597, 598)}


@mcode(595, 597, 598, step=Step.SWITCHES)
def follow(run: Run, b: BlockContext) -> None:
    """Axis along the path (M595), right (M597) or left (M598) of it."""
    run.modal.tangent = int(b.number)
    run.path.shape = Tangent(run, OFFSETS_DEG[run.modal.tangent]).shape


@mcode(596, 599, step=Step.SWITCHES)
def release(run: Run, b: BlockContext) -> None:
    """End of M595 (M596), of M597 and M598 (M599)."""
    if run.modal.tangent in ENDS[int(b.number)]:
        run.modal.tangent = 0
        run.path.shape = None
        run.path.stand(run.path.issued)
