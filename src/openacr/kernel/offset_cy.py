"""What moves or corrects an axis beside its profilers, and the order in which it happens.

Filtered following: the mean of the last n source deltas is added to the gear offset (or to
a parameter), so every delta arrives in n equal parts.

Hand wheel: source counts move the target of the jog profiler, which chases it.

Backlash: while the primary setpoint is positive the offset is +BKL, else 0; the step is
spread evenly over 10 ms. BACKLASH_BY_DIRECTION = 1 takes the direction of travel instead.

Lock: the coordinated position of a locked axis follows the primary setpoint of its leader,
unit for unit; the difference of the two following errors drives the outputs together.
"""

from openacr.cmath import fabs, trunc
from openacr.kernel.axis_cy import axis_scale, axis_target_changed, axis_word, limit_bars
from openacr.kernel.cam_cy import ballscrew_halt, ballscrew_step, cam_halt, cam_step
from openacr.kernel.feedback_cy import FROM_ENCODER
from openacr.kernel.gear_cy import gear_halt, gear_step
from openacr.kernel.hold_cy import NOT_HELD, master_hold
from openacr.kernel.jog_cy import JOG_HOMING, JOG_IDLE, JOG_KILLED, JOG_TO_TARGET
from openacr.kernel.source_cy import (
    FROM_CLOCK,
    LARGEST_DELTA,
    PULSES_PER_S,
    USE_FILTER,
    USE_JOG,
    USE_WHEEL,
    USES,
    axis_word2,
)
from openacr.kernel.words_cy import wrap32
from openacr.map.kinds_cy import kind_of, store_long
from openacr.map.numbers import (
    AF1_CAM_ACTIVATE,
    AF1_GEAR_ACTIVATE,
    AF1_JOG_ACTIVE,
    AF1_JOG_FORWARD,
    AF1_JOG_LOCKOUT,
    AF1_JOG_REVERSE,
    AF2_DIR_LIMIT_ACTIVATE,
    AF2_DIR_LIMIT_TRIPPED,
    AF2_NEGATIVE_DIR_LIMIT,
    AF2_POSITIVE_DIR_LIMIT,
    AF3_FILTER_MOVED,
    AF3_WORD,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AF6_JOG_HOME_REQUEST,
    AF6_WORD,
    AX_ACTUAL_POSITION,
    AX_BACKLASH_SETTING,
    AX_BASE,
    AX_LOCK_FEEDBACK_GAIN,
    AX_RPM,
    AX_RPM_FACTOR,
    AX_STRIDE,
    AXF_BACKLASH_CNT,
    AXF_BASE,
    AXF_CAM_CNT,
    AXF_GEAR_CNT,
    AXF_JOG_CNT,
    AXF_JOG_TARGET_CNT,
    AXF_KINEMATICS_CNT,
    AXF_POSITION_CNT,
    AXF_PSP_CNT,
    AXF_PSP_VELOCITY_CPS,
    AXF_SSP_CNT,
    AXF_SSP_OLD_CNT,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    AXI_BASE,
    AXI_JOG_MODE,
    AXI_JOG_REPLAN,
    AXI_MASTER,
    AXI_ON,
    AXI_POSITION_INDEX,
    AXI_POSITION_SOURCE,
    AXI_STRIDE,
    ENF_BASE,
    ENF_STEP_CNT,
    ENF_STRIDE,
    FLF_BASE,
    FLF_CARRY_CNT,
    FLF_STRIDE,
    FLF_SUM_CNT,
    FLF_WINDOW_CNT,
    FLF_WINDOW_CNT_SIZE,
    FLI_BASE,
    FLI_INDEX,
    FLI_ON,
    FLI_OUT,
    FLI_SIZE,
    FLI_STRIDE,
    FOF_BACKLASH_OLD_CNT,
    FOF_BACKLASH_STEP_CNT,
    FOF_BACKLASH_WANTED_CNT,
    FOF_BASE,
    FOF_JOG_DEBT_S,
    FOF_LOCK_OLD_CNT,
    FOF_LOCK_V,
    FOF_STRIDE,
    FOI_BASE,
    FOI_LEADER,
    FOI_LIVE,
    FOI_STRIDE,
    HWF_BASE,
    HWF_PPU,
    HWF_RATIO,
    HWF_STRIDE,
    KIND_FP32,
    KIND_FP64,
    KIND_LONG,
    MSI_BASE,
    MSI_HOLD,
    MSI_QUEUED,
    MSI_STRIDE,
    OBI_BASE,
    OBI_LOCKED,
    SRF_BASE,
    SRF_DELTA,
    SRF_STRIDE,
    SRI_BASE,
    SRI_KIND,
    SRI_STRIDE,
    USER_BASE,
)
from openacr.views import F32, F64, I32

__all__ = ["backlash_step", "filter_clear", "filter_halt", "followers_step"]

BACKLASH_BY_DIRECTION = 0
BACKLASH_SPREAD_S = 0.01
AXES = 16
ENCODERS = 24
OWN_MOTION = AF1_JOG_FORWARD | AF1_JOG_REVERSE | AF1_GEAR_ACTIVATE | AF1_CAM_ACTIVATE


def source_delta(F: F64, n: int, use: int) -> float:
    """What a source of axis n has moved in this tick."""
    return F[SRF_BASE + (n * USES + use) * SRF_STRIDE + SRF_DELTA]


# filtered following


def filter_clear(F: F64, I: I32, n: int) -> None:
    """Forget the deltas of the window."""
    f: int = FLF_BASE + n * FLF_STRIDE
    for place in range(FLF_WINDOW_CNT_SIZE):
        F[f + FLF_WINDOW_CNT + place] = 0.0
    F[f + FLF_SUM_CNT] = 0.0
    F[f + FLF_CARRY_CNT] = 0.0
    I[FLI_BASE + n * FLI_STRIDE + FLI_INDEX] = 0


def filter_halt(F: F64, I: I32, n: int) -> None:
    """Stop filtered following."""
    I[FLI_BASE + n * FLI_STRIDE + FLI_ON] = 0
    I[AF3_WORD + n] &= ~AF3_FILTER_MOVED
    filter_clear(F, I, n)


def filter_put(F: F64, I: I32, S: F32, n: int, moved: float) -> None:
    """Add to the parameter of FLT OUT; a LONG one gets whole pulses, the rest is carried."""
    number: int = I[FLI_BASE + n * FLI_STRIDE + FLI_OUT]
    kind: int = kind_of(I, number)
    if kind == KIND_LONG:
        f: int = FLF_BASE + n * FLF_STRIDE
        total: float = F[f + FLF_CARRY_CNT] + moved
        whole: float = trunc(total)
        F[f + FLF_CARRY_CNT] = total - whole
        store_long(I, number, wrap32(I[number] + int(whole)))
    elif kind == KIND_FP32:
        S[number] = S[number] + moved
    elif kind == KIND_FP64:
        F[USER_BASE + number] += moved


def filter_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Filtered following of axis n."""
    f: int = FLF_BASE + n * FLF_STRIDE
    i: int = FLI_BASE + n * FLI_STRIDE
    size: int = max(1, min(I[i + FLI_SIZE], FLF_WINDOW_CNT_SIZE))
    place: int = I[i + FLI_INDEX]
    if not 0 <= place < size:
        place = 0
    delta: float = source_delta(F, n, USE_FILTER)
    F[f + FLF_SUM_CNT] += delta - F[f + FLF_WINDOW_CNT + place]
    F[f + FLF_WINDOW_CNT + place] = delta
    I[i + FLI_INDEX] = 0 if place + 1 >= size else place + 1
    mean: float = F[f + FLF_SUM_CNT] / size
    if I[i + FLI_OUT] >= 0:
        filter_put(F, I, S, n, mean)
    else:
        F[AXF_BASE + n * AXF_STRIDE + AXF_GEAR_CNT] += mean


# hand wheel and time base of jogs


def wheel_barred(F: F64, I: I32, S: F32, n: int, side: int) -> bool:
    """Whether a kill, the lockout or an active limit bars the hand wheel on a side."""
    if I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST or I[axis_word(n)] & AF1_JOG_LOCKOUT:
        return True
    return limit_bars(F, I, S, n, side) != 0


def wheel_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Hand wheel of axis n: its counts move the target of the jog profiler."""
    w: int = HWF_BASE + n * HWF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    delta: float = source_delta(F, n, USE_WHEEL)
    mode: int = I[i + AXI_JOG_MODE]
    if delta == 0.0 or F[w + HWF_PPU] == 0.0 or (mode != JOG_IDLE and mode != JOG_TO_TARGET):
        return
    way_u: float = delta / F[w + HWF_PPU] * F[w + HWF_RATIO]
    if way_u == 0.0 or wheel_barred(F, I, S, n, 1 if way_u > 0.0 else -1):
        return
    if mode == JOG_IDLE:
        F[a + AXF_JOG_TARGET_CNT] = F[a + AXF_JOG_CNT]
    F[a + AXF_JOG_TARGET_CNT] += way_u * axis_scale(S, n)
    I[i + AXI_JOG_MODE] = JOG_TO_TARGET
    I[i + AXI_JOG_REPLAN] = 1
    I[axis_word(n)] |= AF1_JOG_ACTIVE


def jog_time(F: F64, I: I32, n: int, period_s: float) -> float:
    """Time the jog of axis n advances in this tick: 1000 source pulses are one second.

    A source that runs back holds the jog until it has come forward again. Kills and homing
    go by the clock.
    """
    tap: int = n * USES + USE_JOG
    mode: int = I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_MODE]
    if (
        I[SRI_BASE + tap * SRI_STRIDE + SRI_KIND] == FROM_CLOCK
        or mode == JOG_KILLED
        or mode == JOG_HOMING
    ):
        return period_s
    f: int = FOF_BASE + n * FOF_STRIDE
    due: float = F[f + FOF_JOG_DEBT_S] + source_delta(F, n, USE_JOG) / PULSES_PER_S
    F[f + FOF_JOG_DEBT_S] = min(due, 0.0)
    return max(due, 0.0)


# backlash


def backlash_wanted(F: F64, S: F32, n: int, psp_cnt: float) -> float:
    """The backlash offset that belongs to a primary setpoint."""
    f: int = FOF_BASE + n * FOF_STRIDE
    full: float = S[AX_BASE + n * AX_STRIDE + AX_BACKLASH_SETTING] * axis_scale(S, n)
    if not fabs(full) < LARGEST_DELTA:
        full = 0.0
    if BACKLASH_BY_DIRECTION:
        moved: float = psp_cnt - F[f + FOF_BACKLASH_OLD_CNT]
        F[f + FOF_BACKLASH_OLD_CNT] = psp_cnt
        if moved == 0.0:
            return F[f + FOF_BACKLASH_WANTED_CNT]
        return full if moved > 0.0 else 0.0
    return full if psp_cnt > 0.0 else 0.0


def backlash_step(F: F64, S: F32, n: int, psp_cnt: float, dt: float) -> None:
    """Bring the backlash offset of axis n to what it should be, a step taking 10 ms."""
    f: int = FOF_BASE + n * FOF_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    wanted: float = backlash_wanted(F, S, n, psp_cnt)
    offset: float = F[a + AXF_BACKLASH_CNT]
    if wanted != F[f + FOF_BACKLASH_WANTED_CNT]:
        F[f + FOF_BACKLASH_WANTED_CNT] = wanted
        F[f + FOF_BACKLASH_STEP_CNT] = fabs(wanted - offset) / BACKLASH_SPREAD_S
    if offset == wanted:
        return
    step: float = F[f + FOF_BACKLASH_STEP_CNT] * dt
    left: float = wanted - offset
    if fabs(left) <= step * (1.0 + 1e-9):
        F[a + AXF_BACKLASH_CNT] = wanted
    else:
        F[a + AXF_BACKLASH_CNT] = offset + (step if left > 0.0 else -step)


# locked pairs


def lock_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Let the locked axis n follow its leader; runs behind the setpoints of the leader.

    Flags that would move it on its own are taken back, as commands are refused.
    """
    I[axis_word(n)] &= ~OWN_MOTION
    I[AF6_WORD + n] &= ~AF6_JOG_HOME_REQUEST
    f: int = FOF_BASE + n * FOF_STRIDE
    leader: int = I[FOI_BASE + n * FOI_STRIDE + FOI_LEADER] - 1
    now: float = F[AXF_BASE + leader * AXF_STRIDE + AXF_PSP_CNT]
    moved: float = now - F[f + FOF_LOCK_OLD_CNT]
    F[f + FOF_LOCK_OLD_CNT] = now
    if moved != 0.0:
        a: int = AXF_BASE + n * AXF_STRIDE
        F[a + AXF_POSITION_CNT] += moved / axis_scale(S, leader) * axis_scale(S, n)
        F[a + AXF_TARGET_CNT] = F[a + AXF_POSITION_CNT]
        axis_target_changed(F, I, n)


def lock_error(F: F64, I: I32, n: int) -> float:
    """Following error of axis n, unrounded."""
    actual: int = I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
    return F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT] - actual


def locks_couple(F: F64, I: I32, S: F32) -> None:
    """Coupling voltages: Lock Feedback Gain of the leader times the difference of errors."""
    for n in range(AXES):
        F[FOF_BASE + n * FOF_STRIDE + FOF_LOCK_V] = 0.0
    for n in range(AXES):
        leader: int = I[FOI_BASE + n * FOI_STRIDE + FOI_LEADER] - 1
        if 0 <= leader < AXES and I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
            gain: float = S[AX_BASE + leader * AX_STRIDE + AX_LOCK_FEEDBACK_GAIN]
            other: float = lock_error(F, I, n) * axis_scale(S, leader) / axis_scale(S, n)
            volts: float = gain * (lock_error(F, I, leader) - other)
            F[FOF_BASE + leader * FOF_STRIDE + FOF_LOCK_V] += volts
            F[FOF_BASE + n * FOF_STRIDE + FOF_LOCK_V] -= volts


def lock_leader(I: I32, n: int) -> int:
    """The axis that leads axis n, -1 if it is not locked."""
    if not I[OBI_BASE + OBI_LOCKED]:
        return -1
    leader: int = I[FOI_BASE + n * FOI_STRIDE + FOI_LEADER] - 1
    return leader if 0 <= leader < AXES and leader != n else -1


# directional limits and speed in revolutions


def direction_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Directional limits: motion in a barred direction trips a feedhold of the master."""
    word: int = axis_word2(n)
    flags: int = I[word]
    velocity: float = F[AXF_BASE + n * AXF_STRIDE + AXF_PSP_VELOCITY_CPS] * axis_scale(S, n)
    if flags & AF2_DIR_LIMIT_TRIPPED:
        return
    if (velocity > 0.0 and flags & AF2_POSITIVE_DIR_LIMIT) or (
        velocity < 0.0 and flags & AF2_NEGATIVE_DIR_LIMIT
    ):
        I[word] = flags | AF2_DIR_LIMIT_TRIPPED
        m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
        if m >= 0:
            i: int = MSI_BASE + m * MSI_STRIDE
            if I[i + MSI_QUEUED] and I[i + MSI_HOLD] == NOT_HELD:
                master_hold(F, I, S, m)


def rpm_step(F: F64, I: I32, S: F32, n: int) -> None:
    """RPM = RPM Factor * pulses moved in this tick."""
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    moved: float = F[a + AXF_SSP_CNT] - F[a + AXF_SSP_OLD_CNT]
    k: int = I[i + AXI_POSITION_INDEX]
    if I[i + AXI_POSITION_SOURCE] == FROM_ENCODER and 0 <= k < ENCODERS:
        moved = F[ENF_BASE + k * ENF_STRIDE + ENF_STEP_CNT]
    S[p + AX_RPM] = S[p + AX_RPM_FACTOR] * moved


# the order of things


def followers_used(I: I32, n: int) -> int:
    """Not 0 if anything of this module concerns axis n.

    The settings are 32-bit floats; any that is not 0 has bits set.
    """
    p: int = AX_BASE + n * AX_STRIDE
    return (
        I[FOI_BASE + n * FOI_STRIDE + FOI_LIVE]
        | I[p + AX_BACKLASH_SETTING]
        | I[p + AX_RPM_FACTOR]
        | (I[axis_word2(n)] & AF2_DIR_LIMIT_ACTIVATE)
    )


def followers_step(F: F64, I: I32, S: F32, n: int, dt: float, rate_hz: float) -> None:
    """Gear, filter and cam of axis n, then the offsets that depend on the primary setpoint."""
    a: int = AXF_BASE + n * AXF_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    if I[p + AX_BACKLASH_SETTING]:
        I[FOI_BASE + n * FOI_STRIDE + FOI_LIVE] = 1  # so that a later 0 is noticed
    if I[FOI_BASE + n * FOI_STRIDE + FOI_LIVE]:
        gear_step(F, I, S, n, dt)
        cam_step(F, I, S, n, rate_hz)
        if I[FLI_BASE + n * FLI_STRIDE + FLI_ON]:
            filter_step(F, I, S, n)
        psp: float = F[a + AXF_POSITION_CNT] + F[a + AXF_KINEMATICS_CNT]
        psp = psp + F[a + AXF_GEAR_CNT] + F[a + AXF_JOG_CNT] + F[a + AXF_CAM_CNT]
        backlash_step(F, S, n, psp, dt)
        ballscrew_step(F, I, S, n, psp)
    if I[axis_word2(n)] & AF2_DIR_LIMIT_ACTIVATE:
        direction_step(F, I, S, n)
    if S[p + AX_RPM_FACTOR] > 0.0:
        rpm_step(F, I, S, n)


def followers_halt(F: F64, I: I32, n: int) -> None:
    """A kill or limit lets axis n go of everything it follows."""
    gear_halt(F, I, n)
    cam_halt(F, I, n)
    ballscrew_halt(I, n)
    if I[FLI_BASE + n * FLI_STRIDE + FLI_ON]:
        filter_halt(F, I, n)
