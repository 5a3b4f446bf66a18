"""Spacing of the knots of a time law: dense where the path bends, wide on lines and circles.

With the speed v = min(feed, (A/|q''|)^1/2, (J/|r|)^1/3), r = q''' + |q''|^2 q' (0 on lines and
circles), the distance between knots is the least of

    BUILD_UP (A/J) v         to switch the jerk while the acceleration builds up
    TURN_RAD / |q''|         to follow a circle
    SPREAD J / (|r'| v^3)    to follow the jerk that the path takes

but not less than one length. With the distance from narrow ones it grows no faster than GROWTH,
g(s) = min g(r) + GROWTH |s - r|: there the tool is slow, and splines want neighbours of like size.
"""

import numpy as np

from openacr.trajectory.path.setpoints import Reals

GROWTH = 0.12
TINY = 1e-100
TURN_RAD = 0.06
SPREAD = 0.2  # of the jerk
BUILD_UP = 0.08  # of the time in which acceleration builds up


def widest(
    points: Reals, step: float, feeds: Reals, acceleration: float, jerk: float, dense_u: float
) -> Reals:
    """The largest distances between knots on the intervals of a path, before they are graded.

    `points` are control points of a B-spline, `feeds` the feeds on its intervals,
    `dense_u` the distance of knots where the path takes jerk.
    """
    first = np.diff(points, axis=0)[1:-1] / step
    second = np.diff(points, n=2, axis=0) / step**2
    bend = np.sqrt((second * second).sum(axis=1))
    bend = np.maximum(np.maximum(bend[:-1], bend[1:]), TINY)
    third = np.diff(second, axis=0) / step + (bend * bend)[:, None] * first
    shake = np.sqrt((third * third).sum(axis=1))
    fourth = np.diff(third, axis=0, append=third[-1:]) / step
    change = np.sqrt((fourth * fourth).sum(axis=1))
    change[1:] = np.maximum(change[1:], change[:-1])
    speeds = np.minimum(np.sqrt(acceleration / bend), np.cbrt(jerk / np.maximum(shake, TINY)))
    np.minimum(speeds, feeds, out=speeds)
    gaps = np.minimum(BUILD_UP * acceleration / jerk * speeds, TURN_RAD / bend)
    np.minimum(gaps, SPREAD * jerk / np.maximum(change * speeds**3, TINY), out=gaps)
    found: Reals = np.maximum(gaps, dense_u)
    return found


def continued(knots: Reals, s: Reals, gaps: Reals, end_u: float, end_gap: float | None) -> Reals:
    """Knots continued as far as `end_u`, with the largest distances `gaps` at s.

    `end_gap`: the end gets a knot of its own, followed by a gap.
    """
    begin = float(knots[-1])
    if end_u <= begin:
        return knots
    inside = s > begin
    place: Reals = np.concatenate([[begin], s[inside]])
    most: Reals = np.concatenate([[begin - float(knots[-2])], gaps[inside]])
    if end_gap is not None:
        before = place < end_u
        place = np.append(place[before], end_u)
        most = np.append(most[before], end_gap)
    new = _spaced(place, _graded(place, most), end_u, end_gap is not None)
    found: Reals = np.concatenate([knots, new])
    return found


def _graded(s: Reals, gaps: Reals) -> Reals:
    """The largest distances at s that grow by GROWTH of the distance at most."""
    slope = GROWTH * s
    after = np.minimum.accumulate(gaps - slope) + slope
    before = np.minimum.accumulate((gaps + slope)[::-1])[::-1] - slope
    found: Reals = np.minimum(after, before)
    return found


def _spaced(s: Reals, gaps: Reals, end_u: float, is_end: bool) -> Reals:
    """Knots between s[0] and `end_u` with the distances `gaps`; an end is no part of them."""
    density = 1.0 / gaps
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))])
    whole = float(np.interp(end_u, s, count))
    numbers = np.arange(1.0, np.floor(whole) + 1.0)
    if is_end:
        most = max(1.0, np.round(whole))
        numbers = np.arange(1.0, most) * (whole / most)
    found: Reals = np.interp(numbers, count, s)
    return found


def sharpest(points: Reals, step: float) -> float:
    """The largest curvature between some control points of a path, `step` apart."""
    bends = np.diff(points, n=2, axis=0) / step**2
    return float(np.sqrt((bends * bends).sum(axis=1)).max())
