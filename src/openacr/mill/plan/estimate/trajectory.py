"""Setpoints of a planned program over time, without a card.

A planned curve is the spline of its control points, as the card runs it. Any other move runs
through phases (see `phases`); its shape gives the position. At a rounded corner the path leaves the
programmed one towards the other move, by the law of the card (kernel/path/corner_cy.py).
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from openacr.cnc.canonical import AXES, Arc, Point
from openacr.kernel.path.corner_cy import corner_lift
from openacr.mill.config.curves import PERIOD_S as KNOT_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_window import REST
from openacr.mill.plan.moves.arcs import along
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.geometry import linear_axes
from openacr.mill.plan.moves.phases import Phases, duration_s
from openacr.mill.plan.moves.planning import Corner
from openacr.plant.describe import schema
from openacr.trajectory.path.setpoints import evaluate

Rows = NDArray[np.float64]
PERIOD_S = schema.Card().period_s  # of the virtual machine
TOGETHER = 4096  # rows passed to `write` at once
ROUNDING = 1e-9  # of a period: a sample at the very end of a move belongs to it


class Trajectory:
    """Samples the moves of a program as they are planned; give it to a `Predictor` as reader.

    `write` gets rows of time [s], the position of each axis [units of the machine] and the line.
    """

    def __init__(self, settings: Settings, period_s: float, write: Callable[[Rows], None]) -> None:
        self._axes = [axis.index for axis in settings.axes]
        self._linear = linear_axes(settings)  # axes for which tangents have a component
        self._period_s = period_s
        self._write = write
        self._rows: list[list[float]] = []
        self._count = 0  # samples so far
        self._time_s = 0.0  # at the end of the moves that are sampled
        self._place: Point = (0.0,) * AXES
        self._line = 0
        self._before: Job | None = (
            None  # the last move sampled, where a corner joins it to the next
        )
        self._next: tuple[Job, Phases] | None = None  # waits for the direction of its successor
        self._in_curve: list[tuple[int, float]] = []  # lines and times of the moves of a curve

    def read(self, job: Job) -> None:
        """Ignore a move that is not planned yet."""

    def curve(self, points: Rows) -> None:
        """Sample a planned curve: the spline of its control points, which runs from knot 1 on."""
        begin_s, self._time_s = self._time_s, self._time_s + (len(points) - REST) * KNOT_S
        last = math.floor(self._time_s / self._period_s + ROUNDING)
        now_s = np.arange(self._count, last + 1, dtype=np.float64) * self._period_s
        self._count = last + 1
        knots = 1.0 + (now_s - begin_s) / KNOT_S
        places = evaluate(points, knots)[0]
        lines, seconds = zip(*self._in_curve, strict=True)
        move = np.searchsorted(np.cumsum(seconds)[:-1], now_s - begin_s, "right")
        self._rows += np.column_stack([now_s, places, np.array(lines)[move]]).tolist()
        self._line, self._in_curve = lines[-1], []
        self._flush()

    def passed(self, job: Job, phases: Phases) -> None:
        """Receive a planned move; the one before it is sampled, because its corner is now known."""
        if job.is_in_curve:
            self._sample(None)
            self._before, self._place = None, job.finish
            self._in_curve.append((job.entry.source.line, duration_s(phases)))
            return
        self._sample(job)
        self._next = job, phases

    def rested(self, seconds: float) -> None:
        """Sample a stop and its dwell."""
        self._sample(None)
        self._before = None
        self._until(self._time_s + seconds, lambda _now_s: self._place)

    def close(self) -> None:
        """Sample the remaining move, with the end of the program as last row."""
        self.rested(0.0)
        self._add(self._time_s, self._place)
        self._flush()

    def _sample(self, following: Job | None) -> None:
        """Sample the waiting move."""
        if self._next is None:
            return
        job, phases = self._next
        self._next = None
        begin_s, before = self._time_s, self._before
        ends_s = np.cumsum([0.0, *(phase.seconds for phase in phases)])
        starts_u = np.cumsum([0.0, *(phase.length_u for phase in phases)])
        self._line = job.entry.source.line

        def place(now_s: float) -> Point:
            k = min(int(np.searchsorted(ends_s, now_s - begin_s, "right")) - 1, len(phases) - 1)
            travelled = starts_u[k] + phases[k].at(now_s - begin_s - ends_s[k])[0]
            return self._at(job, before, following, min(float(travelled), job.length_u))

        self._until(begin_s + float(ends_s[-1]), place)
        self._place, self._before = job.finish, job

    def _at(self, job: Job, before: Job | None, following: Job | None, travelled_u: float) -> Point:
        share = travelled_u / job.length_u
        if isinstance(job.entry, Arc):
            point = list(along(job.entry, job.begin, share))
        else:
            point = [a + share * (b - a) for a, b in zip(job.begin, job.finish, strict=True)]
        if before is not None and before.corner is not None:
            self._lift_off(point, before.corner, before, job, travelled_u)
        if following is not None and job.corner is not None:
            self._lift_off(point, job.corner, job, following, job.length_u - travelled_u)
        return tuple(point)

    def _lift_off(
        self, point: list[float], corner: Corner, first: Job, second: Job, away_u: float
    ) -> None:
        """Move a point of the programmed path onto the rounded corner, `away_u` from it."""
        if first.end is None or second.start is None:
            return
        lift = corner_lift(away_u, corner.reach_u, 0)
        for axis, a, b in zip(self._linear, first.end, second.start, strict=True):
            point[axis] += lift * (b - a)

    def _until(self, end_s: float, place: Callable[[float], Point]) -> None:
        """Add the samples up to a time."""
        last = math.floor(end_s / self._period_s + ROUNDING)
        while self._count <= last:
            now_s = self._count * self._period_s
            self._add(now_s, place(now_s))
            self._count += 1
        self._time_s = end_s

    def _add(self, now_s: float, point: Point) -> None:
        if self._rows and self._rows[-1][0] == now_s:
            return
        self._rows.append([now_s, *(point[axis] for axis in self._axes), self._line])
        if len(self._rows) >= TOGETHER:
            self._flush()

    def _flush(self) -> None:
        if self._rows:
            self._write(np.array(self._rows))
            self._rows = []
