"""Pieces of random outlines, shuffled, turned and a little apart, become the outline again."""

import cProfile
import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import LineString, Polygon
from tests.search import search

from openacr.cnc.dxf.chains import Chain, directed, in_order, joined, turned
from openacr.cnc.dxf.doubles import without_doubles
from openacr.cnc.dxf.nesting import depths, parents
from openacr.cnc.dxf.nesting import outline as outline_of
from openacr.cnc.dxf.segments import Point, Segment, bulged, reverse_all

pytestmark = pytest.mark.evidence("oracle", "outlines and areas of shapely")

EPSILON = 0.002


def points_of(chain: Chain, count: int = 60) -> list[Point]:
    """The chain as points."""
    found = [chain.start]
    for segment in chain.segments:
        if segment.centre is None:
            found.append(segment.end)
            continue
        x, y = segment.centre
        a0 = math.atan2(segment.start[1] - y, segment.start[0] - x)
        for k in range(1, count):
            angle = a0 + segment.sweep_rad * k / count
            found.append(
                (x + segment.radius * math.cos(angle), y + segment.radius * math.sin(angle))
            )
        found.append(segment.end)
    return found


def outline(seed: int, count: int) -> list[Segment]:
    """A closed outline around the origin with lines and arcs, counter-clockwise."""
    chance = random.Random(seed)
    corners = []
    for k in range(count):
        angle = 2 * math.pi * (k + 0.6 * chance.random()) / count
        r = chance.uniform(2, 5)
        corners.append((r * math.cos(angle), r * math.sin(angle)))
    bulges = [chance.choice((0.0, 0.0, chance.uniform(-0.3, 0.3))) for _ in corners]
    ends = [*corners[1:], corners[0]]
    return [bulged(a, b, bulge) for a, b, bulge in zip(corners, ends, bulges, strict=True)]


def torn(segments: list[Segment], seed: int, gap: float) -> list[tuple[Segment, ...]]:
    """The segments in any order, in either direction, their ends up to `gap` away."""
    chance = random.Random(seed)

    def near(point: Point) -> Point:
        angle, r = chance.uniform(0, 2 * math.pi), gap / 2 * chance.random()
        return (point[0] + r * math.cos(angle), point[1] + r * math.sin(angle))

    pieces: list[tuple[Segment, ...]] = []
    for one in segments:
        if one.centre is None:
            one = Segment(near(one.start), near(one.end))
        pieces.append(reverse_all([one]) if chance.random() < 0.5 else (one,))
    chance.shuffle(pieces)
    return pieces


@pytest.mark.req("MILL-DXF-03", "MILL-DXF-10")
@search(150)
@given(st.integers(0, 10**9), st.integers(3, 25), st.floats(0, EPSILON * 0.99), st.booleans())
def test_a_closed_outline_comes_back_whole_in_the_wanted_direction(
    seed: int, count: int, gap: float, is_counter_clockwise: bool
) -> None:
    segments = outline(seed, count)
    whole = Chain(tuple(segments), True)
    (found,) = directed(
        joined(torn(segments, seed, gap), EPSILON), is_counter_clockwise=is_counter_clockwise
    )
    assert found.is_closed
    assert len(found.segments) == count
    assert found.start == found.end
    assert all(a.end == b.start for a, b in zip(found.segments, found.segments[1:], strict=False))
    assert (found.area > 0) == is_counter_clockwise
    wanted, got = Polygon(points_of(whole)), Polygon(points_of(found))
    assert got.area == pytest.approx(wanted.area, abs=count * 10 * EPSILON)
    assert abs(found.area) == pytest.approx(got.area, rel=2e-3)
    assert got.exterior.hausdorff_distance(wanted.exterior) < 3 * EPSILON
    assert found.length == pytest.approx(whole.length, abs=4 * count * EPSILON)


@search(100)
@given(st.integers(0, 10**9), st.integers(4, 25))
def test_an_open_path_comes_back_whole_and_runs_from_its_end_nearest_to_the_tool(
    seed: int, count: int
) -> None:
    segments = outline(seed, count)[:-1]
    chains = joined(torn(segments, seed, EPSILON / 2), EPSILON)
    assert [chain.is_closed for chain in chains] == [False]
    last = segments[-1].end
    (single,) = chains
    found = turned(single, (last[0] * 1.1, last[1] * 1.1))
    distances = [math.dist(found.start, last), math.dist(found.end, last)]
    assert min(distances) < EPSILON
    tool = (last[0] * 1.1, last[1] * 1.1)
    assert math.dist(found.start, tool) <= math.dist(found.end, tool)
    wanted = LineString(points_of(Chain(tuple(segments), False)))
    assert LineString(points_of(found)).hausdorff_distance(wanted) < 3 * EPSILON


def test_several_outlines_stay_apart_and_come_in_the_order_of_their_starts() -> None:
    pieces = []
    for number, at in enumerate((20.0, 0.0, 40.0)):
        moved = [
            Segment((s.start[0] + at, s.start[1]), (s.end[0] + at, s.end[1]))
            for s in outline(number, 7)
        ]
        pieces += torn(moved, number, 0.0)
    random.Random(3).shuffle(pieces)
    apart = joined(pieces, EPSILON)
    chains = [apart[number] for number in in_order(apart)]
    assert [chain.is_closed for chain in chains] == [True] * 3
    assert [round(chain.start[0] / 20) for chain in chains] == [0, 1, 2]


def test_a_crossing_is_passed_straight_on() -> None:
    """A plus sign of four lines: two chains, not two corners."""
    ends = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
    chains = joined([(Segment((0.0, 0.0), end),) for end in ends], EPSILON)
    assert len(chains) == 2
    for chain in chains:
        (x0, y0), (x1, y1) = chain.start, chain.end
        assert (x0, y0) == (-x1, -y1)


def test_ends_farther_apart_than_epsilon_are_not_joined() -> None:
    apart = [(Segment((0, 0), (1, 0)),), (Segment((1, EPSILON * 1.1), (2, 0)),)]
    assert len(joined(apart, EPSILON)) == 2
    near = [(Segment((0, 0), (1, 0)),), (Segment((1, EPSILON * 0.9), (2, 0)),)]
    assert len(joined(near, EPSILON)) == 1


def test_what_is_shorter_than_epsilon_vanishes_in_its_node() -> None:
    pieces = [
        (Segment((0, 0), (1, 0)),),
        (Segment((1, 0), (1.001, 0)),),
        (Segment((1.001, 0), (1, 1)),),
    ]
    (chain,) = joined(pieces, EPSILON)
    assert len(chain.segments) == 2


def test_a_circle_alone_is_a_closed_chain() -> None:
    circle = Segment((1, 0), (1, 0), (0, 0), 2 * math.pi)
    (chain,) = directed(joined([(circle,)], EPSILON), is_counter_clockwise=False)
    assert (chain.is_closed, chain.segments[0].sweep_rad) == (True, -2 * math.pi)
    assert chain.area == pytest.approx(-math.pi)
    assert chain.length == pytest.approx(2 * math.pi)


@given(st.floats(-3, 3).filter(lambda b: abs(b) > 1e-3))
def test_a_bulge_is_the_tangent_of_a_quarter_of_the_sweep(bulge: float) -> None:
    arc = bulged((1.0, 2.0), (4.0, -1.0), bulge)
    assert arc.centre is not None
    assert math.tan(arc.sweep_rad / 4) == pytest.approx(bulge)
    assert math.dist(arc.centre, arc.start) == pytest.approx(math.dist(arc.centre, arc.end))
    a0 = math.atan2(arc.start[1] - arc.centre[1], arc.start[0] - arc.centre[0])
    x = arc.centre[0] + arc.radius * math.cos(a0 + arc.sweep_rad)
    y = arc.centre[1] + arc.radius * math.sin(a0 + arc.sweep_rad)
    assert (x, y) == pytest.approx(arc.end)


def test_the_work_of_joining_grows_no_faster_than_the_pieces() -> None:
    def calls(count: int) -> int:
        """Functions that are called on the way."""
        pieces, profile = torn(outline(5, count), 5, 1e-5), cProfile.Profile()
        assert len(profile.runcall(joined, pieces, 2e-5)) >= 1
        return sum(each.callcount for each in profile.getstats())

    assert calls(4000) < 5 * calls(1000)


def ring(x: float, y: float, radius: float) -> tuple[Segment, ...]:
    """A full circle."""
    return (Segment((x + radius, y), (x + radius, y), (x, y), 2 * math.pi),)


def test_insides_come_before_outsides_and_the_nearest_of_them_first() -> None:
    """Two plates, one with two holes of which one has an island, and a stroke in the other."""
    stroke = (Segment((20.0, 0.0), (21.0, 0.0)),)
    rings = ((0, 9), (5, 2), (-5, 3), (-5, 1), (20, 6))
    pieces = [*(ring(x, 0, radius) for x, radius in rings), stroke]
    chains = joined(pieces, EPSILON)
    around = parents(chains, [outline_of(chain) for chain in chains])
    order = [chains[number] for number in in_order(chains, parents=around)]
    sizes = [round(chain.segments[0].radius) for chain in order]
    assert sizes == [1, 3, 2, 9, 0, 6]  # a circle begins at its right
    by_size = {round(chain.segments[0].radius): k for k, chain in enumerate(chains)}
    deep = depths(around)
    assert [deep[by_size[size]] for size in (9, 2, 3, 1, 6, 0)] == [0, 1, 1, 2, 0, 1]


def test_what_is_drawn_twice_is_left_out_once() -> None:
    line = (Segment((0.0, 0.0), (4.0, 0.0)),)
    cap = (bulged((0.0, 0.0), (4.0, 0.0), 0.5),)
    other = (bulged((0.0, 0.0), (4.0, 0.0), -0.5),)
    near = (Segment((0.0005, 0.0), (4.0, 0.0005)),)
    pieces = [line, cap, other, near, reverse_all(cap), ring(9, 9, 1), ring(9, 9, 1), ring(9, 9, 2)]
    assert without_doubles(pieces, EPSILON) == [line, cap, other, pieces[5], pieces[7]]
    assert len(without_doubles(pieces, 1e-5)) == 6  # `near` is a line of its own


def test_two_thousand_nested_chains_are_ordered_quickly() -> None:
    pieces = [ring(10.0 * (k % 50), 10.0 * (k // 50), 1 + (k % 3)) for k in range(1000)]
    pieces += [ring(10.0 * (k % 50), 10.0 * (k // 50), 0.5) for k in range(1000)]
    chains = joined(pieces, EPSILON)
    around = parents(chains, [outline_of(chain) for chain in chains])
    order = in_order(chains, parents=around)
    assert sorted(order) == list(range(2000))
    places = {number: place for place, number in enumerate(order)}
    assert sum(1 for k in around if k >= 0) == 1000
    assert all(places[k] < places[outer] for k, outer in enumerate(around) if outer >= 0)
