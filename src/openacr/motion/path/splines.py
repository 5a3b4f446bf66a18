"""SPLINE: a smooth curve through points, one cubic between each two.

The knot of a point is the time of the move to it. The velocity at a point follows from its
neighbours, and Spline Buffer Length says how many are looked at:

    2  none: straight lines
    3  (p[i] - p[i-1]) / t[i]
    4  (p[i+1] - p[i-1]) / (t[i+1] + t[i])
    5  (p[i-2] - 8 p[i-1] + 8 p[i+1] - p[i+2]) / 12 t, with equal times; else as 4

So the motion is that many points less two after the input. At both ends of the curve the
velocity is 0. It begins where the axes are; a first point there is no further one.
"""

from openacr.map.rows import masters
from openacr.map.words import mf3
from openacr.motion.card import Card
from openacr.motion.path import bezier, curve_moves, curve_points
from openacr.motion.path.bezier import Bezier
from openacr.motion.path.curve_points import CurvePoints

SHORTEST, LONGEST = 2, 5


def take(
    card: Card, program: int, master: int, values_cnt: dict[int, float], time_s: float
) -> None:
    """Take a point, reached in a time from the one before, and go as far as is known."""
    curve = curve_points.load(card, master)
    if not curve.points:
        curve = CurvePoints(
            points=[curve_moves.base_point(card, master)], weights=[1.0], knots=[0.0]
        )
    point = list(curve.points[-1])
    for slave, value in values_cnt.items():
        point[slave] = value
        curve.slaves |= 1 << slave
    if point != curve.points[0] or len(curve.points) > 1:  # else it is the start itself
        curve.points.append(point)
        curve.weights.append(1.0)
        curve.knots.append(time_s)
    card.memory.I[mf3.word[master]] |= mf3.SPLINE_DATA_AVAIL
    _follow(card, program, master, curve, _length(card, master) - 2, ends=False)
    curve_points.store(card, master, curve)


def finish(card: Card, program: int, master: int) -> None:
    """Go to the last point."""
    curve = curve_points.load(card, master)
    if curve.points:
        _follow(card, program, master, curve, 0, ends=True)
        curve_points.store(card, master, CurvePoints())


def _length(card: Card, master: int) -> int:
    """Spline Buffer Length; whatever else was written counts as the nearest."""
    value = card.memory.S[masters.spline_buffer_length[master]]
    if not value < LONGEST:
        return LONGEST
    return max(int(value), SHORTEST)


def _follow(
    card: Card, program: int, master: int, curve: CurvePoints, lag: int, *, ends: bool
) -> None:
    """Hand over all moves whose velocities are known."""
    length = _length(card, master)
    while curve.points_before + 1 + lag < len(curve.points):
        end = curve.points_before + 1
        is_last = ends and end == len(curve.points) - 1
        arrive = [0.0] * len(curve.tangent) if is_last else _velocity(curve, end, length)
        _piece(card, program, master, curve, arrive, straight=length == SHORTEST, ends=is_last)
        curve.tangent = arrive
        curve.points_before = end
        _forget(curve)


def _forget(curve: CurvePoints) -> None:
    """One point before the next piece is enough for its velocities."""
    for _ in range(curve.points_before - 1):
        for row in (curve.points, curve.weights, curve.knots):
            row.pop(0)
        curve.points_before -= 1


def _velocity(curve: CurvePoints, at: int, length: int) -> list[float]:
    points, times = curve.points, curve.knots
    before, here = points[at - 1], points[at]
    if length <= SHORTEST + 1 or at + 1 >= len(points):
        return [(b - a) / times[at] for a, b in zip(before, here, strict=True)]
    after = points[at + 1]
    if length == LONGEST and 2 <= at < len(points) - 2 and len(set(times[at - 1 : at + 3])) == 1:
        step = 12.0 * times[at]
        return [
            (a - 8.0 * b + 8.0 * c - d) / step
            for a, b, c, d in zip(points[at - 2], before, after, points[at + 2], strict=True)
        ]
    both = times[at] + times[at + 1]
    return [(b - a) / both for a, b in zip(before, after, strict=True)]


def _piece(
    card: Card,
    program: int,
    master: int,
    curve: CurvePoints,
    arrive: list[float],
    *,
    straight: bool,
    ends: bool,
) -> None:
    numbers, at = curve.numbers, curve.points_before
    start, end, leave, arrive = (
        [vector[s] for s in numbers]
        for vector in (curve.points[at], curve.points[at + 1], curve.tangent, arrive)
    )
    time_s = curve.knots[at + 1]
    curve_piece = (
        bezier.line(start, end) if straight else bezier.hermite(start, end, leave, arrive, time_s)
    )
    _send(card, program, master, curve, curve_piece, time_s, ends=ends)


def _send(
    card: Card,
    program: int,
    master: int,
    curve: CurvePoints,
    curve_piece: Bezier,
    time_s: float,
    *,
    ends: bool,
) -> None:
    is_timed = bool(card.memory.I[mf3.word[master]] & mf3.SPLINE_TIME_MODE)
    if not is_timed and curve_piece.is_point:
        return
    pace = curve_moves.Pace(rate=float(is_timed), begins=not curve.is_open, ends=ends)
    curve_moves.hand_over(card, program, master, curve.numbers, curve_piece, time_s, pace)
    curve.is_open = True
    card.memory.I[mf3.word[master]] |= mf3.SPLINE_LOADED
