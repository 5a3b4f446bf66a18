"""The space in which a path is planned: linear axes as they are, rotary axes by a radius.

The planner keeps one tolerance and one length along all axes, so a degree counts as a length
(`geometry.per_degree`). Where the factor is a power of two, a place converted to the plan and back
is the same to the last bit; with another one it is within the rounding of a float.
"""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import (
    ACCELERATION_SHARE,
    JERK_SHARE,
    accelerations,
    speeds,
)
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.geometry import weights
from openacr.trajectory import Limits, Setpoints

Rows = NDArray[np.float64]


class PlanMetric:
    """Converts places and distances between the machine and the plan of a path."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        each = weights(settings)
        self._factors = np.array([each[axis.index] for axis in settings.axes])
        self._turns = [
            (axis.index, each[axis.index]) for axis in settings.axes if not axis.is_linear
        ]
        self._planned_u = deque([0.0])  # where moves end, along the plan
        self._moved_u = deque([0.0])  # and as the sum of their own lengths

    def limits(self) -> Limits:
        """What the planner may use of the limits of the machine."""
        axes = self._settings.axes
        return Limits(
            self._scaled(speeds(self._settings)),
            self._scaled([ACCELERATION_SHARE * each for each in accelerations(self._settings)]),
            self._scaled([JERK_SHARE * axis.jerk_ups3 for axis in axes]),
            tuple(axis.is_linear for axis in axes) if self._turns else (),
        )

    def place(self, place: Sequence[float]) -> tuple[float, ...]:
        """A place of the machine, one value per configured axis, as one of the plan."""
        return self._scaled(place)

    def of_plan(self, places: Rows) -> Rows:
        """Places of the plan as those of the machine."""
        found: Rows = places / self._factors
        return found

    def _scaled(self, values: Sequence[float]) -> tuple[float, ...]:
        return tuple(
            value * factor for value, factor in zip(values, self._factors.tolist(), strict=True)
        )

    def length_ratio(self, job: Job) -> float:
        """The length of a move in the plan, as a multiple of its own."""
        turned_u = math.hypot(
            *(weight * (job.finish[axis] - job.begin[axis]) for axis, weight in self._turns)
        )
        own_u = 0.0 if job.start is None else job.length_u
        return math.hypot(own_u, turned_u) / job.length_u

    def note(self, planned_u: float, length_u: float) -> None:
        """Note the length of a move in the plan, and its own."""
        self._planned_u.append(self._planned_u[-1] + planned_u)
        self._moved_u.append(self._moved_u[-1] + length_u)

    def of_machine(self, found: Setpoints) -> Setpoints:
        """Setpoints of the plan as those of the machine, with distances by lengths of moves."""
        marks, moved = list(self._planned_u), list(self._moved_u)
        path_u = np.interp([*found.path_u, found.rest_path_u], marks, moved)
        while len(self._planned_u) > 2 and self._planned_u[1] <= found.path_u[0]:
            self._planned_u.popleft()
            self._moved_u.popleft()
        return replace(
            found,
            points=self.of_plan(found.points),
            rest=self.of_plan(found.rest),
            path_u=path_u[:-1],
            rest_path_u=float(path_u[-1]),
        )
