"""One servo interrupt, in the order of the card.

The world outside has moved during the period before; its new state is read first, and the
outputs computed here act on it during the next one.
"""

from openacr.kernel.axis_cy import axis_setpoints, axis_show, axis_take_written
from openacr.kernel.capture_cy import capture_step
from openacr.kernel.clock_cy import clock_step
from openacr.kernel.drive_cy import drive_step, motion_enable_step
from openacr.kernel.feedback_cy import encoder_step, feedback_step
from openacr.kernel.jog_cy import jog_step
from openacr.kernel.limits_cy import limits_step
from openacr.kernel.master_cy import master_step
from openacr.kernel.servo_cy import servo_step
from openacr.kernel.slow_cy import slow_scan
from openacr.map.numbers import (
    AXI_BASE,
    AXI_ON,
    AXI_STRIDE,
    KRI_AXES,
    KRI_BASE,
    KRI_MASTERS,
    KRI_SLOW_TICKS,
    PLI_BASE,
    PLI_KIND,
    PLI_STRIDE,
    SYSF_BASE,
    SYSF_PERIOD_S,
    SYSI_BASE,
    SYSI_SLOW_PHASE,
)
from openacr.views import F32, F64, I32

__all__ = ["tick"]

MODELLED = 16


def tick(F: F64, I: I32, S: F32) -> None:
    """Everything the card does in one servo period."""
    period_s: float = F[SYSF_BASE + SYSF_PERIOD_S]
    axes: int = I[KRI_BASE + KRI_AXES]
    masters: int = I[KRI_BASE + KRI_MASTERS]
    for e in range(MODELLED):
        if I[PLI_BASE + e * PLI_STRIDE + PLI_KIND]:
            encoder_step(F, I, e, period_s)
    for n in range(axes):
        written: bool = axis_take_written(F, I, n)
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
            feedback_step(F, I, S, n, written, period_s)
    capture_step(F, I)
    clock_step(F, I, period_s)
    motion_enable_step(I, axes)
    for n in range(axes):
        drive_step(I, n, period_s)
        limits_step(F, I, S, n)
    for m in range(masters):
        master_step(F, I, S, m, period_s)
    for n in range(axes):
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
            jog_step(F, I, S, n, period_s)
            axis_setpoints(F, S, n, period_s)
            servo_step(F, I, S, n, period_s)
            axis_show(F, I, n)
    slow: int = I[SYSI_BASE + SYSI_SLOW_PHASE] + 1
    if slow >= I[KRI_BASE + KRI_SLOW_TICKS]:
        slow = 0
        slow_scan(F, I, S, axes, masters)
    I[SYSI_BASE + SYSI_SLOW_PHASE] = slow
