"""Ends of chains at sharp corners: how far they swing out, and how long they overlap."""

import math

import numpy as np
import pytest
from tests.trajectory.measures import PERIOD_S, limits, planned, points
from tests.trajectory.programs import Segments, line

from openacr.trajectory import Arc, Limits, Segment, TrajectoryPlanner, evaluate
from openacr.trajectory.course.end_law import (
    rest_h,
    rest_shape,
    rest_time,
    rest_u,
    turn_row,
    turn_s,
)
from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.stream.chains import Chain, Corner
from openacr.trajectory.stream.corners import corner_between

pytestmark = pytest.mark.evidence("oracle", "closed forms of constant jerk, differences of samples")
START, TOLERANCE = (0.0, 0.0, 0.0), 0.01
SWING, JERK = 0.01, 20_000.0
SMOOTH_POINTS = 260


def curve(*vertices: tuple[float, float], feed: float = 100.0) -> Reals:
    """The curve through some vertices from the origin, four points for each period."""
    segments = [line(n, x, y, 0, TOLERANCE, feed) for n, (x, y) in enumerate(vertices)]
    control = points(planned(segments, START, limits()))
    return evaluate(control, np.arange(0, len(control) - 1, 0.25))[0]


def corner(before: Segment, after: Segment, machine: Limits | None = None) -> Corner:
    first = Piece(START, before)
    chains = Chain(), Chain()
    chains[0].add(first)
    chains[1].add(Piece(before.end, after))
    return corner_between(machine or limits(), PERIOD_S, *chains)


# --- the law of an end ---------------------------------------------------------------


def test_a_start_swings_out_by_its_distance_and_is_a_cubic_without_a_swing() -> None:
    t1 = turn_s(SWING, JERK)
    times = np.linspace(t1, 6.0 * t1, 5001)
    assert min(rest_u(t, SWING, JERK) for t in times) == pytest.approx(-SWING, rel=1e-6)
    assert rest_u(t1, SWING, JERK) == pytest.approx(-JERK * t1**3 / 6.0)
    assert rest_u(0.01, 0.0, JERK) == pytest.approx(JERK * 0.01**3 / 6.0)


@pytest.mark.parametrize("swing", [0.0, SWING])
def test_speed_and_acceleration_at_a_distance_are_those_of_a_constant_jerk(swing: float) -> None:
    t1, step = turn_s(swing, JERK), 1e-5
    for s in (0.002, 0.05, 3.0):
        r = float(rest_time(s, swing, JERK))
        time = r + 2.0 * t1
        assert rest_u(time, swing, JERK) == pytest.approx(s, rel=1e-12)
        near = [rest_u(time + n * step, swing, JERK) for n in (-1, 0, 1)]
        v = (near[2] - near[0]) / (2.0 * step)
        a = (near[2] - 2.0 * near[1] + near[0]) / step**2
        assert rest_h(np.array([s]), swing, JERK)[0] == pytest.approx(v * v, rel=1e-4)
        slope, bend, reach = rest_shape(s, swing)
        assert slope == pytest.approx(2.0 * a / v**2, rel=1e-4)
        assert bend == pytest.approx(2.0 * JERK / v**3, rel=1e-4)
        assert reach == pytest.approx(time * v, rel=1e-4)


def test_the_jerk_changes_its_sign_after_the_time_of_the_turn() -> None:
    time = float(rest_time(0.05, SWING, JERK)) + 2.0 * turn_s(SWING, JERK)
    t1 = turn_s(SWING, JERK)
    expected = (t1, -JERK * t1**3 / 6.0, -JERK * t1**2 / 2.0, -JERK * t1)
    assert turn_row(time, 0.05, SWING) == pytest.approx(expected)
    assert turn_row(time, 0.05, 0.0) == (0.0, 0.0, 0.0, 0.0)


# --- sharp corners -------------------------------------------------------------------


def test_a_right_angle_is_passed_on_its_outside_within_the_tolerance() -> None:
    at = curve((20.0, 0.0), (20.0, 20.0))
    assert 0.009 < at[:, 0].max() - 20.0 <= TOLERANCE
    assert 0.009 < -at[:, 1].min() <= TOLERANCE
    assert np.linalg.norm(at[:, :2] - [20.0, 0.0], axis=1).min() <= TOLERANCE
    assert len(at) == 4 * 225  # of 229 without a swing


@pytest.mark.parametrize("legs", [((20.0, 0.0), (20.0, 1.0)), ((1.0, 0.0), (1.0, 20.0))])
def test_a_leg_too_short_for_the_overlap_does_not_swing_out(
    legs: tuple[tuple[float, float], ...],
) -> None:
    at = curve(*legs)
    assert at[:, 0].max() <= legs[-1][0] + 1e-12
    assert at[:, 1].min() >= -1e-12


def test_a_feed_that_is_reached_within_the_overlap_leaves_no_swing() -> None:
    assert curve((20.0, 0.0), (20.0, 20.0), feed=50.0)[:, 1].min() >= -1e-12
    assert curve((20.0, 0.0), (20.0, 20.0), feed=70.0)[:, 1].min() < -0.009


def test_without_a_jerk_limit_nothing_swings_out() -> None:
    segments = [line(1, 20, 0, 0, TOLERANCE), line(2, 20, 20, 0, TOLERANCE)]
    control = points(planned(segments, START, limits(None)))
    assert control[:, 1].min() >= 0.0


def test_the_path_length_does_not_go_back_where_the_tool_swings_out() -> None:
    segments = [line(1, 20, 0, 0, TOLERANCE), line(2, 20, 20, 0, TOLERANCE)]
    setpoints = planned(segments, START, limits())
    path = np.concatenate([each.path_u for each in setpoints])
    assert (np.diff(path) >= 0.0).all()
    assert path[-1] == 40.0


def test_a_smooth_chain_swings_out_at_its_start_and_keeps_the_limits() -> None:
    vertices = ((20.0, 0.0), (20.0, 15.0), (19.0, 30.0))
    assert 0.009 < -curve(*vertices)[:, 1].min() <= TOLERANCE
    segments = [line(n, x, y, 0, TOLERANCE) for n, (x, y) in enumerate(vertices)]
    control = points(planned(segments, START, limits()))
    assert len(control) == SMOOTH_POINTS
    assert np.abs(np.diff(control, n=3, axis=0)).max() <= JERK * PERIOD_S**3 * (1.0 + 1e-6)


def test_a_last_piece_shorter_than_the_overlap_leaves_no_swing() -> None:
    chains = Chain(), Chain()
    for start, end in (((0.0, 0.0), (20.0, 0.0)), ((20.0, 0.0), (20.3, 0.03))):
        chains[0].add(Piece((*start, 0.0), line(1, *end, 0, TOLERANCE)))
    chains[1].add(Piece((20.3, 0.03, 0.0), line(2, 20.3, 20.0, 0, TOLERANCE)))
    assert corner_between(limits(), PERIOD_S, *chains).end.swing_u == 0.0


def test_a_swing_turns_within_a_share_of_the_build_up_of_acceleration() -> None:
    found = corner(line(1, 200, 0, 0, 0.2, 400.0), line(2, 200, 200, 0, 0.2, 400.0),
                   Limits((400.0,) * 3, (1000.0,) * 3, (JERK,) * 3))  # fmt: skip
    assert turn_s(found.end.swing_u, found.end.jerk) == pytest.approx(0.3 * 1000.0 / JERK)


def test_both_jerks_of_a_swing_are_within_the_limit_of_every_axis() -> None:
    angle = math.radians(20.0)
    before = line(1, 20.0 * math.cos(angle), 20.0 * math.sin(angle), 0, TOLERANCE)
    after = line(2, before.end[0] - 20.0 * math.sin(angle),
                 before.end[1] + 20.0 * math.cos(angle), 0, TOLERANCE)  # fmt: skip
    found = corner(before, after)
    assert found.end.swing_u == found.start.swing_u == pytest.approx(0.97 * TOLERANCE)
    share = math.cos(angle) + math.sin(angle)
    assert found.end.jerk == pytest.approx(0.999 * JERK / share)
    assert found.end.share == pytest.approx(0.999 / share * math.cos(angle))


def test_the_end_of_a_smooth_chain_off_the_axes_leaves_its_share_of_the_jerk() -> None:
    """Two shallow turns, then one of 120 degrees: it overlaps as long as two straight legs."""
    angle, at, segments = math.radians(40.0), np.zeros(2), []
    for n, turn in enumerate((0.0, 10.0, 10.0, 120.0)):
        angle += math.radians(turn)
        at = at + 12.0 * np.array([math.cos(angle), math.sin(angle)])
        segments.append(line(n, at[0], at[1], 0, TOLERANCE))
    planner = TrajectoryPlanner(START, limits())
    for segment in segments:
        planner.add(segment)
    planner.stop()
    while planner.take() is not None:
        pass
    made = planner._stream.last
    assert made is not None
    assert made.course.lead_s == pytest.approx(0.0237, abs=0.0005)


# --- arcs at a corner ----------------------------------------------------------------


def leaving(radius: float) -> tuple[Segment, Segment]:
    """Half a circle to the left, and a line to the right of its end."""
    arc = Arc(0, 1, (0.0, radius), math.pi)
    ended: Segments = [
        Segment(1, (0.0, 2.0 * radius, 0.0), 100.0, TOLERANCE, arc=arc),
        line(2, 0.0, 20.0 + 2.0 * radius, 0, TOLERANCE),
    ]
    return ended[0], ended[1]


@pytest.mark.parametrize("radius", [1.0, 3.0])
def test_the_jerk_across_an_arc_is_left_to_it_where_it_overlaps_a_line(radius: float) -> None:
    share = 1.0 + 72.0 * TOLERANCE / math.sqrt(2.0) / radius
    found = corner(*leaving(radius))
    assert found.start.jerk == pytest.approx(0.999 * JERK / share, rel=1e-3)
    assert found.end.swing_u == 0.0


def test_a_small_circle_keeps_the_whole_jerk_and_overlaps_for_a_shorter_time() -> None:
    assert corner(*leaving(0.5)).start.jerk == pytest.approx(0.999 * JERK)
