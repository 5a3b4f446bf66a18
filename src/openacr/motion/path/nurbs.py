"""NURB: rational B-splines of order RANK from control points, knots and weights.

Knot i belongs to point i, and RANK more follow the last point. The curve runs from knot
RANK - 1 to the knot after that of the last point; the span from knot j to j + 1 needs the
knots up to j + RANK - 1, so the motion is RANK - 1 points after the input.
"""

from itertools import pairwise

from openacr.errors import CardError
from openacr.map.rows import masters
from openacr.map.words import mf3
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.motion.path import bezier, curve_moves, curve_points
from openacr.motion.path.bezier import Bezier
from openacr.motion.path.curve_points import CurvePoints

STEP = 1.0  # between knots that are not given
FASTEST = 1e6


def take(
    card: Card,
    program: int,
    master: int,
    values_cnt: dict[int, float],
    knot: float | None,
    weight: float | None,
) -> None:
    """Take a control point or, without values, a knot; go as far as is known."""
    curve = curve_points.load(card, master)
    value = _knot(curve, knot)
    if values_cnt:
        _add_point(card, master, curve, values_cnt, 1.0 if weight is None else weight)
    elif weight is not None or len(curve.knots) >= len(curve.points) + _rank(card, master):
        raise CardError(INVALID_ARGUMENT)
    curve.knots.append(value)
    card.memory.I[mf3.word[master]] |= mf3.NURB_PENDING
    _follow(card, program, master, curve, ends=False)
    curve_points.store(card, master, curve)


def finish(card: Card, program: int, master: int) -> None:
    """Repeat the last knot as often as is missing, and go to the end of the curve.

    Without a knot after the last point the next one is repeated: a curve whose last knot
    was that of the last point would end before it.
    """
    curve = curve_points.load(card, master)
    if not curve.points:
        return
    rank = _rank(card, master)
    if len(curve.points) < rank and not curve.is_open:
        raise CardError(INVALID_ARGUMENT)
    if len(curve.knots) == len(curve.points):
        curve.knots.append(curve.knots[-1] + STEP)
    missing = len(curve.points) + rank - len(curve.knots)
    curve.knots += [curve.knots[-1]] * missing
    _follow(card, program, master, curve, ends=True)
    curve_points.store(card, master, CurvePoints())


def _rank(card: Card, master: int) -> int:
    return curve_points.rank(card, master)


def _knot(curve: CurvePoints, knot: float | None) -> float:
    """The knot that is meant; `Invalid argument` for one below the one before."""
    if knot is None:
        return curve.knots[-1] + STEP if curve.knots else 0.0
    if curve.knots and not knot >= curve.knots[-1]:
        raise CardError(INVALID_ARGUMENT)
    return knot


def _add_point(
    card: Card, master: int, curve: CurvePoints, values_cnt: dict[int, float], weight: float
) -> None:
    if not weight > 0.0 or len(curve.knots) > len(curve.points):
        raise CardError(INVALID_ARGUMENT)
    point = list(curve.points[-1]) if curve.points else curve_moves.base_point(card, master)
    for slave, value in values_cnt.items():
        point[slave] = value
        curve.slaves |= 1 << slave
    curve.points.append(point)
    curve.weights.append(weight)


def _follow(card: Card, program: int, master: int, curve: CurvePoints, *, ends: bool) -> None:
    """Hand over all spans whose points and knots are known."""
    rank = _rank(card, master)
    while len(curve.points) >= rank and len(curve.knots) >= 2 * rank - 1:
        begin, end = curve.knots[rank - 1 : rank + 1]
        if end > begin:
            numbers = curve.numbers
            points = [[point[s] for s in numbers] for point in curve.points[:rank]]
            span_curve = bezier.span(points, curve.weights[:rank], curve.knots[: 2 * rank - 1])
            is_last = ends and not any(b > a for a, b in pairwise(curve.knots[rank:]))
            _send(card, program, master, curve, span_curve, end - begin, ends=is_last)
        for row in (curve.points, curve.weights, curve.knots):
            row.pop(0)


def _send(
    card: Card,
    program: int,
    master: int,
    curve: CurvePoints,
    span_curve: Bezier,
    span: float,
    *,
    ends: bool,
) -> None:
    flags = card.memory.I[mf3.word[master]]
    if not flags & mf3.NURB_TIME and span_curve.is_point:
        return
    parts = bezier.halves(span_curve) if flags & mf3.NURB_SMOOTH else (span_curve,)
    for part in parts:
        pace = _pace(card, master, curve, part, ends=ends and part is parts[-1])
        size = span / len(parts)
        curve_moves.hand_over(card, program, master, curve.numbers, part, size, pace)
        curve.is_open = True
    card.memory.I[mf3.word[master]] |= mf3.NURB_LOADED


def _pace(
    card: Card, master: int, curve: CurvePoints, part: Bezier, *, ends: bool
) -> curve_moves.Pace:
    flags = card.memory.I[mf3.word[master]]
    begins = not curve.is_open
    if flags & mf3.NURB_TIME:
        factor = card.memory.S[masters.nurb_time_factor[master]]
        start_s = card.memory.S[masters.nurb_start_time[master]]
        return curve_moves.Pace(
            rate=1.0 / factor if factor > 1.0 / FASTEST else FASTEST,
            start_s=start_s if start_s > 0.0 else 0.0,
            is_nurb=True,
            begins=begins,
            ends=ends,
        )
    most = _bend_speed(card, master, curve, part) if flags & mf3.NURB_SMOOTH else 0.0
    return curve_moves.Pace(most_ups=most, is_nurb=True, begins=begins, ends=ends)


def _bend_speed(card: Card, master: int, curve: CurvePoints, part: Bezier) -> float:
    """Speed at which the tightest bend takes ACC: v^2 / R <= ACC."""
    acc = card.memory.F[masters.acc_ups2[master]]
    axes = [card.memory.I[masters.slave_axis[master] + s] for s in curve.numbers]
    radius = bezier.tightest_radius(part, [scale_of(card, axis) for axis in axes])
    bound = (acc * radius) ** 0.5
    return bound if bound < FASTEST else 0.0
