"""Cams and ballscrew tables: outputs interpolated linearly in arrays of a program.

A table is a chain of segments. Segment k is `length_k` source pulses long and has an array
LA of m >= 2 equally spaced points, m - 1 intervals; the tables are read as they are in each
tick, so changed points act at once. With total length L and p = index + FLZ

    cycle c = floor(p / L),   u = p - c L,   y = points interpolated at u
    cam offset = base + y * SCALE + OFFSET * PPU + shift.

The index counts source pulses from 0 at CAM ON; `base` makes the offset begin where it was,
and adopts a value written into the shown offset. A table whose last value
differs from its first is incremental: every cycle passed adds (last - first) * SCALE to the
shift, with the table and the scale of that moment.

A ballscrew table is not incremental and has no base; its index is the value of its source
(by default the primary setpoint of this tick), held at the ends of the table.

An array that no longer exists switches its user off.
"""

from openacr.cmath import fabs, floor
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.sources.source_cy import (
    CAM_ON,
    CAPTURED,
    DISARMED,
    EXPIRED,
    FROM_SELF,
    TRIGGERS,
    USE_BALLSCREW,
    USE_CAM,
    USES,
    WAITING,
    source_shown,
    trigger_step,
)
from openacr.map.numbers import HEAP_BYTE_BASE, HEAP_BYTES
from openacr.map.rows import axes, cams, kernel, sources, storage, tables, triggers
from openacr.map.words import af1, af2, af4
from openacr.views import F32, F64, I32

__all__ = ["array_header", "ballscrew_step", "cam_step", "table_ready", "table_value"]
__inlined__ = ["cam_run", "cam_step", "table_value"]

# Tables of references to arrays of a program: each a place, then a count.
LONGS = 0
SINGLES = 2
DOUBLES = 4
HEAP_FIRST = HEAP_BYTE_BASE >> 2
HEAP_END = (HEAP_BYTE_BASE + HEAP_BYTES) >> 2
PROGRAMS = 16
BALLSCREW_TABLES = 16
MOST_SAMPLES = 64
EPS_CNT = 1e-9
NOT_PASSED = 1e300


# tables


def array_header(I: I32, program: int, table: int, array: int, words: int) -> int:
    """Index of the header (its length) of an array of a program; 0 if there is none.

    `table` says which of its tables of references (LONGS, SINGLES, DOUBLES) names the array,
    `words` the size of an element. Every index is checked: users may write them.
    """
    if not 0 <= program < PROGRAMS:
        return 0
    place: int = storage.la_base[program] + table
    if not 0 <= array < I[place + 1]:  # their count
        return 0
    reference: int = I[place] + array
    if not HEAP_FIRST <= reference < HEAP_END:
        return 0
    header: int = I[reference]
    if not HEAP_FIRST <= header < HEAP_END:
        return 0
    if I[header] < 1 or header + I[header] * words >= HEAP_END:
        return 0
    return header


def segment_header(I: I32, b: int, k: int) -> int:
    """Header of the points of segment k of table b, 0 if they do not exist."""
    array: int = I[tables.array[b] + k] - 1
    return array_header(I, I[tables.program[b] + k], LONGS, array, 1)


def table_ready(F: F64, I: I32, b: int) -> bool:
    """Whether table b is complete."""
    return table_found(F, I, b) != 0


def table_found(F: F64, I: I32, b: int) -> int:
    """Header of the last array of table b, with its length, first and last value.

    0 if the table is not complete. While nothing is written, a table remains what it was.
    """
    if I[tables.header[b]]:
        return I[tables.header[b]]
    found: int = table_search(F, I, b)
    if I[kernel.untouched]:
        I[tables.header[b]] = found
    return found


def table_search(F: F64, I: I32, b: int) -> int:
    """Look at all arrays of table b; see `table_found`."""
    segments: int = min(I[tables.segments[b]], tables.ARRAY_SIZE)
    total_cnt: float = 0.0
    header: int = 0
    for k in range(segments):
        header = segment_header(I, b, k)
        if header == 0 or I[header] < 2 or F[tables.length_cnt[b] + k] <= 0.0:
            return 0
        if k == 0:
            F[tables.first_cnt[b]] = I[header + 1]
        F[tables.last_cnt[b]] = I[header + I[header]]
        total_cnt += F[tables.length_cnt[b] + k]
    F[tables.total_cnt[b]] = total_cnt
    return header if total_cnt > 0.0 else 0


def tables_forget(I: I32) -> None:
    """Let all tables be looked at anew."""
    for b in range(tables.COUNT):
        I[tables.header[b]] = 0


def table_value(F: F64, I: I32, b: int, u_cnt: float) -> float:
    """Table b, which is ready, at u source pulses from its begin; held beyond its ends."""
    last: int = min(I[tables.segments[b]], tables.ARRAY_SIZE) - 1
    k: int = 0
    while k < last and u_cnt >= F[tables.length_cnt[b] + k]:
        u_cnt -= F[tables.length_cnt[b] + k]
        k += 1
    header: int = I[tables.header[b]]
    if header == 0 or k < last:
        header = segment_header(I, b, k)
    intervals: int = I[header] - 1
    place: float = u_cnt * intervals / F[tables.length_cnt[b] + k]
    place = max(0.0, min(place, float(intervals)))
    point: int = int(place)
    if point >= intervals:
        return I[header + 1 + intervals]
    low: float = I[header + 1 + point]
    high: float = I[header + 2 + point]
    return low + (high - low) * (place - point)


# cams


def cam_place(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> None:
    """Put the cam offset of axis n where the index is; count the cycles that were passed."""
    total_cnt: float = F[tables.total_cnt[n]]
    index_cnt: float = F[cams.index_cnt[n]] + F[tables.flz_cnt[n]]
    cycle: float = floor(index_cnt / total_cnt)
    if cycle != F[cams.cycle[n]]:
        gain_cnt: float = (F[tables.last_cnt[n]] - F[tables.first_cnt[n]]) * F[tables.scale[n]]
        F[tables.shift_cnt[n]] += (cycle - F[cams.cycle[n]]) * gain_cnt
        F[cams.cycle[n]] = cycle
    old_cnt: float = F[axes.cam_cnt[n]]
    if old_cnt != F[tables.shown_cnt[n]]:
        F[cams.base_cnt[n]] += old_cnt - F[tables.shown_cnt[n]]
    offset_cnt: float = F[cams.base_cnt[n]] + cam_formula(F, I, S, n, index_cnt - cycle * total_cnt)
    F[axes.cam_cnt[n]] = offset_cnt
    F[tables.shown_cnt[n]] = offset_cnt
    cam_smooth(F, I, n, offset_cnt - old_cnt, rate_hz)


def cam_formula(F: F64, I: I32, S: F32, n: int, u_cnt: float) -> float:
    """What the table of axis n puts out at u, without base."""
    value_cnt: float = table_value(F, I, n, u_cnt) * F[tables.scale[n]]
    return value_cnt + F[tables.offset_u[n]] * axis_scale(S, n) + F[tables.shift_cnt[n]]


def cam_smooth(F: F64, I: I32, n: int, moved_cnt: float, rate_hz: float) -> None:
    """The feed-forward sees the cam's speed averaged over CAM Velocity Smooth samples."""
    size: int = I[cams.window_size[n]]
    place: int = I[cams.window_index[n]]
    if size == 1:  # nothing to average
        I[cams.window_count[n]] = 1
        F[cams.sum_cnt[n]] = 0.0 + moved_cnt
        F[cams.window_cnt[n]] = moved_cnt
        I[cams.window_index[n]] = 0
        F[axes.cam_smoothing_cps[n]] = (F[cams.sum_cnt[n]] - moved_cnt) * rate_hz
        return
    if I[cams.window_count[n]] < size:
        I[cams.window_count[n]] += 1
    else:
        F[cams.sum_cnt[n]] -= F[cams.window_cnt[n] + place]
    F[cams.sum_cnt[n]] += moved_cnt
    F[cams.window_cnt[n] + place] = moved_cnt
    I[cams.window_index[n]] = 0 if place + 1 >= size else place + 1
    mean_cnt: float = F[cams.sum_cnt[n]] / I[cams.window_count[n]]
    F[axes.cam_smoothing_cps[n]] = (mean_cnt - moved_cnt) * rate_hz


def cam_start(F: F64, I: I32, S: F32, n: int, index_cnt: float) -> None:
    """Engage the cam of axis n at an index, without a jump."""
    total_cnt: float = F[tables.total_cnt[n]]
    place_cnt: float = index_cnt + F[tables.flz_cnt[n]]
    F[cams.index_cnt[n]] = index_cnt
    F[cams.cycle[n]] = floor(place_cnt / total_cnt)
    u_cnt: float = place_cnt - F[cams.cycle[n]] * total_cnt
    F[cams.base_cnt[n]] = F[axes.cam_cnt[n]] - cam_formula(F, I, S, n, u_cnt)
    F[tables.shown_cnt[n]] = F[axes.cam_cnt[n]]
    F[cams.sum_cnt[n]] = 0.0
    size: int = I[axes.cam_velocity_smooth[n]]
    I[cams.window_size[n]] = max(1, min(size, MOST_SAMPLES))
    I[cams.window_count[n]] = 0
    I[cams.window_index[n]] = 0
    I[tables.running[n]] = 1
    I[af1.word[n]] |= af1.CAM_ACTIVATE


def cam_stop(F: F64, I: I32, n: int) -> None:
    """Disengage the cam of axis n; its offset stays."""
    I[tables.running[n]] = 0
    I[cams.poff[n]] = 0
    I[af1.word[n]] &= ~af1.CAM_ACTIVATE
    I[af2.word[n]] &= ~(af2.CAM_TRIGGER_MODE | af2.CAM_TRIGGER_STARTED)
    F[axes.cam_smoothing_cps[n]] = 0.0


def cam_halt(F: F64, I: I32, n: int) -> None:
    """Stop and disarm: a kill or a limit."""
    cam_stop(F, I, n)
    I[cams.pon[n]] = 0
    I[triggers.kind[n * TRIGGERS + CAM_ON]] = DISARMED


def cam_passed(old_cnt: float, delta_cnt: float, position_cnt: float, total_cnt: float) -> float:
    """How far on the cam passes `position_cnt` within `delta_cnt` of `old_cnt`, or NOT_PASSED."""
    distance_cnt: float = position_cnt - old_cnt
    distance_cnt -= floor(distance_cnt / total_cnt) * total_cnt
    if delta_cnt < 0.0:
        distance_cnt -= total_cnt
    if distance_cnt == 0.0:
        return NOT_PASSED
    return distance_cnt if fabs(distance_cnt) <= fabs(delta_cnt) else NOT_PASSED


def cam_run(F: F64, I: I32, S: F32, n: int, delta_cnt: float, rate_hz: float) -> None:
    """Follow `delta_cnt` source pulses; end at CAM CYCLES or where POFF says."""
    total_cnt: float = F[tables.total_cnt[n]]
    ends: bool = False
    if I[cams.poff[n]]:
        old_cnt: float = F[cams.index_cnt[n]] + F[tables.flz_cnt[n]]
        distance_cnt: float = cam_passed(old_cnt, delta_cnt, F[cams.poff_cnt[n]], total_cnt)
        if distance_cnt != NOT_PASSED:
            delta_cnt = distance_cnt
            ends = True
    F[cams.index_cnt[n]] += delta_cnt
    limit_cnt: float = I[axes.cam_cycles[n]] * total_cnt
    if limit_cnt > 0.0 and fabs(F[cams.index_cnt[n]]) >= limit_cnt - EPS_CNT:
        F[cams.index_cnt[n]] = limit_cnt if F[cams.index_cnt[n]] > 0.0 else -limit_cnt
        ends = True
    cam_place(F, I, S, n, rate_hz)
    if ends:
        cam_stop(F, I, n)


def cam_waiting(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> None:
    """A cam that is off: see whether its trigger or the position of PON has come."""
    t: int = n * TRIGGERS + CAM_ON
    delta_cnt: float = F[sources.delta[n * USES + USE_CAM]]
    if I[triggers.kind[t]] != DISARMED:
        captures: bool = I[triggers.kind[t]] >= CAPTURED
        state: int = trigger_step(F, I, S, t, n * USES + USE_CAM, 0.0)
        if state == WAITING:
            return
        if state == EXPIRED:
            I[af2.word[n]] &= ~af2.CAM_TRIGGER_MODE
            return
        if captures:
            I[af2.word[n]] |= af2.CAM_TRIGGER_STARTED
        cam_start(F, I, S, n, 0.0)
        cam_run(F, I, S, n, F[triggers.over_cnt[t]], rate_hz)
        return
    index_cnt: float = F[sources.old[n * USES + USE_CAM]] - delta_cnt + F[tables.flz_cnt[n]]
    distance_cnt: float = cam_passed(
        index_cnt, delta_cnt, F[cams.pon_cnt[n]], F[tables.total_cnt[n]]
    )
    if distance_cnt != NOT_PASSED:
        I[cams.pon[n]] = 0
        cam_start(F, I, S, n, F[cams.pon_cnt[n]] - F[tables.flz_cnt[n]])
        cam_run(F, I, S, n, delta_cnt - distance_cnt, rate_hz)


def cam_step(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> None:
    """The cam of axis n in one tick."""
    running: int = I[tables.running[n]]
    wanted: int = I[af1.word[n]] & af1.CAM_ACTIVATE
    armed: int = I[triggers.kind[n * TRIGGERS + CAM_ON]] | I[cams.pon[n]]
    if not running and not wanted and not armed:
        return
    is_ready: bool = I[tables.header[n]] != 0 or table_ready(F, I, n)
    if I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST or not is_ready:
        cam_halt(F, I, n)
        return
    if not wanted:
        if running:
            cam_stop(F, I, n)
        if armed:
            cam_waiting(F, I, S, n, rate_hz)
        return
    if not running:
        cam_start(F, I, S, n, 0.0)
    delta_cnt: float = F[sources.delta[n * USES + USE_CAM]]
    cam_run(F, I, S, n, delta_cnt, rate_hz)


# ballscrews


def ballscrew_step(F: F64, I: I32, S: F32, n: int, psp_cnt: float) -> None:
    """The ballscrew offset of axis n at a primary setpoint."""
    b: int = BALLSCREW_TABLES + n
    if not I[af1.word[n]] & af1.BALLSCREW_ACTIVATE:
        if I[tables.running[b]]:
            I[tables.running[b]] = 0
            F[axes.ballscrew_cnt[n]] = 0.0
        return
    if not table_ready(F, I, b):
        I[af1.word[n]] &= ~af1.BALLSCREW_ACTIVATE
        I[tables.running[b]] = 0
        F[axes.ballscrew_cnt[n]] = 0.0
        return
    if I[tables.running[b]] and F[axes.ballscrew_cnt[n]] != F[tables.shown_cnt[b]]:
        F[tables.shift_cnt[b]] += F[axes.ballscrew_cnt[n]] - F[tables.shown_cnt[b]]
    tap: int = n * USES + USE_BALLSCREW
    index_cnt: float = psp_cnt
    if I[sources.kind[tap]] != FROM_SELF:
        index_cnt = source_shown(I, tap, F[sources.old[tap]])
    value_cnt: float = table_value(F, I, b, index_cnt + F[tables.flz_cnt[b]]) * F[tables.scale[b]]
    value_cnt += F[tables.offset_u[b]] * axis_scale(S, n) + F[tables.shift_cnt[b]]
    F[axes.ballscrew_cnt[n]] = value_cnt
    F[tables.shown_cnt[b]] = value_cnt
    I[tables.running[b]] = 1


def ballscrew_halt(I: I32, n: int) -> None:
    """Stop a table for a kill: its offset stays, so that the setpoint does not step."""
    I[af1.word[n]] &= ~af1.BALLSCREW_ACTIVATE
    I[tables.running[BALLSCREW_TABLES + n]] = 0
