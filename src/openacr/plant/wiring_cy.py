"""Switches, regions of space, markers and outputs: what drives the inputs of the card.

Switches and markers are evaluated only when a motor passes the border of one. Edges are
recorded with the fraction of the tick at which they occurred, so that a position capture is
exact to the count at any speed.
"""

from openacr.cmath import floor
from openacr.map.numbers import (
    PLF_BASE,
    PLF_MARKER_FALL_CNT,
    PLF_MARKER_FALL_FRACTION,
    PLF_MARKER_PHASE_CNT,
    PLF_MARKER_PITCH_CNT,
    PLF_MARKER_RISE_CNT,
    PLF_MARKER_RISE_FRACTION,
    PLF_POSITION_CNT,
    PLF_PREVIOUS_CNT,
    PLF_QUIET_HIGH_CNT,
    PLF_QUIET_LOW_CNT,
    PLF_STRIDE,
    PLGF_BASE,
    PLGF_FALL_FRACTION,
    PLGF_RISE_FRACTION,
    PLGI_BASE,
    PLGI_FALLS,
    PLGI_FOLLOWS,
    PLGI_RISES,
    PLGI_WIRES,
    PLGI_WORDS,
    PLI_BASE,
    PLI_MARKER,
    PLI_MARKER_EDGES,
    PLI_STRIDE,
    PLNI_BASE,
    PLNI_LEVEL,
    PLNI_STRIDE,
    PLNI_STUCK,
    PLNI_STUCK_LEVEL,
    PLNI_WIRED,
    PLNI_WORD,
    PLWF_BASE,
    PLWF_DELAY_S,
    PLWF_HIGH_CNT,
    PLWF_LOW_CNT,
    PLWF_STRIDE,
    PLWF_WAITED_S,
    PLWI_ACTIVE,
    PLWI_AXIS,
    PLWI_BASE,
    PLWI_BIT,
    PLWI_CLOSED,
    PLWI_MASK,
    PLWI_MORE,
    PLWI_OUTPUT_MASK,
    PLWI_OUTPUT_WORD,
    PLWI_SLOT,
    PLWI_STRIDE,
)
from openacr.views import F64, I32

MARKER_RISE = 1
MARKER_FALL = 2
NO_BORDER_CNT = 1e18


def motor_borders(F: F64, I: I32, n: int) -> None:
    """Find the nearest borders on both sides of motor n, and whether the marker is present.

    As long as the motor stays between them nothing can change, so the step checks only these
    two; a border belongs to the range above it.
    """
    f: int = PLF_BASE + n * PLF_STRIDE
    w: int = 0
    at: float = F[f + PLF_POSITION_CNT]
    F[f + PLF_QUIET_LOW_CNT] = -NO_BORDER_CNT
    F[f + PLF_QUIET_HIGH_CNT] = NO_BORDER_CNT
    for w in range(I[PLGI_BASE + PLGI_FOLLOWS], I[PLGI_BASE + PLGI_WIRES]):
        if I[PLWI_BASE + w * PLWI_STRIDE + PLWI_AXIS] == n:
            _narrow_quiet(F, f, at, F[PLWF_BASE + w * PLWF_STRIDE + PLWF_LOW_CNT])
            _narrow_quiet(F, f, at, F[PLWF_BASE + w * PLWF_STRIDE + PLWF_HIGH_CNT])
    if F[f + PLF_MARKER_PITCH_CNT] > 0.0:
        mark: float = _marker_below(F, f, at, 0.0)
        _narrow_quiet(F, f, at, mark)
        _narrow_quiet(F, f, at, mark + 1.0)
        _narrow_quiet(F, f, at, mark + F[f + PLF_MARKER_PITCH_CNT])
        I[PLI_BASE + n * PLI_STRIDE + PLI_MARKER] = 1 if at < mark + 1.0 else 0


def _narrow_quiet(F: F64, f: int, at: float, border: float) -> None:
    if border <= at:
        if border > F[f + PLF_QUIET_LOW_CNT]:
            F[f + PLF_QUIET_LOW_CNT] = border
    elif border < F[f + PLF_QUIET_HIGH_CNT]:
        F[f + PLF_QUIET_HIGH_CNT] = border


def _marker_below(F: F64, f: int, at: float, shift: float) -> float:
    """Highest start of a marker, moved by `shift` counts, that is not above `at`."""
    pitch: float = F[f + PLF_MARKER_PITCH_CNT]
    phase: float = F[f + PLF_MARKER_PHASE_CNT] + shift
    return phase + floor((at - phase) / pitch) * pitch


def marker_edges(F: F64, I: I32, f: int, i: int) -> None:
    """Record the first edges of the marker within the tick, with the count just after them.

    The marker is present during one count, between a start and start + 1. Moving up it rises
    at a start and falls one count later; moving down it rises at start + 1 and falls at start.
    """
    if F[f + PLF_MARKER_PITCH_CNT] <= 0.0:
        return
    old: float = F[f + PLF_PREVIOUS_CNT]
    travel: float = F[f + PLF_POSITION_CNT] - old
    rise: float = 0.0
    fall: float = 0.0
    if travel > 0.0:
        rise = _marker_below(F, f, old, 0.0) + F[f + PLF_MARKER_PITCH_CNT]
        fall = _marker_below(F, f, old, 1.0) + F[f + PLF_MARKER_PITCH_CNT]
        F[f + PLF_MARKER_RISE_CNT] = rise
        F[f + PLF_MARKER_FALL_CNT] = fall
    elif travel < 0.0:
        rise = _marker_below(F, f, old, 1.0)
        fall = _marker_below(F, f, old, 0.0)
        F[f + PLF_MARKER_RISE_CNT] = rise - 1.0
        F[f + PLF_MARKER_FALL_CNT] = fall - 1.0
    else:
        return
    F[f + PLF_MARKER_RISE_FRACTION] = (rise - old) / travel
    F[f + PLF_MARKER_FALL_FRACTION] = (fall - old) / travel
    if _border_passed(old, F[f + PLF_POSITION_CNT], rise) != 0:
        I[i + PLI_MARKER_EDGES] |= MARKER_RISE
    if _border_passed(old, F[f + PLF_POSITION_CNT], fall) != 0:
        I[i + PLI_MARKER_EDGES] |= MARKER_FALL


def _border_passed(old: float, new: float, border: float) -> int:
    """1 if the border is between two positions; it belongs to the range above it."""
    if (old < border) != (new < border):
        return 1
    return 0


def read_boxes(F: F64, I: I32) -> None:
    """Find which boxes the motors entered or left, and when within the tick.

    During one tick the motors move on a straight line. Each side of a box holds during one
    interval of that line, the box during the intersection of these intervals (the method of
    Liang and Barsky), so a box that is crossed within a single tick shows both its edges.
    """
    w: int = I[PLGI_BASE + PLGI_FOLLOWS]
    head: int = 0
    inside: int = 0
    enter: float = 0.0
    leave: float = 0.0
    while w < I[PLGI_BASE + PLGI_WIRES]:
        head = w
        inside = _side_holds(F, I, w)
        enter = _side_enters(F, I, w)
        leave = _side_leaves(F, I, w)
        while I[PLWI_BASE + w * PLWI_STRIDE + PLWI_MORE] != 0:
            w += 1
            inside &= _side_holds(F, I, w)
            enter = max(enter, _side_enters(F, I, w))
            leave = min(leave, _side_leaves(F, I, w))
        _box_edges(F, I, head, inside, enter, leave)
        w += 1


def _side_holds(F: F64, I: I32, w: int) -> int:
    at: float = F[_motor_of_side(I, w) + PLF_POSITION_CNT]
    if F[PLWF_BASE + w * PLWF_STRIDE + PLWF_LOW_CNT] <= at:
        if at < F[PLWF_BASE + w * PLWF_STRIDE + PLWF_HIGH_CNT]:
            return 1
    return 0


def _motor_of_side(I: I32, w: int) -> int:
    return PLF_BASE + I[PLWI_BASE + w * PLWI_STRIDE + PLWI_AXIS] * PLF_STRIDE


def _side_enters(F: F64, I: I32, w: int) -> float:
    """Fraction of the tick at which the motor comes between the two sides; 2 for never."""
    f: int = _motor_of_side(I, w)
    travel: float = F[f + PLF_POSITION_CNT] - F[f + PLF_PREVIOUS_CNT]
    if travel > 0.0:
        return (F[PLWF_BASE + w * PLWF_STRIDE + PLWF_LOW_CNT] - F[f + PLF_PREVIOUS_CNT]) / travel
    if travel < 0.0:
        return (F[PLWF_BASE + w * PLWF_STRIDE + PLWF_HIGH_CNT] - F[f + PLF_PREVIOUS_CNT]) / travel
    return 0.0 if _side_holds(F, I, w) != 0 else 2.0


def _side_leaves(F: F64, I: I32, w: int) -> float:
    """Fraction of the tick at which the motor is no longer between the two sides."""
    f: int = _motor_of_side(I, w)
    travel: float = F[f + PLF_POSITION_CNT] - F[f + PLF_PREVIOUS_CNT]
    if travel > 0.0:
        return (F[PLWF_BASE + w * PLWF_STRIDE + PLWF_HIGH_CNT] - F[f + PLF_PREVIOUS_CNT]) / travel
    if travel < 0.0:
        return (F[PLWF_BASE + w * PLWF_STRIDE + PLWF_LOW_CNT] - F[f + PLF_PREVIOUS_CNT]) / travel
    return 1.0


def _box_edges(F: F64, I: I32, w: int, inside: int, enter: float, leave: float) -> None:
    was: int = I[PLWI_BASE + w * PLWI_STRIDE + PLWI_ACTIVE]
    if inside != 0 and was == 0:
        _wire_edge(F, I, w, 1, enter)
    elif inside == 0 and was != 0:
        _wire_edge(F, I, w, 0, leave)
    elif inside == 0 and enter >= 0.0 and enter < leave and leave <= 1.0:
        _wire_edge(F, I, w, 1, enter)
        _wire_edge(F, I, w, 0, leave)


def _wire_edge(F: F64, I: I32, w: int, active: int, fraction: float) -> None:
    """Record the new level of the input a wire drives and, for onboard inputs, the moment."""
    r: int = PLWI_BASE + w * PLWI_STRIDE
    slot: int = PLNI_BASE + I[r + PLWI_SLOT] * PLNI_STRIDE
    level: int = slot + PLNI_LEVEL
    on: int = active ^ I[r + PLWI_CLOSED]
    I[r + PLWI_ACTIVE] = active
    if on != 0:
        I[level] |= I[r + PLWI_MASK]
    else:
        I[level] &= ~I[r + PLWI_MASK]
    if I[r + PLWI_SLOT] != 0 or (I[slot + PLNI_STUCK] & I[r + PLWI_MASK]) != 0:
        return
    if on != 0:
        I[PLGI_BASE + PLGI_RISES] |= I[r + PLWI_MASK]
        F[PLGF_BASE + PLGF_RISE_FRACTION + I[r + PLWI_BIT]] = min(max(fraction, 0.0), 1.0)
    else:
        I[PLGI_BASE + PLGI_FALLS] |= I[r + PLWI_MASK]
        F[PLGF_BASE + PLGF_FALL_FRACTION + I[r + PLWI_BIT]] = min(max(fraction, 0.0), 1.0)


def follow_outputs(F: F64, I: I32, dt: float) -> None:
    """Give inputs wired to outputs the level that has lasted for the delay."""
    w: int = 0
    r: int = 0
    f: int = 0
    on: int = 0
    for w in range(I[PLGI_BASE + PLGI_FOLLOWS]):
        r = PLWI_BASE + w * PLWI_STRIDE
        f = PLWF_BASE + w * PLWF_STRIDE
        on = 1 if (I[I[r + PLWI_OUTPUT_WORD]] & I[r + PLWI_OUTPUT_MASK]) != 0 else 0
        if on == I[r + PLWI_ACTIVE]:
            F[f + PLWF_WAITED_S] = 0.0
        else:
            F[f + PLWF_WAITED_S] += dt
            if F[f + PLWF_WAITED_S] >= F[f + PLWF_DELAY_S]:
                _wire_edge(F, I, w, on, 1.0)


def write_wired_inputs(I: I32) -> None:
    """Set wired inputs from their wires or forced levels; other inputs are not changed."""
    k: int = 0
    r: int = 0
    word: int = 0
    level: int = 0
    for k in range(I[PLGI_BASE + PLGI_WORDS]):
        r = PLNI_BASE + k * PLNI_STRIDE
        word = I[r + PLNI_WORD]
        level = (I[r + PLNI_LEVEL] & ~I[r + PLNI_STUCK]) | I[r + PLNI_STUCK_LEVEL]
        I[word] = (I[word] & ~I[r + PLNI_WIRED]) | level
