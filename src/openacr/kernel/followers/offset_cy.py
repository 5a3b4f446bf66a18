"""What moves or corrects an axis beside its profilers, and the order in which it happens.

Filtered following: the mean of the last n source deltas is added to the gear offset (or to
a parameter), so every delta arrives in n equal parts.

Hand wheel: source counts move the target of the jog profiler, which chases it.

Backlash: while the primary setpoint is positive the offset is +BKL, else 0; the step is
spread evenly over 10 ms. With BKL DIR 1 the direction of travel decides: +BKL from the first
step forward, 0 from the first step back, kept at rest. RES begins at 0.

Lock: the coordinated position of a locked axis follows the primary setpoint of its leader,
unit for unit; the difference of the two following errors drives the outputs together.
"""

from openacr.cmath import fabs, trunc
from openacr.kernel.axis.axis_cy import (
    ROUNDING_CNT,
    axis_primary,
    axis_scale,
    axis_target_changed,
    limit_bars,
)
from openacr.kernel.axis.feedback_cy import FROM_ENCODER
from openacr.kernel.followers.cam_cy import (
    BALLSCREW_TABLES,
    ballscrew_halt,
    ballscrew_step,
    cam_halt,
    cam_step,
)
from openacr.kernel.followers.gear_cy import gear_halt, gear_step
from openacr.kernel.jog.jog_cy import JOG_HOMING, JOG_IDLE, JOG_KILLED, JOG_TO_TARGET
from openacr.kernel.path.hold_cy import NOT_HELD, master_hold
from openacr.kernel.sources.source_cy import (
    FROM_CLOCK,
    LARGEST_DELTA,
    PULSES_PER_S,
    USE_FILTER,
    USE_JOG,
    USE_WHEEL,
    USES,
)
from openacr.kernel.words_cy import wrap32
from openacr.map.kinds_cy import kind_of, store_long
from openacr.map.numbers import KIND_FP32, KIND_FP64, KIND_LONG, USER_BASE
from openacr.map.rows import (
    axes,
    encoders,
    filters,
    followers,
    hand_wheels,
    masters,
    objects,
    sources,
    tables,
)
from openacr.map.words import af1, af2, af3, af4, af6
from openacr.views import F32, F64, I32

__all__ = ["backlash_step", "filter_clear", "filter_halt", "followers_step"]
__inlined__ = ["followers_step"]

BACKLASH_SPREAD_S = 0.01
AXES = 16
ENCODERS = 24
OWN_MOTION = af1.JOG_FORWARD | af1.JOG_REVERSE | af1.GEAR_ACTIVATE | af1.CAM_ACTIVATE


def source_delta(F: F64, n: int, use: int) -> float:
    """What a source of axis n has moved in this tick."""
    return F[sources.delta[n * USES + use]]


# filtered following


def filter_clear(F: F64, I: I32, n: int) -> None:
    """Forget the deltas of the window."""
    for place in range(filters.WINDOW_CNT_SIZE):
        F[filters.window_cnt[n] + place] = 0.0
    F[filters.sum_cnt[n]] = 0.0
    F[filters.carry_cnt[n]] = 0.0
    I[filters.index[n]] = 0


def filter_halt(F: F64, I: I32, n: int) -> None:
    """Stop filtered following."""
    I[filters.on[n]] = 0
    I[af3.word[n]] &= ~af3.FILTER_MOVED
    filter_clear(F, I, n)


def filter_put(F: F64, I: I32, S: F32, n: int, moved_cnt: float) -> None:
    """Add to the parameter of FLT OUT; a LONG one gets whole pulses, the rest is carried."""
    number: int = I[filters.out[n]]
    kind: int = kind_of(I, number)
    if kind == KIND_LONG:
        total_cnt: float = F[filters.carry_cnt[n]] + moved_cnt
        whole_cnt: float = trunc(total_cnt)
        F[filters.carry_cnt[n]] = total_cnt - whole_cnt
        store_long(I, number, wrap32(I[number] + int(whole_cnt)))
    elif kind == KIND_FP32:
        S[number] = S[number] + moved_cnt
    elif kind == KIND_FP64:
        F[USER_BASE + number] += moved_cnt


def filter_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Filtered following of axis n."""
    size: int = max(1, min(I[filters.size[n]], filters.WINDOW_CNT_SIZE))
    place: int = I[filters.index[n]]
    if not 0 <= place < size:
        place = 0
    delta_cnt: float = source_delta(F, n, USE_FILTER)
    F[filters.sum_cnt[n]] += delta_cnt - F[filters.window_cnt[n] + place]
    F[filters.window_cnt[n] + place] = delta_cnt
    I[filters.index[n]] = 0 if place + 1 >= size else place + 1
    mean_cnt: float = F[filters.sum_cnt[n]] / size
    if I[filters.out[n]] >= 0:
        filter_put(F, I, S, n, mean_cnt)
    else:
        F[axes.gear_cnt[n]] += mean_cnt


# hand wheel and time base of jogs


def wheel_barred(F: F64, I: I32, S: F32, n: int, side: int) -> bool:
    """Whether a kill, the lockout or an active limit bars the hand wheel on a side."""
    if I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST or I[af1.word[n]] & af1.JOG_LOCKOUT:
        return True
    return limit_bars(F, I, S, n, side) != 0


def wheel_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Hand wheel of axis n: its counts move the target of the jog profiler."""
    delta_cnt: float = source_delta(F, n, USE_WHEEL)
    mode: int = I[axes.jog_mode[n]]
    if (
        delta_cnt == 0.0
        or F[hand_wheels.ppu[n]] == 0.0
        or (mode != JOG_IDLE and mode != JOG_TO_TARGET)
    ):
        return
    distance_u: float = delta_cnt / F[hand_wheels.ppu[n]] * F[hand_wheels.ratio[n]]
    if distance_u == 0.0 or wheel_barred(F, I, S, n, 1 if distance_u > 0.0 else -1):
        return
    if mode == JOG_IDLE:
        F[axes.jog_target_cnt[n]] = F[axes.jog_cnt[n]]
    F[axes.jog_target_cnt[n]] += distance_u * axis_scale(S, n)
    I[axes.jog_mode[n]] = JOG_TO_TARGET
    I[axes.jog_replan[n]] = 1
    I[af1.word[n]] |= af1.JOG_ACTIVE


def jog_time(F: F64, I: I32, n: int, period_s: float) -> float:
    """Time the jog of axis n advances in this tick: 1000 source pulses are one second.

    A source that runs back holds the jog until it has come forward again. Kills and homing
    go by the clock.
    """
    tap: int = n * USES + USE_JOG
    mode: int = I[axes.jog_mode[n]]
    if I[sources.kind[tap]] == FROM_CLOCK or mode == JOG_KILLED or mode == JOG_HOMING:
        return period_s
    due_s: float = F[followers.jog_debt_s[n]] + source_delta(F, n, USE_JOG) / PULSES_PER_S
    F[followers.jog_debt_s[n]] = min(due_s, 0.0)
    return max(due_s, 0.0)


# backlash


def backlash_wanted(F: F64, I: I32, S: F32, n: int, psp_cnt: float) -> float:
    """The backlash offset that belongs to a primary setpoint."""
    full_cnt: float = S[axes.backlash_setting[n]] * axis_scale(S, n)
    if not fabs(full_cnt) < LARGEST_DELTA:
        full_cnt = 0.0
    if I[axes.backlash_by_direction[n]]:
        moved_cnt: float = psp_cnt - F[followers.backlash_old_cnt[n]]
        if fabs(moved_cnt) <= ROUNDING_CNT:
            return full_cnt if F[followers.backlash_wanted_cnt[n]] != 0.0 else 0.0
        F[followers.backlash_old_cnt[n]] = psp_cnt
        return full_cnt if moved_cnt > 0.0 else 0.0
    return full_cnt if psp_cnt > 0.0 else 0.0


def backlash_used(F: F64, I: I32, n: int) -> bool:
    """Whether axis n has a backlash offset or may get one."""
    if I[axes.backlash_setting[n]] | I[axes.backlash_by_direction[n]]:
        return True
    return F[followers.backlash_wanted_cnt[n]] != 0.0 or F[axes.backlash_cnt[n]] != 0.0


def backlash_step(F: F64, I: I32, S: F32, n: int, psp_cnt: float, dt_s: float) -> None:
    """Bring the backlash offset of axis n to what it should be, a step taking 10 ms."""
    wanted_cnt: float = backlash_wanted(F, I, S, n, psp_cnt)
    offset_cnt: float = F[axes.backlash_cnt[n]]
    if wanted_cnt != F[followers.backlash_wanted_cnt[n]]:
        F[followers.backlash_wanted_cnt[n]] = wanted_cnt
        F[followers.backlash_step_cnt[n]] = fabs(wanted_cnt - offset_cnt) / BACKLASH_SPREAD_S
    if offset_cnt == wanted_cnt:
        return
    step_cnt: float = F[followers.backlash_step_cnt[n]] * dt_s
    left_cnt: float = wanted_cnt - offset_cnt
    if fabs(left_cnt) <= step_cnt * (1.0 + 1e-9):
        F[axes.backlash_cnt[n]] = wanted_cnt
    else:
        F[axes.backlash_cnt[n]] = offset_cnt + (step_cnt if left_cnt > 0.0 else -step_cnt)


# locked pairs


def lock_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Let the locked axis n follow its leader; runs after the setpoints of the leader.

    Flags that would move it on its own are taken back, as commands are refused.
    """
    I[af1.word[n]] &= ~OWN_MOTION
    I[af6.word[n]] &= ~af6.JOG_HOME_REQUEST
    leader: int = I[followers.leader[n]] - 1
    now_cnt: float = F[axes.psp_cnt[leader]]
    moved_cnt: float = now_cnt - F[followers.lock_old_cnt[n]]
    F[followers.lock_old_cnt[n]] = now_cnt
    if moved_cnt != 0.0:
        F[axes.position_cnt[n]] += moved_cnt / axis_scale(S, leader) * axis_scale(S, n)
        F[axes.target_cnt[n]] = F[axes.position_cnt[n]]
        axis_target_changed(F, I, n)


def lock_error(F: F64, I: I32, n: int) -> float:
    """Following error of axis n, unrounded."""
    actual: int = I[axes.actual_position[n]]
    return F[axes.ssp_cnt[n]] - actual


def locks_couple(F: F64, I: I32, S: F32) -> None:
    """Coupling voltages: Lock Feedback Gain of the leader times the difference of errors."""
    for n in range(AXES):
        F[followers.lock_v[n]] = 0.0
    for n in range(AXES):
        leader: int = I[followers.leader[n]] - 1
        if 0 <= leader < AXES and I[axes.on[n]]:
            gain: float = S[axes.lock_feedback_gain[leader]]
            other_cnt: float = lock_error(F, I, n) * axis_scale(S, leader) / axis_scale(S, n)
            volts: float = gain * (lock_error(F, I, leader) - other_cnt)
            F[followers.lock_v[leader]] += volts
            F[followers.lock_v[n]] -= volts


def lock_leader(I: I32, n: int) -> int:
    """The axis that leads axis n, -1 if it is not locked."""
    if not I[objects.locked]:
        return -1
    leader: int = I[followers.leader[n]] - 1
    return leader if 0 <= leader < AXES and leader != n else -1


# directional limits and speed in revolutions


def direction_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Directional limits: motion in a barred direction trips a feedhold of the master."""
    word: int = af2.word[n]
    flags: int = I[word]
    velocity: float = F[axes.psp_velocity_cps[n]] * axis_scale(S, n)
    if flags & af2.DIR_LIMIT_TRIPPED:
        return
    if (velocity > 0.0 and flags & af2.POSITIVE_DIR_LIMIT) or (
        velocity < 0.0 and flags & af2.NEGATIVE_DIR_LIMIT
    ):
        I[word] = flags | af2.DIR_LIMIT_TRIPPED
        m: int = I[axes.master[n]]
        if m >= 0:
            if I[masters.queued[m]] and I[masters.hold[m]] == NOT_HELD:
                master_hold(F, I, S, m)


def rpm_step(F: F64, I: I32, S: F32, n: int) -> None:
    """RPM = RPM Factor * pulses moved in this tick."""
    moved_cnt: float = F[axes.ssp_cnt[n]] - F[axes.ssp_old_cnt[n]]
    k: int = I[axes.position_index[n]]
    if I[axes.position_source[n]] == FROM_ENCODER and 0 <= k < ENCODERS:
        moved_cnt = F[encoders.step_cnt[k]]
    S[axes.rpm[n]] = S[axes.rpm_factor[n]] * moved_cnt


# the order of things


def followers_used(I: I32, n: int) -> int:
    """Not 0 if anything of this module concerns axis n.

    The settings are 32-bit floats; any that is not 0 has bits set.
    """
    if I[followers.live[n]]:
        return 1
    return (
        I[axes.backlash_setting[n]]
        | I[axes.rpm_factor[n]]
        | (I[af2.word[n]] & af2.DIR_LIMIT_ACTIVATE)
    )


def followers_step(F: F64, I: I32, S: F32, n: int, dt_s: float, rate_hz: float) -> None:
    """Gear, filter and cam of axis n, then the offsets that depend on the primary setpoint."""
    if I[axes.backlash_setting[n]]:
        I[followers.live[n]] = 1  # so that a later 0 is noticed
    if I[followers.live[n]]:
        gear_step(F, I, S, n, dt_s)
        cam_step(F, I, S, n, rate_hz)
        if I[filters.on[n]]:
            filter_step(F, I, S, n)
        if backlash_used(F, I, n):
            backlash_step(F, I, S, n, axis_primary(F, n), dt_s)
        if I[af1.word[n]] & af1.BALLSCREW_ACTIVATE or I[tables.running[BALLSCREW_TABLES + n]]:
            ballscrew_step(F, I, S, n, axis_primary(F, n))
    if I[af2.word[n]] & af2.DIR_LIMIT_ACTIVATE:
        direction_step(F, I, S, n)
    if S[axes.rpm_factor[n]] > 0.0:
        rpm_step(F, I, S, n)


def followers_halt(F: F64, I: I32, n: int) -> None:
    """A kill or limit lets axis n go of everything it follows."""
    gear_halt(F, I, n)
    cam_halt(F, I, n)
    ballscrew_halt(I, n)
    if I[filters.on[n]]:
        filter_halt(F, I, n)
