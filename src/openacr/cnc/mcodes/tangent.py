"""M595 to M599: an axis that follows the direction of the path."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes import Step
from openacr.cnc.tables import ACROMILL
from openacr.cnc.tangent import Tangent

if TYPE_CHECKING:
    from openacr.cnc.interpreter import Interpreter
    from openacr.cnc.turn import Turn

mcode = ACROMILL.mcode
OFFSETS_DEG = {595: 0.0, 597: -90.0, 598: 90.0}
ENDS = {596: (595,), 599: (597, 598)}


@mcode(595, 597, 598, step=Step.SWITCHES)
def follow(run: Interpreter, b: Turn) -> None:
    """Axis along the path (M595), right (M597) or left (M598) of it."""
    run.modal.tangent = int(b.number)
    run.path.shape = Tangent(run, OFFSETS_DEG[run.modal.tangent]).shape


@mcode(596, 599, step=Step.SWITCHES)
def release(run: Interpreter, b: Turn) -> None:
    """End of M595 (M596), of M597 and M598 (M599)."""
    if run.modal.tangent in ENDS[int(b.number)]:
        run.modal.tangent = 0
        run.path.shape = None
        run.path.stand(run.path.issued)
