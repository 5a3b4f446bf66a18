"""Electronic gearing: the gear offset follows a source.

    gear offset += delta / GEAR PPU * ratio * PPU        [pulses]

The internal ratio r ramps linearly in time to RATIO with GEAR ACC and to 0 with GEAR DEC
(ratio units per second, 0 at once), through 0 where the sign changes. Within a tick the
mean of r over the tick counts, so a source of constant speed v gives exactly
v * ACC * t^2 / 2 during a ramp, at any tick length. What a ramp up has lost against the
full ratio is the gear slip.

A trigger splits its tick at the event: the gear counts only what the source does behind it
(GEAR ON) or before it (GEAR OFF).
"""

from openacr.cmath import fabs
from openacr.kernel.axis_cy import axis_scale, axis_word
from openacr.kernel.source_cy import (
    CAPTURED,
    DISARMED,
    EXPIRED,
    FIRED,
    GEAR_OFF,
    GEAR_ON,
    LARGEST_DELTA,
    TRIGGERS,
    USE_GEAR,
    USES,
    WAITING,
    axis_word2,
    trigger_step,
)
from openacr.map.numbers import (
    AF1_GEAR_ACTIVATE,
    AF1_GEAR_ACTIVE,
    AF1_GEAR_AT_SPEED,
    AF1_GEAR_LOCK,
    AF1_GEAR_STOPPING,
    AF2_GEAR_MAX,
    AF2_GEAR_MIN,
    AF2_GEAR_OFF_ARMED,
    AF2_GEAR_OFF_POSITION,
    AF2_GEAR_ON_POSITION,
    AF2_GEAR_ON_TRIG_ARMED,
    AF2_GEAR_TRIGGER_STARTED,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AX_BASE,
    AX_GEAR_SLIP,
    AX_GEAR_TRIGGER_OFF_OFFSET,
    AX_GEAR_TRIGGER_ON_OFFSET,
    AX_STRIDE,
    AXF_BASE,
    AXF_GEAR_CNT,
    AXF_STRIDE,
    GRF_ACC_RPS,
    GRF_BASE,
    GRF_DEC_RPS,
    GRF_MAX_U,
    GRF_MIN_U,
    GRF_PPU,
    GRF_RATIO,
    GRF_RATIO_NOW,
    GRF_SLIP_CNT,
    GRF_SLIP_SHOWN_CNT,
    GRF_STRIDE,
    SRF_BASE,
    SRF_DELTA,
    SRF_STRIDE,
    TGF_BASE,
    TGF_OVER_CNT,
    TGF_STRIDE,
    TGI_BASE,
    TGI_KIND,
    TGI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["gear_ramp", "gear_step"]

ON_FLAGS = AF2_GEAR_ON_TRIG_ARMED | AF2_GEAR_ON_POSITION
OFF_FLAGS = AF2_GEAR_OFF_ARMED | AF2_GEAR_OFF_POSITION
EPS = 1e-9
RATIO_STATE = AF1_GEAR_ACTIVE | AF1_GEAR_AT_SPEED | AF1_GEAR_STOPPING


def gear_ramp(F: F64, n: int, goal: float, dt: float, at_once: bool) -> float:
    """Ramp the internal ratio of axis n towards `goal` for `dt`; return its mean."""
    g: int = GRF_BASE + n * GRF_STRIDE
    ratio: float = F[g + GRF_RATIO_NOW]
    if at_once:
        ratio = goal
    if ratio == goal or dt <= 0.0:
        F[g + GRF_RATIO_NOW] = ratio
        return ratio
    area: float = 0.0
    left: float = dt
    for _ in range(2):  # down to 0, then up on the other side
        stage: float = 0.0 if ratio * goal < 0.0 else goal
        rate: float = F[g + GRF_DEC_RPS] if fabs(stage) < fabs(ratio) else F[g + GRF_ACC_RPS]
        if rate > 0.0:
            needed: float = fabs(stage - ratio) / rate
            if needed > left * (1.0 + EPS):
                rate = rate if stage > ratio else -rate
                area += left * (ratio + rate * left / 2.0)
                ratio += rate * left
                left = 0.0
                break
            area += needed * (ratio + stage) / 2.0
            left = max(left - needed, 0.0)
        ratio = stage
        if ratio == goal:
            break
    F[g + GRF_RATIO_NOW] = ratio
    return (area + left * ratio) / dt


def gear_slip(F: F64, S: F32, n: int, lost_cnt: float) -> None:
    """Add to Gear Slip, which anybody may write."""
    g: int = GRF_BASE + n * GRF_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    if S[p + AX_GEAR_SLIP] != F[g + GRF_SLIP_SHOWN_CNT]:
        F[g + GRF_SLIP_CNT] = S[p + AX_GEAR_SLIP]
    F[g + GRF_SLIP_CNT] += lost_cnt
    S[p + AX_GEAR_SLIP] = F[g + GRF_SLIP_CNT]
    F[g + GRF_SLIP_SHOWN_CNT] = S[p + AX_GEAR_SLIP]


def gear_place(F: F64, I: I32, S: F32, n: int, moved_cnt: float) -> None:
    """Move the gear offset of axis n, never farther beyond GEAR MAX and MIN."""
    g: int = GRF_BASE + n * GRF_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    word: int = axis_word2(n)
    flags: int = I[word] & ~(AF2_GEAR_MAX | AF2_GEAR_MIN)
    if not fabs(moved_cnt) < LARGEST_DELTA:
        return
    if F[g + GRF_MAX_U] > F[g + GRF_MIN_U]:
        scale: float = axis_scale(S, n)
        old: float = F[a + AXF_GEAR_CNT] / scale
        new: float = old + moved_cnt / scale
        if new >= F[g + GRF_MAX_U]:
            flags |= AF2_GEAR_MAX
            new = min(new, max(old, F[g + GRF_MAX_U]))
            moved_cnt = (new - old) * scale
        elif new <= F[g + GRF_MIN_U]:
            flags |= AF2_GEAR_MIN
            new = max(new, min(old, F[g + GRF_MIN_U]))
            moved_cnt = (new - old) * scale
    I[word] = flags
    F[a + AXF_GEAR_CNT] += moved_cnt


def gear_run(F: F64, I: I32, S: F32, n: int, delta: float, dt: float) -> None:
    """Let the gear of axis n follow `delta` source pulses that came within `dt`."""
    g: int = GRF_BASE + n * GRF_STRIDE
    word: int = axis_word(n)
    on: bool = I[word] & AF1_GEAR_ACTIVATE != 0
    goal: float = F[g + GRF_RATIO] if on else 0.0
    mean: float = gear_ramp(F, n, goal, dt, I[word] & AF1_GEAR_LOCK != 0)
    step: float = 0.0
    if F[g + GRF_PPU] != 0.0:
        step = delta / F[g + GRF_PPU] * axis_scale(S, n)
    if on and mean != goal and step != 0.0:
        gear_slip(F, S, n, (goal - mean) * step)
    gear_place(F, I, S, n, step * mean)


def gear_show(F: F64, I: I32, n: int) -> None:
    """Flags of the gear of axis n."""
    g: int = GRF_BASE + n * GRF_STRIDE
    word: int = axis_word(n)
    flags: int = I[word] & ~RATIO_STATE
    if flags & AF1_GEAR_ACTIVATE:
        flags |= AF1_GEAR_ACTIVE
        if F[g + GRF_RATIO_NOW] == F[g + GRF_RATIO]:
            flags |= AF1_GEAR_AT_SPEED
    else:
        I[axis_word2(n)] &= ~AF2_GEAR_TRIGGER_STARTED
        if F[g + GRF_RATIO_NOW] != 0.0:
            flags |= AF1_GEAR_ACTIVE | AF1_GEAR_STOPPING
    I[word] = flags


def gear_behind(F: F64, t: int, delta: float) -> float:
    """Part of the tick behind the event of trigger t."""
    return F[TGF_BASE + t * TGF_STRIDE + TGF_OVER_CNT] / delta if delta != 0.0 else 0.0


def gear_on_trigger(F: F64, I: I32, S: F32, n: int, delta: float, dt: float) -> bool:
    """Advance what GEAR ON waits for; True if the gear has started in this tick."""
    t: int = n * TRIGGERS + GEAR_ON
    captures: bool = I[TGI_BASE + t * TGI_STRIDE + TGI_KIND] >= CAPTURED
    offset: float = I[AX_BASE + n * AX_STRIDE + AX_GEAR_TRIGGER_ON_OFFSET]
    state: int = trigger_step(F, I, S, t, n * USES + USE_GEAR, offset)
    if state == WAITING:
        return False
    word: int = axis_word2(n)
    I[word] &= ~ON_FLAGS
    if state == EXPIRED:
        return False
    if captures:
        I[word] |= AF2_GEAR_TRIGGER_STARTED
    I[axis_word(n)] |= AF1_GEAR_ACTIVATE
    over: float = F[TGF_BASE + t * TGF_STRIDE + TGF_OVER_CNT]
    gear_run(F, I, S, n, over, dt * gear_behind(F, t, delta))
    return True


def gear_off_trigger(F: F64, I: I32, S: F32, n: int, delta: float, dt: float) -> bool:
    """Advance what GEAR OFF waits for; True if it has come in this tick."""
    t: int = n * TRIGGERS + GEAR_OFF
    offset: float = I[AX_BASE + n * AX_STRIDE + AX_GEAR_TRIGGER_OFF_OFFSET]
    state: int = trigger_step(F, I, S, t, n * USES + USE_GEAR, offset)
    if state != WAITING:
        I[axis_word2(n)] &= ~OFF_FLAGS
    if state != FIRED:
        return False
    over: float = F[TGF_BASE + t * TGF_STRIDE + TGF_OVER_CNT]
    behind: float = gear_behind(F, t, delta)
    gear_run(F, I, S, n, delta - over, dt * (1.0 - behind))
    I[axis_word(n)] &= ~AF1_GEAR_ACTIVATE
    gear_run(F, I, S, n, over, dt * behind)
    return True


def gear_halt(F: F64, I: I32, n: int) -> None:
    """Let go of the source at once and disarm: a kill or a limit."""
    I[axis_word(n)] &= ~(AF1_GEAR_ACTIVATE | RATIO_STATE)
    I[axis_word2(n)] &= ~(ON_FLAGS | OFF_FLAGS | AF2_GEAR_TRIGGER_STARTED)
    I[TGI_BASE + (n * TRIGGERS + GEAR_ON) * TGI_STRIDE + TGI_KIND] = DISARMED
    I[TGI_BASE + (n * TRIGGERS + GEAR_OFF) * TGI_STRIDE + TGI_KIND] = DISARMED
    F[GRF_BASE + n * GRF_STRIDE + GRF_RATIO_NOW] = 0.0


def gear_step(F: F64, I: I32, S: F32, n: int, dt: float) -> None:
    """The gear of axis n in one tick of `dt` seconds."""
    if I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST:
        gear_halt(F, I, n)
        return
    delta: float = F[SRF_BASE + (n * USES + USE_GEAR) * SRF_STRIDE + SRF_DELTA]
    on: int = I[TGI_BASE + (n * TRIGGERS + GEAR_ON) * TGI_STRIDE + TGI_KIND]
    off: int = I[TGI_BASE + (n * TRIGGERS + GEAR_OFF) * TGI_STRIDE + TGI_KIND]
    running: int = I[axis_word(n)] & (AF1_GEAR_ACTIVATE | AF1_GEAR_ACTIVE)
    if not running and on == DISARMED and off == DISARMED:
        return
    done: bool = False
    if on != DISARMED:
        done = gear_on_trigger(F, I, S, n, delta, dt)
    if off != DISARMED and not done:
        done = gear_off_trigger(F, I, S, n, delta, dt)
    if not done:
        gear_run(F, I, S, n, delta, dt)
    gear_show(F, I, n)
