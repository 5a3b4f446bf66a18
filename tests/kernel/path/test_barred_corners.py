"""Start Move Inhibit and SYNC on a path with rounded corners: it stops where it has room to."""

from collections.abc import Callable

import numpy as np
import pytest
from tests.kernel.path.test_corners import Point, accelerations, follow, jerks, rig
from tests.kernel.path.test_late_corners import JRK, chain
from tests.kernel.rig import Reals, Rig

from openacr.kernel.path.sync_cy import sync_drop
from openacr.map import numbers as at
from openacr.map.words import mf1, mf2

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
    made.I[at.KRI_BASE + at.KRI_MASTERS] = 2
    for m in range(2):
        made.I[mf2.word[m]] = made.I[mf2.word[m]] | bit if on else made.I[mf2.word[m]] & ~bit


def barred(made: Rig, points: list[Point], tick: int, bar: Bar) -> Reals:
    def meanwhile(now: int) -> None:
        if now in (tick, tick + REST):
            bar(made, now == tick)

    return follow(made, points, meanwhile)


@pytest.mark.parametrize("points", [PATH, CHORDS])
@pytest.mark.parametrize("jrk", [0.0, JRK])
@pytest.mark.parametrize("bar", [inhibit, sync])
def test_a_path_that_is_barred_at_any_tick_keeps_all_limits(
    bar: Bar, jrk: float, points: list[Point]
) -> None:
    for tick in range(1, len(follow(rig(0.1, jrk=jrk), points)) - 1, 5):
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


def test_a_kill_of_one_member_lets_the_other_pass_the_corner_it_is_in() -> None:
    for tick in range(60, 200, 7):
        made = rig(0.1)

        def meanwhile(now: int, made: Rig = made, tick: int = tick) -> None:
            if now == tick:
                sync_drop(made.F, made.I, made.S, 0)

        places = follow(made, PATH, meanwhile)
        assert accelerations(places).max() <= 1000 * (1 + 1e-4)
