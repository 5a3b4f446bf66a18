r"""Setpoints: control points of a uniform cubic B-spline in time.

Knot i is at the time i D. Between the knots i and i + 1, with x = t/D - i,

    6 q  = (1-x)^3 c[i-1] + (3x^3 - 6x^2 + 4) c[i] + (-3x^3 + 3x^2 + 3x + 1) c[i+1] + x^3 c[i+2]
    q''  = (1-x) a[i] + x a[i+1]                   a[i] = (c[i-1] - 2 c[i] + c[i+1]) / D^2
    q''' = (c[i+2] - 3 c[i+1] + 3 c[i] - c[i-1]) / D^3

Position, velocity and acceleration are continuous, the jerk is constant between knots. All of
them are
means of the differences of control points: where these keep a limit, every instant keeps it.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Reals = npt.NDArray[np.float64]
Whole = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Setpoints:
    """Successive control points of a trajectory, and those that bring it to rest after them.

    `lines` and `path_u` are the source line and the programmed distance since the start of the
    path at each of them, `factors` those of the feeds that they are planned with. `rest` continues
    `points` where no further setpoints come: it ends at rest, at `rest_path_u`.
    """

    first: int
    period_s: float
    points: Reals
    lines: Whole
    path_u: Reals
    rest: Reals
    rest_path_u: float
    factors: Reals

    @property
    def end(self) -> int:
        """The index of the control point after the last one."""
        return self.first + len(self.points)


def evaluate(points: Reals, at_knots: Reals) -> tuple[Reals, Reals, Reals, Reals]:
    """Position and three derivatives by knot (not by second) of the spline of control points.

    `at_knots` counts from points[0]; before the first and after the last point the spline is at
    rest.
    """
    padded = np.concatenate([points[:1], points, points[-1:], points[-1:]])
    row = np.clip(np.floor(at_knots).astype(np.int64), 0, len(points) - 1)
    x = (np.clip(at_knots, 0.0, len(points) - 1) - row)[:, None]
    y = 1.0 - x
    c0, c1, c2, c3 = (padded[row + n] for n in range(4))
    position = (y**3 * c0 + (4 + x * x * (3 * x - 6)) * c1 + (4 + y * y * (3 * y - 6)) * c2) / 6
    position += x**3 * c3 / 6
    d0, d1, d2 = c1 - c0, c2 - c1, c3 - c2
    speed = 0.5 * y * y * d0 + (0.5 + x * y) * d1 + 0.5 * x * x * d2
    return position, speed, y * (d1 - d0) + x * (d2 - d1), d2 - 2 * d1 + d0
