"""Cams and ballscrew tables: outputs interpolated linearly in arrays of a program.

A table is a chain of segments. Segment k is `length_k` source pulses long and has an array
LA of m >= 2 equally spaced points, m - 1 intervals; the tables are read as they are in each
tick, so changed points act at once. With total length L and p = index + FLZ

    cycle c = floor(p / L),   u = p - c L,   y = points interpolated at u
    cam offset = base + y * SCALE + OFFSET * PPU + shift.

The index counts source pulses from 0 at CAM ON; `base` makes the offset begin where it was,
and takes up whatever somebody writes into the shown offset. A table whose last value
differs from its first is incremental: every cycle passed adds (last - first) * SCALE to the
shift, with the table and the scale of that moment.

A ballscrew table is not incremental and has no base; its index is the value of its source
(by default the primary setpoint of this tick), held at the ends of the table.

An array that no longer exists switches its user off.
"""

from openacr.cmath import fabs, floor
from openacr.kernel.axis_cy import axis_scale, axis_word
from openacr.kernel.source_cy import (
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
    axis_word2,
    source_shown,
    trigger_step,
)
from openacr.map.numbers import (
    AF1_BALLSCREW_ACTIVATE,
    AF1_CAM_ACTIVATE,
    AF2_CAM_TRIGGER_MODE,
    AF2_CAM_TRIGGER_STARTED,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AX_BASE,
    AX_CAM_CYCLES,
    AX_CAM_VELOCITY_SMOOTH,
    AX_STRIDE,
    AXF_BALLSCREW_CNT,
    AXF_BASE,
    AXF_CAM_CNT,
    AXF_CAM_SMOOTHING_CPS,
    AXF_STRIDE,
    CAF_BASE,
    CAF_BASE_CNT,
    CAF_CYCLE,
    CAF_INDEX_CNT,
    CAF_POFF_CNT,
    CAF_PON_CNT,
    CAF_STRIDE,
    CAF_SUM_CNT,
    CAF_WINDOW_CNT,
    CAI_BASE,
    CAI_POFF,
    CAI_PON,
    CAI_STRIDE,
    CAI_WINDOW_COUNT,
    CAI_WINDOW_INDEX,
    CAI_WINDOW_SIZE,
    HEAP_BYTE_BASE,
    HEAP_BYTES,
    SRF_BASE,
    SRF_DELTA,
    SRF_OLD,
    SRF_STRIDE,
    SRI_BASE,
    SRI_KIND,
    SRI_STRIDE,
    STI_BASE,
    STI_LA_BASE,
    STI_LA_COUNT,
    STI_STRIDE,
    TBF_BASE,
    TBF_FIRST_CNT,
    TBF_FLZ_CNT,
    TBF_LAST_CNT,
    TBF_LENGTH_CNT,
    TBF_OFFSET_U,
    TBF_SCALE,
    TBF_SHIFT_CNT,
    TBF_SHOWN_CNT,
    TBF_STRIDE,
    TBF_TOTAL_CNT,
    TBI_ARRAY,
    TBI_ARRAY_SIZE,
    TBI_BASE,
    TBI_PROGRAM,
    TBI_RUNNING,
    TBI_SEGMENTS,
    TBI_STRIDE,
    TGF_BASE,
    TGF_OVER_CNT,
    TGF_STRIDE,
    TGI_BASE,
    TGI_KIND,
    TGI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["array_header", "ballscrew_step", "cam_step", "table_ready", "table_value"]

HEAP_FIRST = HEAP_BYTE_BASE >> 2
HEAP_END = (HEAP_BYTE_BASE + HEAP_BYTES) >> 2
PROGRAMS = 16
BALLSCREW_TABLES = 16
MOST_SAMPLES = 64
EPS_CNT = 1e-9
NOT_PASSED = 1e300


# tables


def array_header(I: I32, program: int, row: int, array: int, words: int) -> int:
    """Index of the header (its length) of an array of a program; 0 if there is none.

    `row` is the storage row of the table of references (that of its count follows it),
    `words` the size of an element. Every index is checked: users may write them.
    """
    if not 0 <= program < PROGRAMS:
        return 0
    place: int = STI_BASE + program * STI_STRIDE + row
    if not 0 <= array < I[place + STI_LA_COUNT - STI_LA_BASE]:
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
    i: int = TBI_BASE + b * TBI_STRIDE
    array: int = I[i + TBI_ARRAY + k] - 1
    return array_header(I, I[i + TBI_PROGRAM + k], STI_LA_BASE, array, 1)


def table_ready(F: F64, I: I32, b: int) -> bool:
    """Whether table b is complete; finds its length, first and last value."""
    f: int = TBF_BASE + b * TBF_STRIDE
    segments: int = min(I[TBI_BASE + b * TBI_STRIDE + TBI_SEGMENTS], TBI_ARRAY_SIZE)
    total: float = 0.0
    for k in range(segments):
        header: int = segment_header(I, b, k)
        if header == 0 or I[header] < 2 or F[f + TBF_LENGTH_CNT + k] <= 0.0:
            return False
        if k == 0:
            F[f + TBF_FIRST_CNT] = I[header + 1]
        F[f + TBF_LAST_CNT] = I[header + I[header]]
        total += F[f + TBF_LENGTH_CNT + k]
    F[f + TBF_TOTAL_CNT] = total
    return total > 0.0


def table_value(F: F64, I: I32, b: int, u: float) -> float:
    """Table b, which is ready, at u source pulses from its begin; held beyond its ends."""
    f: int = TBF_BASE + b * TBF_STRIDE
    last: int = min(I[TBI_BASE + b * TBI_STRIDE + TBI_SEGMENTS], TBI_ARRAY_SIZE) - 1
    k: int = 0
    while k < last and u >= F[f + TBF_LENGTH_CNT + k]:
        u -= F[f + TBF_LENGTH_CNT + k]
        k += 1
    header: int = segment_header(I, b, k)
    intervals: int = I[header] - 1
    place: float = u * intervals / F[f + TBF_LENGTH_CNT + k]
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
    c: int = CAF_BASE + n * CAF_STRIDE
    f: int = TBF_BASE + n * TBF_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    total: float = F[f + TBF_TOTAL_CNT]
    index: float = F[c + CAF_INDEX_CNT] + F[f + TBF_FLZ_CNT]
    cycle: float = floor(index / total)
    if cycle != F[c + CAF_CYCLE]:
        gain: float = (F[f + TBF_LAST_CNT] - F[f + TBF_FIRST_CNT]) * F[f + TBF_SCALE]
        F[f + TBF_SHIFT_CNT] += (cycle - F[c + CAF_CYCLE]) * gain
        F[c + CAF_CYCLE] = cycle
    old: float = F[a + AXF_CAM_CNT]
    if old != F[f + TBF_SHOWN_CNT]:
        F[c + CAF_BASE_CNT] += old - F[f + TBF_SHOWN_CNT]
    offset: float = F[c + CAF_BASE_CNT] + cam_formula(F, I, S, n, index - cycle * total)
    F[a + AXF_CAM_CNT] = offset
    F[f + TBF_SHOWN_CNT] = offset
    cam_smooth(F, I, n, offset - old, rate_hz)


def cam_formula(F: F64, I: I32, S: F32, n: int, u: float) -> float:
    """What the table of axis n puts out at u, without base."""
    f: int = TBF_BASE + n * TBF_STRIDE
    value: float = table_value(F, I, n, u) * F[f + TBF_SCALE]
    return value + F[f + TBF_OFFSET_U] * axis_scale(S, n) + F[f + TBF_SHIFT_CNT]


def cam_smooth(F: F64, I: I32, n: int, moved: float, rate_hz: float) -> None:
    """The feed-forward sees the cam's speed averaged over CAM Velocity Smooth samples."""
    c: int = CAF_BASE + n * CAF_STRIDE
    i: int = CAI_BASE + n * CAI_STRIDE
    size: int = I[i + CAI_WINDOW_SIZE]
    place: int = I[i + CAI_WINDOW_INDEX]
    if I[i + CAI_WINDOW_COUNT] < size:
        I[i + CAI_WINDOW_COUNT] += 1
    else:
        F[c + CAF_SUM_CNT] -= F[c + CAF_WINDOW_CNT + place]
    F[c + CAF_SUM_CNT] += moved
    F[c + CAF_WINDOW_CNT + place] = moved
    I[i + CAI_WINDOW_INDEX] = 0 if place + 1 >= size else place + 1
    mean: float = F[c + CAF_SUM_CNT] / I[i + CAI_WINDOW_COUNT]
    F[AXF_BASE + n * AXF_STRIDE + AXF_CAM_SMOOTHING_CPS] = (mean - moved) * rate_hz


def cam_start(F: F64, I: I32, S: F32, n: int, index: float) -> None:
    """Engage the cam of axis n at an index, without a jump."""
    c: int = CAF_BASE + n * CAF_STRIDE
    f: int = TBF_BASE + n * TBF_STRIDE
    i: int = CAI_BASE + n * CAI_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    total: float = F[f + TBF_TOTAL_CNT]
    place: float = index + F[f + TBF_FLZ_CNT]
    F[c + CAF_INDEX_CNT] = index
    F[c + CAF_CYCLE] = floor(place / total)
    u: float = place - F[c + CAF_CYCLE] * total
    F[c + CAF_BASE_CNT] = F[a + AXF_CAM_CNT] - cam_formula(F, I, S, n, u)
    F[f + TBF_SHOWN_CNT] = F[a + AXF_CAM_CNT]
    F[c + CAF_SUM_CNT] = 0.0
    size: int = I[AX_BASE + n * AX_STRIDE + AX_CAM_VELOCITY_SMOOTH]
    I[i + CAI_WINDOW_SIZE] = max(1, min(size, MOST_SAMPLES))
    I[i + CAI_WINDOW_COUNT] = 0
    I[i + CAI_WINDOW_INDEX] = 0
    I[TBI_BASE + n * TBI_STRIDE + TBI_RUNNING] = 1
    I[axis_word(n)] |= AF1_CAM_ACTIVATE


def cam_stop(F: F64, I: I32, n: int) -> None:
    """Disengage the cam of axis n; its offset stays."""
    I[TBI_BASE + n * TBI_STRIDE + TBI_RUNNING] = 0
    I[CAI_BASE + n * CAI_STRIDE + CAI_POFF] = 0
    I[axis_word(n)] &= ~AF1_CAM_ACTIVATE
    I[axis_word2(n)] &= ~(AF2_CAM_TRIGGER_MODE | AF2_CAM_TRIGGER_STARTED)
    F[AXF_BASE + n * AXF_STRIDE + AXF_CAM_SMOOTHING_CPS] = 0.0


def cam_halt(F: F64, I: I32, n: int) -> None:
    """Stop and disarm: a kill or a limit."""
    cam_stop(F, I, n)
    I[CAI_BASE + n * CAI_STRIDE + CAI_PON] = 0
    I[TGI_BASE + (n * TRIGGERS + CAM_ON) * TGI_STRIDE + TGI_KIND] = DISARMED


def cam_passed(old: float, delta: float, position: float, total: float) -> float:
    """How far within `delta` from `old` the cam passes `position`, NOT_PASSED if it does not."""
    way: float = position - old
    way -= floor(way / total) * total
    if delta < 0.0:
        way -= total
    if way == 0.0:
        return NOT_PASSED
    return way if fabs(way) <= fabs(delta) else NOT_PASSED


def cam_run(F: F64, I: I32, S: F32, n: int, delta: float, rate_hz: float) -> None:
    """Follow `delta` source pulses; end at CAM CYCLES or where POFF says."""
    c: int = CAF_BASE + n * CAF_STRIDE
    f: int = TBF_BASE + n * TBF_STRIDE
    total: float = F[f + TBF_TOTAL_CNT]
    ends: bool = False
    if I[CAI_BASE + n * CAI_STRIDE + CAI_POFF]:
        old: float = F[c + CAF_INDEX_CNT] + F[f + TBF_FLZ_CNT]
        way: float = cam_passed(old, delta, F[c + CAF_POFF_CNT], total)
        if way != NOT_PASSED:
            delta = way
            ends = True
    F[c + CAF_INDEX_CNT] += delta
    limit: float = I[AX_BASE + n * AX_STRIDE + AX_CAM_CYCLES] * total
    if limit > 0.0 and fabs(F[c + CAF_INDEX_CNT]) >= limit - EPS_CNT:
        F[c + CAF_INDEX_CNT] = limit if F[c + CAF_INDEX_CNT] > 0.0 else -limit
        ends = True
    cam_place(F, I, S, n, rate_hz)
    if ends:
        cam_stop(F, I, n)


def cam_waiting(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> None:
    """A cam that is off: see whether its trigger or the position of PON has come."""
    t: int = n * TRIGGERS + CAM_ON
    c: int = CAF_BASE + n * CAF_STRIDE
    f: int = TBF_BASE + n * TBF_STRIDE
    tap: int = SRF_BASE + (n * USES + USE_CAM) * SRF_STRIDE
    delta: float = F[tap + SRF_DELTA]
    if I[TGI_BASE + t * TGI_STRIDE + TGI_KIND] != DISARMED:
        captures: bool = I[TGI_BASE + t * TGI_STRIDE + TGI_KIND] >= CAPTURED
        state: int = trigger_step(F, I, S, t, n * USES + USE_CAM, 0.0)
        if state == WAITING:
            return
        if state == EXPIRED:
            I[axis_word2(n)] &= ~AF2_CAM_TRIGGER_MODE
            return
        if captures:
            I[axis_word2(n)] |= AF2_CAM_TRIGGER_STARTED
        cam_start(F, I, S, n, 0.0)
        cam_run(F, I, S, n, F[TGF_BASE + t * TGF_STRIDE + TGF_OVER_CNT], rate_hz)
        return
    index: float = F[tap + SRF_OLD] - delta + F[f + TBF_FLZ_CNT]
    way: float = cam_passed(index, delta, F[c + CAF_PON_CNT], F[f + TBF_TOTAL_CNT])
    if way != NOT_PASSED:
        I[CAI_BASE + n * CAI_STRIDE + CAI_PON] = 0
        cam_start(F, I, S, n, F[c + CAF_PON_CNT] - F[f + TBF_FLZ_CNT])
        cam_run(F, I, S, n, delta - way, rate_hz)


def cam_step(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> None:
    """The cam of axis n in one tick."""
    running: int = I[TBI_BASE + n * TBI_STRIDE + TBI_RUNNING]
    wanted: int = I[axis_word(n)] & AF1_CAM_ACTIVATE
    armed: int = (
        I[TGI_BASE + (n * TRIGGERS + CAM_ON) * TGI_STRIDE + TGI_KIND]
        | I[CAI_BASE + n * CAI_STRIDE + CAI_PON]
    )
    if not running and not wanted and not armed:
        return
    if I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST or not table_ready(F, I, n):
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
    delta: float = F[SRF_BASE + (n * USES + USE_CAM) * SRF_STRIDE + SRF_DELTA]
    cam_run(F, I, S, n, delta, rate_hz)


# ballscrews


def ballscrew_step(F: F64, I: I32, S: F32, n: int, psp_cnt: float) -> None:
    """The ballscrew offset of axis n at a primary setpoint."""
    b: int = BALLSCREW_TABLES + n
    i: int = TBI_BASE + b * TBI_STRIDE
    f: int = TBF_BASE + b * TBF_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    if not I[axis_word(n)] & AF1_BALLSCREW_ACTIVATE:
        if I[i + TBI_RUNNING]:
            I[i + TBI_RUNNING] = 0
            F[a + AXF_BALLSCREW_CNT] = 0.0
        return
    if not table_ready(F, I, b):
        I[axis_word(n)] &= ~AF1_BALLSCREW_ACTIVATE
        I[i + TBI_RUNNING] = 0
        F[a + AXF_BALLSCREW_CNT] = 0.0
        return
    if I[i + TBI_RUNNING] and F[a + AXF_BALLSCREW_CNT] != F[f + TBF_SHOWN_CNT]:
        F[f + TBF_SHIFT_CNT] += F[a + AXF_BALLSCREW_CNT] - F[f + TBF_SHOWN_CNT]
    tap: int = n * USES + USE_BALLSCREW
    index: float = psp_cnt
    if I[SRI_BASE + tap * SRI_STRIDE + SRI_KIND] != FROM_SELF:
        index = source_shown(I, tap, F[SRF_BASE + tap * SRF_STRIDE + SRF_OLD])
    value: float = table_value(F, I, b, index + F[f + TBF_FLZ_CNT]) * F[f + TBF_SCALE]
    value += F[f + TBF_OFFSET_U] * axis_scale(S, n) + F[f + TBF_SHIFT_CNT]
    F[a + AXF_BALLSCREW_CNT] = value
    F[f + TBF_SHOWN_CNT] = value
    I[i + TBI_RUNNING] = 1


def ballscrew_halt(I: I32, n: int) -> None:
    """Stop a table for a kill: its offset stays, so that the setpoint does not step."""
    I[axis_word(n)] &= ~AF1_BALLSCREW_ACTIVATE
    I[TBI_BASE + (BALLSCREW_TABLES + n) * TBI_STRIDE + TBI_RUNNING] = 0
