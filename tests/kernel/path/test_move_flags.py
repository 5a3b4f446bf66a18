"""Flags of a master that change its next move: override lock and block skip."""

import pytest
from tests.kernel.rig import Rig

IN_MOTION, LOCK_PENDING, LOCK_ACTIVE = 516, 526, 527
CHECK, INPUT = 2048, 2049


def moving() -> Rig:
    """One axis of 1000 pulses per unit at 10 units/s without ramps, overridden to a half."""
    rig = Rig(1, ppu=[1000.0]).master(acc=0, dec=0, stp=0, vel=10, fov=0.5, rov=0.25)
    rig.depth(4)
    return rig


@pytest.mark.parametrize(("is_rapid", "override"), [(False, 0.5), (True, 0.25)])
def test_the_lock_puts_1_in_place_of_fov_and_of_rov(is_rapid: bool, override: float) -> None:
    rig = moving()
    rig.bit(LOCK_PENDING, True)
    rig.move(5.0, rapid=is_rapid)
    rig.ticks(20)
    assert (rig.bit(LOCK_ACTIVE), rig.path_velocity) == (True, 10.0)
    rig.bit(LOCK_ACTIVE, False)  # by hand, in the move
    rig.ticks(2)
    assert rig.path_velocity == 10.0 * override
    rig.bit(LOCK_ACTIVE, True)
    rig.ticks(2)
    assert rig.path_velocity == 10.0
    rig.bit(LOCK_PENDING, False)
    rig.record(while_=IN_MOTION)
    rig.move(0.0, rapid=is_rapid)
    rig.ticks(2)
    assert (rig.bit(LOCK_ACTIVE), rig.path_velocity) == (False, 10.0 * override)


@pytest.mark.parametrize(
    ("check", "is_input", "is_skipped"),
    [(False, False, False), (False, True, False), (True, False, False), (True, True, True)],
)
def test_block_skip_drops_the_next_move_with_check_and_input_alone(
    check: bool, is_input: bool, is_skipped: bool
) -> None:
    rig = moving()
    rig.bit(CHECK, check)
    rig.bit(INPUT, is_input)
    rig.move(1.0)
    rig.move(-2.0)
    rig.move(-2.5)
    path = rig.record(while_=IN_MOTION)
    assert (rig.bit(CHECK), rig.bit(INPUT)) == (False, is_input)
    assert max(path) == pytest.approx(0.0 if is_skipped else 1000.0)
    assert (min(path), path[-1]) == (-2500.0, -2500.0)  # the moves after it are made
