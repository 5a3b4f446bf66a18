"""Exact drives: a servo without lag, whatever the gains of the card.

Any voltage at its input takes the motor, within a servo period, to where the axis that closes its
loop with this encoder was commanded in the period before; without voltage it stays. So there is a
following error of one period of travel in motion, and none at rest. Hard stops, a jam and a cut
cable act as on any other motor.
"""

from openacr.cmath import rint
from openacr.map.numbers import (
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_COUNT,
    AX_STRIDE,
    AXF_BASE,
    AXF_SSP_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_ON,
    AXI_POSITION_INDEX,
    AXI_POSITION_SOURCE,
    AXI_STRIDE,
    ENI_BASE,
    ENI_MULT,
    ENI_STRIDE,
    PLF_BASE,
    PLF_POSITION_CNT,
    PLF_STRIDE,
    PLF_VOLTS,
)
from openacr.views import F64, I32

RAW_COUNTS = 4.0  # raw counts per encoder line; MULT selects how many of them count
FROM_ENCODER = 0


def exact_motor(F: F64, I: I32, n: int, ready: int) -> None:
    """Bring motor n to the commanded position of its axis."""
    f: int = PLF_BASE + n * PLF_STRIDE
    mult: int = I[ENI_BASE + n * ENI_STRIDE + ENI_MULT]
    axis: int = _axis_of(I, n)
    if ready == 0 or F[f + PLF_VOLTS] == 0.0 or mult == 0 or axis < 0:
        return
    commanded: float = rint(F[AXF_BASE + axis * AXF_STRIDE + AXF_SSP_CNT])
    missing: float = commanded - I[AX_BASE + axis * AX_STRIDE + AX_ACTUAL_POSITION]
    F[f + PLF_POSITION_CNT] += missing * RAW_COUNTS / mult


def _axis_of(I: I32, encoder: int) -> int:
    """The first axis that is on and has this encoder as position feedback, -1 for none."""
    m: int = 0
    for m in range(AX_COUNT):
        i: int = AXI_BASE + m * AXI_STRIDE
        if I[i + AXI_ON] != 0 and I[i + AXI_POSITION_INDEX] == encoder:
            if I[i + AXI_POSITION_SOURCE] == FROM_ENCODER:
                return m
    return -1
