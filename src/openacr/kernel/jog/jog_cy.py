"""The jog profiler of an axis; its position is the jog offset.

Its profile counts forwards in direction `jog_sign` from the offset at which the plan began
(`jog_origin_cnt`), in pulses. A jog that has to turn round first comes to rest, then plans
anew. Settings are read live: JOG VEL acts at once, ACC, DEC and JRK at the next ramp.

The same profiler brings an axis to rest on a kill or limit (it takes over the whole
command velocity) and runs the homing sequence.
"""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import LIMITS_ENABLED, axis_scale, axis_sense, limit_bars
from openacr.kernel.jog.homing_cy import home_abort, home_arrived, home_begin, home_step
from openacr.kernel.jog.jogplan_cy import (
    FAR_CNT,
    JOG_PROFILE,
    jog_ramp_down,
    jog_room,
    jog_run,
    jog_setting,
    jog_speed,
)
from openacr.kernel.profile.profile_cy import profile_advance, profile_reset, profile_stop
from openacr.kernel.profile.ramps_cy import STOPPING
from openacr.kernel.sources.source_cy import FROM_CLOCK, USE_JOG, USES
from openacr.map.rows import axes, kernel, masters, profiles, sources
from openacr.map.words import af1, af4, af5, af6
from openacr.views import F32, F64, I32

__all__ = ["jog_step", "jog_take_over"]
__inlined__ = ["jog_step"]

JOG_IDLE = 0
JOG_CONTINUOUS = 1
JOG_TO_TARGET = 2
JOG_STOPPING = 3  # JOG OFF
JOG_KILLED = 4  # kill, limit
JOG_HOMING = 5

JOG_WANTED = af1.JOG_FORWARD | af1.JOG_REVERSE
HOME_BARS = af1.JOG_LOCKOUT | af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE
JOG_STATES = af1.JOG_ACTIVE | af1.JOG_DIRECTION | af1.JOG_AT_SPEED | af1.JOG_STOPPING


def jog_plan(F: F64, I: I32, S: F32, n: int) -> None:
    """Plan the jog of axis n from its present motion towards what is wanted."""
    speed_cps: float = jog_speed(F, I, S, n)
    I[axes.jog_replan[n]] = 0
    want: int = I[axes.jog_want[n]]
    sign: int = want * axis_sense(S, n)
    distance_cnt: float = FAR_CNT
    if I[axes.jog_mode[n]] == JOG_TO_TARGET:
        distance_cnt = F[axes.jog_target_cnt[n]] - F[axes.jog_cnt[n]]
        sign = 1 if distance_cnt >= 0.0 else -1
        distance_cnt = fabs(distance_cnt)
    elif I[af1.word[n]] & af1.JOG_LIMIT_CHECK:
        distance_cnt = max(jog_room(F, S, n, want), 0.0)
    I[axes.jog_turning[n]] = 0 if jog_run(F, I, S, n, sign, distance_cnt, speed_cps) else 1


def jog_brake(F: F64, I: I32, S: F32, n: int) -> None:
    """Ramp a jog to rest with JOG DEC (JOG OFF)."""
    I[axes.jog_mode[n]] = JOG_STOPPING
    I[axes.jog_turning[n]] = 0
    I[axes.jog_replan[n]] = 0
    dec_cps2: float = jog_setting(S, n, axes.jog_decel_setting[n])
    jerk_cps3: float = jog_setting(S, n, axes.jog_jerk_setting[n])
    jog_ramp_down(F, I, n, dec_cps2, jerk_cps3, STOPPING)


def jog_take_over(F: F64, I: I32, S: F32, n: int, rate_ups2: float) -> None:
    """Bring axis n to rest with `rate_ups2`, starting from its whole command velocity.

    The caller has stopped every other profiler of the axis; rate 0 stops at once.
    """
    if I[axes.jog_mode[n]] == JOG_HOMING:
        home_abort(I, n)
    velocity_cps: float = F[axes.psp_velocity_cps[n]]
    I[af1.word[n]] &= ~JOG_WANTED
    I[axes.jog_sign[n]] = -1 if velocity_cps < 0.0 else 1
    I[axes.jog_turning[n]] = 0
    I[axes.jog_replan[n]] = 0
    F[axes.jog_origin_cnt[n]] = F[axes.jog_cnt[n]]
    profile_reset(F, I, JOG_PROFILE + n, fabs(velocity_cps), 0.0)
    I[axes.jog_mode[n]] = JOG_KILLED
    rate_cps2: float = rate_ups2 * fabs(axis_scale(S, n))
    profile_stop(F, I, JOG_PROFILE + n, FAR_CNT, rate_cps2, 0.0, STOPPING)


def jog_home_request(I: I32, n: int) -> None:
    """The flag form of JOG HOME: start the search at rest, unless something bars it."""
    flags: int = I[af6.word[n]]
    negative: bool = flags & af6.JOG_HOME_DIRECTION != 0
    I[af6.word[n]] = flags & ~af6.JOG_HOME_REQUEST
    if home_barred(I, n):
        return
    home_begin(I, n, -1 if negative else 1)
    I[axes.jog_mode[n]] = JOG_HOMING


def home_barred(I: I32, n: int) -> bool:
    """Whether axis n moves, is killed, locked out or jogs by another time base."""
    m: int = I[axes.master[n]]
    if m >= 0 and I[masters.queued[m]]:
        return True
    if I[af1.word[n]] & HOME_BARS or I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST:
        return True
    if I[axes.jog_mode[n]] != JOG_IDLE:
        return True
    return I[sources.kind[n * USES + USE_JOG]] != FROM_CLOCK


def jog_requests(F: F64, I: I32, S: F32, n: int) -> None:
    """Follow the jog flags, which commands, programs and hosts set and clear alike."""
    if I[af6.word[n]] & af6.JOG_HOME_REQUEST:
        jog_home_request(I, n)
    flags: int = I[af1.word[n]]
    mode: int = I[axes.jog_mode[n]]
    if mode == JOG_HOMING:
        return
    want: int = 0
    if I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST and flags & JOG_WANTED:
        # Not left for later: lifting the kill must not start anything.
        flags &= ~JOG_WANTED
        I[af1.word[n]] = flags
    if flags & af1.JOG_FORWARD:
        want += 1
    if flags & af1.JOG_REVERSE:
        want -= 1
    if want != 0 and limit_bars(F, I, S, n, want):
        I[af1.word[n]] = flags & ~JOG_WANTED
        want = 0
    if want != 0:
        if mode == JOG_IDLE and flags & af1.JOG_LOCKOUT:
            return
        if mode == JOG_IDLE and flags & af1.JOG_LIMIT_CHECK and jog_room(F, S, n, want) <= 0.0:
            return
        if mode != JOG_CONTINUOUS or want != I[axes.jog_want[n]]:
            I[axes.jog_mode[n]] = JOG_CONTINUOUS
            I[axes.jog_want[n]] = want
            I[axes.jog_replan[n]] = 1
    elif mode == JOG_CONTINUOUS:
        jog_brake(F, I, S, n)


def jog_stop_request(F: F64, I: I32, S: F32, n: int) -> None:
    """Jog Stopping, set from outside while nothing stops: the jog ends as by JOG OFF."""
    if not I[af1.word[n]] & af1.JOG_STOPPING:
        return
    if I[profiles.kind[JOG_PROFILE + n]] == STOPPING:
        return
    mode: int = I[axes.jog_mode[n]]
    if mode == JOG_HOMING:
        home_abort(I, n)
    if mode == JOG_HOMING or mode == JOG_CONTINUOUS or mode == JOG_TO_TARGET:
        I[af1.word[n]] &= ~JOG_WANTED
        jog_brake(F, I, S, n)


def jog_follow(F: F64, I: I32, S: F32, n: int) -> None:
    """Replan for a new target or a changed JOG VEL."""
    mode: int = I[axes.jog_mode[n]]
    if mode != JOG_CONTINUOUS and mode != JOG_TO_TARGET:
        return
    if not I[axes.jog_replan[n]]:
        if I[axes.jog_turning[n]]:
            return
        if I[profiles.kind[JOG_PROFILE + n]] == STOPPING:
            return
        if I[kernel.untouched]:  # so are the settings, and every plan is made with them
            return
        planned_cps: float = F[profiles.target_velocity[JOG_PROFILE + n]]
        if jog_speed(F, I, S, n) == planned_cps:
            return
    jog_plan(F, I, S, n)


def jog_place(F: F64, I: I32, n: int) -> None:
    """Put the jog offset where the profile is."""
    distance_cnt: float = F[profiles.distance[JOG_PROFILE + n]]
    sign: int = I[axes.jog_sign[n]]
    F[axes.jog_cnt[n]] = F[axes.jog_origin_cnt[n]] + sign * distance_cnt


def jog_rest(F: F64, I: I32, n: int) -> None:
    """End the jog of axis n: no motion, no jog flags but those that ask for one."""
    I[axes.jog_mode[n]] = JOG_IDLE
    I[axes.jog_turning[n]] = 0
    profile_reset(F, I, JOG_PROFILE + n, 0.0, 0.0)


def jog_waits(I: I32, n: int) -> bool:
    """Whether JOG ABS or INC waits for the end of the stop of a limit or kill."""
    return I[axes.jog_mode[n]] == JOG_KILLED and I[axes.jog_replan[n]] != 0


def jog_arrived(F: F64, I: I32, S: F32, n: int, left_s: float) -> None:
    """The plan of axis n has ended with `left_s` seconds of the tick to go."""
    mode: int = I[axes.jog_mode[n]]
    if mode == JOG_HOMING:
        if home_arrived(F, I, S, n):
            jog_rest(F, I, n)
    elif I[axes.jog_turning[n]] or jog_waits(I, n):
        if mode == JOG_KILLED:
            I[axes.jog_mode[n]] = JOG_TO_TARGET
        profile_reset(F, I, JOG_PROFILE + n, 0.0, 0.0)
        jog_plan(F, I, S, n)
        if profile_advance(F, I, JOG_PROFILE + n, left_s) >= 0.0:
            jog_finish_target(F, I, n)
        else:
            jog_place(F, I, n)
    elif mode == JOG_CONTINUOUS:
        profile_reset(F, I, JOG_PROFILE + n, 0.0, 0.0)  # at the jog limit
        F[axes.jog_origin_cnt[n]] = F[axes.jog_cnt[n]]
        F[profiles.target_velocity[JOG_PROFILE + n]] = jog_speed(F, I, S, n)
    else:
        jog_finish_target(F, I, n)


def jog_finish_target(F: F64, I: I32, n: int) -> None:
    """A jog has ended; one with a target stands exactly on it."""
    if I[axes.jog_mode[n]] == JOG_TO_TARGET:
        F[axes.jog_cnt[n]] = F[axes.jog_target_cnt[n]]
    jog_rest(F, I, n)


def jog_numbers_show(F: F64, I: I32, S: F32, n: int) -> None:
    """Publish speed and acceleration of the jog profiler."""
    sign: int = I[axes.jog_sign[n]]
    units: float = 1.0 / axis_scale(S, n)
    S[axes.current_jog_veloc[n]] = sign * F[profiles.velocity[JOG_PROFILE + n]] * units
    S[axes.current_jog_accel[n]] = sign * F[profiles.accel[JOG_PROFILE + n]] * units


def jog_show(F: F64, I: I32, S: F32, n: int) -> None:
    """Publish speed, acceleration and flags of the jog profiler."""
    if I[axes.jog_mode[n]] == JOG_IDLE or not I[kernel.unread]:
        jog_numbers_show(F, I, S, n)
    velocity_cps: float = F[profiles.velocity[JOG_PROFILE + n]]
    word: int = af1.word[n]
    flags: int = I[word] & ~JOG_STATES
    if I[axes.jog_mode[n]] != JOG_IDLE:
        flags |= af1.JOG_ACTIVE
        if I[axes.jog_sign[n]] * velocity_cps * axis_sense(S, n) < 0.0:
            flags |= af1.JOG_DIRECTION
        if I[profiles.kind[JOG_PROFILE + n]] == STOPPING:
            flags |= af1.JOG_STOPPING
        elif (
            velocity_cps != 0.0
            and F[profiles.accel[JOG_PROFILE + n]] == 0.0
            and not I[axes.jog_turning[n]]
        ):
            flags |= af1.JOG_AT_SPEED
    I[word] = flags


def jog_undisturbed(I: I32, n: int) -> bool:
    """Whether nothing asks the running jog of axis n for anything, so that its plan holds.

    Where nothing else writes, a PLC may still write the flags of jogs. It reaches none that kills
    or homes; a kill by the interrupt has taken the jog over.
    """
    if not I[kernel.untouched] or I[axes.jog_replan[n]]:
        return False
    asked: int = I[af1.word[n]] & (JOG_WANTED | af1.JOG_STOPPING)
    if I[axes.jog_mode[n]] == JOG_TO_TARGET:
        return asked == 0
    wanted: int = af1.JOG_FORWARD if I[axes.jog_want[n]] > 0 else af1.JOG_REVERSE
    if I[axes.jog_mode[n]] != JOG_CONTINUOUS or asked != wanted:
        return False
    return I[af5.word[n]] & LIMITS_ENABLED == 0


def jog_idle(I: I32, n: int) -> bool:
    """Whether axis n has no jog and no flag of it, nor a request for one."""
    if I[axes.jog_mode[n]] != JOG_IDLE or I[af6.word[n]] & af6.JOG_HOME_REQUEST:
        return False
    return I[af1.word[n]] & (JOG_WANTED | JOG_STATES) == 0


def jog_step(F: F64, I: I32, S: F32, n: int, dt_s: float) -> None:
    """Advance the jog profiler of axis n by `dt_s` seconds."""
    if not jog_undisturbed(I, n):
        jog_stop_request(F, I, S, n)
        mode: int = I[axes.jog_mode[n]]
        if mode != JOG_KILLED and mode != JOG_HOMING:
            jog_requests(F, I, S, n)
            if I[axes.jog_mode[n]] == JOG_IDLE:
                I[af1.word[n]] &= ~JOG_STATES  # a command may have been ahead of a refusal
                return
            jog_follow(F, I, S, n)
    if I[axes.jog_mode[n]] == JOG_HOMING and home_step(F, I, S, n):
        jog_rest(F, I, n)
    if I[axes.jog_mode[n]] != JOG_IDLE:
        left_s: float = profile_advance(F, I, JOG_PROFILE + n, dt_s)
        jog_place(F, I, n)
        if left_s >= 0.0:
            jog_arrived(F, I, S, n, left_s)
    jog_show(F, I, S, n)
