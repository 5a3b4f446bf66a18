"""One servo interrupt, in the order of the card.

The world outside has moved during the period before; its new state is read first, and the
outputs computed here act on it during the next one.
"""

from openacr.kernel.analog_cy import analog_step
from openacr.kernel.axis_cy import axis_setpoints, axis_show, axis_take_written, axis_word
from openacr.kernel.capture_cy import capture_step
from openacr.kernel.clock_cy import clock_step
from openacr.kernel.drive_cy import drive_step, motion_enable_step
from openacr.kernel.fast_flags_cy import fast_flags_step
from openacr.kernel.fast_status_cy import fast_status_step
from openacr.kernel.feedback_cy import (
    encoder_filters_step,
    encoder_links_step,
    encoder_step,
    feedback_step,
)
from openacr.kernel.jog_cy import jog_step
from openacr.kernel.limits_cy import limits_step
from openacr.kernel.master_cy import master_busy, master_step
from openacr.kernel.modules_cy import missing_inputs_step, missing_outputs_step
from openacr.kernel.object_cy import object_outputs_step, object_sources_step
from openacr.kernel.offset_cy import (
    followers_step,
    followers_used,
    jog_time,
    lock_leader,
    lock_step,
    locks_couple,
    wheel_step,
)
from openacr.kernel.path_cy import master_word
from openacr.kernel.sample_cy import sample_step
from openacr.kernel.servo_cy import servo_step
from openacr.kernel.slow_cy import slow_scan
from openacr.kernel.source_cy import sources_follow, triggers_watch
from openacr.kernel.sync_cy import sync_step
from openacr.map.numbers import (
    AF1_BALLSCREW_ACTIVATE,
    AF1_CAM_ACTIVATE,
    AF1_GEAR_ACTIVE,
    AF1_JOG_ACTIVE,
    AXF_BASE,
    AXF_JOINT_CNT,
    AXF_KINEMATICS_CNT,
    AXF_POSITION_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_MASTER,
    AXI_ON,
    AXI_STRIDE,
    FOI_BASE,
    FOI_LIVE,
    FOI_STRIDE,
    HWI_BASE,
    HWI_ON,
    HWI_STRIDE,
    KRI_AXES,
    KRI_BASE,
    KRI_FILTERED_ENCODERS,
    KRI_KINEMATICS,
    KRI_LINKED_ENCODERS,
    KRI_MASTERS,
    KRI_MISSING_ADCS,
    KRI_MISSING_DACS,
    KRI_MISSING_ENCODERS,
    KRI_MISSING_STEPPERS,
    KRI_SLOW_TICKS,
    KRI_SYNCED,
    MC1_ENABLE_FAST_FLAGS_UPDATE_MODE,
    MF1_IN_MOTION,
    MO_SAMPLE_TRIGGER_ARMED,
    OBI_BASE,
    OBI_LIVE,
    OBI_LOCKED,
    PLGI_ANALOGS,
    PLGI_BASE,
    PLI_BASE,
    PLI_KIND,
    PLI_STRIDE,
    SAI_ARMED_OLD,
    SAI_BASE,
    SYSF_BASE,
    SYSF_PERIOD_S,
    SYSI_BASE,
    SYSI_SLOW_PHASE,
    W_FSTAT,
    W_MISC_CONTROL_1,
    W_MISC_OUTPUTS,
)
from openacr.views import F32, F64, I32

__all__ = ["tick"]

MODELLED = 16
OFFSETS_ACTIVE = AF1_JOG_ACTIVE | AF1_GEAR_ACTIVE | AF1_CAM_ACTIVATE | AF1_BALLSCREW_ACTIVATE


def axis_changing(I: I32, n: int) -> bool:
    """Whether the shown positions of axis n may change although its setpoint rests.

    Parts can cancel each other out; at rest a refresh with every slow scan is enough.
    """
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if I[axis_word(n)] & OFFSETS_ACTIVE or I[SYSI_BASE + SYSI_SLOW_PHASE] == 0:
        return True
    return m >= 0 and I[master_word(m)] & MF1_IN_MOTION != 0


def axis_advance(F: F64, I: I32, S: F32, n: int, period_s: float, rate_hz: float) -> None:
    """Jog and all offsets of axis n, and its setpoint sums."""
    dt: float = period_s
    used: bool = followers_used(I, n) != 0
    if used:
        if I[HWI_BASE + n * HWI_STRIDE + HWI_ON]:
            wheel_step(F, I, S, n)
        if I[FOI_BASE + n * FOI_STRIDE + FOI_LIVE]:
            dt = jog_time(F, I, n, period_s)
    jog_step(F, I, S, n, dt)
    if used:
        followers_step(F, I, S, n, period_s, rate_hz)
    if axis_setpoints(F, S, n, rate_hz) or used or axis_changing(I, n):
        axis_show(F, I, n)


def locked_advance(F: F64, I: I32, S: F32, axes: int, period_s: float, rate_hz: float) -> None:
    """Axes locked to others, behind their leaders."""
    for n in range(axes):
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON] and lock_leader(I, n) >= 0:
            lock_step(F, I, S, n)
            axis_advance(F, I, S, n, period_s, rate_hz)
    locks_couple(F, I, S)


def joints_keep(F: F64, I: I32, axes: int) -> None:
    """INVK: note the joint positions before the masters go on."""
    for n in range(axes):
        a: int = AXF_BASE + n * AXF_STRIDE
        F[a + AXF_JOINT_CNT] = F[a + AXF_POSITION_CNT] + F[a + AXF_KINEMATICS_CNT]


def joints_stay(F: F64, I: I32, axes: int) -> None:
    """INVK: the joints are where the last evaluation has put them, not where the path is."""
    for n in range(axes):
        m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
        if m >= 0 and I[KRI_BASE + KRI_KINEMATICS] & (1 << m):
            a: int = AXF_BASE + n * AXF_STRIDE
            F[a + AXF_KINEMATICS_CNT] = F[a + AXF_JOINT_CNT] - F[a + AXF_POSITION_CNT]


def tick(F: F64, I: I32, S: F32) -> None:
    """Everything the card does in one servo period."""
    period_s: float = F[SYSF_BASE + SYSF_PERIOD_S]
    rate_hz: float = 1.0 / period_s
    axes: int = I[KRI_BASE + KRI_AXES]
    masters: int = I[KRI_BASE + KRI_MASTERS]
    if I[KRI_BASE + KRI_FILTERED_ENCODERS]:
        encoder_filters_step(F, I, period_s)
    for e in range(MODELLED):
        if I[PLI_BASE + e * PLI_STRIDE + PLI_KIND]:
            encoder_step(F, I, e, rate_hz)
    if I[PLGI_BASE + PLGI_ANALOGS]:
        analog_step(F, I, S)
    if (
        I[KRI_BASE + KRI_MISSING_ENCODERS]
        | I[KRI_BASE + KRI_MISSING_ADCS]
        | I[KRI_BASE + KRI_MISSING_STEPPERS]
    ):
        missing_inputs_step(I, S)
    if I[KRI_BASE + KRI_LINKED_ENCODERS]:
        encoder_links_step(I, rate_hz)
    for n in range(axes):
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
            written: bool = axis_take_written(F, I, n)
            feedback_step(F, I, S, n, written, rate_hz)
    for n in range(axes):
        if I[FOI_BASE + n * FOI_STRIDE + FOI_LIVE]:
            triggers_watch(F, I, S, n)
    capture_step(F, I)
    clock_step(F, I, period_s)
    if I[OBI_BASE + OBI_LIVE]:
        object_sources_step(F, I, S, period_s)
    for n in range(axes):
        if I[FOI_BASE + n * FOI_STRIDE + FOI_LIVE]:
            sources_follow(F, I, S, n)
    motion_enable_step(I, axes)
    for n in range(axes):
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
            drive_step(I, n, period_s)
            limits_step(F, I, S, n)
    if I[KRI_BASE + KRI_SYNCED]:
        sync_step(F, I, S, masters)
    if I[KRI_BASE + KRI_KINEMATICS]:
        joints_keep(F, I, axes)
    for m in range(masters):
        if master_busy(I, m):
            master_step(F, I, S, m, period_s)
    if I[KRI_BASE + KRI_KINEMATICS]:
        joints_stay(F, I, axes)
    for n in range(axes):
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON] and lock_leader(I, n) < 0:
            axis_advance(F, I, S, n, period_s, rate_hz)
    if I[OBI_BASE + OBI_LOCKED]:
        locked_advance(F, I, S, axes, period_s, rate_hz)
    for n in range(axes):
        if I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
            servo_step(F, I, S, n, period_s, rate_hz)
    if I[OBI_BASE + OBI_LIVE]:
        object_outputs_step(F, I, S)
    if I[W_MISC_OUTPUTS] & MO_SAMPLE_TRIGGER_ARMED or I[SAI_BASE + SAI_ARMED_OLD]:
        sample_step(F, I, S, period_s)
    if I[W_FSTAT]:
        fast_status_step(F, I, S, period_s)
    if I[KRI_BASE + KRI_MISSING_DACS]:
        missing_outputs_step(I, S)
    if I[W_MISC_CONTROL_1] & MC1_ENABLE_FAST_FLAGS_UPDATE_MODE:
        fast_flags_step(F, I, S, axes)
    slow: int = I[SYSI_BASE + SYSI_SLOW_PHASE] + 1
    if slow >= I[KRI_BASE + KRI_SLOW_TICKS]:
        slow = 0
        slow_scan(F, I, S, axes, masters)
    I[SYSI_BASE + SYSI_SLOW_PHASE] = slow
