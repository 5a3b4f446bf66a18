"""Distances of many curves at once, and the check of whole chains."""

import random
import time
from math import cos, pi, sin

import numpy as np
import pytest
import shapely
from tests.cnc.compensation.oracle import contour, line_of, points
from tests.cnc.compensation.tools import Path, Trace, compensate

from openacr.cnc.compensation import ChainCheck, Side
from openacr.cnc.compensation.boxes import Tree
from openacr.cnc.compensation.nearness import Curves, distances
from openacr.cnc.geometry.elements import Element

pytestmark = pytest.mark.evidence("oracle", "distances of shapely")


def curves_of(elements: list[Element]) -> Curves:
    return Curves.of(
        np.array([each.start[:2] for each in elements]),
        np.array([each.end[:2] for each in elements]),
        np.array([each.centre or (0.0, 0.0) for each in elements]),
        np.array([each.sweep_rad for each in elements]),
    )


def some(seed: int, count: int = 6) -> list[Element]:
    rnd = random.Random(seed)
    return contour(rnd, count, arcs=0.6, turn=3.1).elements[1:-1]


@pytest.mark.parametrize("seed", range(40))
def test_distances_are_those_of_fine_chords(seed: int) -> None:
    one, other = some(seed), some(1000 + seed)
    pairs = [(a, b) for a in one for b in other]
    found = distances(curves_of([a for a, _ in pairs]), curves_of([b for _, b in pairs]))
    for (a, b), near in zip(pairs, found, strict=True):
        assert near == pytest.approx(
            shapely.distance(line_of([a], 0.005), line_of([b], 0.005)), abs=5e-5
        )


@pytest.mark.parametrize("seed", range(20))
def test_boxes_hold_their_curves_tightly(seed: int) -> None:
    elements = some(seed)
    low, high = curves_of(elements).boxes()
    for element, corner, other in zip(elements, low, high, strict=True):
        inside = points(element, 0.001)
        assert inside.min(axis=0) == pytest.approx(corner, abs=1e-5)
        assert inside.max(axis=0) == pytest.approx(other, abs=1e-5)


def test_a_tree_finds_the_pairs_that_all_against_all_would_find() -> None:
    one, other = curves_of(some(1, 70)), curves_of(some(2, 90))
    reach = np.linspace(0.01, 0.5, 70)
    asked, own, near = Tree(other).nearer(one, reach)
    i, j = np.divmod(np.arange(70 * 90), 90)
    all_near = distances(one[i], other[j])
    wanted = all_near < reach[i]
    found = set(zip(asked.tolist(), own.tolist(), strict=True))
    assert found == set(zip(i[wanted].tolist(), j[wanted].tolist(), strict=True))
    assert near.min() == all_near[wanted].min()


def test_a_long_chain_is_checked_in_little_time() -> None:
    """A spiral of 20 000 chords with a pitch that is just wide enough."""
    trace = Trace()
    check = ChainCheck(0.001, trace.report)
    path = Path(1.0, 0.0)
    for k in range(1, 20_001):
        radius, angle = 1.0 + 0.2 * k / 200, 2 * pi * k / 200
        path.to(radius * cos(angle), radius * sin(angle))
    for element in path.elements:
        check.contour(element)
    shifted = Path(1.1, 0.0)
    for k in range(1, 19_001):
        radius, angle = 1.1 + 0.2 * k / 200, 2 * pi * k / 200
        shifted.to(radius * cos(angle), radius * sin(angle))
    for element in shifted.elements:
        check.centre_path(element, 0.1)
    began = time.process_time()
    check.end()
    assert time.process_time() - began < 10.0
    assert trace.findings == []


def test_the_nearest_point_is_reported_with_both_lines() -> None:
    path = Path(-1, 2).to(0, 0).to(3, 0).to(3, 1).to(4, 1).to(4, 0.3).to(6, 0.3).to(6, 3)
    path.to(2.7, 3).to(2.7, 0.7).to(0, 0.7).to(-1, 2)
    trace = compensate(path.elements, 0.2, is_checked=True)
    assert ("W323", "tool comes to 0.1 from line 3, its radius is 0.2", 9) in trace.findings


def square(before: float, after: float) -> Path:
    """Around the outside of a square of 2, from `before` its first corner to `after` it."""
    path = Path(-before - 1, -1).to(-before, 0).to(2, 0).to(2, 2).to(0, 2).to(0, -after)
    return path.to(-1, -after - 1)


@pytest.mark.parametrize(
    ("before", "after", "codes"),
    [
        (0.5, 0.5, set()),
        (0.5, 0.0, set()),  # the last line ends on the first
        (0.0, 0.5, set()),
        (0.5, -9e-7, set()),  # within the epsilon
        (-9e-7, 0.5, set()),
        (0.5, -0.1, {"W323"}),  # the contour is open: its first line may be an edge
    ],
)
def test_lines_that_overrun_the_corner_at_which_they_meet_are_no_edges_beyond_it(
    before: float, after: float, codes: set[str]
) -> None:
    trace = compensate(square(before, after).elements, 0.25, Side.RIGHT, is_checked=True)
    assert set(trace.codes) == codes


def test_lines_that_run_beside_each_other_are_edges_to_their_ends() -> None:
    path = Path(-1, -1).to(0, 0).to(3, 0).to(3, 0.3).to(0, 0.3).to(-1, 1)
    trace = compensate(path.elements, 0.25, is_checked=True)
    assert "W323" in trace.codes
