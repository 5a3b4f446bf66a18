"""Windows that would exceed a limit: planned more slowly, or not at all."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from tests.trajectory.measures import PERIOD_S, limits, planned, points
from tests.trajectory.programs import Segments, surface
from tests.trajectory.random_programs import program

from openacr.trajectory import Arc, Limits, Segment, TrajectoryError, TrajectoryPlanner
from openacr.trajectory.smooth_course import SmoothCourse

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
    keeps, windows = SmoothCourse._samples_keep_limits, []

    def fails(course: SmoothCourse, *, is_first: bool) -> bool:
        windows.append(is_first)
        return len(windows) <= 2 and keeps(course, is_first=is_first)

    monkeypatch.setattr(SmoothCourse, "_samples_keep_limits", fails)
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


def test_a_window_that_is_slowed_down_is_a_start_for_the_next_one() -> None:
    """The jerk of one axis is a hundredth of the others': a mean of two laws broke a row there."""
    segments, axes, _ = program(16)
    jerks = np.array([20_000.0] * (axes - 1) + [200.0])
    machine = Limits((100.0,) * axes, (1000.0,) * axes, tuple(jerks.tolist()))
    control = points(planned(segments, (0.0,) * axes, machine))
    assert control[-1].tolist() == list(segments[-1].end)
    reached = np.abs(np.diff(control, 3, axis=0)).max(axis=0) / PERIOD_S**3
    assert (reached <= jerks * (1 + 1e-6)).all()
    assert reached[-1] > 0.95 * jerks[-1]
