"""One window of a time law: its knots, the rows of all limits, and their solution (speed_cy.py)."""

from dataclasses import dataclass

import numpy as np

from openacr.compiled import pick
from openacr.trajectory.course.end_law import rest_shape
from openacr.trajectory.path.arrays import flat, room, whole
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.speed import cells_cy, speed_cy, speed_rows_cy
from openacr.trajectory.speed import speed_curve_cy as row
from openacr.trajectory.speed.knots import Rest, rest_weights, tie_end, tie_start
from openacr.views import F64

_weights = pick(row.speed_weights)
_values = pick(row.speed_values)
_solve = pick(speed_cy.speed_solve)
_worst = pick(row.speed_worst)
_rows = pick(speed_rows_cy.speed_rows)
_excess = pick(cells_cy.cells_excess)
_law = pick(speed_rows_cy.law_from_speed)

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
    """Knots (with two more on each side) and all that depends on them alone.

    The arrays are parts of the table that compiled functions take (speed_curve_cy.py).
    """

    def __init__(
        self, curve: Curve, knots: Reals, rules: Rules, start: Rest | None, end: Rest | None
    ) -> None:
        """`start`, `end`: how the path begins and ends at rest; None where it goes on."""
        self.curve, self.rules, axes = curve, rules, curve.axes
        self.count = count = len(knots) - 4
        size = row.K_AXES + row.AXIS * axes
        self._J, self._N = whole(row.J_SIZE), room(row.N_LIMITS + row.GROUPS * axes)
        self._J[row.J_AXES], self._J[row.J_POINTS] = axes, curve.count
        self._J[row.J_KNOTS], self._J[row.J_ROW], self._J[row.J_STEPS] = count, size, STEPS
        self._N[row.N_STEP_U], self._N[row.N_ORIGIN_U] = curve.step, curve.origin
        self._N[row.N_LONG_S] = rules.long_s
        self._N[row.N_LIMITS : row.N_LIMITS + len(rules.limits)] = flat(rules.limits)
        table = np.zeros((count + 4, size))
        table[:, row.K_AT_U] = knots
        self._K, table = flat(table), table[2:-2]
        self._table = table
        self.plain = table[:, row.K_PLAIN : row.K_PLAIN + row.WEIGHTS]
        _weights(self._J, self._K)
        tied = table[:, row.K_TIED : row.K_TIED + row.WEIGHTS]
        tied[:] = self.plain
        self._start = self._end = None
        gaps = np.diff(knots[2:-2])
        lengths = table[:, row.K_LENGTH_U]
        lengths[:-1] += 0.5 * gaps
        lengths[1:] += 0.5 * gaps
        first, head, stop, tail = 1, 3, count - 1, count - 1
        if start is not None:
            s = float(knots[2]) - start.at_u
            self._start = rest_weights(self.plain[0], s, start.swing_u, 1)
            tie_start(tied, self._start)
            lengths[0] += rest_shape(s, start.swing_u)[2]
            first, head = 0, 2
        if end is not None:
            s = end.at_u - float(knots[-3])
            self._end = rest_weights(self.plain[-1], s, end.swing_u, -1)
            tie_end(tied, self._end)
            lengths[-1] += rest_shape(s, end.swing_u)[2]
            stop = tail = count
        self._J[row.J_FIRST], self._J[row.J_STOP] = first, stop
        self._J[row.J_HEAD], self._J[row.J_TAIL] = head, tail
        self._values = table[:, row.K_H : row.K_H + 3]
        self.cap = table[:, row.K_CAP]
        by_axis = table[:, row.K_AXES :].reshape(count, axes, row.AXIS)
        self.rows = by_axis[:, :, : row.A_DUAL]
        self.set_rows()

    def set_rows(self) -> None:
        """Compute the rows of the limits for the present shares."""
        table, rules = self._table, self.rules
        table[:, row.K_FEED_UPS], table[:, row.K_TOOL_UPS] = rules.feed, rules.tool
        table[:, row.K_PUSH], table[:, row.K_SOFT] = rules.push, rules.soft
        table[:, row.K_ZONE], table[:, row.K_NORMAL_UPS2] = rules.zone, rules.normal
        _rows(self._J, self._N, self._K, self.curve.points)
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
        return _worst(self._J, self._K, flat(x))

    def solve(self, x: Reals, kappa: float, least: float) -> int:
        """Improve coefficients that keep all limits; the number of steps."""
        self._N[row.N_KAPPA], self._N[row.N_LEAST] = kappa, least
        system = room(speed_cy.UNKNOWN * (self.count + 2))
        steps = _solve(self._J, self._N, self._K, flat(x), system)
        self.tie(x)
        return steps

    def excess(self, x: Reals, fast: float) -> Reals:
        """Squared speeds, mean accelerations and jerks of the cells, relative to the limits.

        `fast` is the share of the squared speed that a cell may use.
        """
        _values(self._J, self._K, flat(x), 1, 0, self.count, row.K_PLAIN, row.K_H)
        _excess(self._J, self._N, self._K, self.curve.points)
        found: Reals = self._table[:, row.K_CELL : row.K_CELL + 3].T.copy()
        found[0] /= fast
        return found

    def continue_law(self, x: Reals, rows: Reals, at: int) -> None:
        """Write the law of the cells after the row `at` of a law."""
        _law(self._J, self._K, flat(x), flat(rows), at)

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
        h = self._values[:, None]
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
