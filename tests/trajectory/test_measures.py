"""How far points are from a path: small arcs, and many short chords next to a long line."""

import math

import numpy as np
import pytest
from tests.trajectory.measures import deviations, off

from openacr.trajectory import Arc, Segment

RADIUS = 0.0116


@pytest.mark.parametrize("angle", np.arange(1, 12) / 12.0 * math.pi)
def test_a_point_of_a_small_arc_is_on_the_path(angle: float) -> None:
    half = Segment(1, (-RADIUS, 0.0), 100.0, 0.003, arc=Arc(0, 1, (0.0, 0.0), math.pi))
    point = RADIUS * np.array([math.cos(angle), math.sin(angle)])
    assert deviations(np.tile(point, (4, 1)), [half], (RADIUS, 0.0))[0] <= 4e-4 * RADIUS


def test_a_point_of_a_long_line_is_on_it_among_many_short_chords() -> None:
    angles = np.linspace(0.0, 2.0 * math.pi, 101)
    ring = np.stack([0.02 + 0.004 * np.cos(angles), 0.005 + 0.004 * np.sin(angles)], axis=1)
    starts = np.concatenate([[[0.0, 0.0]], ring[:-1]])
    ends = np.concatenate([[[0.2, 0.0]], ring[1:]])
    assert off(np.array([[0.02, 0.0]]), starts, ends) <= 1e-15


def test_the_distance_from_the_nearest_of_some_lines_is_exact() -> None:
    starts, ends = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[1.0, 0.0], [1.0, 3.0]])
    assert off(np.array([[0.4, -0.3]]), starts, ends) == pytest.approx(0.3, abs=1e-15)
    assert off(np.array([[1.0, 3.5]]), starts, ends) == pytest.approx(0.5, abs=1e-15)
