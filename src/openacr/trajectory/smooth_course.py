"""The course of a smooth chain: its tube, and its speed window by window.

Of the path that is known and smoothed, the first part is committed, the rest planned to a slow
constant speed from which
a stop takes a few samples: what is committed can always be brought to rest on known path. The
next window starts from the
plan left over, continued at that slow speed, which keeps all limits; from there every step of the
solver keeps them, too (speed_cy.py).
"""

import math
from collections.abc import Sequence

import numpy as np

from openacr.compiled import pick
from openacr.trajectory import course_cy, speed_rows_cy
from openacr.trajectory.arrays import flat
from openacr.trajectory.course import Course, Soft
from openacr.trajectory.knots import Grid, Slow, extended, rest_h, stop_rows, stop_speed
from openacr.trajectory.limits import Along, Limits, TrajectoryError
from openacr.trajectory.segments import Piece
from openacr.trajectory.setpoints import Reals
from openacr.trajectory.tube import AHEAD, STEP, Tube
from openacr.trajectory.window import Curve, Rules, Window

_fill = pick(course_cy.course_fill)
_law = pick(speed_rows_cy.law_from_speed)
PARTS = speed_rows_cy.PARTS

JERK_SHARE, ACCELERATION_SHARE = 0.99, 0.99  # of the limits, for what happens between knots
REST_SHARE = 0.95  # of the jerk near rest, where knots are sparse
SLOW_JERK, SLOW_ACCELERATION = 0.35, 0.25  # shares at the slow speed ahead
NORMAL_SHARE = 0.3  # of the tolerance at most, for the B-spline in time
TUBE_SHARE = 0.96  # of the tolerance, for smoothing and the B-spline
PER_RADIUS = 10.0  # samples on the radius of an arc, at least
LEAST_STEPS = 32  # samples of the shortest chain
KNOT = 2.0  # samples between two knots
LONG = 0.7  # periods: what takes longer is seen by a single difference of setpoints
SLOW_STEPS = 2.0  # of time between two knots where the feed is low
END_ROWS = 8  # control points that shape an end
MOST_AGAIN, AGAIN_SHARE = 3, 0.96
RAMP = 12  # knots from one slow speed to the next
MOST_TRIES = 40
LOOK = 2.5  # braking distances ahead of what is committed
BATCH = 0.5  # of that, committed at once


def look_ahead(along: Along) -> float:
    """The length of path to be planned after what is committed: some braking distances."""
    brake = along.speed**2 / (2.0 * along.acceleration)
    return LOOK * (brake + along.speed * along.acceleration / (2.0 * along.jerk))


class SmoothCourse(Course):
    """A course that grows with its chain."""

    __slots__ = ("_begun_s", "_ease", "_feeds", "_first", "_grid", "_kept", "_knots", "_last",
                 "_level", "_limits", "_period_s", "_push", "_slow", "_slow_h", "_soft",
                 "_tolerances", "_tube", "_x", "lines", "look_u", "offsets", "steps")  # fmt: skip

    def __init__(
        self, limits: Limits, period_s: float, known: Sequence[Piece], soft: Soft | None
    ) -> None:
        first = known[0]
        super().__init__(first.start, first.start, course_cy.OPEN)
        self._limits, self._period_s = limits, period_s
        tolerance = min(piece.segment.tolerance_u for piece in known)
        feed = max(piece.segment.feed_ups for piece in known)
        along = limits.along(first.tangent(0.0), feed, period_s)
        corner_s = max(0.1 * (48.0 * tolerance / along.jerk) ** (1 / 3), 0.5 * period_s)
        time_s = min(corner_s, max(along.acceleration / along.jerk / 16.0, 0.5 * period_s))
        radius = min((p.radius_u for p in known if not p.is_line), default=math.inf)
        length = sum(piece.length_u for piece in known)
        step = min(
            STEP * tolerance,
            0.2 * corner_s * along.speed,
            radius / PER_RADIUS,
            length / LEAST_STEPS,
        )
        knot_u = KNOT * step
        normal = max(limits.acceleration_ups2) * period_s**2 / 6.0
        share = TUBE_SHARE - min(NORMAL_SHARE, normal / tolerance)
        self._tube = Tube(limits.axes, step, share)
        self._first, self._last = soft, Soft(along.jerk, 0.0)
        self._grid = Grid(knot_u, time_s, REST_SHARE * self._soft_jerk(soft, along.jerk))
        self._kept = np.zeros((1, 4))
        self._knots = np.empty(0)
        self._x = np.empty(0)
        self._push = self._soft = np.empty(0)  # shares of the limits that the rows use
        self._ease = 1.0  # share of the jerk of new windows
        self._begun_s = 0.0  # where the present window begins
        self._slow_h: float = min(
            stop_speed(4.0 * knot_u, along.jerk) ** 2, 0.25 * along.acceleration * RAMP * knot_u
        )
        self._level = self._slow_h
        self.look_u = look_ahead(along)
        self.offsets: list[float] = []  # ends of the pieces
        self._slow: list[Slow] = []
        self.lines: list[int] = []
        self._feeds: list[float] = []
        self._tolerances: list[float] = []
        self.steps = 0  # of the solver, all windows together

    @staticmethod
    def _soft_jerk(soft: Soft | None, jerk: float) -> float:
        return jerk if soft is None else min(soft.jerk, jerk)

    # --- input -------------------------------------------------------------------

    def add(self, piece: Piece) -> None:
        """Append a piece of the chain."""
        self._tube.add(piece)
        self.offsets.append(self._tube.known_u)
        self.lines.append(piece.segment.line)
        self._feeds.append(piece.segment.feed_ups)
        self._tolerances.append(piece.segment.tolerance_u)
        gap = SLOW_STEPS * self._grid.time_s * piece.segment.feed_ups
        if gap < self._grid.length_u:
            end = self._tube.known_u
            self._slow.append(Slow(end - piece.length_u, end, gap))

    def close(self, last: Piece, soft: Soft | None) -> None:
        """No piece follows; `soft`: the end overlaps another chain."""
        self._tube.close()
        length = self._tube.length_u
        axes = self._limits.axes
        self.H[course_cy.H_LENGTH] = length
        for k in range(axes):
            self.H[course_cy.H_START + axes + k] = last.segment.end[k]
        if soft is not None:
            self._last = soft
        else:
            u = last.tangent(last.length_u)
            self._last = Soft(self._limits.along(u, 1.0, self._period_s).jerk, 0.0)

    @property
    def is_closed(self) -> bool:
        """Whether the end of the chain is known."""
        return math.isfinite(self._tube.length_u)

    @property
    def wants_u(self) -> float:
        """The length of path that has to be known before the next window."""
        begun = float(self._knots[2]) if len(self._knots) else 0.0
        return float(begun) + (
            (1.0 + BATCH) * self.look_u + (RAMP + 8) * self._grid.length_u + AHEAD * self._tube.step
        )

    # --- one window --------------------------------------------------------------

    def plan(self) -> None:
        """Plan the next window, and commit what may be run.

        Its setpoints are checked; where one is above a limit the window is planned again with less
        of the jerk.
        """
        self._tube.grow()
        before = self._knots, self._x, self._push, self._soft, self._kept, self._level
        for _ in range(MOST_AGAIN):
            self._plan_window()
            if self._samples_keep_limits():
                return
            self._knots, self._x, self._push, self._soft, self._kept, self._level = before
            self._ease *= AGAIN_SHARE
        self._plan_window()

    def _samples_keep_limits(self) -> bool:
        """Whether setpoints of the law are within the limits of acceleration and jerk."""
        period, axes = self._period_s, self._limits.axes
        begin = float(self._begun_s)
        count = int((self.duration_s - begin) / period) + 4
        points, gone = np.empty((count, axes)), np.empty(count)
        _fill(self.H, self.C, self.Z, begin, period, count, flat(points), flat(gone))
        push = np.abs(np.diff(points, n=2, axis=0)).max(axis=0) / period**2
        jerk = np.abs(np.diff(points, n=3, axis=0)).max(axis=0) / period**3
        most = np.array(self._limits.checked())
        return bool((push <= most[axes : 2 * axes]).all() and (jerk <= most[2 * axes :]).all())

    def _plan_window(self) -> None:
        points, origin = self._tube.control_points()
        self.set_path(points, self._tube.step, origin)
        curve = Curve(self.C, len(points), self._limits.axes, self._tube.step, origin)
        is_first = not len(self._knots)
        before = self._new_knots()
        window = Window(
            curve, self._knots, self._rules(self._knots, before),
            0.0 if is_first else None, self._tube.length_u if self.is_closed else None,
        )  # fmt: skip
        level = self._slow_level(curve, before)
        ease = 1.0
        for _ in range(MOST_TRIES):
            start = window.tie(self._guess(level, ease, is_first))
            if window.slack(start) > 0.0:
                break
            level *= 0.5
            ease *= 0.5
        else:
            raise TrajectoryError(f"line {self.lines[-1]}: no slow speed keeps the limits")
        slowness = 1.0 / math.sqrt(float(window.cap.max()))
        self._x, steps = window.fit(start, slowness)
        self.steps += steps
        self._level = level
        self._commit(window, is_first)

    def _new_knots(self) -> int:
        """Append knots as far as the path is final; returns how many there were before."""
        tube, grid, before = self._tube, self._grid, len(self._knots)
        end_u = tube.valid_u - (RAMP + 4) * grid.length_u
        last: list[float] = []
        if self.is_closed:
            ending = Grid(grid.length_u, grid.time_s, REST_SHARE * self._last.jerk)
            ending = ending.on(self._bend(-END_ROWS, None))
            last = [tube.length_u - s for s in reversed(ending.graded(0.5 * tube.length_u))]
            end_u = last[0]
        if not before:
            grid = grid.on(self._bend(0, END_ROWS))
        known = [float(s) for s in self._knots]
        self._knots = np.array(extended(known, grid, self._slow, end_u, last, tube.length_u))
        return before

    def _bend(self, first: int, stop: int | None) -> float:
        """The largest curvature between some control points of the path."""
        points = self._tube.control_points()[0][first:stop]
        bends = np.diff(points, n=2, axis=0) / self._tube.step**2
        return float(np.sqrt((bends * bends).sum(axis=1)).max())

    def _rules(self, knots: Reals, before: int) -> Rules:
        """What rules at knots; the first ones keep the shares of the last window."""
        inner, ends = knots[2:-2], len(self.offsets) - 1
        left = np.minimum(np.searchsorted(self.offsets, knots[1:-3]), ends)
        right = np.minimum(np.searchsorted(self.offsets, knots[3:-1]), ends)
        feeds, tolerances = np.array(self._feeds), np.array(self._tolerances)
        feed = np.minimum(feeds[left], feeds[right])
        tolerance = np.minimum(tolerances[left], tolerances[right])
        for i in np.flatnonzero(right > left + 1):
            feed[i] = feeds[left[i] : right[i] + 1].min()
            tolerance[i] = tolerances[left[i] : right[i] + 1].min()
        zone = self._zone(inner, self._first)
        rest = 40.0 * self._grid.jerk * self._grid.time_s**3
        soft = np.where(inner < rest, REST_SHARE, JERK_SHARE)
        if self.is_closed:
            to_end = self._tube.length_u - inner
            zone *= self._zone(to_end, self._last)
            soft[to_end < rest] = REST_SHARE
        soft *= zone * self._ease
        push = np.full(len(inner), ACCELERATION_SHARE)
        if before > 4:
            push[: before - 4], soft[: before - 4] = (
                self._push[: before - 4],
                self._soft[: before - 4],
            )
        self._push, self._soft = push, soft
        limits = self._limits
        jerks = limits.jerks(self._period_s)
        ruling = np.array([*limits.velocity_ups, *limits.acceleration_ups2, *jerks])
        normal = NORMAL_SHARE * 6.0 / self._period_s**2 * tolerance
        return Rules(0.9999 * feed, push, soft, zone, normal, ruling, LONG * self._period_s)

    def _zone(self, s: Reals, soft: Soft | None) -> Reals:
        """The share of the jerk limits at distances from an end that overlaps."""
        share = np.ones(len(s))
        if soft is not None and soft.time_s > 0.0:
            most = min(self._limits.jerks(self._period_s))
            share[s < soft.jerk * soft.time_s**3 / 6.0] = min(1.0, soft.jerk / most)
        return share

    def _slow_level(self, curve: Curve, before: int) -> float:
        """A constant h that keeps all limits from the new knots on."""
        start = self._knots[max(before - RAMP, 2)]
        s = np.arange(start, self._tube.valid_u, self._grid.length_u)
        if not len(s):
            return self._slow_h
        knots = np.concatenate([s[:1] - 2e-6, s[:1] - 1e-6, s, s[-1:] + 1e-6, s[-1:] + 2e-6])
        push, soft = self._push, self._soft
        window = Window(curve, knots, self._rules(knots, 0), None, None)
        self._push, self._soft = push, soft
        bend = float(np.abs(window.rows[:, :, 0]).max())
        jerk = float((np.abs(window.rows[:, :, 2]) + window.rows[:, :, 5]).max())
        return min(
            self._slow_h,
            float(SLOW_ACCELERATION * window.cap.min()),
            SLOW_ACCELERATION / max(bend, 1e-12),
            float((SLOW_JERK / max(jerk, 1e-12)) ** (2 / 3)),
        )

    def _guess(self, level: float, ease: float, is_first: bool) -> Reals:
        """Coefficients that keep all limits: those planned before, then a slow constant speed."""
        knots = self._knots
        old = len(self._x)
        x = np.empty(len(knots) - 2)
        x[:old] = self._x
        place = np.concatenate([knots[1:2], (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3.0,
                                knots[-2:-1]])  # fmt: skip
        new = place[old:]
        wanted = np.full(len(new), level)
        if old:
            ramp = np.clip((new - place[old - 1]) / (RAMP * self._grid.length_u), 0.0, 1.0)
            wanted = self._level + (level - self._level) * ramp * ramp * (3.0 - 2.0 * ramp)
        inverse = wanted**-2.0
        brake = 0.6 * min(self._limits.acceleration_ups2)
        if is_first:
            s = np.maximum(new, knots[2])
            inverse += rest_h(s, 0.4 * self._grid.jerk * ease) ** -2.0
            inverse += (brake * ease * s) ** -2.0
        if self.is_closed:
            to_end = self._tube.length_u - np.minimum(new, knots[-3])
            inverse += rest_h(to_end, 0.4 * self._last.jerk * ease) ** -2.0
            inverse += (brake * ease * to_end) ** -2.0
        x[old:] = inverse**-0.5
        return x

    def _commit(self, window: Window, is_first: bool) -> None:
        """Make the law of the window, and commit its first part."""
        knots, kept, count, plain = self._knots, len(self._kept), window.count, window.plain
        z = np.zeros((kept + PARTS * count + 4, 4))
        z[:kept] = self._kept
        row = kept - 1
        if is_first:
            row = kept
            w = plain[0].reshape(3, 3) @ self._x[:3]
            v = math.sqrt(w[0])
            z[row] = (3.0 * knots[2] / v, knots[2], v, 0.5 * w[1])
        _law(flat(knots), flat(self._x), flat(plain), 0, count, flat(z), row)
        last = row + PARTS * (count - 1)
        self._begun_s = 0.0 if is_first else float(z[row, 0])
        if self.is_closed:
            length = self._tube.length_u
            z[last + 1] = (z[last, 0] + 3.0 * (length - knots[-3]) / z[last, 2], length, 0.0, 0.0)
            self.is_complete = True
            self.set_law(flat(z), last + 2)
            self.committed_s = float(z[last + 1, 0])
            return
        jerk = SLOW_JERK * min(self._limits.jerks(self._period_s))
        brake = 0.5 * min(self._limits.acceleration_ups2)
        z[last + 1 : last + 4] = np.reshape(stop_rows(list(z[last]), jerk, brake), (3, 4))
        self.set_law(flat(z), last + 4)
        done = int(np.searchsorted(knots[2:-2], knots[-3] - self.look_u)) - 1
        done = max(done, 1)
        self.committed_s = float(z[row + PARTS * done, 0])
        self._kept = z[: row + PARTS * done + 1].copy()
        self._knots, self._x = knots[done:].copy(), self._x[done:].copy()
        self._push, self._soft = self._push[done:].copy(), self._soft[done:].copy()

    def drop(self, time_s: float) -> None:
        """Forget what lies before a time of the course."""
        keep = int(np.searchsorted(self._kept[:, 0], time_s)) - 2
        if keep > 0:
            self._kept = self._kept[keep:].copy()
            s = float(self._kept[0, 1])
            self._tube.drop(s)
            self._slow = [each for each in self._slow if each.end_u > s]
            gone = int(np.searchsorted(self.offsets, s)) - 1
            if gone > 0:
                for each in (self.offsets, self.lines, self._feeds, self._tolerances):
                    del each[:gone]
