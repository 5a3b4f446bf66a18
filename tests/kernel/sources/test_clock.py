"""Time of the card: millisecond counter, clock pulses, and the slow scan."""

import pytest
from tests.kernel.rig import Rig

from openacr.map import numbers as at
from openacr.motion.axis import registers

CLOCK = at.P_GLOBAL_SYSTEM_CLOCK


@pytest.mark.parametrize("period_s", [0.0001, 0.0005, 0.0007, 0.002])
def test_the_millisecond_counter_keeps_time(period_s: float) -> None:
    rig = Rig()
    rig.card.set_period(period_s)
    rig.ticks(3000)
    assert rig.I[CLOCK] == pytest.approx(3000 * period_s * 1000, abs=1)
    assert rig.card.clock.tick == 3000


def test_the_counter_wraps_to_zero() -> None:
    rig = Rig()
    rig.I[CLOCK] = 2**31 - 1
    rig.ticks(2)
    assert rig.I[CLOCK] == 0


@pytest.mark.parametrize(("flag", "cycle_ms"), [(80, 20), (81, 100), (82, 1000), (83, 60_000)])
def test_clock_pulses_are_on_for_half_of_their_cycle(flag: int, cycle_ms: int) -> None:
    rig = Rig()
    for clock in (0, cycle_ms // 2 - 2, cycle_ms // 2 - 1, cycle_ms - 2, cycle_ms - 1):
        rig.I[CLOCK] = clock
        rig.ticks(2)
        assert rig.bit(flag) == ((clock + 1) % cycle_ms < cycle_ms / 2)


def test_a_clock_written_below_zero_goes_on() -> None:
    rig = Rig()
    rig.I[CLOCK] = -3
    rig.ticks(4)
    assert rig.I[CLOCK] == -1


def test_bands_are_refreshed_by_the_slow_scan() -> None:
    rig = Rig(ppu=[100.0])
    rig.axis(plus_a_limit=5, minus_a_limit=-5, plus_b_limit=1, minus_b_limit=-1)
    registers.res(rig.card, 0, 3.0)
    rig.ticks(100)
    assert (rig.bit(770), rig.bit(771)) == (True, True)  # in A, not in B
    assert (rig.bit(530), rig.bit(531)) == (True, True)
    registers.res(rig.card, 0, 6.0)
    rig.ticks(100)
    assert (rig.bit(770), rig.bit(771)) == (False, True)
    registers.res(rig.card, 0, 0.5)
    rig.ticks(100)
    assert (rig.bit(770), rig.bit(771)) == (True, False)


def test_requests_of_the_slow_scan_clear_themselves() -> None:
    rig = Rig(ppu=[100.0]).master(acc=10, dec=10, stp=10, vel=1)
    rig.move(10.0)
    rig.ticks(50).bit(520, True)
    rig.ticks(100)
    assert (rig.bit(520), rig.bit(518) or rig.bit(519)) == (False, True)
    rig.bit(542, True)  # lockout
    rig.seconds(0.5).bit(521, True)
    rig.ticks(100)
    assert (rig.bit(521), rig.bit(519)) == (False, True)
    rig.bit(542, False)
    rig.bit(521, True)
    rig.ticks(100)
    assert (rig.bit(521), rig.bit(519)) == (False, False)
    rig.record()
    assert rig.real("position_cnt") == 1000.0
