"""Electronic gearing: the gear offset follows a source.

    gear offset += delta / GEAR PPU * ratio * PPU        [pulses]

The internal ratio r ramps linearly in time to RATIO with GEAR ACC and to 0 with GEAR DEC
(ratio units per second, 0 at once), through 0 where the sign changes. Within a tick the
mean of r over the tick counts, so a source of constant speed v gives exactly
v * ACC * t^2 / 2 during a ramp, at any tick length. What a ramp up has lost against the
full ratio is the gear slip.

A trigger splits its tick at the event: the gear counts only what the source does after it
(GEAR ON) or before it (GEAR OFF).
"""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.sources.source_cy import (
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
    trigger_step,
)
from openacr.map.rows import axes, gears, sources, triggers
from openacr.map.words import af1, af2, af4
from openacr.views import F32, F64, I32

__all__ = ["gear_ramp", "gear_step"]
__inlined__ = ["gear_run", "gear_step"]

ON_FLAGS = af2.GEAR_ON_TRIG_ARMED | af2.GEAR_ON_POSITION
OFF_FLAGS = af2.GEAR_OFF_ARMED | af2.GEAR_OFF_POSITION
EPS = 1e-9
RATIO_STATE = af1.GEAR_ACTIVE | af1.GEAR_AT_SPEED | af1.GEAR_STOPPING


def gear_ramp(F: F64, n: int, goal: float, dt_s: float, at_once: bool) -> float:
    """Ramp the internal ratio of axis n towards `goal` for `dt_s`; return its mean."""
    ratio: float = F[gears.ratio_now[n]]
    if at_once:
        ratio = goal
    if ratio == goal or dt_s <= 0.0:
        F[gears.ratio_now[n]] = ratio
        return ratio
    area_s: float = 0.0
    left_s: float = dt_s
    for _ in range(2):  # down to 0, then up on the other side
        stage: float = 0.0 if ratio * goal < 0.0 else goal
        rate_rps: float = F[gears.dec_rps[n]] if fabs(stage) < fabs(ratio) else F[gears.acc_rps[n]]
        if rate_rps > 0.0:
            needed_s: float = fabs(stage - ratio) / rate_rps
            if needed_s > left_s * (1.0 + EPS):
                rate_rps = rate_rps if stage > ratio else -rate_rps
                area_s += left_s * (ratio + rate_rps * left_s / 2.0)
                ratio += rate_rps * left_s
                left_s = 0.0
                break
            area_s += needed_s * (ratio + stage) / 2.0
            left_s = max(left_s - needed_s, 0.0)
        ratio = stage
        if ratio == goal:
            break
    F[gears.ratio_now[n]] = ratio
    return (area_s + left_s * ratio) / dt_s


def gear_slip(F: F64, S: F32, n: int, lost_cnt: float) -> None:
    """Add to Gear Slip, which any program may write."""
    if S[axes.gear_slip[n]] != F[gears.slip_shown_cnt[n]]:
        F[gears.slip_cnt[n]] = S[axes.gear_slip[n]]
    F[gears.slip_cnt[n]] += lost_cnt
    S[axes.gear_slip[n]] = F[gears.slip_cnt[n]]
    F[gears.slip_shown_cnt[n]] = S[axes.gear_slip[n]]


def gear_place(F: F64, I: I32, S: F32, n: int, moved_cnt: float) -> None:
    """Move the gear offset of axis n, never farther beyond GEAR MAX and MIN."""
    word: int = af2.word[n]
    flags: int = I[word] & ~(af2.GEAR_MAX | af2.GEAR_MIN)
    if not fabs(moved_cnt) < LARGEST_DELTA:
        return
    if F[gears.max_u[n]] > F[gears.min_u[n]]:
        scale: float = axis_scale(S, n)
        old_u: float = F[axes.gear_cnt[n]] / scale
        new_u: float = old_u + moved_cnt / scale
        if new_u >= F[gears.max_u[n]]:
            flags |= af2.GEAR_MAX
            new_u = min(new_u, max(old_u, F[gears.max_u[n]]))
            moved_cnt = (new_u - old_u) * scale
        elif new_u <= F[gears.min_u[n]]:
            flags |= af2.GEAR_MIN
            new_u = max(new_u, min(old_u, F[gears.min_u[n]]))
            moved_cnt = (new_u - old_u) * scale
    I[word] = flags
    F[axes.gear_cnt[n]] += moved_cnt


def gear_run(F: F64, I: I32, S: F32, n: int, delta_cnt: float, dt_s: float) -> None:
    """Let the gear of axis n follow `delta_cnt` source pulses that came within `dt_s`."""
    word: int = af1.word[n]
    on: bool = I[word] & af1.GEAR_ACTIVATE != 0
    goal: float = F[gears.ratio[n]] if on else 0.0
    mean: float = F[gears.ratio_now[n]]
    if mean != goal:
        mean = gear_ramp(F, n, goal, dt_s, I[word] & af1.GEAR_LOCK != 0)
    step_cnt: float = 0.0
    if F[gears.ppu[n]] != 0.0:
        step_cnt = delta_cnt / F[gears.ppu[n]] * axis_scale(S, n)
    if on and mean != goal and step_cnt != 0.0:
        gear_slip(F, S, n, (goal - mean) * step_cnt)
    gear_place(F, I, S, n, step_cnt * mean)


def gear_show(F: F64, I: I32, n: int) -> None:
    """Flags of the gear of axis n."""
    word: int = af1.word[n]
    flags: int = I[word] & ~RATIO_STATE
    if flags & af1.GEAR_ACTIVATE:
        flags |= af1.GEAR_ACTIVE
        if F[gears.ratio_now[n]] == F[gears.ratio[n]]:
            flags |= af1.GEAR_AT_SPEED
    else:
        I[af2.word[n]] &= ~af2.GEAR_TRIGGER_STARTED
        if F[gears.ratio_now[n]] != 0.0:
            flags |= af1.GEAR_ACTIVE | af1.GEAR_STOPPING
    I[word] = flags


def gear_remainder(F: F64, t: int, delta_cnt: float) -> float:
    """Part of the tick after the event of trigger t."""
    return F[triggers.over_cnt[t]] / delta_cnt if delta_cnt != 0.0 else 0.0


def gear_on_trigger(F: F64, I: I32, S: F32, n: int, delta_cnt: float, dt_s: float) -> bool:
    """Advance what GEAR ON waits for; True if the gear has started in this tick."""
    t: int = n * TRIGGERS + GEAR_ON
    captures: bool = I[triggers.kind[t]] >= CAPTURED
    offset_cnt: float = I[axes.gear_trigger_on_offset[n]]
    state: int = trigger_step(F, I, S, t, n * USES + USE_GEAR, offset_cnt)
    if state == WAITING:
        return False
    word: int = af2.word[n]
    I[word] &= ~ON_FLAGS
    if state == EXPIRED:
        return False
    if captures:
        I[word] |= af2.GEAR_TRIGGER_STARTED
    I[af1.word[n]] |= af1.GEAR_ACTIVATE
    over_cnt: float = F[triggers.over_cnt[t]]
    gear_run(F, I, S, n, over_cnt, dt_s * gear_remainder(F, t, delta_cnt))
    return True


def gear_off_trigger(F: F64, I: I32, S: F32, n: int, delta_cnt: float, dt_s: float) -> bool:
    """Advance what GEAR OFF waits for; True if it has come in this tick."""
    t: int = n * TRIGGERS + GEAR_OFF
    offset_cnt: float = I[axes.gear_trigger_off_offset[n]]
    state: int = trigger_step(F, I, S, t, n * USES + USE_GEAR, offset_cnt)
    if state != WAITING:
        I[af2.word[n]] &= ~OFF_FLAGS
    if state != FIRED:
        return False
    over_cnt: float = F[triggers.over_cnt[t]]
    remainder: float = gear_remainder(F, t, delta_cnt)
    gear_run(F, I, S, n, delta_cnt - over_cnt, dt_s * (1.0 - remainder))
    I[af1.word[n]] &= ~af1.GEAR_ACTIVATE
    gear_run(F, I, S, n, over_cnt, dt_s * remainder)
    return True


def gear_halt(F: F64, I: I32, n: int) -> None:
    """Let go of the source at once and disarm: a kill or a limit."""
    I[af1.word[n]] &= ~(af1.GEAR_ACTIVATE | RATIO_STATE)
    I[af2.word[n]] &= ~(ON_FLAGS | OFF_FLAGS | af2.GEAR_TRIGGER_STARTED)
    I[triggers.kind[n * TRIGGERS + GEAR_ON]] = DISARMED
    I[triggers.kind[n * TRIGGERS + GEAR_OFF]] = DISARMED
    F[gears.ratio_now[n]] = 0.0


def gear_step(F: F64, I: I32, S: F32, n: int, dt_s: float) -> None:
    """The gear of axis n in one tick of `dt_s` seconds."""
    if I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST:
        gear_halt(F, I, n)
        return
    delta_cnt: float = F[sources.delta[n * USES + USE_GEAR]]
    on: int = I[triggers.kind[n * TRIGGERS + GEAR_ON]]
    off: int = I[triggers.kind[n * TRIGGERS + GEAR_OFF]]
    running: int = I[af1.word[n]] & (af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE)
    if not running and on == DISARMED and off == DISARMED:
        return
    done: bool = False
    if on != DISARMED:
        done = gear_on_trigger(F, I, S, n, delta_cnt, dt_s)
    if off != DISARMED and not done:
        done = gear_off_trigger(F, I, S, n, delta_cnt, dt_s)
    if not done:
        gear_run(F, I, S, n, delta_cnt, dt_s)
    gear_show(F, I, n)
