"""Start Move Inhibit and SYNC on a path with rounded corners: it stops where it has room to."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from tests.kernel.path.test_corners import Point, accelerations, follow, jerks, rig
from tests.kernel.path.test_late_corners import JRK, chain
from tests.kernel.rig import Reals, Rig, T
from tests.search import stride

from openacr.kernel.path.sync_cy import sync_drop
from openacr.map.rows import kernel, masters
from openacr.map.words import mf1, mf2
from openacr.motion.path import buffer, moves
from openacr.motion.path.move_request import Circle, Direction

PATH = chain([(1.0, 0.0), (0.5, 30.0), (0.6, 0.0), (0.6, -40.0), (0.2, 20.0), (0.5, 90.0)])
CHORDS = chain([(0.4, 3.0)] * 20)
REST = 500
Bar = Callable[[Rig, bool], None]


def inhibit(made: Rig, on: bool) -> None:
    bit = mf1.START_MOVE_INHIBIT
    made.I[mf1.word[0]] = made.I[mf1.word[0]] | bit if on else made.I[mf1.word[0]] & ~bit


def sync(made: Rig, on: bool) -> None:
    """SYNC with a second member that has no move; taken out again, the path goes on."""
    bit = mf2.SYNC_MODE
    made.I[kernel.masters] = 2
    for m in range(2):
        made.I[mf2.word[m]] = made.I[mf2.word[m]] | bit if on else made.I[mf2.word[m]] & ~bit


def barred(made: Rig, points: list[Point], tick: int, bar: Bar) -> Reals:
    def meanwhile(now: int) -> None:
        if now in (tick, tick + REST):
            bar(made, now == tick)

    return follow(made, points, meanwhile)


@pytest.mark.search
@pytest.mark.parametrize("points", [PATH, CHORDS])
@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("bar", [inhibit, sync])
def test_a_path_that_is_barred_at_any_tick_keeps_all_limits(
    bar: Bar, jrk: float, points: list[Point]
) -> None:
    for tick in range(1, len(follow(rig(0.1, jrk=jrk), points)) - 1, stride(5)):
        places = barred(rig(0.1, jrk=jrk), points, tick, bar)
        assert tuple(places[-1]) == pytest.approx(points[-1], abs=1e-9)
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)
        if jrk:
            assert jerks(places).max() <= jrk * (1 + 1e-3)


@pytest.mark.parametrize("bar", [inhibit, sync])
def test_a_barred_path_rests_at_the_first_corner_before_which_it_has_room(bar: Bar) -> None:
    """It is at 32 units/s in the corner to the second leg of 0.5: too fast for that one's end."""
    places = barred(rig(0.1), PATH, 110, bar)
    rests = np.flatnonzero(np.all(np.diff(places, axis=0) == 0.0, axis=1))
    assert len(rests) > 300
    assert tuple(places[rests[0]]) == pytest.approx(PATH[2], abs=1e-9)


STRAIGHT = chain([(0.5, 0.0)] * 12)


@pytest.mark.search
@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("bar", [inhibit, sync])
def test_a_path_without_a_tolerance_is_barred_at_the_first_joint_before_which_it_has_room(
    bar: Bar, jrk: float
) -> None:
    """On a straight line the joints are no reason to slow down, but places to stop at."""
    free = follow(rig(0.0, jrk=jrk), STRAIGHT)
    for tick in range(1, len(free) - 1, stride(5)):
        places = barred(rig(0.0, jrk=jrk), STRAIGHT, tick, bar)
        assert tuple(places[-1]) == pytest.approx(STRAIGHT[-1], abs=1e-9)
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)
        if jrk:
            assert jerks(places).max() <= jrk * (1 + 1e-3)
        speed = (free[tick] - free[tick - 1])[0] / T
        room = speed**2 / 2000.0
        rests = np.flatnonzero(np.all(np.diff(places[tick:], axis=0) == 0.0, axis=1))
        if not jrk and free[tick][0] + room < STRAIGHT[-2][0] - 0.1:
            rest = places[tick + rests[0]][0]
            assert min(abs(rest - x) for x, _ in STRAIGHT) < 1e-9
            assert free[tick][0] + room - 0.1 <= rest <= free[tick][0] + room + 0.6


def test_a_barred_path_with_curves_at_both_ends_of_a_line_rests_in_front_of_one() -> None:
    """Beside an arc no corner is rounded, though the path has a tolerance."""
    made = rig(0.1)

    def issue(point: Point) -> None:
        if point == (6.0, 2.0):
            arc = Circle((0, 1), (6.0, 2.0), (4.0, 2.0), Direction.COUNTER_CLOCKWISE)
            moves.issue(made.card, 0, [arc])
        else:
            made.move(*point)

    def meanwhile(now: int) -> None:
        if now in (20, 20 + REST):
            inhibit(made, now == 20)

    places = follow(made, [(4.0, 0.0), (6.0, 2.0), (6.0, 8.0)], meanwhile, issue)
    rests = np.flatnonzero(np.all(np.diff(places, axis=0) == 0.0, axis=1))
    assert tuple(places[rests[0]]) == pytest.approx((4.0, 0.0), abs=1e-9)


def test_a_move_given_without_look_keeps_its_final_velocity_where_the_next_is_barred() -> None:
    made = rig(0.1).master(fvel=20.0)
    buffer.switch_look(made.card, 0, on=False)

    def meanwhile(now: int) -> None:
        if now == 5:
            buffer.switch_look(made.card, 0, on=True)
        if now in (5, REST):
            inhibit(made, now == 5)

    places = follow(made, [(4.0, 0.0), (8.0, 0.0)], meanwhile)
    reached = int(np.argmax(places[:, 0] >= 4.0 - 1e-9))
    assert (places[reached - 1] - places[reached - 2])[0] / T == pytest.approx(20.0, abs=1.0)
    assert tuple(places[reached + 50]) == (4.0, 0.0)


def dropped(made: Rig, points: list[Point], tick: int) -> Reals:
    """Positions along the points, of which those that wait at a tick are dropped."""

    def meanwhile(now: int) -> None:
        if now == tick:
            sync_drop(made.F, made.I, made.S, 0)

    return follow(made, points, meanwhile)


@pytest.mark.search
@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("fvel", [0.0, 20.0])
def test_a_kill_of_one_member_lets_the_other_pass_the_corner_it_is_in(
    fvel: float, jrk: float
) -> None:
    for tick in range(20, 300, stride(7)):
        places = dropped(rig(0.1, jrk=jrk).master(fvel=fvel), PATH, tick)
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)
        if jrk:
            assert jerks(places).max() <= jrk * (1 + 1e-3)


@pytest.mark.search
@pytest.mark.parametrize("fvel", [0.0, 20.0])
def test_a_barred_path_with_a_final_velocity_rests_where_it_is_to_stop(fvel: float) -> None:
    for tick in range(20, 200, stride(9)):
        places = barred(rig(0.1).master(fvel=fvel), PATH, tick, inhibit)
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)


@pytest.mark.search
def test_a_path_held_within_a_corner_ends_after_it_though_its_moves_are_dropped() -> None:
    within = 0
    for tick in range(30, 120, stride(1)):
        made = rig(0.5)
        corner_out_u = masters.corner_out_u[0]

        def meanwhile(now: int, made: Rig = made, tick: int = tick) -> None:
            if now == tick:
                moves.hold(made.card, 0)
            elif now == 300:
                sync_drop(made.F, made.I, made.S, 0)
            elif now == 310:
                moves.release(made.card, 0)

        places = follow(made, CHORDS[:6], meanwhile)
        end = [math.dist(places[-1], each) < 1e-9 for each in CHORDS].index(True)
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)
        held = places[300]
        within += math.dist(held, CHORDS[end - 1]) < 0.2 if end else 0
        assert made.F[corner_out_u] == 0.0
    assert within > 0


def test_moves_after_a_drop_are_laid_out_from_the_end_of_those_that_are_left() -> None:
    """The new corner is one of 90 degrees at the end of the first move, with room before it."""
    made = rig(0.1)
    made.move(10.0, 0.0)
    made.move(20.0, 0.0)
    made.ticks(20)
    sync_drop(made.F, made.I, made.S, 0)
    places = follow(made, [(10.0, 10.0), (0.0, 10.0)])
    for corner in ((10.0, 0.0), (10.0, 10.0)):
        off = np.min(np.linalg.norm(places - corner, axis=1))
        assert off == pytest.approx(0.1, rel=0.02)
    assert accelerations(places)[3:].max() <= 1000 * (1 + 1e-4)


@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("bar", [inhibit, sync])
def test_both_builds_agree_about_barred_paths(bar: Bar, jrk: float) -> None:
    digests = []
    for pure in (False, True):
        made = rig(0.1, jrk=jrk, pure=pure)
        barred(made, PATH[:4], 90, bar)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]


@pytest.mark.search
def test_a_kill_of_one_member_lets_the_other_brake_on_a_path_without_a_tolerance() -> None:
    """Every other move of the line is slower, so that each of them is a section of its own."""
    lengths = []
    for tick in range(5, 160, stride(3)):
        made = rig(0.0)

        def issue(point: Point, made: Rig = made) -> None:
            made.master(vel=100.0 if round(2 * point[0]) % 2 else 60.0)
            made.move(*point)

        def meanwhile(now: int, made: Rig = made, tick: int = tick) -> None:
            if now == tick:
                sync_drop(made.F, made.I, made.S, 0)

        places = follow(made, STRAIGHT[:9], meanwhile, issue)
        assert min(abs(places[-1][0] - x) for x, _ in STRAIGHT) < 1e-9
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)
        lengths.append(places[-1][0])
    assert lengths == sorted(lengths)
    assert lengths[0] < lengths[-1] <= STRAIGHT[8][0]
