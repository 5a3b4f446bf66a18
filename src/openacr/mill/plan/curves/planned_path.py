"""Moves with a path tolerance on a machine with a jerk limit: one planned curve from rest to rest.

`openacr.trajectory` plans path and time; here are the limits of the machine, and which move the
curve is in. A move without a tolerance does not belong to such a curve (`is_planned`): it is sent
as a move of its own, as on any machine.
"""

import math
from collections import deque
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from openacr.cnc.canonical import Arc
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.plan_metric import PlanMetric
from openacr.mill.plan.moves.encoding import Job
from openacr.trajectory import Arc as PlanArc
from openacr.trajectory import Segment, Setpoints, TrajectoryError, TrajectoryPlanner

Rows = NDArray[np.float64]
AHEAD_U = 1e-9
MOST_POINTS = 1024  # of one take
PASSED_S = 0.4  # of motion at the programmed feeds that the planner knows, at least
PASSED_FASTER_S = 1.2  # the same where a part of it is to be planned again with higher feeds


class PlannedPath:
    """The moves of one curve: those that are not begun, and their setpoints."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._axes = [axis.index for axis in settings.axes]
        self._scales = [axis.pulses_per_unit for axis in settings.axes]
        self._jobs: deque[tuple[float, Job]] = deque()  # with the path before each of them
        self._waiting: deque[Job] = deque()  # not passed to the planner
        self._planner: TrajectoryPlanner | None = None
        self._metric = PlanMetric(settings)
        self._path_u = 0.0
        self.planned_u = 0.0  # the path of the moves that the planner has
        self._feed = 1.0
        self.start: Rows = np.zeros(len(self._axes))  # whole pulses
        self._known_s = self._passed_s = 0.0
        self._is_stopped = False  # the path known so far ends at rest
        self.is_at_end = False  # and all of it is planned
        self.is_open = False  # its control points are being sent
        self.fault = ""  # why the rest of it cannot be planned: it ends at rest before that

    # --- moves --------------------------------------------------------------------------

    def add(self, job: Job) -> None:
        """Append a move."""
        if self._planner is None:
            self._metric = PlanMetric(self._settings)
            start = self._metric.place(self._whole(job.begin_cnt))
            self.start = self._metric.of_plan(np.array(start))  # as its first setpoints
            self._planner = TrajectoryPlanner(start, self._metric.limits(), PERIOD_S)
            self._planner.override(self._feed)
        self._is_stopped = self.is_at_end = False
        job.is_in_curve = True
        self._jobs.append((self._path_u, job))
        self._path_u += job.length_u
        self._known_s += job.length_u / job.feed_ups
        self._waiting.append(job)

    def override(self, factor: float) -> None:
        """Plan what has not been taken with a factor of the feeds: an override above 100 %."""
        planner, rises = self._planner, factor > self._feed
        self._feed = factor
        if planner is None:
            return
        while rises and self._passed_s < PASSED_FASTER_S and self._pass_on(planner):
            pass
        planner.override(factor)

    def _pass_on(self, planner: TrajectoryPlanner) -> bool:
        """Pass a move on to the planner; the last one only where the path rests, on a pulse."""
        if len(self._waiting) <= (not self._is_stopped):
            return False
        job = self._waiting.popleft()
        ends = not self._waiting
        end = self._whole(job.finish_cnt) if ends else self._place(job.finish)
        ratio = self._metric.length_ratio(job)
        entry = job.entry
        arc = None
        if isinstance(entry, Arc):
            first, second = (self._axes.index(a) for a in (entry.plane.first, entry.plane.second))
            arc = PlanArc(first, second, entry.centre, entry.sweep_rad)
        self.planned_u += job.length_u
        self._passed_s += job.length_u / job.feed_ups
        planned_u = planner.add(
            Segment(
                line=entry.source.line, end=self._metric.place(end),
                feed_ups=job.feed_ups * ratio, tolerance_u=job.path_tolerance_u,
                is_rapid=job.is_rapid, arc=arc, tool_ups=job.feed_ups,
                fastest=self._fastest(job),
            )
        )  # fmt: skip
        self._metric.note(planned_u, job.length_u)
        if ends:
            planner.stop()
        return True

    def _fastest(self, job: Job) -> float:
        """The largest factor of the feed of a move."""
        if job.is_rapid:
            return 1.0
        if job.start is None:  # of rotary axes alone: the planner has their limits
            return math.inf
        return max(self._settings.speeds.max_ups / job.feed_ups, 1.0)

    def _whole(self, counts: Sequence[int]) -> tuple[float, ...]:
        return tuple(count / scale for count, scale in zip(counts, self._scales, strict=True))

    def _place(self, point: Sequence[float]) -> tuple[float, ...]:
        return tuple(point[axis] for axis in self._axes)

    def __len__(self) -> int:
        """The moves that have not begun, and 1 for a curve that is not at its end or has none."""
        return len(self._jobs) + (self.is_open or bool(self.fault))

    @property
    def known_s(self) -> float:
        """How long the moves that have not begun take at their feeds."""
        return self._known_s

    def __iter__(self) -> Iterator[Job]:
        return (job for _, job in self._jobs)

    def begun(self, path_u: float) -> Iterator[Job]:
        """Remove and yield the moves that have begun where the curve is `path_u` along the path."""
        while self._jobs and self._jobs[0][0] < path_u - AHEAD_U:
            job = self._jobs.popleft()[1]
            self._known_s -= job.length_u / job.feed_ups
            self._passed_s -= job.length_u / job.feed_ups
            yield job

    def clear(self) -> list[Job]:
        """Remove and return the moves that have not begun; the plan is dropped."""
        jobs = [job for _, job in self._jobs]
        self._jobs.clear()
        self._waiting.clear()
        self._planner = None
        self._path_u = self.planned_u = self._known_s = self._passed_s = 0.0
        self.is_open = self._is_stopped = self.is_at_end = False
        self.fault = ""
        return jobs

    # --- setpoints ----------------------------------------------------------------------

    def stop(self) -> None:
        """Let the path known so far end at rest."""
        if self._planner is not None and not self._is_stopped:
            self._is_stopped = True
            if not self._waiting:
                self._planner.stop()

    def take(self, most: int = MOST_POINTS) -> Setpoints | None:
        """The next setpoints, `most` at most; None where nothing more can be planned yet.

        That is so for good where there is a `fault`.
        """
        if self.fault:
            return None
        try:
            return self._next(most)
        except TrajectoryError as error:
            self.fault, self.is_at_end = str(error), True
            return None

    def prepare(self, ahead_s: float) -> bool:
        """Plan one more section of what is to be taken within a time; whether there was any."""
        planner = self._planner
        if planner is None or self.fault:
            return False
        while self._passed_s < PASSED_S + ahead_s and self._pass_on(planner):
            pass
        return planner.prepare(math.ceil(ahead_s / PERIOD_S))

    @property
    def ready_s(self) -> float:
        """How long the setpoints take that are planned and not taken."""
        return 0.0 if self._planner is None else self._planner.ready * PERIOD_S

    def _next(self, most: int) -> Setpoints | None:
        planner, found = self._planner, None
        while planner is not None and found is None:
            while self._passed_s < PASSED_S and self._pass_on(planner):
                pass
            found = planner.take(most)
            if found is None and not self._pass_on(planner):
                break
        self.is_at_end = found is None and self._is_stopped
        return None if found is None else self._metric.of_machine(found)

    def end_at(self, point: Rows) -> None:
        """Note that the curve has ended at rest: another one begins there."""
        self.is_open = False
        self.start = point
        if not self._jobs:
            self._planner = None
            self._path_u = self.planned_u = 0.0
