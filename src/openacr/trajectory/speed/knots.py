"""Knots of the speed curve, and how it begins and ends at rest.

At rest h = (ds/dt)^2 falls to 0 like s^(4/3), which no spline follows. So the first knot lies
where the constant jerk J gets in `FIRST` steps of time; up to there the law is that of
end_law.py. From there on knots lie one step of time apart until they are one length apart. Further
on their distances are those of spacing.py.
"""

from dataclasses import dataclass, replace

import numpy as np

from openacr.trajectory.course.end_law import rest_shape, rest_u, turn_s
from openacr.trajectory.path.setpoints import Reals

FIRST = 4.0
FIRST_TURNS = 5.0  # times t1 of a swing: soon after it has come back
ACROSS = 0.04  # of the jerk


@dataclass(frozen=True, slots=True)
class Rest:
    """Where a chain starts from rest or ends at it, and how far it swings out."""

    at_u: float
    swing_u: float


@dataclass(frozen=True, slots=True)
class Grid:
    """Distances in length and, near rest, in time between knots."""

    length_u: float
    time_s: float
    jerk: float  # of a start from rest
    swing_u: float = 0.0  # of a start from rest

    def on(self, bend: float) -> "Grid":
        """The grid for an end with a curvature, where the exact start has to be shorter.

        On a curve the start s = J t^3/6 has a jerk across the path of 1.5 J^2 t^3 times the
        curvature.
        """
        most_s = (ACROSS / 1.5 / (self.jerk * max(bend, 1e-12))) ** (1 / 3) / FIRST
        return replace(self, time_s=min(self.time_s, most_s))

    def graded(self, most_u: float) -> list[float]:
        """Distances from rest of the knots near it, `most_u` at most; the last gap is a length."""
        time = min(self.time_s, 0.05 * (most_u / self.jerk) ** (1 / 3))
        begin = max(FIRST * time, FIRST_TURNS * turn_s(self.swing_u, self.jerk))
        distances: list[float] = []
        while True:
            s = rest_u(begin + len(distances) * time, self.swing_u, self.jerk)
            if s > most_u:
                break
            if distances and s - distances[-1] >= self.length_u:
                break
            distances.append(s)
        if not distances:
            distances.append(rest_u(begin, self.swing_u, self.jerk))
        while len(distances) > 1 and distances[-1] + 0.5 * self.length_u > most_u:
            distances.pop()
        return distances


def first_knots(grid: Grid, most_u: float) -> list[float]:
    """The knots of a start from rest, `most_u` from it at most, with two more before them."""
    graded = grid.graded(most_u)
    gap = graded[1] - graded[0] if len(graded) > 1 else 0.5 * graded[0]
    return [graded[0] - 0.66 * gap, graded[0] - 0.33 * gap, *graded]


def closed_knots(knots: Reals, last: list[float], length_u: float) -> Reals:
    """Knots continued by those of an end at rest, with two more after them."""
    gap = float(knots[-1] - knots[-2])
    if last[0] - knots[-1] < 0.3 * gap:
        last = last[1:] or [0.5 * (float(knots[-1]) + length_u)]
    gap = length_u - last[-1]
    found: Reals = np.concatenate([knots, last, [last[-1] + 0.3 * gap, last[-1] + 0.6 * gap]])
    return found


def rest_weights(weights: Reals, s: float, swing_u: float, side: int) -> Reals:
    """The three coefficients at a knot at the distance s from rest, relative to the free one.

    `side` is 1 after a start, -1 before an end.
    """
    slope, bend, _ = rest_shape(s, swing_u)
    wanted: Reals = np.array([1.0, side * slope, bend])
    a, b, c = (weights[n : n + 3] for n in (0, 3, 6))
    inverse = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    found: Reals = inverse @ wanted
    ratios: Reals = found / found[2 if side > 0 else 0]
    return ratios


def tie_start(weights: Reals, ratios: Reals) -> None:
    """Rewrite the rows of the first two knots for the one free coefficient of a start from rest."""
    rows = weights[:2].reshape(2, 3, 3)
    free = rows[0] @ ratios
    rows[0] = 0.0
    rows[0, :, 2] = free
    rows[1, :, 1] += rows[1, :, 0] * ratios[1]
    rows[1, :, 0] = 0.0


def tie_end(weights: Reals, ratios: Reals) -> None:
    """Rewrite the rows of the last two knots for the one free coefficient of an end at rest."""
    rows = weights[-2:].reshape(2, 3, 3)
    free = rows[1] @ ratios
    rows[1] = 0.0
    rows[1, :, 0] = free
    rows[0, :, 1] += rows[0, :, 2] * ratios[1]
    rows[0, :, 2] = 0.0
