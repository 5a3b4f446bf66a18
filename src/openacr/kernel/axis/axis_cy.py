"""Per axis: the words of an axis, resets of its registers, and the setpoint sums.

    primary setpoint   = coordinated (with INVK: joint) + gear + jog + cam
    secondary setpoint = primary + ballscrew + backlash

All parts are float64 pulses inside; the LONG parameters show them rounded. A shown value
that differs from what was last shown was written by a program or host and replaces the part.
"""

from openacr.cmath import fabs
from openacr.kernel.words_cy import round32
from openacr.map.rows import axes, followers, kernel, masters, tables
from openacr.map.words import af5
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
LIMITS_ENABLED = (
    af5.POSITIVE_HARDWARE_LIMIT_ENABLE
    | af5.NEGATIVE_HARDWARE_LIMIT_ENABLE
    | af5.POSITIVE_SOFTWARE_LIMIT_ENABLE
    | af5.NEGATIVE_SOFTWARE_LIMIT_ENABLE
)
BEYOND_FP32 = 3.5e38  # more than any 32-bit number but infinity
ROUNDING_CNT = 1e-6  # of sums of offsets and points of curves; far below one pulse


def axis_scale(S: F32, n: int) -> float:
    """Pulses per unit of axis n with its sign; a 0, infinity or NaN written counts as 1."""
    ppu: float = S[axes.ppu[n]]
    return ppu if 0.0 < fabs(ppu) < BEYOND_FP32 else 1.0


def axis_sense(S: F32, n: int) -> int:
    """+1 or -1: the direction of pulses in which the units of axis n count up."""
    return -1 if axis_scale(S, n) < 0.0 else 1


def limit_bars(F: F64, I: I32, S: F32, n: int, side: int) -> int:
    """Which limit bars axis n on `side` (+1 or -1) now: hard, soft or none.

    A hard limit bars while its switch is active, a soft one while the setpoint is beyond it,
    each where it is enabled. The "encountered" flags are records of the past and bar nothing.
    """
    if hard_limit_active(I[af5.word[n]], side):
        return HARD_BARRED
    if soft_limit_crossed(F, S, n, I[af5.word[n]], side):
        return SOFT_BARRED
    return NOT_BARRED


def hard_limit_active(flags: int, side: int) -> bool:
    """Whether the hardware limit of a side is enabled and its switch active."""
    if side > 0:
        return (
            flags & af5.POSITIVE_HARDWARE_LIMIT_ENABLE != 0
            and flags & af5.POSITIVE_LIMIT_INPUT != 0
        )
    return flags & af5.NEGATIVE_HARDWARE_LIMIT_ENABLE != 0 and flags & af5.NEGATIVE_LIMIT_INPUT != 0


def soft_limit_crossed(F: F64, S: F32, n: int, flags: int, side: int) -> bool:
    """Whether the software limit of a side is enabled and the primary setpoint beyond it.

    The limit is compared in pulses, formed as the target of a move is: a move that ends
    exactly on it does not cross it.
    """
    limit_u: float = F[axes.slm_plus_u[n]]
    enabled: int = flags & af5.POSITIVE_SOFTWARE_LIMIT_ENABLE
    if side < 0:
        limit_u = F[axes.slm_minus_u[n]]
        enabled = flags & af5.NEGATIVE_SOFTWARE_LIMIT_ENABLE
    if enabled == 0:
        return False
    beyond_cnt: float = F[axes.psp_cnt[n]] - limit_u * axis_scale(S, n)
    return side * axis_sense(S, n) * beyond_cnt > ROUNDING_CNT


def axis_primary(F: F64, n: int) -> float:
    """Primary setpoint of axis n from its parts."""
    return (
        (F[axes.position_cnt[n]] + F[axes.kinematics_cnt[n]])
        + F[axes.gear_cnt[n]]
        + F[axes.jog_cnt[n]]
        + F[axes.cam_cnt[n]]
    )


def axis_secondary(F: F64, n: int, psp_cnt: float) -> float:
    """Secondary setpoint of axis n from the primary one."""
    return psp_cnt + F[axes.ballscrew_cnt[n]] + F[axes.backlash_cnt[n]]


def axis_sum(F: F64, n: int) -> None:
    """Form primary and secondary setpoint from their parts."""
    psp_cnt: float = axis_primary(F, n)
    F[axes.psp_cnt[n]] = psp_cnt
    F[axes.ssp_cnt[n]] = axis_secondary(F, n, psp_cnt)


def axis_offsets(F: F64, n: int) -> float:
    """What the secondary setpoint is beyond the coordinated position."""
    return (
        F[axes.kinematics_cnt[n]]
        + F[axes.gear_cnt[n]]
        + F[axes.jog_cnt[n]]
        + F[axes.cam_cnt[n]]
        + F[axes.ballscrew_cnt[n]]
        + F[axes.backlash_cnt[n]]
    )


def axis_jog_set(F: F64, I: I32, n: int, offset_cnt: float) -> None:
    """Replace the jog offset of axis n; a jog under way continues from there."""
    F[axes.jog_origin_cnt[n]] += offset_cnt - F[axes.jog_cnt[n]]
    F[axes.jog_cnt[n]] = offset_cnt
    I[axes.jog_replan[n]] = 1


def axis_setpoints(F: F64, S: F32, n: int, rate_hz: float) -> bool:
    """Setpoint sums of this tick and their differences; True if the primary one has moved."""
    psp_cnt: float = axis_primary(F, n)
    ssp_cnt: float = axis_secondary(F, n, psp_cnt)
    ssp_old_cnt: float = F[axes.ssp_cnt[n]]
    moved_cnt: float = psp_cnt - F[axes.psp_cnt[n]]
    F[axes.psp_cnt[n]] = psp_cnt
    F[axes.ssp_cnt[n]] = ssp_cnt
    F[axes.ssp_old_cnt[n]] = ssp_old_cnt
    velocity_cps: float = moved_cnt * rate_hz
    S[axes.velocity[n]] = velocity_cps
    S[axes.acceleration[n]] = (velocity_cps - F[axes.psp_velocity_cps[n]]) * rate_hz
    F[axes.psp_velocity_cps[n]] = velocity_cps
    F[axes.travel_cnt[n]] += fabs(moved_cnt)
    F[axes.peak_velocity_cps[n]] = max(F[axes.peak_velocity_cps[n]], fabs(velocity_cps))
    velocity_cps = (ssp_cnt - ssp_old_cnt) * rate_hz
    velocity_cps += F[axes.cam_smoothing_cps[n]]
    F[axes.ssp_accel_cps2[n]] = (velocity_cps - F[axes.ssp_velocity_cps[n]]) * rate_hz
    F[axes.ssp_velocity_cps[n]] = velocity_cps
    return moved_cnt != 0.0


def axis_settled(F: F64, I: I32, n: int) -> None:
    """After a jump of the registers: no velocity, no old setpoint, target = current, all shown."""
    axis_sum(F, n)
    F[axes.ssp_old_cnt[n]] = F[axes.ssp_cnt[n]]
    F[axes.psp_velocity_cps[n]] = 0.0
    F[axes.ssp_velocity_cps[n]] = 0.0
    F[axes.ssp_accel_cps2[n]] = 0.0
    F[axes.target_cnt[n]] = F[axes.position_cnt[n]]
    F[followers.backlash_old_cnt[n]] = F[axes.psp_cnt[n]]  # a jump is no travel
    for other in range(axes.COUNT):  # axes locked to this one do not follow the jump
        if I[followers.leader[other]] == n + 1:
            F[followers.lock_old_cnt[other]] = F[axes.psp_cnt[n]]
    m: int = I[axes.master[n]]
    if m >= 0:
        F[masters.target_cnt[m] + I[axes.slave[n]]] = F[axes.position_cnt[n]]
    axis_show(F, I, n)


def axis_preload(F: F64, I: I32, n: int, position_cnt: float) -> None:
    """RES: the axis stands at `position_cnt` and all offsets are 0 (the encoder is set apart)."""
    F[axes.position_cnt[n]] = position_cnt
    F[axes.kinematics_cnt[n]] = 0.0
    F[axes.gear_cnt[n]] = 0.0
    F[axes.cam_cnt[n]] = 0.0
    F[axes.ballscrew_cnt[n]] = 0.0
    F[axes.backlash_cnt[n]] = 0.0
    F[followers.backlash_wanted_cnt[n]] = 0.0
    I[tables.running[axes.COUNT + n]] = 0  # look up the ballscrew anew
    axis_jog_set(F, I, n, 0.0)
    F[axes.error_old_cnt[n]] = 0.0
    axis_settled(F, I, n)


def axis_renew(F: F64, I: I32, n: int) -> None:
    """REN: take the actual position as setpoint, so that the following error is 0."""
    actual_cnt: float = I[axes.actual_position[n]]
    psp_cnt: float = actual_cnt - F[axes.ballscrew_cnt[n]] - F[axes.backlash_cnt[n]]
    psp_cnt -= F[axes.kinematics_cnt[n]]
    F[axes.position_cnt[n]] = (
        psp_cnt - F[axes.gear_cnt[n]] - F[axes.jog_cnt[n]] - F[axes.cam_cnt[n]]
    )
    F[axes.error_old_cnt[n]] = 0.0
    axis_settled(F, I, n)


def axis_target(F: F64, I: I32, n: int) -> float:
    """Where the last move that axis n has been given ends [pulses]; at rest where it is."""
    m: int = I[axes.master[n]]
    if m < 0:
        return F[axes.target_cnt[n]]
    return F[masters.target_cnt[m] + I[axes.slave[n]]]


def axis_show(F: F64, I: I32, n: int) -> None:
    """Show the positions of axis n in its LONG parameters."""
    shown: int = round32(F[axes.position_cnt[n]])
    I[axes.current_position[n]] = shown
    I[axes.shown_current[n]] = shown
    shown = round32(axis_target(F, I, n))
    I[axes.target_position[n]] = shown
    I[axes.shown_target[n]] = shown
    shown = round32(F[axes.gear_cnt[n]])
    I[axes.gear_offset[n]] = shown
    I[axes.shown_gear[n]] = shown
    shown = round32(F[axes.jog_cnt[n]])
    I[axes.jog_offset[n]] = shown
    I[axes.shown_jog[n]] = shown
    shown = round32(F[axes.cam_cnt[n]])
    I[axes.cam_offset[n]] = shown
    I[axes.shown_cam[n]] = shown
    shown = round32(F[axes.ballscrew_cnt[n]])
    I[axes.ballscrew_offset[n]] = shown
    I[axes.shown_ballscrew[n]] = shown
    I[axes.backlash_offset[n]] = round32(F[axes.backlash_cnt[n]])
    I[axes.primary_setpoint[n]] = round32(F[axes.psp_cnt[n]])
    I[axes.secondary_setpoint[n]] = round32(F[axes.ssp_cnt[n]])


def axis_take_written(F: F64, I: I32, n: int) -> None:
    """Take over what was written into the shown positions.

    The actual one belongs to the feedback step, which sets the encoder to what was written.
    """
    joint_cnt: float = F[axes.position_cnt[n]] + F[axes.kinematics_cnt[n]]
    if I[axes.current_position[n]] != I[axes.shown_current[n]]:
        F[axes.position_cnt[n]] = I[axes.current_position[n]]
        F[axes.target_cnt[n]] = F[axes.position_cnt[n]]
        axis_keep_joint(F, I, n, joint_cnt)
        axis_target_changed(F, I, n)
    elif I[axes.target_position[n]] != I[axes.shown_target[n]]:
        F[axes.target_cnt[n]] = I[axes.target_position[n]]
        F[axes.position_cnt[n]] = F[axes.target_cnt[n]]
        axis_keep_joint(F, I, n, joint_cnt)
        axis_target_changed(F, I, n)
    if I[axes.gear_offset[n]] != I[axes.shown_gear[n]]:
        F[axes.gear_cnt[n]] = I[axes.gear_offset[n]]
    if I[axes.jog_offset[n]] != I[axes.shown_jog[n]]:
        axis_jog_set(F, I, n, I[axes.jog_offset[n]])
    if I[axes.cam_offset[n]] != I[axes.shown_cam[n]]:
        F[axes.cam_cnt[n]] = I[axes.cam_offset[n]]
    if I[axes.ballscrew_offset[n]] != I[axes.shown_ballscrew[n]]:
        F[axes.ballscrew_cnt[n]] = I[axes.ballscrew_offset[n]]


def axis_keep_joint(F: F64, I: I32, n: int, joint_cnt: float) -> None:
    """With INVK a written position says where the tool is; the joint stays."""
    m: int = I[axes.master[n]]
    if m >= 0 and I[kernel.kinematics] & (1 << m):
        F[axes.kinematics_cnt[n]] = joint_cnt - F[axes.position_cnt[n]]


def axis_target_changed(F: F64, I: I32, n: int) -> None:
    """Tell the master of axis n where the next incremental move starts."""
    m: int = I[axes.master[n]]
    if m >= 0:
        F[masters.target_cnt[m] + I[axes.slave[n]]] = F[axes.position_cnt[n]]
