"""How the tool gets from one element to the next, for every pair of forms."""

from math import pi, sqrt

import pytest
from tests.cnc.compensation.tools import EXACT, Path, compensate

from openacr.cnc.compensation import Rules, Side


def near(point: tuple[float, float]) -> object:
    return pytest.approx(point, abs=1e-9)


def test_a_reversal_is_rounded_by_half_a_turn() -> None:
    path = Path(0, 1).to(0, 0).to(2, 0).to(0, 0).to(0, -1)
    trace = compensate(path.elements, 0.25)
    (corner,) = trace.inserted
    assert corner.centre == (2, 0)
    assert corner.sweep_rad == pytest.approx(-pi)


def test_a_cusp_that_closes_on_the_tool_is_an_inside_corner() -> None:
    # The arc goes straight back and then away from the line on the side of the tool.
    path = Path(0, 1).to(0, 0).to(4, 0).arc(2, 2, 4, 2, -1).to(1, 2)
    trace = compensate(path.elements, 0.25)
    assert trace.inserted == []
    assert trace.ends[1] == near((4 - sqrt(2.25**2 - 1.75**2), 0.25))


@pytest.mark.req("MILL-COMP-20")
def test_the_root_epsilon_makes_circles_cross() -> None:
    # A lens of two circles of radius 2; with 1.0 the inner circles touch at L = 2.
    def crosses(gap: float, root_epsilon: int) -> bool:
        half = 1 + gap / 2
        top = sqrt(4 - half * half)
        path = Path(0, 0).to(2 - half, 0).arc(0, top, -half, 0, 1).arc(half - 2, 0, half, 0, 1)
        path.to(0, -0.1)
        rules = Rules(epsilon=1e-6, root_epsilon=root_epsilon)
        trace = compensate(path.elements, 1.0, rules=rules)
        assert "E321" not in trace.codes
        return near((0, 0)) in trace.ends  # midway between the circles

    # The square is 1 - (1 + gap / 2)^2.
    assert crosses(2e-5, -4)
    assert not crosses(2e-5, -5)
    assert crosses(0.99e-4, -4)
    assert not crosses(1.01e-4, -4)


def test_circles_that_are_farther_apart_than_the_tool_do_not_cross() -> None:
    top = sqrt(4 - 1.9**2)
    path = Path(0, 0).to(0.1, 0).arc(0, top, -1.9, 0, 1).arc(-0.1, 0, 1.9, 0, 1).to(0, 0)
    trace = compensate(path.elements, 1.5)
    assert "E321" in trace.codes


@pytest.mark.req("MILL-COMP-08")
def test_paths_that_no_longer_cross_are_joined_by_an_inserted_line() -> None:
    top = sqrt(3)
    path = Path(-2, -4).to(0, -top).arc(0, top, -1, 0, 1).arc(0, -top, 1, 0, 1).to(2, -4)
    trace = compensate(path.elements, 1.1)
    (line,) = trace.inserted
    assert line.centre is None
    assert trace.ends[1:3] == [near((-0.1, 0)), near((0.1, 0))]
    assert "W320" in trace.codes
    for one, other in zip(trace.elements, trace.elements[1:], strict=False):
        assert one.end == pytest.approx(other.start)


def chord_and_circle(*, is_arc_first: bool) -> Path:
    """A line that is a chord, 1/2 above the centre of a circle of radius 1; the tool is inside."""
    x = sqrt(0.75)
    if is_arc_first:
        return Path(0, -3).to(0, -2).to(-1, 0).arc(x, 0.5, 0, 0, -1).to(-2, 0.5).to(-3, 0.5)
    return Path(-3, 0.5).to(-2, 0.5).to(x, 0.5).arc(-1, 0, 0, 0, 1).to(0, -2).to(0, -3)


@pytest.mark.req("MILL-COMP-08")
@pytest.mark.parametrize("is_arc_first", [False, True])
@pytest.mark.parametrize(
    ("radius", "joins"),
    [(0.2, []), (0.25, []), (0.3, [(0.8, 0.7)]), (0.45, [(0.95, 0.55)])],
)
def test_a_line_and_an_arc_that_no_longer_cross_are_joined_where_they_are_nearest(
    radius: float, joins: list[tuple[float, float]], is_arc_first: bool
) -> None:
    """Their offsets, y = 1/2 + r and the circle of radius 1 - r, touch with r = 1/4."""
    path = chord_and_circle(is_arc_first=is_arc_first)
    trace = compensate(path.elements, radius, Side.RIGHT if is_arc_first else Side.LEFT)
    lines = [each for each in trace.inserted if each.centre is None]
    across = [(one.start[:2], one.end[:2])[:: -1 if is_arc_first else 1] for one in lines]
    assert across == [(near((0, high)), near((0, low))) for high, low in joins]
    assert trace.codes.count("W320") == len(joins)
    for one, other in zip(trace.elements, trace.elements[1:], strict=False):
        assert one.end == pytest.approx(other.start)


def test_default_rules_are_those_of_a_new_store() -> None:
    assert Rules() == Rules(0.002, 0.01, -4, True)
    assert Rules(root_epsilon=-4).root == pytest.approx(1e-4)
    assert EXACT.root == pytest.approx(1e-12)
