"""The jog profiler of an axis; its position is the jog offset.

Its profile counts forwards in direction `jog_sign` from the offset at which the plan began
(`jog_origin_cnt`), in pulses. A jog that has to turn round first comes to rest, then plans
anew. Settings are read live: JOG VEL acts at once, ACC, DEC and JRK at the next ramp.

The same profiler brings an axis to rest on a kill or limit (it takes over the whole
command velocity) and runs the homing sequence.
"""

from openacr.cmath import fabs
from openacr.kernel.axis_cy import axis_scale, axis_sense, axis_word, limit_bars
from openacr.kernel.homing_cy import home_abort, home_arrived, home_begin, home_step
from openacr.kernel.jogplan_cy import (
    FAR_CNT,
    JOG_PROFILE,
    jog_ramp_down,
    jog_run,
    jog_setting,
    jog_speed,
)
from openacr.kernel.profile_cy import STOPPING, profile_advance, profile_reset, profile_stop
from openacr.kernel.source_cy import FROM_CLOCK, USE_JOG, USES
from openacr.map.numbers import (
    AF1_CAM_ACTIVATE,
    AF1_GEAR_ACTIVATE,
    AF1_GEAR_ACTIVE,
    AF1_JOG_ACTIVE,
    AF1_JOG_AT_SPEED,
    AF1_JOG_DIRECTION,
    AF1_JOG_FORWARD,
    AF1_JOG_LIMIT_CHECK,
    AF1_JOG_LOCKOUT,
    AF1_JOG_REVERSE,
    AF1_JOG_STOPPING,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AF6_JOG_HOME_DIRECTION,
    AF6_JOG_HOME_REQUEST,
    AF6_WORD,
    AX_BASE,
    AX_CURRENT_JOG_ACCEL,
    AX_CURRENT_JOG_VELOC,
    AX_JOG_DECEL_SETTING,
    AX_JOG_JERK_SETTING,
    AX_MINUS_JOG_LIMIT,
    AX_PLUS_JOG_LIMIT,
    AX_STRIDE,
    AXF_BASE,
    AXF_JOG_CNT,
    AXF_JOG_ORIGIN_CNT,
    AXF_JOG_TARGET_CNT,
    AXF_PSP_VELOCITY_CPS,
    AXF_STRIDE,
    AXI_BASE,
    AXI_JOG_MODE,
    AXI_JOG_REPLAN,
    AXI_JOG_SIGN,
    AXI_JOG_TURNING,
    AXI_JOG_WANT,
    AXI_MASTER,
    AXI_STRIDE,
    MSI_BASE,
    MSI_QUEUED,
    MSI_STRIDE,
    PRF_ACCEL,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
    PRF_TARGET_VELOCITY,
    PRF_VELOCITY,
    PRI_BASE,
    PRI_KIND,
    PRI_STRIDE,
    SRI_BASE,
    SRI_KIND,
    SRI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["jog_step", "jog_take_over"]

JOG_IDLE = 0
JOG_CONTINUOUS = 1
JOG_TO_TARGET = 2
JOG_STOPPING = 3  # JOG OFF
JOG_KILLED = 4  # kill, limit
JOG_HOMING = 5

JOG_WANTED = AF1_JOG_FORWARD | AF1_JOG_REVERSE
HOME_BARS = AF1_JOG_LOCKOUT | AF1_GEAR_ACTIVATE | AF1_GEAR_ACTIVE | AF1_CAM_ACTIVATE
JOG_STATES = AF1_JOG_ACTIVE | AF1_JOG_DIRECTION | AF1_JOG_AT_SPEED | AF1_JOG_STOPPING


def jog_plan(F: F64, I: I32, S: F32, n: int) -> None:
    """Plan the jog of axis n from its present motion towards what is wanted."""
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    speed: float = jog_speed(F, I, S, n)
    I[i + AXI_JOG_REPLAN] = 0
    want: int = I[i + AXI_JOG_WANT]
    sign: int = want * axis_sense(S, n)
    distance: float = FAR_CNT
    if I[i + AXI_JOG_MODE] == JOG_TO_TARGET:
        distance = F[a + AXF_JOG_TARGET_CNT] - F[a + AXF_JOG_CNT]
        sign = 1 if distance >= 0.0 else -1
        distance = fabs(distance)
    elif I[axis_word(n)] & AF1_JOG_LIMIT_CHECK:
        distance = max(jog_room(F, S, n, want), 0.0)
    I[i + AXI_JOG_TURNING] = 0 if jog_run(F, I, S, n, sign, distance, speed) else 1


def jog_room(F: F64, S: F32, n: int, want: int) -> float:
    """Pulses from the present jog offset to the jog limit (JLM) in direction `want`."""
    p: int = AX_BASE + n * AX_STRIDE
    limit: float = S[p + AX_PLUS_JOG_LIMIT] if want > 0 else S[p + AX_MINUS_JOG_LIMIT]
    way: float = limit * axis_scale(S, n) - F[AXF_BASE + n * AXF_STRIDE + AXF_JOG_CNT]
    return want * axis_sense(S, n) * way


def jog_brake(F: F64, I: I32, S: F32, n: int) -> None:
    """Ramp a jog to rest with JOG DEC (JOG OFF)."""
    i: int = AXI_BASE + n * AXI_STRIDE
    I[i + AXI_JOG_MODE] = JOG_STOPPING
    I[i + AXI_JOG_TURNING] = 0
    I[i + AXI_JOG_REPLAN] = 0
    dec: float = jog_setting(S, n, AX_JOG_DECEL_SETTING)
    jerk: float = jog_setting(S, n, AX_JOG_JERK_SETTING)
    jog_ramp_down(F, I, n, dec, jerk, STOPPING)


def jog_take_over(F: F64, I: I32, S: F32, n: int, rate_ups2: float) -> None:
    """Bring axis n to rest with `rate_ups2`, starting from its whole command velocity.

    The caller has stopped every other profiler of the axis; rate 0 stops at once.
    """
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    if I[i + AXI_JOG_MODE] == JOG_HOMING:
        home_abort(I, n)
    velocity: float = F[a + AXF_PSP_VELOCITY_CPS]
    I[axis_word(n)] &= ~JOG_WANTED
    I[i + AXI_JOG_SIGN] = -1 if velocity < 0.0 else 1
    I[i + AXI_JOG_TURNING] = 0
    I[i + AXI_JOG_REPLAN] = 0
    F[a + AXF_JOG_ORIGIN_CNT] = F[a + AXF_JOG_CNT]
    profile_reset(F, I, JOG_PROFILE + n, fabs(velocity), 0.0)
    I[i + AXI_JOG_MODE] = JOG_KILLED
    rate: float = rate_ups2 * fabs(axis_scale(S, n))
    profile_stop(F, I, JOG_PROFILE + n, FAR_CNT, rate, 0.0, STOPPING)


def jog_home_request(I: I32, n: int) -> None:
    """The flag form of JOG HOME: start the search at rest, unless something bars it."""
    flags: int = I[AF6_WORD + n]
    negative: bool = flags & AF6_JOG_HOME_DIRECTION != 0
    I[AF6_WORD + n] = flags & ~AF6_JOG_HOME_REQUEST
    if home_barred(I, n):
        return
    home_begin(I, n, -1 if negative else 1)
    I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_MODE] = JOG_HOMING


def home_barred(I: I32, n: int) -> bool:
    """Whether axis n moves, is killed, locked out or jogs by another time base."""
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if m >= 0 and I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED]:
        return True
    if I[axis_word(n)] & HOME_BARS or I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST:
        return True
    if I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_MODE] != JOG_IDLE:
        return True
    return I[SRI_BASE + (n * USES + USE_JOG) * SRI_STRIDE + SRI_KIND] != FROM_CLOCK


def jog_requests(F: F64, I: I32, S: F32, n: int) -> None:
    """Follow the jog flags, which commands, programs and hosts set and clear alike."""
    i: int = AXI_BASE + n * AXI_STRIDE
    if I[AF6_WORD + n] & AF6_JOG_HOME_REQUEST:
        jog_home_request(I, n)
    flags: int = I[axis_word(n)]
    mode: int = I[i + AXI_JOG_MODE]
    if mode == JOG_HOMING:
        return
    want: int = 0
    if I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST and flags & JOG_WANTED:
        # Not left for later: lifting the kill must not start anything.
        flags &= ~JOG_WANTED
        I[axis_word(n)] = flags
    if flags & AF1_JOG_FORWARD:
        want += 1
    if flags & AF1_JOG_REVERSE:
        want -= 1
    if want != 0 and limit_bars(F, I, S, n, want):
        I[axis_word(n)] = flags & ~JOG_WANTED
        want = 0
    if want != 0:
        if mode == JOG_IDLE and flags & AF1_JOG_LOCKOUT:
            return
        if mode == JOG_IDLE and flags & AF1_JOG_LIMIT_CHECK and jog_room(F, S, n, want) <= 0.0:
            return
        if mode != JOG_CONTINUOUS or want != I[i + AXI_JOG_WANT]:
            I[i + AXI_JOG_MODE] = JOG_CONTINUOUS
            I[i + AXI_JOG_WANT] = want
            I[i + AXI_JOG_REPLAN] = 1
    elif mode == JOG_CONTINUOUS:
        jog_brake(F, I, S, n)


def jog_stop_request(F: F64, I: I32, S: F32, n: int) -> None:
    """Jog Stopping, set from outside while nothing stops: the jog ends as by JOG OFF."""
    if not I[axis_word(n)] & AF1_JOG_STOPPING:
        return
    if I[PRI_BASE + (JOG_PROFILE + n) * PRI_STRIDE + PRI_KIND] == STOPPING:
        return
    mode: int = I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_MODE]
    if mode == JOG_HOMING:
        home_abort(I, n)
    if mode == JOG_HOMING or mode == JOG_CONTINUOUS or mode == JOG_TO_TARGET:
        I[axis_word(n)] &= ~JOG_WANTED
        jog_brake(F, I, S, n)


def jog_follow(F: F64, I: I32, S: F32, n: int) -> None:
    """Replan for a new target or a changed JOG VEL."""
    i: int = AXI_BASE + n * AXI_STRIDE
    mode: int = I[i + AXI_JOG_MODE]
    if mode != JOG_CONTINUOUS and mode != JOG_TO_TARGET:
        return
    if not I[i + AXI_JOG_REPLAN]:
        if I[i + AXI_JOG_TURNING]:
            return
        if I[PRI_BASE + (JOG_PROFILE + n) * PRI_STRIDE + PRI_KIND] == STOPPING:
            return
        planned: float = F[PRF_BASE + (JOG_PROFILE + n) * PRF_STRIDE + PRF_TARGET_VELOCITY]
        if jog_speed(F, I, S, n) == planned:
            return
    jog_plan(F, I, S, n)


def jog_place(F: F64, I: I32, n: int) -> None:
    """Put the jog offset where the profile is."""
    a: int = AXF_BASE + n * AXF_STRIDE
    distance: float = F[PRF_BASE + (JOG_PROFILE + n) * PRF_STRIDE + PRF_DISTANCE]
    sign: int = I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_SIGN]
    F[a + AXF_JOG_CNT] = F[a + AXF_JOG_ORIGIN_CNT] + sign * distance


def jog_rest(F: F64, I: I32, n: int) -> None:
    """End the jog of axis n: no motion, no jog flags but those that ask for one."""
    i: int = AXI_BASE + n * AXI_STRIDE
    I[i + AXI_JOG_MODE] = JOG_IDLE
    I[i + AXI_JOG_TURNING] = 0
    profile_reset(F, I, JOG_PROFILE + n, 0.0, 0.0)


def jog_arrived(F: F64, I: I32, S: F32, n: int, left: float) -> None:
    """The plan of axis n has ended with `left` seconds of the tick to go."""
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    mode: int = I[i + AXI_JOG_MODE]
    if mode == JOG_HOMING:
        if home_arrived(F, I, S, n):
            jog_rest(F, I, n)
    elif I[i + AXI_JOG_TURNING]:
        profile_reset(F, I, JOG_PROFILE + n, 0.0, 0.0)
        jog_plan(F, I, S, n)
        if profile_advance(F, I, JOG_PROFILE + n, left) >= 0.0:
            jog_finish_target(F, I, n)
        else:
            jog_place(F, I, n)
    elif mode == JOG_CONTINUOUS:
        profile_reset(F, I, JOG_PROFILE + n, 0.0, 0.0)  # at the jog limit
        F[a + AXF_JOG_ORIGIN_CNT] = F[a + AXF_JOG_CNT]
        F[PRF_BASE + (JOG_PROFILE + n) * PRF_STRIDE + PRF_TARGET_VELOCITY] = jog_speed(F, I, S, n)
    else:
        jog_finish_target(F, I, n)


def jog_finish_target(F: F64, I: I32, n: int) -> None:
    """A jog has ended; one with a target stands exactly on it."""
    a: int = AXF_BASE + n * AXF_STRIDE
    if I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_MODE] == JOG_TO_TARGET:
        F[a + AXF_JOG_CNT] = F[a + AXF_JOG_TARGET_CNT]
    jog_rest(F, I, n)


def jog_show(F: F64, I: I32, S: F32, n: int) -> None:
    """Publish speed, acceleration and flags of the jog profiler."""
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    f: int = PRF_BASE + (JOG_PROFILE + n) * PRF_STRIDE
    sign: int = I[i + AXI_JOG_SIGN]
    velocity: float = sign * F[f + PRF_VELOCITY]
    units: float = 1.0 / axis_scale(S, n)
    S[p + AX_CURRENT_JOG_VELOC] = velocity * units
    S[p + AX_CURRENT_JOG_ACCEL] = sign * F[f + PRF_ACCEL] * units
    word: int = axis_word(n)
    flags: int = I[word] & ~JOG_STATES
    if I[i + AXI_JOG_MODE] != JOG_IDLE:
        flags |= AF1_JOG_ACTIVE
        if velocity * units < 0.0:
            flags |= AF1_JOG_DIRECTION
        if I[PRI_BASE + (JOG_PROFILE + n) * PRI_STRIDE + PRI_KIND] == STOPPING:
            flags |= AF1_JOG_STOPPING
        elif velocity != 0.0 and F[f + PRF_ACCEL] == 0.0 and not I[i + AXI_JOG_TURNING]:
            flags |= AF1_JOG_AT_SPEED
    I[word] = flags


def jog_step(F: F64, I: I32, S: F32, n: int, dt: float) -> None:
    """Advance the jog profiler of axis n by `dt` seconds."""
    i: int = AXI_BASE + n * AXI_STRIDE
    jog_stop_request(F, I, S, n)
    mode: int = I[i + AXI_JOG_MODE]
    if mode != JOG_KILLED and mode != JOG_HOMING:
        jog_requests(F, I, S, n)
        if I[i + AXI_JOG_MODE] == JOG_IDLE:
            I[axis_word(n)] &= ~JOG_STATES  # a command may have been ahead of a refusal
            return
        jog_follow(F, I, S, n)
    if I[i + AXI_JOG_MODE] == JOG_HOMING and home_step(F, I, S, n):
        jog_rest(F, I, n)
    if I[i + AXI_JOG_MODE] != JOG_IDLE:
        left: float = profile_advance(F, I, JOG_PROFILE + n, dt)
        jog_place(F, I, n)
        if left >= 0.0:
            jog_arrived(F, I, S, n, left)
    jog_show(F, I, S, n)
