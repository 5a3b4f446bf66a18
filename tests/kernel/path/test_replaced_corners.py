"""TRJ on a path with rounded corners: the path comes to rest within its limits, then turns back."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.kernel.path.test_corners import Point, accelerations, follow, jerks, rig
from tests.kernel.path.test_late_corners import CHAINS, JRK, TOLERANCES, chain
from tests.kernel.rig import Reals, Rig
from tests.search import search, stride

from openacr.motion.path import moves
from openacr.motion.path.move_request import Target

PATH = chain([(1.0, 0.0), (1.0, 0.0), (1.0, 60.0), (2.0, 30.0)])


def replaced(made: Rig, points: list[Point], tick: int, place: Point) -> Reals:
    """Positions along the points, of which a TRJ takes the place at a tick."""
    targets = [Target(n, value) for n, value in enumerate(place)]

    def meanwhile(now: int) -> None:
        if now == tick:
            moves.issue(made.card, 0, targets, replace=True)

    return follow(made, points, meanwhile)


def keeps(places: Reals, jrk: float) -> None:
    assert accelerations(places).max() <= 1000 * (1 + 1e-4)
    if jrk:
        assert jerks(places).max() <= jrk * (1 + 1e-3)


@pytest.mark.search
@pytest.mark.parametrize("jrk", [0.0, JRK])
def test_a_path_that_is_turned_back_at_any_tick_keeps_all_limits(jrk: float) -> None:
    for tick in range(1, len(follow(rig(0.1, jrk=jrk), PATH)) - 2, stride(1)):
        places = replaced(rig(0.1, jrk=jrk), PATH, tick, (-3.0, -5.0))
        assert tuple(places[-1]) == pytest.approx((-3.0, -5.0), abs=1e-9)
        keeps(places, jrk)


@pytest.mark.parametrize("jrk", [0.0, JRK])
def test_a_path_that_is_turned_back_on_a_long_line_does_not_go_on_to_its_end(jrk: float) -> None:
    line = chain([(2.0, 0.0), (30.0, 40.0), (5.0, 60.0)])
    places = replaced(rig(0.1, jrk=jrk), line, 250, (-3.0, -5.0))
    assert places[:, 0].max() < 15.0
    keeps(places, jrk)


@pytest.mark.parametrize(("jrk", "first"), [(0.0, 0.5), (JRK, 0.21)])
def test_corners_after_the_path_has_turned_back_are_rounded_from_where_it_did(
    jrk: float, first: float
) -> None:
    """Under jerk the first reaches to a quarter of the line from there: 6.85 units."""
    made = rig(0.5, jrk=jrk)
    back: list[Point] = [(-3.0, -5.0), (-3.0, -15.0), (-13.0, -15.0)]

    def meanwhile(now: int) -> None:
        if now == 120:
            for point in back:
                targets = [Target(n, value) for n, value in enumerate(point)]
                moves.issue(made.card, 0, targets, replace=point == back[0])

    places = follow(made, PATH, meanwhile)
    assert tuple(places[-1]) == pytest.approx(back[-1], abs=1e-9)
    off = [np.min(np.linalg.norm(places - corner, axis=1)) for corner in back[:2]]
    assert off == pytest.approx([first, 0.5], abs=0.001)
    keeps(places, jrk)


@search(100)
@given(CHAINS, TOLERANCES, st.integers(1, 400), st.sampled_from([0.0, JRK]))
def test_any_path_that_is_turned_back_keeps_all_limits(
    points: list[Point], tolerance: float, tick: int, jrk: float
) -> None:
    made = rig(tolerance, jrk=jrk)
    made.depth(12)
    heading: list[Reals] = []

    def meanwhile(now: int) -> None:
        here = np.array([made.real("position_cnt", n) / 10_000.0 for n in range(2)])
        heading.append(here)
        if now == tick and now > 1:
            back = here - 20.0 * (heading[-1] - heading[-2]) / max(
                float(np.linalg.norm(heading[-1] - heading[-2])), 1e-9
            )
            targets = [Target(n, float(value)) for n, value in enumerate(back)]
            moves.issue(made.card, 0, targets, replace=True)

    keeps(follow(made, points, meanwhile), jrk)


@pytest.mark.parametrize("jrk", [0.0, JRK])
def test_both_builds_agree_about_a_path_that_is_turned_back(jrk: float) -> None:
    digests = []
    for pure in (False, True):
        made = rig(0.1, jrk=jrk, pure=pure)
        replaced(made, PATH[:3], 90, (0.5, -0.2))
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]
