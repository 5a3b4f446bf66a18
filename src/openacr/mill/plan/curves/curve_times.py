"""The time a planned curve takes, move by move: as long as its control points on the card."""

from collections import deque
from collections.abc import Callable, Iterator

import numpy as np

from openacr.mill.config.curves import PERIOD_S
from openacr.mill.plan.curves.curve_window import REST, CurveRows
from openacr.mill.plan.curves.planned_path import PlannedPath, Rows
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.phases import Phases, even
from openacr.trajectory import TrajectoryError

NEAR_U = 1e-12


class CurveTimes:
    """Follows one curve from rest to rest without a card."""

    def __init__(self, path: PlannedPath, watch: Callable[[Rows], None] | None = None) -> None:
        """`watch` gets the control points at the end of the curve."""
        self.path = path
        self._watch = watch
        self._points: list[Rows] = []  # for it
        self.rest_s = 0.0  # at rest at its end
        self._rows: CurveRows | None = None
        self._jobs: deque[Job] = deque()  # begun and not done
        self._phases: Phases = []  # of the first of them
        self._left_u = 0.0  # of it
        self._at_u = 0.0  # the path at the last knot

    def advance(self, *, is_complete: bool) -> Iterator[tuple[Job, Phases]]:
        """Follow the curve as far as it can be planned.

        Yields the moves that are done with their phases: the parts of the path between two knots.
        """
        if is_complete:
            self.path.stop()
        while (found := self.path.take()) is not None:
            if self._rows is None:
                self._rows, self.path.is_open = CurveRows(self.path.start), True
            yield from self._pass(*self._rows.add(found))
        if self.path.fault:
            raise TrajectoryError(self.path.fault)
        if self._rows is not None and self.path.is_at_end:
            yield from self._pass(*self._rows.tail())
            yield from self._end()

    def _pass(self, points: Rows, paths: Rows) -> Iterator[tuple[Job, Phases]]:
        """Pass control points, one every period, with their places on the path."""
        if self._watch is not None:
            self._points.append(points)
        for knot_u in paths.tolist():
            for job in self.path.begun(knot_u):
                self._add(job)
            step_u = max(knot_u - self._at_u, 0.0)
            self._at_u = max(knot_u, self._at_u)
            if step_u <= NEAR_U or not self._jobs:
                self.rest_s += PERIOD_S
                continue
            yield from self._step(step_u, step_u / PERIOD_S)

    def _step(self, step_u: float, speed_ups: float) -> Iterator[tuple[Job, Phases]]:
        """One period at a speed; a move that ends in it is done."""
        while len(self._jobs) > 1 and step_u > self._left_u:
            self._phases.append(even(self._left_u, speed_ups, speed_ups))
            step_u -= self._left_u
            yield self._done()
        self._phases.append(even(step_u, speed_ups, speed_ups))
        self._left_u -= step_u

    def _add(self, job: Job) -> None:
        if not self._jobs:
            self._left_u = job.length_u
        self._jobs.append(job)

    def _done(self) -> tuple[Job, Phases]:
        job, phases = self._jobs.popleft(), self._phases
        self._phases = []
        self._left_u = self._jobs[0].length_u if self._jobs else 0.0
        return job, phases

    def _end(self) -> Iterator[tuple[Job, Phases]]:
        for job in self.path.begun(self.path.planned_u):
            self._add(job)
        while self._jobs:
            yield self._done()
        if self._watch is not None:
            begin = np.repeat(self.path.start[None, :], REST, axis=0)
            self._watch(np.concatenate([begin, *self._points]))
            self._points = []
        self._rows = None
        self._at_u = 0.0
        self.path.end_at(self.path.start)
