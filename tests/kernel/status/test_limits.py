"""Kills, hardware limits and software limits: who stops, how, and what may move afterwards."""

import pytest
from tests.kernel.rig import Rig, T

from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.motion.axis import attach, drive
from openacr.motion.jog import jog
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target

ACTIVE, KAMR, KILL_ALL_MOVES, IN_MOTION = 792, 8467, 522, 516
POSITIVE_INPUT, HARD_POSITIVE = 0, 16148


def travelling(axes: int = 2) -> Rig:
    """Two axes of 1000 pulses per unit, HLDEC 200, SLDEC 50, on their direction to 100."""
    rig = Rig(axes, ppu=[1000.0] * axes).master(acc=100, dec=100, stp=100, vel=10)
    for axis in range(axes):
        reals = at.AXF_BASE + axis * at.AXF_STRIDE
        rig.F[reals + at.AXF_HLDEC_UPS2] = 200.0
        rig.F[reals + at.AXF_SLDEC_UPS2] = 50.0
        rig.F[reals + at.AXF_SLM_PLUS_U] = 24.0
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


@pytest.mark.req("ACR-KAMR-19")
def test_jog_res_moves_the_offset_of_a_stop_into_the_position() -> None:
    rig = travelling()
    rig.move(50.0)
    rig.seconds(1.0).bit(KAMR, True)
    rig.seconds(0.2)
    here = rig.real("psp_cnt")
    jog.reset(rig.card, 0, 0.0)
    rig.ticks(3)
    assert rig.real("jog_cnt") == 0.0
    assert rig.real("psp_cnt") == pytest.approx(here, abs=1e-9)


@pytest.mark.req("ACR-KAMR-08", "ACR-LIM-02")
def test_axes_of_another_master_go_on() -> None:
    rig = travelling()
    attach.detach_slave(rig.card, 0, 1)
    attach.master(rig.card, 1, 1)
    attach.slave(rig.card, 1, 0, 1, "Y")
    rig.I[at.KRI_BASE + at.KRI_MASTERS] = 2
    rig.S[at.MA_BASE + at.MA_STRIDE + at.MA_USER_VELOCITY] = 5.0
    rig.move(50.0)
    moves.issue(rig.card, 1, [Target(1, 50.0)])
    rig.seconds(1.0).bit(KAMR, True)
    rig.seconds(0.2)
    assert rig.real("psp_velocity_cps", 0) == 0.0
    assert rig.real("psp_velocity_cps", 1) == pytest.approx(5000)


@pytest.mark.req("ACR-KAMR-31", "ACR-KAMR-35", "ACR-KAMR-37")
def test_kill_all_moves_stops_at_once_and_leaves_jogs_alone() -> None:
    rig = travelling()
    rig.move(50.0)
    jog.continuous(rig.card, 1, 1)
    rig.seconds(1.0)
    before = rig.real("position_cnt")
    rig.bit(KILL_ALL_MOVES, True)
    rig.ticks()
    assert rig.real("position_cnt") == before == rig.real("target_cnt")
    rig.seconds(0.2)
    assert rig.real("psp_velocity_cps", 1) == pytest.approx(10_000)
    assert rig.bit(KILL_ALL_MOVES)


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


@pytest.mark.req("ACR-LIM-03", "ACR-LIM-04", "ACR-LIM-19", "ACR-KAMR-12")
def test_a_hard_limit_latches_kills_and_bars_one_direction() -> None:
    rig = travelling()
    rig.bit(HARD_POSITIVE, True)
    rig.move(50.0)
    rig.seconds(1.0).bit(POSITIVE_INPUT, True)
    rig.ticks(2)
    assert (rig.bit(16132), rig.bit(KAMR), rig.bit(KAMR + 32)) == (1, 1, 1)
    assert ticks_to_rest(rig) == pytest.approx(10 / 200 / T, abs=3)
    drive.clear_kills(rig.card)
    rig.ticks()
    with pytest.raises(CardError, match="Hard limit"):
        jog.continuous(rig.card, 0, 1)
    jog.continuous(rig.card, 0, -1)
    rig.seconds(0.1)
    assert rig.real("psp_velocity_cps") < 0
    assert (rig.bit(KAMR), rig.bit(16132)) == (False, True)


@pytest.mark.parametrize("first", [-5, 3, 30, 40, 17661, 17663, 17664, 2_000_000_000])
def test_any_first_limit_input_is_safe_and_stays_in_its_word(first: int) -> None:
    rig = travelling()
    rig.I[at.AXI_BASE + at.AXI_HLBIT] = first
    rig.bit(3, True)
    if first == 30:
        for bit in (30, 31, 32):
            rig.bit(bit, True)
    rig.ticks(2)
    states = [rig.bit(16128 + n) for n in range(3)]
    assert states == {3: [1, 0, 0], 30: [1, 1, 0]}.get(first, states)
