"""Phases of a planned move: parts of its path in which the acceleration changes evenly.

With the length L, the speeds v0 and v1 at the ends, the time T and the jerk j, t seconds after its
begin the tool has travelled

    s = v0 t + (v1 - v0) t^2 / (2 T) + j t^2 (t/6 - T/4)

at the speed v0 + (v1 - v0) t/T + j t (t - T)/2 and the acceleration (v1 - v0)/T + j (t - T/2).
Without a jerk that is a constant acceleration.
"""

from typing import NamedTuple


class Phase(NamedTuple):
    """A part of a move at constant jerk, in units of the path and seconds."""

    length_u: float
    begin_ups: float
    end_ups: float
    seconds: float
    jerk_ups3: float = 0.0

    def at(self, t_s: float) -> tuple[float, float, float]:
        """Distance, speed and acceleration `t_s` seconds after its begin."""
        T, j, change_ups = self.seconds, self.jerk_ups3, self.end_ups - self.begin_ups
        if T <= 0.0:
            return 0.0, self.begin_ups, 0.0
        distance_u = self.begin_ups * t_s + 0.5 * change_ups * t_s * t_s / T
        distance_u += j * t_s * t_s * (t_s / 6.0 - T / 4.0)
        speed_ups = self.begin_ups + change_ups * t_s / T + 0.5 * j * t_s * (t_s - T)
        return distance_u, speed_ups, change_ups / T + j * (t_s - 0.5 * T)


Phases = list[Phase]


def even(length_u: float, begin_ups: float, end_ups: float) -> Phase:
    """A phase at constant acceleration."""
    seconds = 2.0 * length_u / (begin_ups + end_ups) if length_u > 0.0 else 0.0
    return Phase(length_u, begin_ups, end_ups, seconds)


def duration_s(phases: Phases) -> float:
    """The time of some phases [s]."""
    return sum(phase.seconds for phase in phases)
