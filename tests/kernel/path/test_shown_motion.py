"""What the parameters and flags of a master say of its moves."""

import pytest
from tests.kernel.rig import Rig

from openacr.map.rows import axes
from openacr.motion.axis import drive
from openacr.motion.jog import jog
from openacr.motion.path import moves
from openacr.motion.path.move_request import FlagState, Target

IN_MOTION, MOVE_BUFFERED, FEEDHOLDING, IN_FEEDHOLD, KILL_ALL_MOVES, KAMR = (
    516,
    517,
    518,
    519,
    522,
    8467,
)
FVEL_ZERO, VEL_LIMIT_FLAG = 525, 5888
CURRENT, TARGET = 12288, 12289
TARGET_ACCELERATION, DISTANCE_SQUARED, INTO_PATH, VEL_LIMIT = 8198, 8204, 8207, 8232
JOG_ACTIVE, JOG_STOPPING = 792, 795


def moving(**profile: float) -> Rig:
    """Two axes of 1000 pulses per unit; VEL 10, ramps of 100 units/s^2."""
    rig = Rig(2, ppu=[1000.0, 1000.0])
    rig.master(**{"acc": 100.0, "dec": 100.0, "stp": 100.0, "vel": 10.0, **profile})
    rig.depth(10)
    return rig


def read(rig: Rig, number: int) -> float:
    return rig.memory.read(number)


def targets(rig: Rig) -> list[float]:
    return [read(rig, TARGET), read(rig, TARGET + 256)]


# Target Position and Distance Squared


def test_the_target_position_is_that_of_the_last_buffered_move() -> None:
    rig = moving()
    shown = []
    for place in ((1.0, 0.0), (2.0, 5.0), (4.0, -3.0)):
        rig.move(*place)
        shown.append(targets(rig))
    moves.issue(rig.card, 0, [Target(1, 1.0, incremental=True)])
    shown.append(targets(rig))
    assert shown == [[1000, 0], [2000, 5000], [4000, -3000], [4000, -2000]]
    while rig.bit(IN_MOTION):
        assert targets(rig) == [4000, -2000]
        at_target = read(rig, CURRENT) == 4000 and read(rig, CURRENT + 256) == -2000
        assert not (at_target and rig.bit(MOVE_BUFFERED))
        rig.ticks()
    assert [read(rig, CURRENT), read(rig, CURRENT + 256)] == [4000, -2000] == targets(rig)


@pytest.mark.parametrize("how", ["kill of moves", "kill of an axis", "halt"])
def test_the_target_position_returns_to_the_position_when_moves_are_dropped(how: str) -> None:
    rig = moving()
    rig.move(5.0, 5.0)
    rig.move(9.0, 1.0)
    rig.seconds(0.2)
    if how == "halt":
        moves.halt(rig.card, 0)
    else:
        rig.bit(KILL_ALL_MOVES if how == "kill of moves" else KAMR, True)
    rig.seconds(0.3)
    assert 1000 < read(rig, CURRENT) < 5000
    assert targets(rig) == [read(rig, CURRENT), read(rig, CURRENT + 256)]


def test_a_replacing_move_forgets_the_targets_of_the_moves_it_drops() -> None:
    rig = moving()
    rig.move(5.0, 5.0)
    rig.move(6.0, 9.0)
    rig.seconds(0.2)
    moves.issue(rig.card, 0, [Target(0, 8.0)], replace=True)
    assert targets(rig) == [8000, read(rig, CURRENT + 256)]
    moves.issue(rig.card, 0, [Target(1, 1.0, incremental=True)])
    end = read(rig, CURRENT + 256) + 1000
    assert targets(rig) == [8000, pytest.approx(end, abs=1)]
    rig.record(while_=IN_MOTION)
    assert [read(rig, CURRENT), read(rig, CURRENT + 256)] == [8000, pytest.approx(end, abs=1)]


def test_the_distance_squared_is_that_of_the_buffered_move() -> None:
    rig = moving()
    rig.move(3.0, 4.0)
    assert read(rig, DISTANCE_SQUARED) == 25.0
    rig.move(3.0, 6.0)
    assert read(rig, DISTANCE_SQUARED) == 4.0
    rig.ticks(50)
    assert read(rig, DISTANCE_SQUARED) == 4.0


# feedhold


def test_feedholding_stays_until_cycle_start() -> None:
    rig = moving()
    rig.move(5.0)
    rig.seconds(0.2)
    moves.hold(rig.card, 0)
    assert (rig.bit(FEEDHOLDING), rig.bit(IN_FEEDHOLD)) == (True, False)
    rig.seconds(0.3)
    assert (rig.bit(FEEDHOLDING), rig.bit(IN_FEEDHOLD), rig.bit(IN_MOTION)) == (1, 1, 1)
    moves.release(rig.card, 0)
    assert (rig.bit(FEEDHOLDING), rig.bit(IN_FEEDHOLD)) == (False, False)


def test_feedholding_clears_when_the_moves_are_dropped() -> None:
    rig = moving()
    rig.move(5.0)
    rig.seconds(0.2)
    moves.hold(rig.card, 0)
    rig.seconds(0.3)
    rig.bit(KILL_ALL_MOVES, True)
    rig.ticks(2)
    assert (rig.bit(FEEDHOLDING), rig.bit(IN_FEEDHOLD), rig.bit(IN_MOTION)) == (0, 0, 0)


# distances, ramps and the velocity limit


def test_the_distance_into_the_path_is_all_that_was_travelled() -> None:
    rig = moving()
    rig.move(3.0, 4.0)
    rig.record(while_=IN_MOTION)
    assert read(rig, INTO_PATH) == 5.0
    rig.seconds(0.1).move(1.0, 4.0)
    rig.seconds(0.15)
    gone = 3.0 - rig.real("position_cnt") / 1000
    assert 0.5 < gone < 1.5
    assert read(rig, INTO_PATH) == pytest.approx(5.0 + gone, rel=1e-6)
    rig.bit(KILL_ALL_MOVES, True)  # what was travelled of a move that is killed counts
    rig.ticks(2)
    gone = 3.0 - rig.real("position_cnt") / 1000
    assert read(rig, INTO_PATH) == pytest.approx(5.0 + gone, rel=1e-6)
    rig.bit(KILL_ALL_MOVES, False)
    rig.move(1.0, 4.0)
    rig.record(while_=IN_MOTION)
    assert read(rig, INTO_PATH) == pytest.approx(7.0, rel=1e-6)


@pytest.mark.parametrize("is_turned", [False, True])
def test_a_replaced_move_counts_as_far_as_it_went(is_turned: bool) -> None:
    rig = moving()
    rig.move(5.0)
    rig.seconds(0.2)
    moves.issue(rig.card, 0, [Target(0, 0.0 if is_turned else 8.0)], replace=True)
    path = rig.record(while_=IN_MOTION)
    travelled = 2 * max(path) / 1000 if is_turned else 8.0
    assert read(rig, INTO_PATH) == pytest.approx(travelled, rel=1e-6)


def test_moves_without_stops_and_cut_ones_count_what_was_travelled() -> None:
    rig = moving(stp=0.0)
    rig.bit(5891, True)  # LookAhead mode
    for end in (1.0, 2.0, 3.0):
        rig.move(end)
    rig.seconds(0.17)
    while rig.bit(IN_MOTION):
        gone = read(rig, INTO_PATH)
        assert gone == pytest.approx(rig.real("position_cnt") / 1000, rel=1e-6)
        rig.ticks()
    assert read(rig, INTO_PATH) == 3.0


@pytest.mark.parametrize("stop_ups2", [100.0, 20.0])
def test_a_move_that_is_interrupted_counts_where_it_ends(stop_ups2: float) -> None:
    """With the softer ramp it comes to rest in the next move, through which it was planned."""
    rig = moving(stp=stop_ups2)
    rig.bit(5891, True)  # LookAhead mode
    moves.issue(rig.card, 0, [Target(0, 2.0)], interrupt=FlagState(40))
    for end in (4.0, 8.0):
        rig.move(end)
    rig.seconds(0.2).bit(40, True)
    while rig.bit(IN_MOTION):
        gone = rig.real("position_cnt") / 1000
        assert read(rig, INTO_PATH) == pytest.approx(gone, rel=1e-6)
        rig.ticks()
    assert read(rig, INTO_PATH) == pytest.approx(8.0, rel=1e-6)


def test_the_target_acceleration_is_the_ramp_also_at_constant_speed() -> None:
    rig = moving(acc=50.0, dec=80.0, stp=40.0)
    rig.move(20.0)
    rig.seconds(0.1)
    assert read(rig, TARGET_ACCELERATION) == 50.0
    rig.seconds(0.5)
    assert (rig.path_velocity, read(rig, TARGET_ACCELERATION)) == (10.0, 50.0)
    moves.hold(rig.card, 0)
    rig.seconds(0.05)
    assert read(rig, TARGET_ACCELERATION) == 80.0


def test_the_vel_limit_flag_is_set_while_the_speed_is_at_the_limit() -> None:
    rig = moving()
    rig.memory.write(VEL_LIMIT, 6.0)
    rig.move(5.0)
    seen = []
    while rig.bit(IN_MOTION):
        rig.ticks()
        seen.append((rig.bit(VEL_LIMIT_FLAG), rig.path_velocity >= 6.0 * (1 - 1e-9)))
    assert all(flag == at_limit for flag, at_limit in seen)
    assert {flag for flag, _ in seen} == {False, True}
    rig.move(0.0)
    rig.seconds(0.2)
    assert rig.bit(VEL_LIMIT_FLAG)
    rig.memory.write(VEL_LIMIT, 0.0)
    rig.ticks(2)
    assert not rig.bit(VEL_LIMIT_FLAG)
    rig.memory.write(VEL_LIMIT, 6.0)
    rig.seconds(0.1)
    assert rig.bit(VEL_LIMIT_FLAG)
    rig.bit(KILL_ALL_MOVES, True)
    rig.ticks(2)
    assert not rig.bit(VEL_LIMIT_FLAG)


# final velocity, jogs


def last_speed(rig: Rig) -> float:
    """Speed of the path in the last tick of its motion."""
    last = 0.0
    while rig.bit(IN_MOTION):
        last = rig.path_velocity
        rig.ticks()
    return last


@pytest.mark.parametrize(("when", "end_ups"), [("never", 4.0), ("in the move", 0.0)])
def test_fvel_zero_acts_when_it_is_set_by_hand_in_a_move(when: str, end_ups: float) -> None:
    rig = moving(fvel=4.0)
    rig.move(5.0)
    rig.seconds(0.3)
    if when != "never":
        rig.bit(FVEL_ZERO, True)
    assert last_speed(rig) == pytest.approx(end_ups, abs=0.06)


def test_fvel_zero_can_be_taken_back_in_the_move() -> None:
    rig = moving(fvel=4.0)
    rig.move(5.0)
    rig.seconds(0.2).bit(FVEL_ZERO, True)
    rig.seconds(0.05).bit(FVEL_ZERO, False)
    assert last_speed(rig) == pytest.approx(4.0, abs=0.06)


@pytest.mark.parametrize("start", ["continuous", "target", "homing"])
def test_jog_stopping_set_from_outside_ends_a_jog_with_its_ramp(start: str) -> None:
    rig = Rig(1, ppu=[1000.0]).jog(vel=10, acc=100, dec=50)
    if start == "continuous":
        jog.continuous(rig.card, 0, 1)
    elif start == "target":
        jog.absolute(rig.card, 0, 50.0)
    else:
        jog.home(rig.card, 0, 1)
    rig.seconds(0.3)
    here = rig.real("jog_cnt")
    rig.bit(JOG_STOPPING, True)
    rig.record(while_=JOG_ACTIVE)
    assert rig.real("jog_cnt") - here == pytest.approx(1000.0, abs=6)  # v^2 / (2 DEC)
    assert (rig.bit(JOG_STOPPING), rig.bit(796), rig.bit(16131)) == (False, False, False)
    assert rig.bit(16135) == (start == "homing")
    here = rig.real("jog_cnt")
    jog.incremental(rig.card, 0, 1.0)  # and bars no later jog
    rig.record(while_=JOG_ACTIVE)
    assert rig.real("jog_cnt") == pytest.approx(here + 1000.0)


def test_jog_stopping_does_nothing_to_an_axis_at_rest_or_one_that_is_killed() -> None:
    rig = Rig(1, ppu=[1000.0]).jog(vel=10, acc=100, dec=1)
    rig.bit(JOG_STOPPING, True)
    rig.ticks(2)
    assert (rig.bit(JOG_STOPPING), rig.bit(JOG_ACTIVE)) == (False, False)
    rig.F[axes.hldec_ups2[0]] = 200.0
    jog.continuous(rig.card, 0, 1)
    rig.seconds(0.3)
    rig.bit(KAMR, True)
    rig.ticks(1).bit(JOG_STOPPING, True)
    here = rig.real("jog_cnt")
    rig.record(while_=JOG_ACTIVE)
    assert rig.real("jog_cnt") - here == pytest.approx(250.0, abs=6)
    drive.clear_kills(rig.card)
