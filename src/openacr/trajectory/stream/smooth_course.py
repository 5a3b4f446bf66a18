"""The course of a smooth chain: its tube, and its speed window by window.

Of the path that is known and smoothed, the first part is committed, the rest planned to a slow
constant speed from which a stop takes a few samples: what is committed can always be brought to
rest on known path. The next window starts from the plan left over, continued at that slow speed,
which keeps all limits; from there every step of the solver keeps them, too (speed_cy.py).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from openacr.trajectory.course import course_cy
from openacr.trajectory.course.course import Course, Soft
from openacr.trajectory.course.end_law import rest_shape, turn_row
from openacr.trajectory.path.arrays import flat
from openacr.trajectory.path.grain import grain_of, look_ahead
from openacr.trajectory.path.limits import Along, Limits, TrajectoryError
from openacr.trajectory.path.sections import Sections
from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.path.tube import AHEAD, Tube, tube_share
from openacr.trajectory.speed.knot_rules import REST_SHARE, KnotRules, Shares
from openacr.trajectory.speed.knots import Grid, Rest, closed_knots, first_knots
from openacr.trajectory.speed.setpoint_check import setpoints_by_limits
from openacr.trajectory.speed.slow_law import (
    SLOW_JERK,
    eased,
    places,
    slow_h,
    stop_rows,
    stop_speed,
    to_rest,
)
from openacr.trajectory.speed.spacing import continued, sharpest, widest
from openacr.trajectory.speed.speed_rows_cy import PARTS
from openacr.trajectory.speed.window import Curve, Window

State = tuple[Any, ...]

SLOW_STEPS = 2.0  # of time between two knots where the feed is low
END_ROWS = 8  # control points that shape an end
MOST_AGAIN, AGAIN_SHARE, SPEED_AGAIN = 3, 0.96, 0.9998
SLOWER = (0.8, 0.5, 0.2, 0.0)  # shares between the slow law and the fastest
SLOWDOWN, MOST_SLOWDOWNS = 1.05, 40
SCALES = np.array(
    [SLOWDOWN, 1.0, 1.0 / SLOWDOWN, 1.0 / SLOWDOWN**2]
)  # of time, distance ... in a law
BACKWARDS = np.array([-1.0, -1.0, 1.0, -1.0])  # a row of a start as one of an end
LEAST_KNOTS = 32  # ahead of what is committed
RAMP = 12  # dense knots from one slow speed to the next
MOST_TRIES = 40
MULTIPLES = (1.0, 2.0, 4.0, 8.0, 16.0)  # of RAMP, where a slow start is not found
BATCH = 0.5  # of that, committed at once
LEAST_AGAIN = 12  # knots of a window that is planned again


@dataclass(frozen=True, slots=True)
class Solved:
    """A window as it was planned: the rows of its law from `first` on, its knots and their law.

    `done`: the number of the last knot that is committed; `has_end`: the knots include those of
    the end.
    """

    first: int
    rows: Reals
    knots: Reals
    x: Reals
    shares: Shares
    done: int
    has_end: bool = False

    @property
    def times(self) -> Reals:
        """The times of the knots."""
        return self.rows[self.first : self.first + PARTS * (len(self.knots) - 5) + 1 : PARTS, 0]

    @property
    def done_s(self) -> float:
        """The time up to which it is committed."""
        return float(self.rows[self.first + PARTS * self.done, 0])

    def knot_after(self, since_s: float) -> int | None:
        """The first knot after a time from which the window may be planned again."""
        at = int(np.searchsorted(self.times, since_s))
        return None if at > min(self.done, len(self.times) - LEAST_AGAIN) else at


class SmoothCourse(Course):
    """A course that grows with its chain."""

    __slots__ = (
        "_along",
        "_begun_s",
        "_first",
        "_grid",
        "_has_end",
        "_kept",
        "_knots",
        "_last",
        "_limits",
        "_period_s",
        "_rules",
        "_slow_h",
        "_solved",
        "_spare",
        "_tube",
        "_x",
        "catches_up",
        "factor",
        "look_u",
        "sections",
        "steps",
    )  # fmt: skip

    def __init__(
        self, limits: Limits, period_s: float, known: Sequence[Piece], soft: Soft | None
    ) -> None:
        first = known[0]
        super().__init__(first.start, first.start, course_cy.OPEN)
        self._limits, self._period_s = limits, period_s
        grain = grain_of(limits, period_s, known)
        along, dense_u, time_s = grain.along, grain.dense_u, grain.time_s
        share = tube_share(grain.across_ups2, period_s, grain.tolerance_u)
        self._tube = Tube(limits.axes, grain.step_u, share, grain.piece_u)
        self._last = Soft(along.jerk, 0.0)
        start = self._last if soft is None else soft.at_most(along.jerk)
        self._grid = Grid(dense_u, time_s, REST_SHARE * start.jerk, start.swing_u)
        self.sections = Sections()
        rest_u = 40.0 * self._grid.jerk * time_s**3
        self._rules = KnotRules(limits, period_s, self.sections, self._tube, rest_u, soft)
        self._kept = np.zeros((1, 4))
        self._knots = np.empty(0)
        self._x = np.empty(0)
        self._begun_s = 0.0  # where the present window begins
        self._solved: tuple[Solved, ...] = ()  # the windows that are not passed
        self._spare: State | None = None  # of the course, before it was reopened
        self.catches_up = False  # what was planned is planned again: by windows as long as before
        self._has_end = False  # the knots include those of the end
        self._slow_h: float = min(
            stop_speed(4.0 * dense_u, along.jerk) ** 2, 0.25 * along.acceleration * RAMP * dense_u
        )
        self._along: Along = along
        self._first = known
        self.factor = first.factor  # the highest one of its feeds
        self.look_u = look_ahead(along)
        self.steps = 0  # of the solver, all windows together

    # --- input -------------------------------------------------------------------

    def add(self, piece: Piece) -> None:
        """Append a piece of the chain."""
        self._tube.add(piece)
        self.sections.add(piece, self._tube.known_u)

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
        self._rules.close(self._last)

    @property
    def is_closed(self) -> bool:
        """Whether the end of the chain is known."""
        return math.isfinite(self._tube.length_u)

    @property
    def known_u(self) -> float:
        """The length of path that is known."""
        return self._tube.known_u

    @property
    def wants_u(self) -> float:
        """The length of path that has to be known before the next window."""
        return self._wants_from(float(self._knots[2]) if len(self._knots) else 0.0)

    def _wants_from(self, begun_u: float) -> float:
        """The same where that window begins at a distance."""
        known_u = (RAMP + 8) * self._grid.length_u + AHEAD * self._tube.step
        return begun_u + (1.0 + BATCH) * self.look_u + known_u

    @property
    def _reaches_end(self) -> bool:
        """Whether the present window ends with the chain."""
        if self.catches_up and self.wants_u < self._tube.length_u:
            return False
        return self.is_closed

    # --- faster ------------------------------------------------------------------

    def hasten(self, since_s: float, factor: float, ahead_u: float) -> bool:
        """Raise the factor of the feeds; whether a part of the course has to be planned again.

        That is what the windows have committed after `since_s`, where enough is known of the
        path: it has `ahead_u` more. Else the windows that follow run faster.
        """
        self.factor = max(self.factor, factor)
        is_complete, self.look_u = self.is_complete, max(self.look_u, self._look_u())
        is_open = self._reopen(since_s, ahead_u)
        if is_open or not is_complete:
            self.sections.hasten(float(self._kept[-1, 1]), factor)
        return is_open

    def _look_u(self) -> float:
        """The look-ahead distance at the highest feed that was known at the start."""
        rules = (piece.segment for piece in self._first)
        feed = max(each.feed_ups * min(self.factor, each.fastest) for each in rules)
        return look_ahead(replace(self._along, speed=max(self._along.speed, feed)))

    def _reopen(self, since_s: float, ahead_u: float) -> bool:
        """Go back to the first knot of a window after a time, if it is committed further."""
        found = ((each, each.knot_after(since_s)) for each in self._solved)
        solved, at = next(((each, at) for each, at in found if at is not None), (None, 0))
        if solved is None:
            return False
        if self._wants_from(float(solved.knots[at + 2])) > self.known_u + ahead_u:
            return False
        self._spare = self._state()
        self._kept = solved.rows[: solved.first + PARTS * at + 1].copy()
        self._knots, self._x = solved.knots[at:].copy(), solved.x[at:].copy()
        self._rules.set_shares(solved.shares)
        self._rules.drop(at)
        self._has_end, self.is_complete, self._solved = solved.has_end, False, ()
        self.catches_up = not solved.has_end
        self.committed_s = float(self._kept[-1, 0])
        return True

    def _state(self) -> State:
        """What a window changes."""
        return (self._knots, self._x, self._kept, self._rules.shares(), self._rules.ease,
                self._solved, self._has_end, self._begun_s, self.Z,
                self.H[course_cy.H_ROWS], self.committed_s, self.is_complete,
                self.catches_up)  # fmt: skip

    def _return_to(self, state: State) -> None:
        """Be as the course was before."""
        (self._knots, self._x, self._kept, shares, self._rules.ease, self._solved, self._has_end,
         self._begun_s, self.Z, self.H[course_cy.H_ROWS], self.committed_s,
         self.is_complete, self.catches_up) = state  # fmt: skip
        self._rules.set_shares(shares)

    # --- one window --------------------------------------------------------------

    def plan(self) -> None:
        """Plan the next window, and commit what may be run.

        Where a course that was reopened finds no other speed it is what it was before.
        """
        try:
            self._plan()
        except TrajectoryError:
            if self._spare is None:
                raise
            self._return_to(self._spare)
        self._spare = None

    def _plan(self) -> None:
        """Plan the next window.

        Its setpoints are checked; where one is above a limit the window is planned again with less
        of the jerk, or of the speeds where those are above theirs, and then more slowly.
        TrajectoryError where nothing keeps the limits: what was committed before still ends at
        rest.
        """
        self._tube.grow()
        points, origin = self._tube.control_points()
        is_first = not len(self._knots)
        self.set_path(points, self._tube.step, origin)
        state = self._state()
        before = self._knots, self._x, self._kept
        shares, fast = self._rules.shares(), 1.0
        for share in (*(1.0,) * (MOST_AGAIN + 1), *SLOWER):
            self._knots, self._x, self._kept = before
            self._rules.set_shares(shares)
            self._plan_window(points, origin, share, fast)
            speed, push, jerk = self._samples(is_first=is_first)
            if max(speed, push, jerk) <= 1.0:
                return
            if speed > 1.0:
                fast *= (SPEED_AGAIN / speed) ** 2
            if max(push, jerk) > 1.0 and share == 1.0:
                self._rules.ease *= AGAIN_SHARE
            if is_first and share < 1.0 and self._slow_down():
                return
        self._return_to(state)
        line = self.sections.lines[-1]
        raise TrajectoryError(f"line {line}: no speed keeps the limits")

    def _slow_down(self) -> bool:
        """Run the first window, which begins at rest, more slowly; False where that is no help."""
        for _ in range(MOST_SLOWDOWNS):
            rows = np.asarray(self.Z).reshape(-1, 4)
            rows[:] *= SCALES
            self._kept = self._kept * SCALES
            self.committed_s *= SLOWDOWN
            self._x = self._x / SLOWDOWN**2
            if max(self._samples(is_first=True)) <= 1.0:
                return True
        return False

    def _samples(self, *, is_first: bool) -> tuple[float, ...]:
        """The largest speed, acceleration and jerk of the present window's setpoints, by limits."""
        since_s = None if is_first else self._begun_s
        found = setpoints_by_limits(self, self._limits, self._period_s, since_s)
        return tuple(found.tolist())

    def _plan_window(self, points: Reals, origin: float, share: float, fast: float) -> None:
        """Plan the window; `share` 0 is a slow law that keeps the limits, 1 the fastest.

        `fast` is the share of the squared speeds that is used between knots.
        """
        curve = Curve(self.C, len(points), self._limits.axes, self._tube.step, origin)
        is_first = not len(self._knots)
        before = self._new_knots(points, origin)
        tail_u = math.inf if self._reaches_end else float(self._knots[-3]) - self.look_u
        window = Window(
            curve, self._knots, self._rules.next(self._knots, max(before - 4, 0), tail_u),
            Rest(0.0, self._grid.swing_u) if is_first else None,
            Rest(self._tube.length_u, self._last.swing_u) if self._reaches_end else None,
        )  # fmt: skip
        level = slow_h(
            curve, self._rules.fresh, float(self._knots[max(before - RAMP, 2)]),
            self._tube.valid_u, self._grid.length_u, self._slow_h,
        )  # fmt: skip
        start = self._slow_start(window, level, is_first)
        slowness = 1.0 / math.sqrt(float(window.cap.max()))
        fastest, steps = window.fit(start, slowness, fast)
        self._x = window.towards(start, fastest, share)
        self.steps += steps
        self._commit(window, is_first)

    def _slow_start(self, window: Window, level: float, is_first: bool) -> Reals:
        """Coefficients that keep all limits, as fast as they are easily found.

        What was planned ends at a slow speed along its own direction. Where an axis with far lower
        limits comes in there, more path is needed to be still slower.
        """
        for multiple in MULTIPLES:
            ease = 1.0
            for _ in range(MOST_TRIES):
                start = window.tie(self._guess(level * ease, ease, multiple, is_first))
                if window.slack(start) > 0.0:
                    return start
                ease *= 0.5
        line = self.sections.lines[-1]
        raise TrajectoryError(f"line {line}: no slow speed keeps the limits")

    def _new_knots(self, points: Reals, origin: float) -> int:
        """Append knots as far as the path is final; returns how many there were before."""
        tube, grid, before = self._tube, self._grid, len(self._knots)
        if self._has_end:
            return before
        dense, length = grid.length_u, tube.length_u
        end_u = tube.valid_u - (RAMP + 4) * dense
        last: list[float] = []
        if self.catches_up:
            limit_u = self.wants_u - AHEAD * tube.step - (RAMP + 4) * dense
            self.catches_up = limit_u < end_u
            end_u = min(end_u, limit_u)
        if self._reaches_end:
            ending = Grid(dense, grid.time_s, REST_SHARE * self._last.jerk, self._last.swing_u)
            ending = ending.on(sharpest(points[-END_ROWS:], tube.step))
            last = [length - s for s in reversed(ending.graded(0.5 * length))]
            end_u = last[0]
        if not before:
            grid = grid.on(sharpest(points[:END_ROWS], tube.step))
            self._knots = np.array(first_knots(grid, 0.5 * min(end_u, length)))
        s: Reals = origin + tube.step * (np.arange(len(points) - 3, dtype=np.float64) + 0.5)
        feeds = self.sections.feeds(s)
        gaps = widest(points, tube.step, feeds, min(self._limits.acceleration_ups2),
                      min(self._limits.jerks(self._period_s)), dense)  # fmt: skip
        np.minimum(gaps, SLOW_STEPS * grid.time_s * feeds, out=gaps)
        np.minimum(gaps, max(self.look_u / LEAST_KNOTS, dense), out=gaps)
        end_gap = (last[1] if len(last) > 1 else length) - last[0] if last else None
        self._knots = continued(self._knots, s, gaps, end_u, end_gap)
        if last:
            self._knots = closed_knots(self._knots, last, length)
        return before

    def _guess(self, level: float, ease: float, multiple: float, is_first: bool) -> Reals:
        """Those coefficients: the ones planned before, then a slow constant speed."""
        knots, old = self._knots, len(self._x)
        x = np.empty(len(knots) - 2)
        x[:old] = self._x
        if old == len(x):
            return x
        place = places(knots)
        new = place[old:]
        inverse = np.full(len(new), level**-2.0)
        brake = min(self._limits.acceleration_ups2)
        if is_first:
            begin = Soft(self._grid.jerk, 0.0, self._grid.swing_u)
            to_rest(inverse, np.maximum(new, knots[2]), brake, begin, ease)
        if self._reaches_end:
            to_end = self._tube.length_u - np.minimum(new, knots[-3])
            to_rest(inverse, to_end, brake, self._last, ease)
        x[old:] = inverse**-0.5
        if old:
            length = multiple * RAMP * self._grid.length_u
            x[old:] = eased(x[old - 1], x[old:], new - place[old - 1], length)
        return x

    def _commit(self, window: Window, is_first: bool) -> None:
        """Make the law of the window, and commit its first part."""
        knots, kept, count = self._knots, len(self._kept), window.count
        z = np.zeros((kept + PARTS * count + 4, 4))
        z[:kept] = self._kept
        row = kept - 1
        if is_first:
            row = kept + 1
            w = window.plain[0].reshape(3, 3) @ self._x[:3]
            s, swing_u, v = float(knots[2]), self._grid.swing_u, math.sqrt(w[0])
            z[row] = (rest_shape(s, swing_u)[2] / v, s, v, 0.5 * w[1])
            z[kept] = turn_row(z[row, 0], s, swing_u)
        window.continue_law(self._x, z, row)
        last = row + PARTS * (count - 1)
        self._begun_s = 0.0 if is_first else float(z[row, 0])
        if self._reaches_end:
            length, swing_u = self._tube.length_u, self._last.swing_u
            s = length - float(knots[-3])
            time_s = rest_shape(s, swing_u)[2] / z[last, 2]
            z[last + 2] = (z[last, 0] + time_s, length, 0.0, 0.0)
            z[last + 1] = z[last + 2] + np.array(turn_row(time_s, s, swing_u)) * BACKWARDS
            self._note(Solved(row, z, knots, self._x, self._rules.shares(), count - 1, True))
            self.is_complete = True
            self.set_law(flat(z), last + 3)
            self.committed_s = float(z[last + 2, 0])
            return
        jerk = SLOW_JERK * min(self._limits.jerks(self._period_s))
        brake = 0.5 * min(self._limits.acceleration_ups2)
        z[last + 1 : last + 4] = np.reshape(stop_rows(list(z[last]), jerk, brake), (3, 4))
        self.set_law(flat(z), last + 4)
        done = int(np.searchsorted(knots[2:-2], knots[-3] - self.look_u)) - 1
        done = max(done, 1)
        self._note(Solved(row, z, knots, self._x, self._rules.shares(), done))
        self.committed_s = float(z[row + PARTS * done, 0])
        self._kept = z[: row + PARTS * done + 1].copy()
        self._knots, self._x = knots[done:].copy(), self._x[done:].copy()
        self._rules.drop(done)

    def _note(self, solved: Solved) -> None:
        """Keep a window, so that a faster feed may begin in it."""
        self._solved = (*self._solved, solved)

    def drop(self, time_s: float) -> None:
        """Forget what lies before a time of the course."""
        self._solved = tuple(each for each in self._solved if each.done_s > time_s)
        keep = int(np.searchsorted(self._kept[:, 0], time_s)) - 2
        if keep > 0:
            self._kept = self._kept[keep:].copy()
            s = float(self._kept[0, 1])
            self._tube.drop(s)
            self.sections.drop(s)
