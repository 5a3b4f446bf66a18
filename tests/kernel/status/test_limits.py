"""Kills, hardware limits and software limits: who stops, how, and what may move afterwards."""

import pytest
from tests.kernel.rig import Rig, T

from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.motion.jog import jog
from openacr.motion.path import moves

KAMR, KILL_ALL_MOVES, IN_MOTION = 8467, 522, 516


def travelling(axes: int = 2) -> Rig:
    """Two axes of 1000 pulses per unit, HLDEC 200, SLDEC 50, on their direction to 100."""
    rig = Rig(axes, ppu=[1000.0] * axes).master(acc=100, dec=100, stp=100, vel=10)
    for axis in range(axes):
        rig.F[axis_rows.hldec_ups2[axis]] = 200.0
        rig.F[axis_rows.sldec_ups2[axis]] = 50.0
        rig.F[axis_rows.slm_plus_u[axis]] = 24.0
        rig.jog(axis, vel=10, acc=100, dec=100)
    return rig


def ticks_to_rest(rig: Rig, axis: int = 0) -> int:
    count = 0
    while rig.real("psp_velocity_cps", axis) != 0.0:
        rig.ticks()
        count += 1
    return count


@pytest.mark.req("ACR-KAMR-02", "ACR-KAMR-03", "ACR-KAMR-07", "ACR-KAMR-17", "ACR-KAMR-18")
@pytest.mark.req("ACR-KAMR-20", "ACR-KAMR-21", "ACR-KAMR-24")
@pytest.mark.req("ACR-CMD-HLDEC")
def test_a_kill_ramps_all_axes_of_the_master_down_with_hldec() -> None:
    rig = travelling()
    rig.move(80.0, 60.0)  # 8 and 6 units/s
    rig.seconds(1.0)
    rig.bit(KAMR, True)
    rig.ticks()
    assert (rig.bit(KAMR + 32), rig.bit(KILL_ALL_MOVES), rig.bit(IN_MOTION)) == (1, 1, 0)
    assert ticks_to_rest(rig, 1) + 1 == pytest.approx(6 / 200 / T, abs=2)
    assert ticks_to_rest(rig, 0) + 61 == pytest.approx(8 / 200 / T, abs=2)
    assert rig.real("jog_cnt") == pytest.approx(8**2 / 400 * 1000, rel=0.02)
    assert rig.bit(KAMR)
    with pytest.raises(CardError, match="Associated Slave Kill Motion Request Active"):
        jog.continuous(rig.card, 1, 1)


@pytest.mark.req("ACR-KAMR-33", "ACR-KAMR-39")
@pytest.mark.parametrize("held", [False, True])
def test_stop_all_moves_decelerates_then_kills(held: bool) -> None:
    rig = travelling()
    rig.move(50.0)
    rig.seconds(1.0)
    if held:
        moves.hold(rig.card, 0)
        rig.seconds(0.3)
        assert rig.bit(519)
    rig.bit(523, True)
    rig.seconds(0.3)
    assert (rig.bit(523), rig.bit(KILL_ALL_MOVES), rig.bit(IN_MOTION)) == (0, 1, 0)
    assert rig.real("psp_velocity_cps") == 0.0


@pytest.mark.parametrize("first", [-5, 3, 30, 40, 17661, 17663, 17664, 2_000_000_000])
def test_any_first_limit_input_is_safe_and_stays_in_its_word(first: int) -> None:
    rig = travelling()
    rig.I[axis_rows.hlbit[0]] = first
    rig.bit(3, True)
    if first == 30:
        for bit in (30, 31, 32):
            rig.bit(bit, True)
    rig.ticks(2)
    states = [rig.bit(16128 + n) for n in range(3)]
    assert states == {3: [1, 0, 0], 30: [1, 1, 0]}.get(first, states)
