"""Exact drives: a servo without lag, whatever the gains of the card.

Any voltage at its input takes the motor, within a servo period, to where the axis that closes its
loop with this encoder was commanded in the period before; without voltage it stays. So there is a
following error of one period of travel in motion, and none at rest. Hard stops, a jam and a cut
cable act as on any other motor.
"""

from openacr.cmath import rint
from openacr.map import numbers as at
from openacr.map.rows import axes
from openacr.views import F64, I32

RAW_COUNTS = 4.0  # raw counts per encoder line; MULT selects how many of them count
FROM_ENCODER = 0


def exact_motor(F: F64, I: I32, n: int, ready: int) -> None:
    """Bring motor n to the commanded position of its axis."""
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    mult: int = I[at.ENI_BASE + n * at.ENI_STRIDE + at.ENI_MULT]
    axis: int = _axis_of(I, n)
    if ready == 0 or F[f + at.PLF_VOLTS] == 0.0 or mult == 0 or axis < 0:
        return
    commanded: float = rint(F[at.AXF_BASE + axis * at.AXF_STRIDE + at.AXF_SSP_CNT])
    missing: float = commanded - I[at.AX_BASE + axis * at.AX_STRIDE + at.AX_ACTUAL_POSITION]
    F[f + at.PLF_POSITION_CNT] += missing * RAW_COUNTS / mult


def _axis_of(I: I32, encoder: int) -> int:
    """The first axis that is on and has this encoder as position feedback, -1 for none."""
    m: int = 0
    for m in range(axes.COUNT):
        i: int = at.AXI_BASE + m * at.AXI_STRIDE
        if I[i + at.AXI_ON] != 0 and I[i + at.AXI_POSITION_INDEX] == encoder:
            if I[i + at.AXI_POSITION_SOURCE] == FROM_ENCODER:
                return m
    return -1
