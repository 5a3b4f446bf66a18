"""Per axis: the words of an axis, resets of its registers, and the setpoint sums.

    primary setpoint   = coordinated (with INVK: joint) + gear + jog + cam
    secondary setpoint = primary + ballscrew + backlash

All parts are float64 pulses inside; the LONG parameters show them rounded. A shown value
that differs from what was last shown has been written by somebody and replaces the part.
"""

from openacr.cmath import fabs
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.numbers import (
    AF1_WORD,
    AF1_WORD_HIGH,
    AF5_NEGATIVE_HARDWARE_LIMIT_ENABLE,
    AF5_NEGATIVE_LIMIT_INPUT,
    AF5_NEGATIVE_SOFTWARE_LIMIT_ENABLE,
    AF5_POSITIVE_HARDWARE_LIMIT_ENABLE,
    AF5_POSITIVE_LIMIT_INPUT,
    AF5_POSITIVE_SOFTWARE_LIMIT_ENABLE,
    AF5_WORD,
    AX_ACCELERATION,
    AX_ACTUAL_POSITION,
    AX_BACKLASH_OFFSET,
    AX_BALLSCREW_OFFSET,
    AX_BASE,
    AX_CAM_OFFSET,
    AX_COUNT,
    AX_CURRENT_POSITION,
    AX_GEAR_OFFSET,
    AX_JOG_OFFSET,
    AX_PPU,
    AX_PRIMARY_SETPOINT,
    AX_SECONDARY_SETPOINT,
    AX_STRIDE,
    AX_TARGET_POSITION,
    AX_VELOCITY,
    AXF_BACKLASH_CNT,
    AXF_BALLSCREW_CNT,
    AXF_BASE,
    AXF_CAM_CNT,
    AXF_CAM_SMOOTHING_CPS,
    AXF_ERROR_OLD_CNT,
    AXF_GEAR_CNT,
    AXF_JOG_CNT,
    AXF_JOG_ORIGIN_CNT,
    AXF_KINEMATICS_CNT,
    AXF_PEAK_VELOCITY_CPS,
    AXF_POSITION_CNT,
    AXF_PSP_CNT,
    AXF_PSP_VELOCITY_CPS,
    AXF_SLM_MINUS_U,
    AXF_SLM_PLUS_U,
    AXF_SSP_ACCEL_CPS2,
    AXF_SSP_CNT,
    AXF_SSP_OLD_CNT,
    AXF_SSP_VELOCITY_CPS,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    AXF_TRAVEL_CNT,
    AXI_BASE,
    AXI_JOG_REPLAN,
    AXI_MASTER,
    AXI_SHOWN_ACTUAL,
    AXI_SHOWN_BALLSCREW,
    AXI_SHOWN_CAM,
    AXI_SHOWN_CURRENT,
    AXI_SHOWN_GEAR,
    AXI_SHOWN_JOG,
    AXI_SHOWN_TARGET,
    AXI_SLAVE,
    AXI_STRIDE,
    FOF_BASE,
    FOF_LOCK_OLD_CNT,
    FOF_STRIDE,
    FOI_BASE,
    FOI_LEADER,
    FOI_STRIDE,
    KRI_BASE,
    KRI_KINEMATICS,
    MSF_BASE,
    MSF_STRIDE,
    MSF_TARGET_CNT,
    TBI_BASE,
    TBI_RUNNING,
    TBI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = [
    "axis_jog_set",
    "axis_preload",
    "axis_renew",
    "axis_settled",
    "axis_show",
    "axis_take_written",
    "axis_target_changed",
    "limit_bars",
]

NOT_BARRED = 0
HARD_BARRED = 1
SOFT_BARRED = 2
ROUNDING_CNT = 1e-6  # of sums of offsets and points of curves; far below one pulse


def axis_word(n: int) -> int:
    """Parameter number of the flag word of axis n."""
    return AF1_WORD + n if n < 8 else AF1_WORD_HIGH + n


def axis_scale(S: F32, n: int) -> float:
    """Pulses per unit of axis n with its sign; a 0, infinity or NaN written counts as 1."""
    ppu: float = S[AX_BASE + n * AX_STRIDE + AX_PPU]
    return ppu if ppu != 0.0 and ppu - ppu == 0.0 else 1.0


def axis_sense(S: F32, n: int) -> int:
    """+1 or -1: the direction of pulses in which the units of axis n count up."""
    return -1 if axis_scale(S, n) < 0.0 else 1


def limit_bars(F: F64, I: I32, S: F32, n: int, side: int) -> int:
    """Which limit bars axis n on `side` (+1 or -1) now: hard, soft or none.

    A hard limit bars while its switch is active, a soft one while the setpoint is beyond it,
    each where it is enabled. The "encountered" flags are records of the past and bar nothing.
    """
    if hard_limit_active(I[AF5_WORD + n], side):
        return HARD_BARRED
    if soft_limit_crossed(F, S, n, I[AF5_WORD + n], side):
        return SOFT_BARRED
    return NOT_BARRED


def hard_limit_active(flags: int, side: int) -> bool:
    """Whether the hardware limit of a side is enabled and its switch active."""
    if side > 0:
        return (
            flags & AF5_POSITIVE_HARDWARE_LIMIT_ENABLE != 0
            and flags & AF5_POSITIVE_LIMIT_INPUT != 0
        )
    return flags & AF5_NEGATIVE_HARDWARE_LIMIT_ENABLE != 0 and flags & AF5_NEGATIVE_LIMIT_INPUT != 0


def soft_limit_crossed(F: F64, S: F32, n: int, flags: int, side: int) -> bool:
    """Whether the software limit of a side is enabled and the primary setpoint beyond it.

    The limit is compared in pulses, formed as the target of a move is: a move that ends
    exactly on it does not cross it.
    """
    a: int = AXF_BASE + n * AXF_STRIDE
    limit_u: float = F[a + AXF_SLM_PLUS_U]
    enabled: int = flags & AF5_POSITIVE_SOFTWARE_LIMIT_ENABLE
    if side < 0:
        limit_u = F[a + AXF_SLM_MINUS_U]
        enabled = flags & AF5_NEGATIVE_SOFTWARE_LIMIT_ENABLE
    if enabled == 0:
        return False
    beyond_cnt: float = F[a + AXF_PSP_CNT] - limit_u * axis_scale(S, n)
    return side * axis_sense(S, n) * beyond_cnt > ROUNDING_CNT


def axis_sum(F: F64, n: int) -> None:
    """Form primary and secondary setpoint from their parts."""
    a: int = AXF_BASE + n * AXF_STRIDE
    psp: float = (
        (F[a + AXF_POSITION_CNT] + F[a + AXF_KINEMATICS_CNT])
        + F[a + AXF_GEAR_CNT]
        + F[a + AXF_JOG_CNT]
        + F[a + AXF_CAM_CNT]
    )
    F[a + AXF_PSP_CNT] = psp
    F[a + AXF_SSP_CNT] = psp + F[a + AXF_BALLSCREW_CNT] + F[a + AXF_BACKLASH_CNT]


def axis_offsets(F: F64, n: int) -> float:
    """What the secondary setpoint is beyond the coordinated position."""
    a: int = AXF_BASE + n * AXF_STRIDE
    return (
        F[a + AXF_KINEMATICS_CNT]
        + F[a + AXF_GEAR_CNT]
        + F[a + AXF_JOG_CNT]
        + F[a + AXF_CAM_CNT]
        + F[a + AXF_BALLSCREW_CNT]
        + F[a + AXF_BACKLASH_CNT]
    )


def axis_jog_set(F: F64, I: I32, n: int, offset_cnt: float) -> None:
    """Replace the jog offset of axis n; a jog under way goes on from there."""
    a: int = AXF_BASE + n * AXF_STRIDE
    F[a + AXF_JOG_ORIGIN_CNT] += offset_cnt - F[a + AXF_JOG_CNT]
    F[a + AXF_JOG_CNT] = offset_cnt
    I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_REPLAN] = 1


def axis_setpoints(F: F64, S: F32, n: int, rate_hz: float) -> bool:
    """Setpoint sums of this tick and their differences; True if the primary one has moved."""
    a: int = AXF_BASE + n * AXF_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    psp_old: float = F[a + AXF_PSP_CNT]
    F[a + AXF_SSP_OLD_CNT] = F[a + AXF_SSP_CNT]
    axis_sum(F, n)
    moved: float = F[a + AXF_PSP_CNT] - psp_old
    velocity: float = moved * rate_hz
    S[p + AX_VELOCITY] = velocity
    S[p + AX_ACCELERATION] = (velocity - F[a + AXF_PSP_VELOCITY_CPS]) * rate_hz
    F[a + AXF_PSP_VELOCITY_CPS] = velocity
    velocity = (F[a + AXF_SSP_CNT] - F[a + AXF_SSP_OLD_CNT]) * rate_hz
    velocity += F[a + AXF_CAM_SMOOTHING_CPS]
    F[a + AXF_SSP_ACCEL_CPS2] = (velocity - F[a + AXF_SSP_VELOCITY_CPS]) * rate_hz
    F[a + AXF_SSP_VELOCITY_CPS] = velocity
    F[a + AXF_TRAVEL_CNT] += fabs(moved)
    F[a + AXF_PEAK_VELOCITY_CPS] = max(
        F[a + AXF_PEAK_VELOCITY_CPS], fabs(F[a + AXF_PSP_VELOCITY_CPS])
    )
    return moved != 0.0


def axis_settled(F: F64, I: I32, n: int) -> None:
    """After a jump of the registers: no velocity, no old setpoint, target = current, all shown."""
    a: int = AXF_BASE + n * AXF_STRIDE
    axis_sum(F, n)
    F[a + AXF_SSP_OLD_CNT] = F[a + AXF_SSP_CNT]
    F[a + AXF_PSP_VELOCITY_CPS] = 0.0
    F[a + AXF_SSP_VELOCITY_CPS] = 0.0
    F[a + AXF_SSP_ACCEL_CPS2] = 0.0
    F[a + AXF_TARGET_CNT] = F[a + AXF_POSITION_CNT]
    for other in range(AX_COUNT):  # axes locked to this one do not follow the jump
        if I[FOI_BASE + other * FOI_STRIDE + FOI_LEADER] == n + 1:
            F[FOF_BASE + other * FOF_STRIDE + FOF_LOCK_OLD_CNT] = F[a + AXF_PSP_CNT]
    i: int = AXI_BASE + n * AXI_STRIDE
    m: int = I[i + AXI_MASTER]
    if m >= 0:
        F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + I[i + AXI_SLAVE]] = F[a + AXF_POSITION_CNT]
    axis_show(F, I, n)


def axis_preload(F: F64, I: I32, n: int, position_cnt: float) -> None:
    """RES: the axis stands at `position_cnt` and all offsets are 0 (the encoder is set apart)."""
    a: int = AXF_BASE + n * AXF_STRIDE
    F[a + AXF_POSITION_CNT] = position_cnt
    F[a + AXF_KINEMATICS_CNT] = 0.0
    F[a + AXF_GEAR_CNT] = 0.0
    F[a + AXF_CAM_CNT] = 0.0
    F[a + AXF_BALLSCREW_CNT] = 0.0
    F[a + AXF_BACKLASH_CNT] = 0.0
    I[TBI_BASE + (AX_COUNT + n) * TBI_STRIDE + TBI_RUNNING] = 0  # look up the ballscrew anew
    axis_jog_set(F, I, n, 0.0)
    F[a + AXF_ERROR_OLD_CNT] = 0.0
    axis_settled(F, I, n)


def axis_renew(F: F64, I: I32, n: int) -> None:
    """REN: take the actual position as setpoint, so that the following error is 0."""
    a: int = AXF_BASE + n * AXF_STRIDE
    actual: float = I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
    psp: float = actual - F[a + AXF_BALLSCREW_CNT] - F[a + AXF_BACKLASH_CNT]
    psp -= F[a + AXF_KINEMATICS_CNT]
    F[a + AXF_POSITION_CNT] = psp - F[a + AXF_GEAR_CNT] - F[a + AXF_JOG_CNT] - F[a + AXF_CAM_CNT]
    F[a + AXF_ERROR_OLD_CNT] = 0.0
    axis_settled(F, I, n)


def axis_target(F: F64, I: I32, n: int) -> float:
    """Where the last move that axis n has been given ends [pulses]; at rest where it is."""
    i: int = AXI_BASE + n * AXI_STRIDE
    m: int = I[i + AXI_MASTER]
    if m < 0:
        return F[AXF_BASE + n * AXF_STRIDE + AXF_TARGET_CNT]
    return F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + I[i + AXI_SLAVE]]


def axis_show(F: F64, I: I32, n: int) -> None:
    """Show the positions of axis n in its LONG parameters."""
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    shown: int = round32(F[a + AXF_POSITION_CNT])
    I[p + AX_CURRENT_POSITION] = shown
    I[i + AXI_SHOWN_CURRENT] = shown
    shown = round32(axis_target(F, I, n))
    I[p + AX_TARGET_POSITION] = shown
    I[i + AXI_SHOWN_TARGET] = shown
    shown = round32(F[a + AXF_GEAR_CNT])
    I[p + AX_GEAR_OFFSET] = shown
    I[i + AXI_SHOWN_GEAR] = shown
    shown = round32(F[a + AXF_JOG_CNT])
    I[p + AX_JOG_OFFSET] = shown
    I[i + AXI_SHOWN_JOG] = shown
    shown = round32(F[a + AXF_CAM_CNT])
    I[p + AX_CAM_OFFSET] = shown
    I[i + AXI_SHOWN_CAM] = shown
    shown = round32(F[a + AXF_BALLSCREW_CNT])
    I[p + AX_BALLSCREW_OFFSET] = shown
    I[i + AXI_SHOWN_BALLSCREW] = shown
    I[p + AX_BACKLASH_OFFSET] = round32(F[a + AXF_BACKLASH_CNT])
    I[p + AX_PRIMARY_SETPOINT] = round32(F[a + AXF_PSP_CNT])
    I[p + AX_SECONDARY_SETPOINT] = round32(F[a + AXF_SSP_CNT])


def axis_take_written(F: F64, I: I32, n: int) -> bool:
    """Take over what was written into the shown positions; True if the actual one was.

    The encoder itself belongs to the feedback step, which sets it to a written actual
    position.
    """
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    joint: float = F[a + AXF_POSITION_CNT] + F[a + AXF_KINEMATICS_CNT]
    if I[p + AX_CURRENT_POSITION] != I[i + AXI_SHOWN_CURRENT]:
        F[a + AXF_POSITION_CNT] = I[p + AX_CURRENT_POSITION]
        F[a + AXF_TARGET_CNT] = F[a + AXF_POSITION_CNT]
        axis_keep_joint(F, I, n, joint)
        axis_target_changed(F, I, n)
    elif I[p + AX_TARGET_POSITION] != I[i + AXI_SHOWN_TARGET]:
        F[a + AXF_TARGET_CNT] = I[p + AX_TARGET_POSITION]
        F[a + AXF_POSITION_CNT] = F[a + AXF_TARGET_CNT]
        axis_keep_joint(F, I, n, joint)
        axis_target_changed(F, I, n)
    if I[p + AX_GEAR_OFFSET] != I[i + AXI_SHOWN_GEAR]:
        F[a + AXF_GEAR_CNT] = I[p + AX_GEAR_OFFSET]
    if I[p + AX_JOG_OFFSET] != I[i + AXI_SHOWN_JOG]:
        axis_jog_set(F, I, n, I[p + AX_JOG_OFFSET])
    if I[p + AX_CAM_OFFSET] != I[i + AXI_SHOWN_CAM]:
        F[a + AXF_CAM_CNT] = I[p + AX_CAM_OFFSET]
    if I[p + AX_BALLSCREW_OFFSET] != I[i + AXI_SHOWN_BALLSCREW]:
        F[a + AXF_BALLSCREW_CNT] = I[p + AX_BALLSCREW_OFFSET]
    return wrap32(I[p + AX_ACTUAL_POSITION]) != I[i + AXI_SHOWN_ACTUAL]


def axis_keep_joint(F: F64, I: I32, n: int, joint_cnt: float) -> None:
    """With INVK a written position says where the tool is; the joint stays."""
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if m >= 0 and I[KRI_BASE + KRI_KINEMATICS] & (1 << m):
        a: int = AXF_BASE + n * AXF_STRIDE
        F[a + AXF_KINEMATICS_CNT] = joint_cnt - F[a + AXF_POSITION_CNT]


def axis_target_changed(F: F64, I: I32, n: int) -> None:
    """Tell the master of axis n where the next incremental move starts."""
    i: int = AXI_BASE + n * AXI_STRIDE
    m: int = I[i + AXI_MASTER]
    if m >= 0:
        F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + I[i + AXI_SLAVE]] = F[
            AXF_BASE + n * AXF_STRIDE + AXF_POSITION_CNT
        ]
