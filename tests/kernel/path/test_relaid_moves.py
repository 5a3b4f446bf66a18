"""Paths that end elsewhere than planned, by Block Skip or INT: what waits is laid out again."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.kernel.path.test_corners import Point, accelerations, follow, jerks, off_path, rig
from tests.kernel.path.test_late_corners import CHAINS, JRK, TOLERANCES, chain
from tests.kernel.rig import Reals, Rig, T
from tests.search import search, stride

from openacr.kernel.path.path_cy import MARK_BLOCK_SKIP
from openacr.map.rows import axes, masters
from openacr.map.rows import moves as records
from openacr.map.words import mf2
from openacr.motion.path import moves
from openacr.motion.path.move_request import FlagState, Target

CHECK, INPUT, SIGNAL = 2048, 2049, 100
# Without its second leg the third turns by 37 instead of 40 degrees, and is 2.5 times as long.
PATH = chain([(2.0, 0.0), (2.0, 40.0), (2.0, -40.0), (2.0, 90.0), (1.0, 20.0)])
LINE = chain([(1.0, 0.0)] * 8)


def without(points: list[Point], place: int) -> list[Point]:
    return points[:place] + points[place + 1 :]


def keeps(places: Reals, jrk: float) -> None:
    assert accelerations(places).max() <= 1000 * (1 + 1e-4)
    if jrk:
        assert jerks(places).max() <= jrk * (1 + 1e-3)


def left_out(made: Rig, points: list[Point], tick: int) -> Reals:
    """Positions along the points; from a tick on Check and Input say that a move is left out."""

    def meanwhile(now: int) -> None:
        if now == tick:
            made.I[mf2.word[0]] |= mf2.BLOCK_SKIP_CHECK | mf2.BLOCK_SKIP_INPUT

    return follow(made, points, meanwhile)


@pytest.mark.search
@pytest.mark.parametrize("jrk", [0.0, JRK])
def test_a_move_that_is_left_out_at_any_tick_leaves_limits_and_tolerance_kept(jrk: float) -> None:
    skipped = []
    for tick in range(1, len(follow(rig(0.1, jrk=jrk), PATH)) - 2, stride(3)):
        places = left_out(rig(0.1, jrk=jrk), PATH, tick)
        keeps(places, jrk)
        off = [off_path(places, PATH)] + [off_path(places, without(PATH, k)) for k in range(1, 5)]
        assert min(off) <= 0.1 * (1 + 1e-6)
        skipped.append(off.index(min(off)))
    assert {0, 1, 2, 3} <= set(skipped)


def test_the_path_stops_before_a_move_that_is_left_out() -> None:
    places = left_out(rig(0.1), PATH, 10)
    assert np.min(np.linalg.norm(places - PATH[0], axis=1)) <= 1000 * T**2 / 2
    assert off_path(places, without(PATH, 1)) <= 0.1


def test_the_corner_after_a_move_that_is_left_out_is_that_of_the_lines_which_are_run() -> None:
    places = left_out(rig(0.05), PATH, 10)
    assert np.min(np.linalg.norm(places - PATH[2], axis=1)) == pytest.approx(0.05, abs=1e-4)
    keeps(places, 0.0)


@pytest.mark.parametrize("tolerance", [0.0, 0.1])
def test_too_late_a_check_is_used_up_by_the_move_that_the_path_runs_into(tolerance: float) -> None:
    """At tick 100 the path has gone 1.26 units at 50 units/s: 1.25 units from rest."""
    made = rig(tolerance)
    places = left_out(made, LINE, 100)
    assert len(places) == len(follow(rig(tolerance), LINE))
    assert (made.bit(CHECK), made.bit(INPUT)) == (False, True)


@pytest.mark.parametrize("tolerance", [0.0, 0.1])
def test_a_check_without_the_input_costs_no_time(tolerance: float) -> None:
    made = rig(tolerance)

    def meanwhile(now: int) -> None:
        if now == 5:
            made.bit(CHECK, True)

    assert len(follow(made, PATH, meanwhile)) == len(follow(rig(tolerance), PATH))
    assert not made.bit(CHECK)


def marked(made: Rig, points: list[Point], place: int, is_input: bool) -> Reals:
    """Positions along the points, of which one is marked as a binary move with Block Skip."""
    made.bit(INPUT, is_input)
    rest = list(points)

    def issue(point: Point) -> None:
        ring = made.I[masters.head[0]] + made.I[masters.queued[0]]
        made.move(*point)
        if point == points[place]:
            made.I[records.marks[made.I[masters.first[0]] + ring % made.I[masters.size[0]]]] |= (
                MARK_BLOCK_SKIP
            )

    return follow(made, rest, issue=issue)


@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("place", [1, 2, 3])
def test_a_marked_move_far_ahead_is_left_out_with_the_input_and_run_into_without(
    place: int, jrk: float
) -> None:
    places = marked(rig(0.1, jrk=jrk), PATH, place, True)
    assert off_path(places, without(PATH, place)) <= 0.1 * (1 + 1e-6)
    keeps(places, jrk)
    whole = marked(rig(0.1, jrk=jrk), PATH, place, False)
    assert whole == pytest.approx(follow(rig(0.1, jrk=jrk), PATH))


@search(150)
@given(CHAINS, TOLERANCES, st.integers(1, 400), st.sampled_from([0.0, JRK]))
def test_any_path_with_a_move_that_is_left_out_keeps_limits_and_tolerance(
    points: list[Point], tolerance: float, tick: int, jrk: float
) -> None:
    places = left_out(rig(tolerance, jrk=jrk), points, tick)
    keeps(places, jrk)
    paths = [points] + [without(points, k) for k in range(len(points))]
    off = [off_path(places, each) for each in paths if each]
    assert min(off) <= tolerance * (1 + 1e-6) + 1e-9


def interrupted(made: Rig, points: list[Point], tick: int) -> Reals:
    """Positions along the points, of which INT ends the first early at a tick."""
    first = points[0]

    def issue(point: Point) -> None:
        targets = [Target(n, value) for n, value in enumerate(point)]
        interrupt = FlagState(SIGNAL) if point == first else None
        moves.issue(made.card, 0, targets, interrupt=interrupt)

    def meanwhile(now: int) -> None:
        if now == tick:
            made.bit(SIGNAL, True)

    return follow(made, points, meanwhile, issue)


# Planned, the second leg turns by 90 degrees and the third goes straight on.
BESIDE: list[Point] = [(10.0, 0.0), (10.0, 5.0), (10.0, 10.0), (0.0, 10.0)]


@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("tick", [5, 60, 100])
def test_corners_after_an_interrupted_move_are_those_of_the_lines_which_are_run(
    tick: int, jrk: float
) -> None:
    places = interrupted(rig(0.1, jrk=jrk), BESIDE, tick)
    assert places[:, 0].max() <= 10.0 + 1e-9
    keeps(places, jrk)
    off = np.min(np.linalg.norm(places - BESIDE[1], axis=1))
    assert off == pytest.approx(0.1, rel=0.02)


@pytest.mark.parametrize("waiting", [2, 3])
def test_the_last_corner_of_the_moves_that_wait_is_rounded_after_an_interrupt(waiting: int) -> None:
    points = BESIDE[: waiting + 1]
    places = interrupted(rig(0.1), points, 60)
    off = np.min(np.linalg.norm(places - points[-2], axis=1))
    assert off == pytest.approx(0.1, rel=0.02)


def test_look_slows_down_for_the_angle_that_an_interrupted_path_turns_by() -> None:
    """Look Ahead stops at 90 degrees and more, which the corner at (10, 5) has not if planned."""
    made = rig(0.0)
    made.F[masters.look_from_deg[0]], made.F[masters.look_to_deg[0]] = 1.0, 20.0
    places = interrupted(made, BESIDE, 60)
    rests = places[1:][np.linalg.norm(np.diff(places, axis=0), axis=1) / T < 2.0]
    assert np.min(np.linalg.norm(rests - BESIDE[1], axis=1)) < 0.01


def test_incremental_moves_after_an_interrupted_one_keep_their_lengths() -> None:
    made = rig(0.1)

    def issue(point: Point) -> None:
        targets = [Target(n, value, True) for n, value in enumerate(point)]
        moves.issue(made.card, 0, targets, interrupt=None if point[1] else FlagState(SIGNAL))

    def meanwhile(now: int) -> None:
        if now == 60:
            made.bit(SIGNAL, True)

    places = follow(made, [(10.0, 0.0), (0.0, 5.0), (3.0, 5.0)], meanwhile, issue)
    start = places[places[:, 1] > 0.0][0][0]
    assert start < 3.0
    assert places[-1] == pytest.approx([start + 3.0, 10.0], abs=1e-6)
    made.move(0.0, 0.0)
    assert made.F[masters.target_cnt[0]] == 0.0


def test_what_is_appended_after_an_interrupted_move_is_laid_out_from_the_last_end() -> None:
    """The first move is one of X, the second of Y alone: X stays where it was interrupted."""
    made = rig(0.1)
    moves.issue(made.card, 0, [Target(0, 10.0)], interrupt=FlagState(SIGNAL))
    moves.issue(made.card, 0, [Target(1, 5.0)])
    made.ticks(60)
    made.bit(SIGNAL, True)
    made.ticks(120)
    here = made.F[axes.psp_cnt[0]]
    assert 0.0 < here < 50_000.0
    assert made.F[masters.target_cnt[0]] == here
    assert made.F[masters.target_cnt[0] + 1] == 50_000.0


Run = Callable[[Rig], Reals]


@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize(
    "run", [lambda made: left_out(made, PATH[:4], 20), lambda made: interrupted(made, BESIDE, 60)]
)
def test_both_builds_agree_about_moves_that_are_laid_out_again(run: Run, jrk: float) -> None:
    digests = []
    for pure in (False, True):
        made = rig(0.1, jrk=jrk, pure=pure)
        run(made)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]
