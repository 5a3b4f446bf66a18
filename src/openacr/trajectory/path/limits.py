"""Limits of the axes, and what they leave along a direction."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import compress

from openacr.errors import OpenacrError

UNLIMITED = 1e300


class TrajectoryError(OpenacrError):
    """A segment, limit or tolerance that no trajectory can be planned for."""


@dataclass(frozen=True, slots=True)
class Along:
    """Limits of speed, acceleration and jerk along one direction."""

    speed: float
    acceleration: float
    jerk: float


@dataclass(frozen=True, slots=True)
class Limits:
    """Highest velocity, acceleration and jerk of every axis, in units and seconds.

    Without jerk limits the acceleration may step; on the grid of setpoints a step takes one period.
    `carries_tool`: the axes whose common speed is limited by `Segment.tool_ups`; empty for none.
    """

    velocity_ups: tuple[float, ...]
    acceleration_ups2: tuple[float, ...]
    jerk_ups3: tuple[float, ...] | None = None
    carries_tool: tuple[bool, ...] = ()

    def __post_init__(self) -> None:
        for name, unit, values in (
            ("velocity", "units/s", self.velocity_ups),
            ("acceleration", "units/s2", self.acceleration_ups2),
            ("jerk", "units/s3", self.jerk_ups3),
        ):
            if values is None:
                continue
            if len(values) != len(self.velocity_ups):
                raise TrajectoryError(
                    f"{len(values)} limits of {name} for {len(self.velocity_ups)} axes"
                )
            for axis, value in enumerate(values):
                if not 0.0 < value < UNLIMITED:
                    raise TrajectoryError(
                        f"limit of {name} of axis {axis} is {value} {unit} (above 0, finite)"
                    )

    @property
    def axes(self) -> int:
        """The number of axes."""
        return len(self.velocity_ups)

    def jerks(self, period_s: float) -> tuple[float, ...]:
        """The jerk limits planned with: without limits one acceleration in two periods."""
        if self.jerk_ups3 is not None:
            return self.jerk_ups3
        return tuple(0.5 * a / period_s for a in self.acceleration_ups2)

    def checked(self) -> tuple[float, ...]:
        """All limits as one row (`_row`); without jerk limits very large ones."""
        return self._row(self.jerk_ups3 or (UNLIMITED,) * self.axes)

    def planned(self, period_s: float) -> tuple[float, ...]:
        """All limits as one row (`_row`); without jerk limits those planned with."""
        return self._row(self.jerks(period_s))

    def _row(self, jerks: tuple[float, ...]) -> tuple[float, ...]:
        """Velocities, accelerations, jerks, and 1 for each axis that carries the tool, else 0."""
        tool = map(float, self.carries_tool or (False,) * self.axes)
        return (*self.velocity_ups, *self.acceleration_ups2, *jerks, *tool)

    def along(
        self,
        direction: Sequence[float],
        feed_ups: float,
        period_s: float,
        tool_ups: float = math.inf,
    ) -> Along:
        """The limits along a direction (a unit vector) at a feed, and at one of the tool."""
        tool = math.hypot(*compress(direction, self.carries_tool))
        return Along(
            min(
                feed_ups,
                tool_ups / tool if tool else math.inf,
                most(self.velocity_ups, direction),
            ),
            most(self.acceleration_ups2, direction),
            most(self.jerks(period_s), direction),
        )


def most(limits: Sequence[float], direction: Sequence[float]) -> float:
    """The largest multiple of any vector within the limits of all axes."""
    return min(
        (limit / abs(part) for limit, part in zip(limits, direction, strict=True) if part),
        default=UNLIMITED,
    )
