"""One window of a time law: its knots, the rows of all limits, and their solution (speed_cy.py)."""

from dataclasses import dataclass

import numpy as np

from openacr.compiled import pick
from openacr.trajectory import cells_cy, speed_curve_cy, speed_cy, speed_rows_cy
from openacr.trajectory.arrays import flat
from openacr.trajectory.end_law import rest_shape
from openacr.trajectory.knots import Rest, rest_weights, tie_end, tie_start
from openacr.trajectory.setpoints import Reals
from openacr.views import F64

_weights = pick(speed_curve_cy.speed_weights)
_values = pick(speed_curve_cy.speed_values)
_solve = pick(speed_cy.speed_solve)
_worst = pick(speed_curve_cy.speed_worst)
_rows = pick(speed_rows_cy.speed_rows)
_excess = pick(cells_cy.cells_excess)

FINE = 2e-4  # of the largest gap: about 0.2 % of the time
STEPS = 120
AGAIN = 0.02  # of the first target, where a solution is near
REACHES = (1, 2, 4, 8, 16, 32)  # knots on both sides of a cell above a limit
BLENDS = (1.0, 0.95, 0.9, 0.8, 0.65, 0.5, 0.35, 0.2, 0.1)
HARDEST = 0.9995  # mean of a cell relative to the limits
EASED = 0.985  # what is aimed at in a cell that was above
FASTEST, SLOWED = 1.001, 0.999  # the same for the squared speed
CELLS = np.array([[FASTEST], [HARDEST], [HARDEST]])
AIMED = np.array([[SLOWED], [EASED], [EASED]])
MARGIN = 0.003  # smallest slack to start from


@dataclass(frozen=True, slots=True)
class Curve:
    """Control points of a path, as compiled functions take them."""

    points: F64
    count: int
    axes: int
    step: float
    origin: float


@dataclass(frozen=True, slots=True)
class Rules:
    """What rules at every knot: feeds, shares of the limits, highest normal acceleration.

    `fast`, `push` and `soft` are the shares of squared speed, acceleration and jerk that the rows
    may use, `zone` the share of the jerk that a cell may use. A cell that takes longer than
    `long_s` is no mean. `tool` is the feed of the axes that carry the tool; `limits` are
    velocities, accelerations and jerks of the axes, and which carry it (`Limits.planned`).
    """

    feed: Reals
    tool: Reals
    fast: Reals
    push: Reals
    soft: Reals
    zone: Reals
    normal: Reals
    limits: Reals
    long_s: float


class Window:
    """Knots (with two more on each side) and all that depends on them alone."""

    def __init__(
        self, curve: Curve, knots: Reals, rules: Rules, start: Rest | None, end: Rest | None
    ) -> None:
        """`start`, `end`: how the path begins and ends at rest; None where it goes on."""
        self.curve, self.knots, self.rules = curve, knots, rules
        self.count = count = len(knots) - 4
        self.plain = np.empty((count, 9))
        _weights(flat(knots), count, flat(self.plain))
        self.weights = self.plain.copy()
        self._start = self._end = None
        gaps = np.diff(knots[2:-2])
        self._lengths = np.zeros(count)
        self._lengths[:-1] += 0.5 * gaps
        self._lengths[1:] += 0.5 * gaps
        self.first, self.head, self.stop, self.tail = 1, 3, count - 1, count - 1
        if start is not None:
            s = float(knots[2]) - start.at_u
            self._start = rest_weights(self.plain[0], s, start.swing_u, 1)
            tie_start(self.weights, self._start)
            self._lengths[0] += rest_shape(s, start.swing_u)[2]
            self.first, self.head = 0, 2
        if end is not None:
            s = end.at_u - float(knots[-3])
            self._end = rest_weights(self.plain[-1], s, end.swing_u, -1)
            tie_end(self.weights, self._end)
            self._lengths[-1] += rest_shape(s, end.swing_u)[2]
            self.stop = self.tail = count
        self._values = np.zeros((count, speed_curve_cy.VALUES))
        self.set_rows()

    def set_rows(self) -> None:
        """Compute the rows of the limits for the present shares."""
        curve, rules = self.curve, self.rules
        self.rows, self.cap = (
            np.empty((self.count, curve.axes, speed_curve_cy.AXIS_ROWS)),
            np.empty(self.count),
        )
        _rows(curve.points, curve.count, curve.axes, curve.step, curve.origin,
              flat(self.knots), 0, self.count, flat(rules.feed), flat(rules.tool),
              flat(rules.push), flat(rules.soft), flat(rules.normal),
              flat(rules.limits), flat(np.empty(4 * curve.axes)),
              flat(self.rows), flat(self.cap))  # fmt: skip
        self.cap *= rules.fast

    def tie(self, x: Reals) -> Reals:
        """Set the coefficients that follow from the free one at a start or end at rest."""
        if self._start is not None:
            x[:2] = self._start[:2] * x[2]
        if self._end is not None:
            x[-2:] = self._end[1:] * x[-3]
        return x

    def slack(self, x: Reals) -> float:
        """The smallest slack of a row, relative to its limit; below 0 where one is broken."""
        return _worst(flat(x), flat(self.weights), flat(self.rows), flat(self.cap),
                      self.first, self.stop, self.curve.axes, flat(self._values))  # fmt: skip

    def solve(self, x: Reals, kappa: float, least: float) -> int:
        """Improve coefficients that keep all limits; the number of steps."""
        axes, count = self.curve.axes, self.count
        rows = count * (1 + 4 * axes)
        steps = _solve(
            flat(x), flat(self.weights), flat(self.rows), flat(self.cap),
            flat(self._lengths), self.first, self.stop, self.head, self.tail, axes,
            kappa, least, STEPS, flat(self._values), flat(np.empty(rows)),
            flat(np.empty(rows)), flat(np.zeros(3 * count + 6)),
            flat(np.zeros(count + 2)), flat(np.zeros(2)),
        )  # fmt: skip
        self.tie(x)
        return steps

    def excess(self, x: Reals, fast: float) -> Reals:
        """Squared speeds, mean accelerations and jerks of the cells, relative to the limits.

        `fast` is the share of the squared speed that a cell may use.
        """
        curve, rules, count = self.curve, self.rules, self.count
        _values(flat(x), flat(self.plain), 0, count, flat(self._values), 0)
        found = np.zeros((3, count))
        _excess(curve.points, curve.count, curve.axes, curve.step, curve.origin,
                flat(self.knots), 0, count - 1, rules.long_s,
                flat(rules.zone), flat(rules.limits), flat(self._values),
                flat(np.empty(4 * curve.axes)), flat(np.empty(5 * curve.axes)),
                *(flat(each) for each in found))  # fmt: skip
        found[0] /= fast
        return found

    def fit(self, start: Reals, slowness: float, fast: float) -> tuple[Reals, int]:
        """The fastest coefficients, from a start that keeps all limits; `slowness` is 1/feed.

        Where a cell is above a limit, the rows of the knots around it are tightened,
        of more knots each time, but never so far that the start would break them. Returns the
        number of steps, too.
        """
        x = start.copy()
        steps = self.solve(x, slowness, FINE * slowness)
        for reach in REACHES:
            over = self.excess(x, fast)
            if (over <= CELLS).all():
                return x, steps
            self._tighten(start, over, reach)
            x = self._between(start, x)
            steps += self.solve(x, AGAIN * slowness, FINE * slowness)
        for share in BLENDS:
            found: Reals = self.tie(start + share * (x - start))
            if self.slack(found) > 0.0 and (self.excess(found, fast) <= CELLS).all():
                return found, steps
        return start, steps

    def towards(self, start: Reals, x: Reals, share: float) -> Reals:
        """A share of the difference from a start to x, or less of it where that breaks a row.

        What keeps the jerk between two laws that do is no convex set: a mean of both may not.
        """
        whole: Reals = self.tie(start + share * (x - start))
        if share == 1.0 or self.slack(whole) > 0.0:
            return whole
        for part in BLENDS[1:]:
            found: Reals = self.tie(start + part * share * (x - start))
            if self.slack(found) > 0.0:
                return found
        return start.copy()

    def _tighten(self, start: Reals, over: Reals, reach: int) -> None:
        """Lower the shares at the knots up to `reach` from cells above a limit."""
        cells: Reals = np.where(over > CELLS, AIMED / np.maximum(over, CELLS), 1.0)
        shares = self.rules.fast, self.rules.push, self.rules.soft
        for share, cell, least in zip(shares, cells, self._used(start), strict=True):
            knot = cell.copy()
            for shift in range(1, reach + 1):
                np.minimum(knot[shift:], cell[:-shift], out=knot[shift:])
                np.minimum(
                    knot[: 1 - shift or None], cell[shift - 1 :], out=knot[: 1 - shift or None]
                )
            share *= np.maximum(knot, np.minimum(1.02 * least, 1.0))
        self.set_rows()

    def _used(self, x: Reals) -> tuple[Reals, Reals, Reals]:
        """The parts of the rows of squared speed, acceleration and jerk used at every knot."""
        self.slack(x)
        h = self._values[:, None, :3]
        push = np.abs(self.rows[:, :, 0] * h[:, :, 0] + self.rows[:, :, 1] * h[:, :, 1])
        jerk = np.abs((self.rows[:, :, 2:5] * h).sum(axis=2)) + self.rows[:, :, 5] * h[:, :, 0]
        jerk *= np.sqrt(np.abs(h[:, :, 0]))
        return self._values[:, 0] / self.cap, push.max(axis=1), jerk.max(axis=1)

    def _between(self, start: Reals, x: Reals) -> Reals:
        """The furthest of some points from the start towards x that keep all rows."""
        for share in BLENDS[1:]:
            found: Reals = self.tie(start + share * (x - start))
            if self.slack(found) > MARGIN:
                return found
        return start.copy()
