"""Software limits of an axis that is locked to another: its leader is stopped, wherever it is."""

import pytest
from tests.basic.motion_bench import PERIOD_S, Bench

from openacr.map.rows import encoders

GEAR_SOURCE = 9  # an encoder that no axis has
SOFT_MET, KILL_ALL_MOVES, JOGGING = 16140, 522, 792


def pair(leader: int, follower: int, *lines: str, follows: bool = True) -> Bench:
    """Two axes of two masters, the second locked to the first, with limits at 5 and -5 units.

    The leader has no limits of its own and ramps down with 200 units/s2, the follower with 50.
    """
    made = Bench()
    made.attach(leader, (leader, "X"))
    made.attach(follower, (follower, "Y"))
    lock = (f"LOCK AXIS{leader} AXIS{follower}",) if follows else ()
    return made.all(
        f"AXIS{leader} PPU 1000", f"AXIS{follower} PPU 1000",
        f"AXIS{leader} SLDEC 200", f"AXIS{follower} SLDEC 50",
        f"AXIS{follower} SLM (5,-5)", f"AXIS{follower} SLIM 3",
        f"AXIS{leader} JOG VEL 10 : AXIS{leader} JOG ACC 0 : AXIS{leader} JOG DEC 0",
        *lock, *lines,
    )  # fmt: skip


def kill(master: int) -> int:
    return KILL_ALL_MOVES + 32 * master


def turn(made: Bench, pulses_per_tick: int, ticks: int) -> list[float]:
    """Turn the source of the gear; the setpoints of axis 0 in pulses, tick by tick."""
    row = encoders.parameters[GEAR_SOURCE]
    found = []
    for _ in range(ticks):
        made.memory.I[row] += pulses_per_tick
        made.ticks(1)
        found.append(made.psp(0))
    return found


@pytest.mark.parametrize(("leader", "follower"), [(0, 1), (1, 0), (2, 3)])
@pytest.mark.parametrize("side", [1, -1])
def test_the_leader_ramps_down_with_its_own_deceleration(
    leader: int, follower: int, side: int
) -> None:
    made = pair(leader, follower, f"AXIS{leader} JOG {'FWD' if side > 0 else 'REV'}")
    latch = SOFT_MET + 32 * follower + (0 if side > 0 else 1)
    while not made.bit(latch):
        made.ticks(1)
    assert 5000 < made.psp(follower) * side <= 5010  # two ticks at 10 units/s
    before = made.psp(leader)
    taken = made.until_clear(JOGGING + 32 * leader)
    assert taken == pytest.approx(10 / 200 / PERIOD_S, abs=3)
    assert abs(made.psp(leader) - before) == pytest.approx(10**2 / 400 * 1000, abs=11)
    assert made.psp(follower) == pytest.approx(made.psp(leader))
    assert (made.bit(kill(leader)), made.bit(kill(follower))) == (True, False)


@pytest.mark.req("ACR-CMD-SLDEC")
def test_without_a_lock_an_axis_stops_those_of_its_own_master() -> None:
    made = pair(0, 1, "AXIS1 JOG VEL 10 : AXIS1 JOG ACC 0", "AXIS0 JOG FWD : AXIS1 JOG FWD",
                follows=False)  # fmt: skip
    made.seconds(2.0)
    assert made.psp(1) == pytest.approx(5000 + 10**2 / 100 * 1000, abs=11)
    assert made.psp(0) == pytest.approx(20_000, abs=11)
    assert (made.bit(kill(0)), made.bit(kill(1))) == (False, True)


def test_a_leader_that_follows_a_gear_farther_out_is_stopped_again() -> None:
    made = pair(0, 1, f"AXIS0 GEAR SRC ENC{GEAR_SOURCE}", "AXIS0 GEAR PPU 1000", "AXIS0 SLDEC 0")
    made.all("AXIS0 GEAR ON")
    assert turn(made, 5, 1200)[-1] == pytest.approx(5000, abs=10)
    assert made.bit(SOFT_MET + 32)
    here = made.psp(0)
    made.all(f"CLR {kill(0)}", "AXIS0 GEAR ON")
    assert max(turn(made, 5, 400)) - here <= 10
    assert made.bit(SOFT_MET + 32)
    made.all(f"CLR {kill(0)}", "AXIS0 GEAR ON")
    assert turn(made, -5, 400)[-1] == pytest.approx(here - 2000, abs=20)
    assert not made.bit(SOFT_MET + 32)


def test_an_axis_of_its_own_that_follows_a_gear_is_stopped_again_whatever_axis_0_does() -> None:
    made = pair(0, 1, "AXIS1 GEAR SRC ENC9", "AXIS1 GEAR PPU 1000", "AXIS1 SLDEC 0", follows=False)
    made.all("AXIS1 GEAR ON")
    turn(made, 5, 1200)
    here = made.psp(1)
    assert here == pytest.approx(5000, abs=10)
    made.all(f"CLR {kill(1)}", "AXIS1 GEAR ON")
    turn(made, 5, 400)
    assert made.psp(1) - here <= 10
    assert made.bit(SOFT_MET + 32)
    assert made.psp(0) == 0.0
