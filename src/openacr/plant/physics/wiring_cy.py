"""Switches, regions of space, markers and outputs: what drives the inputs of the card.

Switches and markers are evaluated only when a motor passes the border of one. Edges are
recorded with the fraction of the tick at which they occurred, so that a position capture is
exact to the count at any speed.
"""

from openacr.cmath import floor
from openacr.map import numbers as at
from openacr.map.rows import plant
from openacr.views import F64, I32

MARKER_RISE = 1
MARKER_FALL = 2
NO_BORDER_CNT = 1e18


def motor_borders(F: F64, I: I32, n: int) -> None:
    """Find the nearest borders on both sides of motor n, and whether the marker is present.

    As long as the motor stays between them nothing can change, so the step checks only these
    two; a border belongs to the range above it.
    """
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    w: int = 0
    here_cnt: float = F[f + at.PLF_POSITION_CNT]
    F[f + at.PLF_QUIET_LOW_CNT] = -NO_BORDER_CNT
    F[f + at.PLF_QUIET_HIGH_CNT] = NO_BORDER_CNT
    for w in range(I[plant.follows], I[plant.wires]):
        if I[at.PLWI_BASE + w * at.PLWI_STRIDE + at.PLWI_AXIS] == n:
            _narrow_quiet(F, f, here_cnt, F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_LOW_CNT])
            _narrow_quiet(F, f, here_cnt, F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_HIGH_CNT])
    if F[f + at.PLF_MARKER_PITCH_CNT] > 0.0:
        mark: float = _marker_below(F, f, here_cnt, 0.0)
        _narrow_quiet(F, f, here_cnt, mark)
        _narrow_quiet(F, f, here_cnt, mark + 1.0)
        _narrow_quiet(F, f, here_cnt, mark + F[f + at.PLF_MARKER_PITCH_CNT])
        I[at.PLI_BASE + n * at.PLI_STRIDE + at.PLI_MARKER] = 1 if here_cnt < mark + 1.0 else 0


def _narrow_quiet(F: F64, f: int, here_cnt: float, border: float) -> None:
    if border <= here_cnt:
        if border > F[f + at.PLF_QUIET_LOW_CNT]:
            F[f + at.PLF_QUIET_LOW_CNT] = border
    elif border < F[f + at.PLF_QUIET_HIGH_CNT]:
        F[f + at.PLF_QUIET_HIGH_CNT] = border


def _marker_below(F: F64, f: int, here_cnt: float, shift: float) -> float:
    """Highest start of a marker, moved by `shift` counts, that is not above `at`."""
    pitch: float = F[f + at.PLF_MARKER_PITCH_CNT]
    phase: float = F[f + at.PLF_MARKER_PHASE_CNT] + shift
    return phase + floor((here_cnt - phase) / pitch) * pitch


def marker_edges(F: F64, I: I32, f: int, i: int) -> None:
    """Record the first edges of the marker within the tick, with the count just after them.

    The marker is present during one count, between a start and start + 1. Moving up it rises
    at a start and falls one count later; moving down it rises at start + 1 and falls at start.
    """
    if F[f + at.PLF_MARKER_PITCH_CNT] <= 0.0:
        return
    old: float = F[f + at.PLF_PREVIOUS_CNT]
    travel: float = F[f + at.PLF_POSITION_CNT] - old
    rise: float = 0.0
    fall: float = 0.0
    if travel > 0.0:
        rise = _marker_below(F, f, old, 0.0) + F[f + at.PLF_MARKER_PITCH_CNT]
        fall = _marker_below(F, f, old, 1.0) + F[f + at.PLF_MARKER_PITCH_CNT]
        F[f + at.PLF_MARKER_RISE_CNT] = rise
        F[f + at.PLF_MARKER_FALL_CNT] = fall
    elif travel < 0.0:
        rise = _marker_below(F, f, old, 1.0)
        fall = _marker_below(F, f, old, 0.0)
        F[f + at.PLF_MARKER_RISE_CNT] = rise - 1.0
        F[f + at.PLF_MARKER_FALL_CNT] = fall - 1.0
    else:
        return
    F[f + at.PLF_MARKER_RISE_FRACTION] = (rise - old) / travel
    F[f + at.PLF_MARKER_FALL_FRACTION] = (fall - old) / travel
    if _border_passed(old, F[f + at.PLF_POSITION_CNT], rise) != 0:
        I[i + at.PLI_MARKER_EDGES] |= MARKER_RISE
    if _border_passed(old, F[f + at.PLF_POSITION_CNT], fall) != 0:
        I[i + at.PLI_MARKER_EDGES] |= MARKER_FALL


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
    w: int = I[plant.follows]
    head: int = 0
    inside: int = 0
    enter: float = 0.0
    leave: float = 0.0
    while w < I[plant.wires]:
        head = w
        inside = _side_holds(F, I, w)
        enter = _side_enters(F, I, w)
        leave = _side_leaves(F, I, w)
        while I[at.PLWI_BASE + w * at.PLWI_STRIDE + at.PLWI_MORE] != 0:
            w += 1
            inside &= _side_holds(F, I, w)
            enter = max(enter, _side_enters(F, I, w))
            leave = min(leave, _side_leaves(F, I, w))
        _box_edges(F, I, head, inside, enter, leave)
        w += 1


def _side_holds(F: F64, I: I32, w: int) -> int:
    here_cnt: float = F[_motor_of_side(I, w) + at.PLF_POSITION_CNT]
    if F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_LOW_CNT] <= here_cnt:
        if here_cnt < F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_HIGH_CNT]:
            return 1
    return 0


def _motor_of_side(I: I32, w: int) -> int:
    return at.PLF_BASE + I[at.PLWI_BASE + w * at.PLWI_STRIDE + at.PLWI_AXIS] * at.PLF_STRIDE


def _side_enters(F: F64, I: I32, w: int) -> float:
    """Fraction of the tick at which the motor comes between the two sides; 2 for never."""
    f: int = _motor_of_side(I, w)
    travel: float = F[f + at.PLF_POSITION_CNT] - F[f + at.PLF_PREVIOUS_CNT]
    if travel > 0.0:
        return (
            F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_LOW_CNT] - F[f + at.PLF_PREVIOUS_CNT]
        ) / travel
    if travel < 0.0:
        return (
            F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_HIGH_CNT] - F[f + at.PLF_PREVIOUS_CNT]
        ) / travel
    return 0.0 if _side_holds(F, I, w) != 0 else 2.0


def _side_leaves(F: F64, I: I32, w: int) -> float:
    """Fraction of the tick at which the motor is no longer between the two sides."""
    f: int = _motor_of_side(I, w)
    travel: float = F[f + at.PLF_POSITION_CNT] - F[f + at.PLF_PREVIOUS_CNT]
    if travel > 0.0:
        return (
            F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_HIGH_CNT] - F[f + at.PLF_PREVIOUS_CNT]
        ) / travel
    if travel < 0.0:
        return (
            F[at.PLWF_BASE + w * at.PLWF_STRIDE + at.PLWF_LOW_CNT] - F[f + at.PLF_PREVIOUS_CNT]
        ) / travel
    return 1.0


def _box_edges(F: F64, I: I32, w: int, inside: int, enter: float, leave: float) -> None:
    was: int = I[at.PLWI_BASE + w * at.PLWI_STRIDE + at.PLWI_ACTIVE]
    if inside != 0 and was == 0:
        _wire_edge(F, I, w, 1, enter)
    elif inside == 0 and was != 0:
        _wire_edge(F, I, w, 0, leave)
    elif inside == 0 and enter >= 0.0 and enter < leave and leave <= 1.0:
        _wire_edge(F, I, w, 1, enter)
        _wire_edge(F, I, w, 0, leave)


def _wire_edge(F: F64, I: I32, w: int, active: int, fraction: float) -> None:
    """Record the new level of the input a wire drives and, for onboard inputs, the moment."""
    r: int = at.PLWI_BASE + w * at.PLWI_STRIDE
    slot: int = at.PLNI_BASE + I[r + at.PLWI_SLOT] * at.PLNI_STRIDE
    level: int = slot + at.PLNI_LEVEL
    on: int = active ^ I[r + at.PLWI_CLOSED]
    I[r + at.PLWI_ACTIVE] = active
    if on != 0:
        I[level] |= I[r + at.PLWI_MASK]
    else:
        I[level] &= ~I[r + at.PLWI_MASK]
    if I[r + at.PLWI_SLOT] != 0 or (I[slot + at.PLNI_STUCK] & I[r + at.PLWI_MASK]) != 0:
        return
    if on != 0:
        I[plant.rises] |= I[r + at.PLWI_MASK]
        F[plant.rise_fraction + I[r + at.PLWI_BIT]] = min(max(fraction, 0.0), 1.0)
    else:
        I[plant.falls] |= I[r + at.PLWI_MASK]
        F[plant.fall_fraction + I[r + at.PLWI_BIT]] = min(max(fraction, 0.0), 1.0)


def follow_outputs(F: F64, I: I32, dt: float) -> None:
    """Give inputs wired to outputs the level that has lasted for the delay."""
    w: int = 0
    r: int = 0
    f: int = 0
    on: int = 0
    for w in range(I[plant.follows]):
        r = at.PLWI_BASE + w * at.PLWI_STRIDE
        f = at.PLWF_BASE + w * at.PLWF_STRIDE
        on = 1 if (I[I[r + at.PLWI_OUTPUT_WORD]] & I[r + at.PLWI_OUTPUT_MASK]) != 0 else 0
        if on == I[r + at.PLWI_ACTIVE]:
            F[f + at.PLWF_WAITED_S] = 0.0
        else:
            F[f + at.PLWF_WAITED_S] += dt
            if F[f + at.PLWF_WAITED_S] >= F[f + at.PLWF_DELAY_S]:
                _wire_edge(F, I, w, on, 1.0)


def write_wired_inputs(I: I32) -> None:
    """Set wired inputs from their wires or forced levels; other inputs are not changed."""
    k: int = 0
    r: int = 0
    word: int = 0
    level: int = 0
    for k in range(I[plant.words]):
        r = at.PLNI_BASE + k * at.PLNI_STRIDE
        word = I[r + at.PLNI_WORD]
        level = (I[r + at.PLNI_LEVEL] & ~I[r + at.PLNI_STUCK]) | I[r + at.PLNI_STUCK_LEVEL]
        I[word] = (I[word] & ~I[r + at.PLNI_WIRED]) | level
