"""LOOK ON, LOOK OFF, LOOK TOL while the path moves: what was decided for a corner stays."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.kernel.path.test_corners import (
    Point,
    accelerations,
    follow,
    jerks,
    off_path,
    rig,
)
from tests.kernel.path.test_late_corners import (
    CHAINS,
    DEPTHS,
    EVERY,
    JRK,
    RAMPS,
    TOLERANCES,
    chain,
    keeps_limits,
    late_rig,
)
from tests.kernel.rig import Reals, Rig, T
from tests.search import search, sparse, stride

from openacr.map.rows import masters
from openacr.map.words import mf4
from openacr.motion.path import buffer

PATH = chain([(1.0, 0.0), (0.5, 30.0), (0.6, 0.0), (0.6, -40.0), (0.2, 20.0), (0.5, 90.0)])
TOLERANCE = 0.1
Switch = tuple[int, str]


def switch(made: Rig, what: str) -> None:
    if what in ("on", "off"):
        buffer.switch_look(made.card, 0, on=what == "on")
    elif what == "neglect":
        made.I[mf4.word[0]] ^= mf4.LOOK_AHEAD_NEGLECT
    else:
        made.F[masters.tolerance_u[0]] = float(what)


def switched(
    made: Rig, points: list[Point], switches: list[Switch], *, on: bool, every: int = 0
) -> Reals:
    """Positions along the points, with LOOK switched as it says; in the end all moves are taken."""
    due = dict(switches)
    buffer.switch_look(made.card, 0, on=on)

    def meanwhile(tick: int) -> None:
        if tick in due:
            switch(made, due[tick])

    return follow(made, points, meanwhile, every=every)


def keeps_acceleration(places: Reals, points: list[Point], tolerance: float) -> None:
    assert tuple(places[-1]) == pytest.approx(points[-1], abs=1e-9)
    assert off_path(places, points) <= tolerance * (1 + 1e-6) + 1e-9
    assert accelerations(places).max() <= 1000 * (1 + 1e-4)


WHATS = ["on", "off", "neglect", "0.02", "0.1"]


@pytest.mark.search
@pytest.mark.parametrize(
    ("what", "depth", "jrk"), sparse(list(itertools.product(WHATS, [2, 10], [0.0, JRK])), 3)
)
def test_a_switch_at_any_tick_keeps_all_limits(what: str, depth: int, jrk: float) -> None:
    def made() -> Rig:
        it = rig(TOLERANCE, jrk=jrk)
        it.depth(depth)
        return it

    on = what != "on"
    for tick in range(0, len(switched(made(), PATH, [], on=on)), stride(1)):
        places = switched(made(), PATH, [(tick, what)], on=on)
        keeps_acceleration(places, PATH, TOLERANCE)
        if jrk:
            assert jerks(places).max() <= jrk * (1 + 1e-3)


SWITCHES = st.lists(
    st.tuples(
        st.integers(1, 400), st.sampled_from(["on", "off", "neglect", "0.001", "0.1", "1.0"])
    ),
    min_size=1,
    max_size=6,
).map(
    lambda waits: list(
        zip(itertools.accumulate(wait for wait, _ in waits), [w for _, w in waits], strict=True)
    )
)


@search(100)
@given(CHAINS, TOLERANCES, DEPTHS, EVERY, RAMPS, SWITCHES, st.booleans())
def test_under_jerk_any_switches_keep_all_limits(
    points: list[Point],
    tolerance: float,
    depth: int,
    every: int,
    ramps: tuple[float, float],
    switches: list[Switch],
    on: bool,
) -> None:
    places = switched(late_rig(tolerance, depth, ramps), points, switches, on=on, every=every)
    keeps_limits(places, points, 1.0)


@search(100)
@given(CHAINS, TOLERANCES, SWITCHES, st.booleans())
def test_without_jerk_any_switches_keep_the_acceleration(
    points: list[Point], tolerance: float, switches: list[Switch], on: bool
) -> None:
    places = switched(rig(tolerance), points, switches, on=on)
    keeps_acceleration(places, points, 1.0)


def rounds(places: Reals, corner: Point) -> bool:
    """Whether a path stays off a corner."""
    return float(np.min(np.linalg.norm(places - corner, axis=1))) > TOLERANCE / 2


SQUARE = chain([(5.0, 0.0), (5.0, 90.0), (5.0, 90.0), (5.0, 90.0)])


@pytest.mark.parametrize(("what", "rounded"), [("on", [False, True]), ("off", [True, False])])
def test_a_switch_counts_for_the_corners_decided_from_then_on(
    what: str, rounded: list[bool]
) -> None:
    made = rig(TOLERANCE)
    made.depth(1)
    places = switched(made, SQUARE, [(1, what)], on=what == "off")
    assert [rounds(places, corner) for corner in SQUARE[:2]] == rounded


@pytest.mark.parametrize("jrk", [0.0, JRK])
def test_both_builds_agree_about_switches(jrk: float) -> None:
    digests = []
    for pure in (False, True):
        made = rig(TOLERANCE, jrk=jrk, pure=pure)
        switched(made, PATH[:4], [(40, "off"), (90, "on")], on=True)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]


@pytest.mark.parametrize("tick", [1, 100, 180, 210])
def test_a_move_given_without_look_ends_with_its_final_velocity_though_look_comes(
    tick: int,
) -> None:
    line = chain([(6.0, 0.0), (6.0, 0.0), (6.0, 0.0)])
    runs = []
    for switches in ([], [(tick, "on")]):
        made = rig(TOLERANCE).master(fvel=20.0)
        runs.append(switched(made, line, switches, on=False))
    assert len(runs[0]) == len(runs[1])
    assert runs[1] == pytest.approx(runs[0], abs=1e-9)
    speed = np.linalg.norm(np.diff(runs[1], axis=0), axis=1)
    at_joint = speed[np.argmin(np.abs(runs[1][:, 0] - 6.0))] / T
    assert at_joint == pytest.approx(20.0, abs=1.0)


EXACT = [[(3.0, 0.0), (3.0, 20.0), (3.0, -15.0), (1.0, 5.0)], [(1.5, 9.0)] * 7 + [(0.3, 9.0)]]


def ramps(made: Rig, points: list[Point], tick: int, what: str) -> Reals:
    """Changes of the speed along a path by time, with one switch."""
    speeds = [0.0]

    def meanwhile(now: int) -> None:
        if now == tick:
            switch(made, what)
        speeds.append(made.path_velocity)

    follow(made, points, meanwhile)
    return np.asarray(np.abs(np.diff([*speeds, made.path_velocity])) / T)


SHARES = [(1.0, 1.0), (1.0, 0.5), (0.6, 1.0)]


@pytest.mark.search
@pytest.mark.parametrize(
    ("legs", "jrk", "what", "share"),
    sparse(list(itertools.product(EXACT, [0.0, JRK], ["off", "neglect"], SHARES)), 5),
)
def test_look_off_at_any_tick_leaves_exact_corners_their_room_to_brake(
    legs: list[tuple[float, float]], jrk: float, what: str, share: tuple[float, float]
) -> None:
    points = chain(legs)
    for tick in range(1, len(follow(rig(0.0, jrk=jrk), points)), stride(3)):
        made = rig(0.0, jrk=jrk).master(dec=1000 * share[0], stp=1000 * share[1])
        assert ramps(made, points, tick, what).max() <= 1000 * (1 + 1e-6)


@pytest.mark.parametrize(
    ("tick", "passed"), [(20, 0), (60, 0), (120, 1), (150, 1), (155, 2), (222, 3)]
)
def test_look_off_ends_the_path_at_the_first_exact_corner_before_which_there_is_room(
    tick: int, passed: int
) -> None:
    """Of legs of 3 units, by 1000 units/s^2: the last one, of 1 unit, is too short to stop on."""
    points = chain(EXACT[0])
    places = switched(rig(0.0), points, [(tick, "off")], on=True)
    slow = np.linalg.norm(np.diff(places, axis=0), axis=1) / T < 1.0
    at = [bool(slow[np.argmin(np.linalg.norm(places - each, axis=1)) - 1]) for each in points[:3]]
    assert at == [False] * passed + [True] * (3 - passed)
