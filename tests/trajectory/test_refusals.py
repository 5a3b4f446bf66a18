"""Windows that would exceed a limit: planned more slowly, or not at all."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from tests.trajectory.measures import PERIOD_S, limits, planned, points
from tests.trajectory.programs import Segments, surface
from tests.trajectory.random_programs import program

from openacr.trajectory import Arc, Limits, Segment, TrajectoryError, TrajectoryPlanner
from openacr.trajectory.stream.smooth_course import SmoothCourse

START = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Strict(Limits):
    """Limits whose setpoints are held to a share of what is planned with."""

    share: float = 1.0

    def checked(self) -> tuple[float, ...]:
        """Velocities as they are, a share of the others."""
        whole = Limits(self.velocity_ups, self.acceleration_ups2, self.jerk_ups3).checked()
        return (*whole[: self.axes], *(self.share * each for each in whole[self.axes :]))


def strict(share: float) -> Strict:
    whole = limits()
    return Strict(whole.velocity_ups, whole.acceleration_ups2, whole.jerk_ups3, share=share)


def wave(width: float = 40.0) -> tuple[Segments, tuple[float, ...]]:
    found = surface(0.01, rows=1, width=width)
    return found, found[0].end


def highest(control: np.ndarray) -> tuple[float, float]:
    a, j = (np.abs(np.diff(control, n, axis=0)).max() / PERIOD_S**n for n in (2, 3))
    return float(a), float(j)


@pytest.mark.parametrize("share", [0.9, 0.7])
def test_windows_above_a_limit_are_planned_more_slowly(share: float) -> None:
    segments, start = wave()
    usual = points(planned(segments, start, limits()))
    slower = points(planned(segments, start, strict(share)))
    a, j = highest(slower)
    assert (a, j) <= (1000.0 * share * (1 + 1e-9), 20_000.0 * share * (1 + 1e-9))
    assert slower[-1].tolist() == list(segments[-1].end)
    assert len(usual) < len(slower) < 3 * len(usual)


def test_a_short_chain_above_a_limit_is_slowed_down_in_time() -> None:
    segments = [Segment(1, START, 100.0, 0.01, arc=Arc(0, 1, (2.0, 0.0), 2.0 * math.pi))]
    usual, slower = (
        points(planned(segments, START, machine)) for machine in (limits(), strict(0.5))
    )
    assert highest(slower)[1] <= 10_000.0 * (1 + 1e-9)
    assert 1.1 * len(usual) < len(slower) < 2.0 * len(usual)


def test_what_cannot_be_planned_is_an_error_after_a_path_that_ends_at_rest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    segments, start = wave(120.0)
    planner = TrajectoryPlanner(start, limits(), PERIOD_S)
    samples, windows = SmoothCourse._samples, []

    def fails(course: SmoothCourse, *, is_first: bool) -> tuple[float, ...]:
        windows.append(is_first)
        return samples(course, is_first=is_first) if len(windows) <= 2 else (0.9, 1.1, 0.9)

    monkeypatch.setattr(SmoothCourse, "_samples", fails)
    taken = []
    with pytest.raises(TrajectoryError, match=r"line \d+: no speed keeps the limits"):
        for segment in segments:
            planner.add(segment)
            while (found := planner.take()) is not None:
                taken.append(found)
    assert len(windows) == 2 + 4 + 4  # attempts at the third window
    control = np.concatenate([*(each.points for each in taken), taken[-1].rest])
    a, j = highest(np.concatenate([control[:1], control[:1], control]))
    assert (a, j) <= (1000.0, 20_000.0)
    assert control[-1].tolist() == control[-2].tolist() == control[-3].tolist()
    assert 5.0 < np.linalg.norm(control[-1] - control[0]) < 100.0


# Shares of the limits of every axis: velocity, acceleration, jerk.
UNLIKE = {
    16: ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 0.01)),
    113: ((1.0, 0.0971), (1.0, 0.0159), (1.0, 0.9617)),
    203: ((1.0, 0.3987), (1.0, 0.3543), (1.0, 0.026)),
}


@pytest.mark.parametrize("seed", UNLIKE)
def test_axes_whose_limits_differ_a_hundredfold_are_planned_within_them(seed: int) -> None:
    """In 16 a mean of two laws broke a row; in the others a slow start needed more path."""
    segments, axes, _ = program(seed)
    most = np.array(UNLIKE[seed]) * np.array([[100.0], [1000.0], [20_000.0]])
    machine = Limits(*(tuple(row) for row in most.tolist()))
    control = points(planned(segments, (0.0,) * axes, machine))
    assert control[-1].tolist() == list(segments[-1].end)
    for order, limit in enumerate(most, start=1):
        reached = np.abs(np.diff(control, order, axis=0)).max(axis=0) / PERIOD_S**order
        assert (reached <= limit * (1 + 1e-6)).all(), order
