"""The control points of one planned curve, from rest to rest, and where they are on the path."""

from collections import deque
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import accelerations, stop_s
from openacr.trajectory import Setpoints
from openacr.trajectory.override.timescale import Progress, TimeScale

Rows = NDArray[np.float64]
REST = 3  # equal control points
SLOWING = 50  # knots in which a scale of time is slowed down, mostly


class CurveRows:
    """Cuts a curve out of the setpoints of a plan: it begins and ends with REST equal points."""

    def __init__(self, start: Rows) -> None:
        self._start = start
        self._last = np.repeat(start[None, :], REST, axis=0)
        self._rest = self._last
        self._rest_u = 0.0
        self._has_begun = False

    def add(self, found: Setpoints) -> tuple[Rows, Rows]:
        """The control points and their places on the path, without those that repeat the start."""
        points, paths = found.points, found.path_u
        if not self._has_begun:
            moved = np.flatnonzero((points != self._start).any(axis=1))
            begin = int(moved[0]) if len(moved) else len(points)
            points, paths = points[begin:], paths[begin:]
            self._has_begun = len(points) > 0
        self._last = np.concatenate([self._last, points])[-REST:]
        self._rest, self._rest_u = found.rest, found.rest_path_u
        return points, paths

    def tail(self) -> tuple[Rows, Rows]:
        """The points that lead to rest after all that were added."""
        points = np.concatenate([self._last, self._rest])
        while len(points) > REST and (points[-REST - 1] == points[-1]).all():
            points = points[:-1]
        count = len(points) - REST
        return points[REST:], np.full(count, self._rest_u)


class CurveWindow:
    """The part of a curve that is known ahead, run through at a scale of its time."""

    def __init__(self, start: Rows, settings: Settings) -> None:
        self._limits = accelerations(settings), [axis.jerk_ups3 for axis in settings.axes]
        self.scale = TimeScale(start.tolist(), PERIOD_S, *self._limits)
        self._last = start[None, :]
        self._fastest_ups = np.zeros(len(start))  # of each axis so far
        self._rows = CurveRows(start)
        self._paths: deque[float] = deque()  # the path at knots, from `_first` on
        self._factors: deque[float] = deque()  # of the feeds there
        self._first = 1

    def append(self, found: Setpoints) -> None:
        """Add setpoints."""
        points, paths = self._rows.add(found)
        self._append(points, paths, found.factors[len(found.factors) - len(points) :])

    def complete(self) -> None:
        """Let the curve end as its last setpoints say."""
        points, paths = self._rows.tail()
        self._append(points, paths, np.ones(len(points)))
        self.scale.complete()

    def _append(self, points: Rows, paths: Rows, factors: Rows) -> None:
        if len(points):
            steps = np.abs(np.diff(np.concatenate([self._last, points]), axis=0))
            self._fastest_ups = np.maximum(self._fastest_ups, steps.max(axis=0) / PERIOD_S)
            self._last = points[-1:]
            self.scale.append(points)
            self._paths.extend(paths.tolist())
            self._factors.extend(factors.tolist())

    def next(self) -> tuple[Progress, Rows]:
        """The next control point."""
        return self.scale.next()

    @property
    def ahead_s(self) -> float:
        """How long what is known ahead takes at the planned speed."""
        return self.scale.ahead * PERIOD_S

    @property
    def stop_s(self) -> float:
        """The quickest ramp to rest from the highest speeds of the curve so far."""
        return max(map(stop_s, self._fastest_ups.tolist(), *self._limits))

    @property
    def path_u(self) -> float:
        """The path at the last control point."""
        self._pass()
        return self._paths[0] if self._paths else 0.0

    @property
    def factor(self) -> float:
        """The highest factor of the feeds, of the plan at the last control point and soon after."""
        self._pass()
        return max(islice(self._factors, SLOWING), default=1.0)

    def _pass(self) -> None:
        knot = int(self.scale.knot)
        while self._first < knot and len(self._paths) > 1:
            self._paths.popleft()
            self._factors.popleft()
            self._first += 1
