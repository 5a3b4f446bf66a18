"""Fast limit flags: chosen groups follow in the servo interrupt, the others with the slow scan."""

from collections.abc import Callable

import pytest
from tests.kernel.rig import Rig

from openacr.map.rows import axes as axis_rows
from openacr.map.rows import system
from openacr.map.words import af4

ENABLE = 5632
EXC, IPB, ALM, BLM, TLM, TIB, MASTER = 2328, 2329, 2330, 2331, 2332, 2333, 2335
SLOW_TICKS = 100
PHASE = system.slow_phase

WORLD = """
[[axis]]
number = 0
counts_per_rev = 4000
drive = { mode = "ideal", revs_per_s_per_volt = 1e-6, lag_s = 0.001 }
"""


def rig(axes: int = 1, *, pure: bool = False) -> Rig:
    """Axes at 0 with narrow bands, ten ticks after a slow scan."""
    made = Rig(axes, ppu=[100.0] * axes, world=WORLD, pure=pure)
    made.modelled = False  # the motor stands still
    for axis in range(axes):
        made.axis(axis, plus_excess_error=1, minus_excess_error=-1)
        made.axis(axis, plus_in_position=1, minus_in_position=-1)
        made.axis(axis, plus_a_limit=5, minus_a_limit=-5, plus_b_limit=5, minus_b_limit=-5)
        made.axis(axis, plus_torque_band=1, minus_torque_band=-1)
    made.ticks(SLOW_TICKS)
    while made.I[PHASE] != 10:
        made.ticks()
    return made


def lag(made: Rig) -> None:
    """Leave the commanded position: a following error, an output, another place."""
    made.axis(proportional_gain=0.05, plus_torque_limit=2, minus_torque_limit=-2)
    made.F[axis_rows.position_cnt[0]] = 600.0


def ticks_until(made: Rig, changed: Callable[[], bool]) -> int:
    """Ticks that pass until something is so."""
    for count in range(1, 2 * SLOW_TICKS):
        made.ticks()
        if changed():
            return count
    raise AssertionError("nothing has changed")


FLAGS = [(EXC, 769), (IPB, 768), (ALM, 770), (BLM, 771), (TLM, 772), (TIB, 773)]


@pytest.mark.parametrize(("fast", "flag"), FLAGS)
def test_a_chosen_flag_changes_in_the_tick_of_its_cause(fast: int, flag: int) -> None:
    made = rig()
    made.bit(ENABLE, True)
    made.bit(fast, True)
    before = made.bit(flag)
    lag(made)
    assert ticks_until(made, lambda: made.bit(flag) != before) == 1


@pytest.mark.parametrize(("fast", "flag"), FLAGS)
@pytest.mark.parametrize(("enable", "choose"), [(False, True), (True, False), (False, False)])
def test_any_other_flag_waits_for_the_slow_scan(
    fast: int, flag: int, enable: bool, choose: bool
) -> None:
    made = rig()
    made.bit(ENABLE, enable)
    made.bit(fast, choose)
    made.bit(2360, True)  # an axis that is not in use chooses in vain
    before = made.bit(flag)
    lag(made)
    assert ticks_until(made, lambda: made.bit(flag) != before) == SLOW_TICKS - 10


def test_groups_take_turns_one_each_tick() -> None:
    made = rig()
    made.bit(ENABLE, True)
    for fast, _ in FLAGS:
        made.bit(fast, True)
    made.ticks(12)
    before = [made.bit(flag) for _, flag in FLAGS]
    lag(made)
    changed: list[int] = []
    for _ in FLAGS:
        made.ticks()
        now = [flag for (_, flag), old in zip(FLAGS, before, strict=True) if made.bit(flag) != old]
        assert len(now) == len(changed) + 1
        changed += [flag for flag in now if flag not in changed]
    assert len(changed) == len(FLAGS)


def test_all_axes_of_a_group_change_together() -> None:
    made = rig(2)
    made.bit(ENABLE, True)
    for fast in (ALM, ALM + 32, IPB + 32):
        made.bit(fast, True)
    made.ticks(2)
    for axis in (0, 1):
        made.F[axis_rows.position_cnt[axis]] = 600.0
    assert ticks_until(made, lambda: not made.bit(770) or not made.bit(802)) <= 2
    assert (made.bit(770), made.bit(802)) == (False, False)


def test_the_flags_of_the_master_follow_those_of_its_axes_the_tick_after() -> None:
    made = rig()
    made.bit(ENABLE, True)
    made.bit(ALM, True)
    made.ticks(2)
    made.bit(MASTER, True)
    assert (made.bit(770), made.bit(530)) == (True, True)
    made.F[axis_rows.position_cnt[0]] = 600.0
    assert ticks_until(made, lambda: not made.bit(530)) <= 3
    assert not made.bit(770)
    slow = rig()
    slow.bit(ENABLE, True)
    slow.bit(ALM, True)
    slow.F[axis_rows.position_cnt[0]] = 600.0
    assert ticks_until(slow, lambda: not slow.bit(530)) == SLOW_TICKS - 10


def test_a_fast_excess_error_stops_the_drive_at_once() -> None:
    made = rig()
    made.bit(ENABLE, True)
    made.bit(EXC, True)
    word = af4.word[0]
    made.I[word] |= af4.EXC_RESPONSE_ENABLE | af4.DRIVE_ENABLED
    lag(made)
    made.ticks()
    assert made.I[word] & af4.EXCESS_ERROR_FAULT


def test_both_builds_agree_to_the_bit() -> None:
    digests = []
    for pure in (False, True):
        made = rig(2, pure=pure)
        made.bit(ENABLE, True)
        for fast in (EXC, IPB, TLM, ALM + 32, MASTER + 32):
            made.bit(fast, True)
        lag(made)
        made.ticks(30)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]
