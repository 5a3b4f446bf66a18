"""Path tolerance: corners are rounded within it, at the acceleration limit, in less time."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.kernel.rig import Reals, Rig, T
from tests.search import search

from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters
from openacr.map.words import mf4
from openacr.motion.path import corners, host_moves, moves
from openacr.motion.path.host_moves import HostMove
from openacr.motion.path.move_request import Target

settings.register_profile("kernel", deadline=None, derandomize=True, database=None)
settings.load_profile("kernel")

IN_MOTION = 516
PPU = 10_000.0
Point = tuple[float, ...]


def rig(
    tolerance: float, *, axes: int = 2, acc: float = 1000.0, jrk: float = 0.0, pure: bool = False
) -> Rig:
    """A card that looks ahead over ten moves at 100 units/s."""
    made = Rig(axes, ppu=[PPU] * axes, pure=pure).master(
        acc=acc, dec=acc, stp=acc, jrk=jrk, vel=100
    )
    made.depth(10)
    made.I[mf4.word[0]] |= mf4.LOOK_AHEAD_MODE
    made.F[masters.tolerance_u[0]] = tolerance
    return made


def follow(
    made: Rig,
    points: Sequence[Point],
    meanwhile: Callable[[int], None] | None = None,
    issue: Callable[[Point], None] | None = None,
    every: int = 0,
) -> Reals:
    """Positions of all axes, tick by tick, along the points, of which one comes `every` ticks."""
    issue = issue or (lambda point: made.move(*point))
    waiting, places, tick = list(points)[::-1], [], 0
    rows = [axis_rows.psp_cnt[n] for n in range(made.axes)]
    places.append([made.F[row] / PPU for row in rows])
    while waiting or made.bit(IN_MOTION):
        while waiting and moves.has_room(made.card, 0) and not (every and tick % every):
            issue(waiting.pop())
            if every:
                break
        if meanwhile:
            meanwhile(tick)
        made.ticks()
        places.append([made.F[row] / PPU for row in rows])
        tick += 1
        assert tick < 60_000
    return np.array(places)


def accelerations(places: Reals) -> Reals:
    """Size of the vector acceleration of every tick, from rest to rest."""
    still = np.vstack([places[:1], places[:1], places, places[-1:], places[-1:]])
    return np.asarray(np.linalg.norm(np.diff(still, n=2, axis=0), axis=1) / T**2)


def off_path(places: Reals, points: Sequence[Point]) -> float:
    """The largest distance of a place from the polyline."""
    corners_at = np.array([places[0], *points])
    best = np.full(len(places), np.inf)
    for a, b in pairwise(corners_at):
        along = b - a
        part = np.clip(((places - a) @ along) / max(along @ along, 1e-30), 0, 1)
        best = np.minimum(best, np.linalg.norm(places - (a + part[:, None] * along), axis=1))
    return float(best.max())


SQUARE = [(20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)]


def test_without_a_tolerance_the_corner_is_reached() -> None:
    places = follow(rig(0.0), SQUARE)
    assert np.min(np.linalg.norm(places - (20.0, 0.0), axis=1)) == 0.0


@pytest.mark.parametrize("tolerance", [0.01, 0.1, 1.0])
def test_a_corner_is_rounded_by_the_tolerance_at_the_acceleration_limit(tolerance: float) -> None:
    exact, rounded = follow(rig(0.0), SQUARE), follow(rig(tolerance), SQUARE)
    assert len(rounded) < len(exact)
    assert tuple(rounded[-1]) == (0.0, 0.0)
    nearest = [np.min(np.linalg.norm(rounded - corner, axis=1)) for corner in SQUARE[:3]]
    assert nearest == pytest.approx([tolerance] * 3, rel=0.02)
    assert off_path(rounded, SQUARE) <= tolerance
    assert accelerations(rounded).max() <= 1000 * (1 + 1e-6)
    assert accelerations(rounded).max() > 950


def test_the_speed_in_a_corner_is_the_highest_that_the_limit_allows() -> None:
    """A parabola with legs T = 4 tol / |u2 - u1| at v needs v^2 |u2 - u1| / 2T."""
    made, slowest = rig(0.1), [100.0]

    def watch(_: int) -> None:
        if made.F[masters.corner_out_u[0]] > 0.0:
            slowest.append(made.path_velocity)

    follow(made, SQUARE, watch)
    reach = 4 * 0.1 / math.sqrt(2)
    assert min(slowest[1:]) == pytest.approx(
        math.sqrt(0.98 * 1000 * 2 * reach / math.sqrt(2)), rel=1e-3
    )


def test_a_move_has_a_tolerance_of_its_own() -> None:
    made = rig(0.0)
    for point, own in zip(SQUARE, (None, 0.5, None, None), strict=True):
        targets = [Target(n, value) for n, value in enumerate(point)]
        moves.issue(made.card, 0, targets, tolerance_u=own)
    places = follow(made, [])
    nearest = [np.min(np.linalg.norm(places - corner, axis=1)) for corner in SQUARE[:3]]
    assert nearest == pytest.approx([0.0, 0.5, 0.0], abs=0.01)


def test_a_tolerance_is_a_length() -> None:
    made = rig(0.25)
    for wrong in (-0.1, math.nan, math.inf):
        with pytest.raises(CardError, match="Invalid argument"):
            corners.set_of_move(made.card, 0, 0, wrong)


def test_an_axis_that_takes_part_in_one_move_only_leaves_and_comes_smoothly() -> None:
    made = rig(0.1, axes=3)
    for targets in ([Target(0, 10.0)], [Target(2, 5.0)], [Target(1, 3.0)]):
        moves.issue(made.card, 0, targets)
    places = follow(made, [])
    assert tuple(places[-1]) == (10.0, 3.0, 5.0)
    assert accelerations(places).max() <= 1000 * (1 + 1e-6)


def test_under_jerk_a_corner_is_rounded_where_that_is_quicker() -> None:
    times = [len(follow(rig(tol, jrk=20_000.0), SQUARE)) for tol in (0.0, 0.01, 0.5)]
    assert times[1] == times[0]
    assert times[2] < times[0]
    places = follow(rig(0.5, jrk=20_000.0), SQUARE)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)
    assert off_path(places, SQUARE) <= 0.5


@pytest.mark.parametrize("jrk", [0.0, 20_000.0])
def test_both_builds_agree_to_the_bit(jrk: float) -> None:
    digests = []
    for pure in (False, True):
        made = rig(0.5, jrk=jrk, pure=pure)
        follow(made, [(1.0, 0.0), (1.0, 1.0), (1.2, 1.0), (1.4, 1.01), (3.0, 5.0)])
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]


def wave(segment: float) -> list[Point]:
    """A surface line of short segments."""
    return [(x, 3 * math.sin(x / 6)) for x in np.arange(segment, 60, segment)]


def test_short_segments_keep_the_feed_and_the_acceleration() -> None:
    points = wave(0.2)
    places = follow(rig(0.01), points)
    whole: list[Point] = [(0.0, 0.0), *points]
    length = sum(math.dist(a, b) for a, b in pairwise(whole))
    # ten moves of 0.2 are looked at: from sqrt(2 * 1000 * 2.0) = 63 units/s they can stop
    assert len(places) * T < length / 60 + 0.1
    assert accelerations(places).max() <= 1000 * (1 + 1e-6)
    assert off_path(places, points) <= 0.01
    assert tuple(places[-1]) == pytest.approx(points[-1], abs=1e-9)


@st.composite
def polylines(draw: st.DrawFn) -> list[Point]:
    """Paths of long and short lines with all kinds of turns."""
    x, y = 0.0, 0.0
    points: list[Point] = []
    for _ in range(draw(st.integers(2, 12))):
        length = 10.0 ** draw(st.floats(-2.0, 1.0))
        angle = draw(st.floats(0.0, 2 * math.pi))
        x, y = x + length * math.cos(angle), y + length * math.sin(angle)
        points.append((x, y))
    return points


EVENTS = st.lists(
    st.tuples(st.integers(1, 150), st.sampled_from(["fov", "hold", "go"]), st.floats(0.0, 2.0)),
    max_size=6,
)


Event = tuple[int, str, float]


def disturbed(made: Rig, events: list[Event]) -> Callable[[int], None]:
    """Override, feedhold and cycle start as they come; in the end the path goes on."""
    due = {}
    tick = 0
    for wait, what, value in [*events, (200, "fov", 1.0), (1, "go", 0.0)]:
        tick += wait
        due[tick] = (what, value)

    def disturb(now: int) -> None:
        what, value = due.get(now, ("", 0.0))
        if what == "fov":
            made.master(fov=value)
        elif what == "hold":
            moves.hold(made.card, 0)
        elif what == "go":
            moves.release(made.card, 0)

    return disturb


def keeps_its_limits(places: Reals, points: Sequence[Point], tolerance: float) -> None:
    assert tuple(places[-1] * PPU) == pytest.approx(tuple(np.array(points[-1]) * PPU), abs=1e-6)
    assert off_path(places, points) <= tolerance * (1 + 1e-6) + 1e-9
    assert accelerations(places).max() <= 1000 * (1 + 1e-4)
    speed = np.linalg.norm(np.diff(places, axis=0), axis=1) / T
    assert speed.max() <= 200 * (1 + 1e-6)


TOLERANCES = st.floats(-4.0, 0.0).map(lambda e: 10.0**e)


@search(250)
@given(polylines(), TOLERANCES, EVENTS)
def test_any_path_stays_within_tolerance_and_acceleration_and_ends_exactly(
    points: list[Point], tolerance: float, events: list[Event]
) -> None:
    made = rig(tolerance)
    keeps_its_limits(follow(made, points, disturbed(made, events)), points, tolerance)


# binary moves bring their tolerance along; LOOK is off


def host_rig(*, pure: bool = False) -> Rig:
    made = rig(0.0, pure=pure)
    made.I[mf4.word[0]] &= ~mf4.LOOK_AHEAD_MODE
    return made


def by_host(made: Rig, tolerances: Sequence[float | None], **more: Any) -> Callable[[Point], None]:
    """Issues moves that end at rest, but for corners with a tolerance and a move after."""
    left = list(tolerances)[::-1]

    def issue(point: Point) -> None:
        move = HostMove(
            master=0, targets_cnt={n: value * PPU for n, value in enumerate(point)},
            acc_ups2=1000.0, vel_ups=100.0, stop_ramp=True, final_velocity_zero=True,
            tolerance_u=left.pop(), **more,
        )  # fmt: skip
        host_moves.issue(made.card, move)

    return issue


def test_a_binary_move_rounds_the_corner_it_brings_a_tolerance_for() -> None:
    made = host_rig()
    issue = by_host(made, [0.2, None, 0.5, 0.1])
    places = follow(made, SQUARE, issue=issue)
    nearest = [np.min(np.linalg.norm(places - corner, axis=1)) for corner in SQUARE]
    assert nearest == pytest.approx([0.2, 0.0, 0.5, 0.0], rel=0.02, abs=1e-4)
    keeps_its_limits(places, SQUARE, 0.5)
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / T
    at_corner = [speeds[np.argmin(np.linalg.norm(places - corner, axis=1))] for corner in SQUARE]
    assert at_corner[1] < 1.0 < 15 < min(at_corner[0], at_corner[2])


def test_a_straight_junction_of_a_binary_chain_is_passed_at_full_speed() -> None:
    points = [(10.0, 0.0), (20.0, 0.0), (30.0, 0.0)]
    made = host_rig()
    places = follow(made, points, issue=by_host(made, [0.01, 0.01, 0.01]))
    assert len(places) * T == pytest.approx(30 / 100 + 0.1, abs=0.002)


def test_a_tolerance_that_is_no_length_is_refused_before_anything_moves() -> None:
    made = host_rig()
    for wrong in (-0.5, math.nan, math.inf):
        with pytest.raises(CardError, match="Invalid argument"):
            by_host(made, [wrong])((1.0, 0.0))
    assert not made.bit(IN_MOTION)


@search(250)
@given(polylines(), st.lists(st.none() | TOLERANCES, min_size=12, max_size=12), EVENTS)
def test_binary_chains_stay_within_tolerance_and_acceleration_and_end_exactly(
    points: list[Point], tolerances: list[float | None], events: list[Event]
) -> None:
    made = host_rig()
    issue = by_host(made, tolerances)
    places = follow(made, points, disturbed(made, events), issue)
    keeps_its_limits(places, points, max(each or 0.0 for each in tolerances[: len(points)]))


def jerks(places: Reals) -> Reals:
    """Size of the vector jerk of every tick, from rest to rest."""
    still = np.vstack([places[:1]] * 3 + [places] + [places[-1:]] * 3)
    return np.asarray(np.linalg.norm(np.diff(still, n=3, axis=0), axis=1) / T**3)


@search(150)
@given(
    polylines(),
    st.lists(st.none() | st.floats(-2.0, 0.3).map(lambda e: 10.0**e), min_size=12, max_size=12),
    EVENTS,
)
def test_under_jerk_binary_chains_keep_all_limits_whatever_happens(
    points: list[Point], tolerances: list[float | None], events: list[Event]
) -> None:
    made = host_rig()
    made.master(jrk=20_000.0)
    places = follow(made, points, disturbed(made, events), by_host(made, tolerances))
    keeps_its_limits(places, points, max(each or 0.0 for each in tolerances[: len(points)]))
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


@pytest.mark.parametrize("tick", range(60, 260, 7))
def test_under_jerk_a_feedhold_near_a_corner_keeps_all_limits(tick: int) -> None:
    made = host_rig()
    made.master(jrk=20_000.0)
    events: list[Event] = [(tick, "hold", 0.0), (600, "go", 0.0)]
    places = follow(made, SQUARE, disturbed(made, events), by_host(made, [0.5] * 4))
    assert np.count_nonzero(np.all(np.diff(places, axis=0) == 0.0, axis=1)) > 100
    keeps_its_limits(places, SQUARE, 0.5)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


@pytest.mark.parametrize("tick", range(61, 400, 24))
@pytest.mark.parametrize("what", ["hold", "fov"])
@pytest.mark.parametrize("tolerance", [0.01, 0.5])
def test_under_jerk_and_look_events_near_a_corner_keep_all_limits(
    tick: int, what: str, tolerance: float
) -> None:
    made = rig(tolerance, jrk=20_000.0)
    events: list[Event] = [(tick, what, 0.2), (300, "go", 0.0), (1, "fov", 1.5)]
    places = follow(made, SQUARE, disturbed(made, events))
    keeps_its_limits(places, SQUARE, tolerance)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


NEAR_STOPS = [(0.009, -0.056), (-0.222, -0.395), (-0.298, -0.246), (-0.289, -0.325)]


@search(150)
@given(
    st.one_of(polylines(), st.sampled_from([0.2, 0.4, 2.0]).map(lambda leg: wave(leg)[:40])),
    st.floats(-3.0, 0.0).map(lambda e: 10.0**e),
    EVENTS,
)
@example(NEAR_STOPS, 0.0013, [(87, "fov", 1.9), (114, "fov", 1.5), (112, "fov", 0.1)])
@example([(-3.423, -0.79), (-0.494, -1.336)], 0.2642, [(166, "hold", 0.0), (58, "go", 0.0)])
@example([(2.163, 0.217), (2.164, 0.353)], 0.1291, [(113, "go", 1.8), (10, "fov", 1.5)])
def test_under_jerk_and_look_any_path_keeps_all_limits_whatever_happens(
    points: list[Point], tolerance: float, events: list[Event]
) -> None:
    made = rig(tolerance, jrk=20_000.0)
    places = follow(made, points, disturbed(made, events))
    keeps_its_limits(places, points, tolerance)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


@pytest.mark.parametrize("straight", [[(9.0, 0.0)], [(9.0, 0.0), (10.0, 0.0)]])
@pytest.mark.parametrize("depth", [1, 2])
@pytest.mark.parametrize("every", [0, 20])
def test_under_jerk_a_corner_that_comes_late_is_entered_without_acceleration(
    straight: list[Point], depth: int, every: int
) -> None:
    x = straight[-1][0]
    points = [*straight, (x + math.cos(0.125), math.sin(0.125))]
    made = rig(0.01, jrk=20_000.0)
    made.depth(depth)
    places = follow(made, points, every=every)
    keeps_its_limits(places, points, 0.01)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


def turning(leg: float, degrees: float, count: int = 20) -> list[Point]:
    """Legs of one length, each turned against the one before it, to either side four at a time."""
    x, y, heading = 0.0, 0.0, 17.0
    points: list[Point] = []
    for k in range(count):
        x += leg * math.cos(math.radians(heading))
        y += leg * math.sin(math.radians(heading))
        points.append((x, y))
        heading += degrees * (1 if (k // 4) % 2 else -1)
    return points


@pytest.mark.parametrize(
    ("points", "tolerance", "seconds"),
    [
        (wave(0.4), 0.01, 3.368),
        (wave(2.0), 0.01, 1.914),
        (wave(2.0), 0.1, 1.786),
        (turning(5.0, 20.0), 0.01, 3.869),
        (turning(5.0, 20.0), 0.1, 2.321),
        (turning(5.0, 45.0), 0.01, 4.0),
    ],
)
def test_under_jerk_chains_of_corners_take_their_time_and_not_their_limits(
    points: list[Point], tolerance: float, seconds: float
) -> None:
    places = follow(rig(tolerance, jrk=20_000.0), points)
    assert len(places) * T == pytest.approx(seconds, rel=0.005)
    keeps_its_limits(places, points, tolerance)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


def test_under_jerk_a_corner_where_rounding_takes_longer_is_a_stop() -> None:
    points = turning(5.0, 45.0)
    places = follow(rig(0.01, jrk=20_000.0), points)
    corners_at = [int(np.argmin(np.linalg.norm(places - each, axis=1))) for each in points[:-1]]
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / T
    assert max(speeds[tick] for tick in corners_at) < 0.01
    assert min(math.dist(places[t], p) for t, p in zip(corners_at, points, strict=False)) < 1e-6


def with_jerks(made: Rig, values: Sequence[float]) -> Callable[[Point], None]:
    """Issues moves, each with a jerk of its own."""
    left = list(values)[::-1]

    def issue(point: Point) -> None:
        made.master(jrk=left.pop())
        made.move(*point)

    return issue


@pytest.mark.parametrize("values", [(20_000.0, 5_000.0), (5_000.0, 20_000.0)])
def test_a_corner_keeps_the_lower_jerk_of_its_two_moves(values: tuple[float, float]) -> None:
    made = rig(0.5)
    points = [(20.0, 0.0), (38.0, 8.0)]
    places = follow(made, points, issue=with_jerks(made, values))
    at_corner = int(np.argmin(np.linalg.norm(places - points[0], axis=1)))
    assert 0.01 < math.dist(places[at_corner], points[0]) <= 0.5
    assert jerks(places)[at_corner - 20 : at_corner + 24].max() <= 5_000 * (1 + 1e-3)


@pytest.mark.parametrize("values", [(20_000.0, 0.0), (0.0, 20_000.0)])
def test_a_corner_between_moves_with_and_without_jerk_is_a_stop(
    values: tuple[float, float],
) -> None:
    made = rig(0.5)
    points = [(20.0, 0.0), (38.0, 8.0)]
    places = follow(made, points, issue=with_jerks(made, values))
    assert np.min(np.linalg.norm(places - points[0], axis=1)) == 0.0
    assert accelerations(places).max() <= 1000 * (1 + 1e-6)


@pytest.mark.parametrize("tick", range(240, 400, 32))
def test_a_hold_before_a_stop_ends_at_rest_in_the_corner_at_the_latest(tick: int) -> None:
    made = rig(0.01, jrk=20_000.0)
    points = turning(5.0, 45.0, 4)
    places = follow(made, points, disturbed(made, [(tick, "hold", 0.0)]))
    held = places[tick + 185]
    assert tuple(held) == tuple(places[tick + 200])
    assert math.dist(held, (0.0, 0.0)) <= 5.0 * (1 + 1e-9)
    keeps_its_limits(places, points, 0.01)
    assert jerks(places).max() <= 20_000 * (1 + 1e-3)


@search(15)
@given(polylines(), st.lists(st.none() | TOLERANCES, min_size=12, max_size=12))
def test_both_builds_agree_about_binary_chains(
    points: list[Point], tolerances: list[float | None]
) -> None:
    digests = []
    for pure in (False, True):
        made = host_rig(pure=pure)
        for point, own in list(zip(points, tolerances, strict=False))[:10]:
            by_host(made, [own])(point)
        made.ticks(300)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]
