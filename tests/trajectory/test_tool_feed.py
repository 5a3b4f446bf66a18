"""The feed of the axes that carry the tool, where other axes move with them."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from tests.trajectory.measures import PERIOD_S, planned, points

from openacr.trajectory import Limits, Segment

TOOL = 5.0
LIMITS = Limits((400.0,) * 3, (1000.0,) * 3, (20_000.0,) * 3, (True, True, False))


def moves(places: Sequence[tuple[float, ...]]) -> list[Segment]:
    """Moves at the feed of the tool, in which the third axis goes with it."""
    found: list[Segment] = []
    start: tuple[float, ...] = (0.0, 0.0, 0.0)
    for k, place in enumerate(places):
        ratio = math.dist(start, place) / math.dist(start[:2], place[:2])
        found.append(Segment(k, place, TOOL * ratio, 0.05, tool_ups=TOOL))
        start = place
    return found


@pytest.mark.parametrize(
    "places",
    [
        [(4.0, 0.0, 20.0), (12.0, 0.0, 40.0)],  # a smooth corner from one share into another
        [(12.0, 0.0, 30.0), (16.0, 0.0, 50.0)],
        [(0.5, 0.0, 4.0), (1.0, 0.0, 3.0)],  # sharp ones, in which both moves are at the feed
        [(0.5, 0.0, 4.0), (0.5, 0.5, 8.0), (1.0, 0.5, 8.0)],
    ],
)
def test_the_tool_is_nowhere_faster_than_its_feed(places: list[tuple[float, ...]]) -> None:
    control = points(planned(moves(places), (0.0, 0.0, 0.0), LIMITS))
    speeds = np.linalg.norm(np.diff(control[:, :2], axis=0), axis=1) / PERIOD_S
    assert 0.99 * TOOL < speeds.max() <= TOOL * (1 + 1e-6)
    assert control[-1].tolist() == list(places[-1])


@pytest.mark.parametrize("tool", [5.0, math.inf])
def test_a_straight_move_is_limited_by_the_feed_of_the_tool_too(tool: float) -> None:
    along = LIMITS.along((0.6, 0.0, 0.8), 10.0, PERIOD_S, tool)
    assert along.speed == min(10.0, tool / 0.6)
    assert LIMITS.along((0.0, 0.0, 1.0), 10.0, PERIOD_S, tool).speed == 10.0
    (found,) = planned([Segment(1, (6.0, 0.0, 8.0), 10.0, 0.05, tool_ups=tool)], (0.0,) * 3, LIMITS)
    speed = np.linalg.norm(np.diff(found.points[:, :2], axis=0), axis=1).max() / PERIOD_S
    assert speed == pytest.approx(min(6.0, tool), rel=1e-6)
