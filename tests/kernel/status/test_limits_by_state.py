"""What a limit bars: a direction, while its switch is active or the setpoint is beyond it."""

import math

import pytest
from tests.kernel.rig import Rig

from openacr.errors import CardError
from openacr.map.rows import axes
from openacr.motion.axis import drive
from openacr.motion.jog import jog
from openacr.motion.path import host_moves

ACTIVE, HOMING, FAILED, KAMR, KILL_ALL_MOVES, IN_MOTION = 792, 16131, 16135, 8467, 522, 516
FORWARD, REVERSE = 796, 797
POSITIVE_SWITCH, NEGATIVE_SWITCH = 0, 1
POSITIVE_MET, NEGATIVE_MET, POSITIVE_SOFT_MET = 16132, 16133, 16140
HARD_ENABLES, SOFT_ENABLES = (16148, 16149), (16150, 16151)


def limited(ppu: float = 1000.0) -> Rig:
    """An axis between switches, jogging and moving at 10 units/s without ramps."""
    rig = Rig(1, ppu=[ppu]).master(acc=0, dec=0, stp=0, vel=10).jog(vel=10, acc=0, dec=0)
    for enable in HARD_ENABLES:
        rig.bit(enable, True)
    return rig


def soft(plus_u: float, minus_u: float, ppu: float = 1000.0, sldec_ups2: float = 0.0) -> Rig:
    """The same axis between software limits only."""
    rig = Rig(1, ppu=[ppu]).master(acc=0, dec=0, stp=0, vel=10).jog(vel=10, acc=0, dec=0)
    for enable in SOFT_ENABLES:
        rig.bit(enable, True)
    rig.F[axes.slm_plus_u[0]] = plus_u
    rig.F[axes.slm_minus_u[0]] = minus_u
    rig.F[axes.sldec_ups2[0]] = sldec_ups2
    return rig


def hit(rig: Rig, side: int) -> None:
    """Jog into the switch of a side, then clear the kills (Ctrl-Y)."""
    jog.continuous(rig.card, 0, side)
    rig.seconds(0.1).bit(POSITIVE_SWITCH if side > 0 else NEGATIVE_SWITCH, True)
    rig.ticks(5)
    assert rig.bit(KAMR)
    drive.clear_kills(rig.card)
    rig.ticks()


@pytest.mark.parametrize(
    ("side", "switch", "met"),
    [(1, POSITIVE_SWITCH, POSITIVE_MET), (-1, NEGATIVE_SWITCH, NEGATIVE_MET)],
)
def test_off_the_switch_an_axis_moves_towards_it_again_without_clearing_the_flag(
    side: int, switch: int, met: int
) -> None:
    rig = limited()
    hit(rig, side)
    with pytest.raises(CardError, match="Hard limit"):
        jog.continuous(rig.card, 0, side)
    with pytest.raises(CardError, match="Hard limit"):
        rig.move(rig.real("position_cnt") / 1000 + side)
    jog.incremental(rig.card, 0, -15.0 * side)
    rig.seconds(0.1).bit(switch, False)
    rig.record(while_=ACTIVE)
    here = rig.real("psp_cnt")
    assert rig.bit(met)
    jog.incremental(rig.card, 0, 3.0 * side)
    rig.record(while_=ACTIVE)
    assert rig.real("psp_cnt") == pytest.approx(here + 3000.0 * side)
    rig.move(2.0 * side)
    rig.record(while_=IN_MOTION)
    assert rig.real("position_cnt") == 2000.0 * side
    assert (rig.bit(met), rig.bit(KAMR)) == (True, False)


def test_an_axis_that_has_met_both_switches_moves_both_ways() -> None:
    rig = limited()
    for side in (1, -1):
        hit(rig, side)
        rig.bit(POSITIVE_SWITCH, False)
        rig.bit(NEGATIVE_SWITCH, False)
        rig.ticks()
    assert rig.bit(POSITIVE_MET)
    assert rig.bit(NEGATIVE_MET)
    for side in (1, -1):
        here = rig.real("psp_cnt")
        jog.incremental(rig.card, 0, 2.0 * side)
        rig.record(while_=ACTIVE)
        assert rig.real("psp_cnt") == pytest.approx(here + 2000.0 * side)


@pytest.mark.parametrize("enabled", [False, True])
@pytest.mark.parametrize(("side", "wanted"), [(1, FORWARD), (-1, REVERSE)])
def test_the_jog_flags_start_nothing_towards_an_active_switch(
    side: int, wanted: int, enabled: bool
) -> None:
    rig = limited()
    rig.bit(HARD_ENABLES[0 if side > 0 else 1], enabled)
    rig.bit(POSITIVE_SWITCH if side > 0 else NEGATIVE_SWITCH, True)
    rig.ticks(2).bit(wanted, True)
    rig.ticks(10)
    assert (rig.real("psp_cnt") == 0.0, rig.bit(wanted), rig.bit(KAMR)) == (
        (True, False, False) if enabled else (False, True, False)
    )
    rig.bit(wanted, False)
    rig.bit(FORWARD + REVERSE - wanted, True)
    rig.ticks(10)
    assert rig.real("psp_velocity_cps") == pytest.approx(-side * 10_000.0)


def test_on_a_switch_moves_that_lead_away_and_then_back_can_be_buffered() -> None:
    rig = limited()
    rig.depth(4)
    rig.bit(POSITIVE_SWITCH, True)
    rig.ticks(2)
    rig.move(-4.0)
    rig.move(-2.0)  # outward, but from -4
    rig.ticks(100).bit(POSITIVE_SWITCH, False)
    rig.record(while_=IN_MOTION)
    assert rig.real("position_cnt") == -2000.0
    rig.bit(POSITIVE_SWITCH, True)
    rig.ticks(2)
    rig.move(-3.0)
    rig.move(-1.0)
    rig.seconds(0.3)  # the switch has stayed active: the second move trips it
    assert (rig.bit(KAMR), rig.bit(POSITIVE_MET)) == (True, True)
    assert rig.real("position_cnt") == pytest.approx(-3000.0, abs=6)


def test_a_binary_move_is_barred_by_an_active_limit_alone() -> None:
    rig = limited()
    hit(rig, 1)
    here = rig.real("position_cnt")
    with pytest.raises(CardError, match="Hard limit"):
        host_moves.issue(rig.card, host_moves.HostMove(master=0, targets_cnt={0: here + 1000.0}))
    host_moves.issue(rig.card, host_moves.HostMove(master=0, targets_cnt={0: here - 1000.0}))
    rig.record(while_=IN_MOTION)
    rig.bit(POSITIVE_SWITCH, False)
    rig.ticks(2)
    host_moves.issue(rig.card, host_moves.HostMove(master=0, targets_cnt={0: here + 1000.0}))
    rig.record(while_=IN_MOTION)
    assert (rig.real("position_cnt"), rig.bit(POSITIVE_MET)) == (here + 1000.0, True)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("ppu", [1000.0, -1000.0, 3.1])
@pytest.mark.parametrize("offset_u", [0.0, 0.7])
@pytest.mark.parametrize("beyond_cnt", [0.0, 0.01])
def test_a_move_exactly_to_a_software_limit_does_not_cross_it(
    side: int, ppu: float, offset_u: float, beyond_cnt: float
) -> None:
    rig = soft(2.3, -2.3, ppu)
    jog.absolute(rig.card, 0, offset_u)
    rig.record(while_=ACTIVE)
    scale = rig.fp32("ppu")
    rig.move(side * (2.3 + beyond_cnt / abs(scale)) - offset_u)
    rig.record(while_=IN_MOTION, then=3)
    met = beyond_cnt > 0.0
    assert rig.real("psp_cnt") == pytest.approx(
        side * (2.3 * scale + math.copysign(beyond_cnt, scale)), abs=1e-6
    )
    assert (rig.bit(POSITIVE_SOFT_MET + (side < 0)), rig.bit(KILL_ALL_MOVES)) == (met, met)


def test_a_software_limit_bars_by_position_whatever_its_flag_says() -> None:
    rig = soft(1.0, -1.0)
    jog.continuous(rig.card, 0, 1)
    rig.seconds(0.5)
    here = rig.real("psp_cnt")
    assert 1000 < here < 1011
    rig.bit(POSITIVE_SOFT_MET, False)
    with pytest.raises(CardError, match="Soft limit"):
        jog.continuous(rig.card, 0, 1)
    rig.bit(FORWARD, True)
    rig.ticks(5)
    assert (rig.real("psp_cnt"), rig.bit(FORWARD)) == (here, False)
    rig.F[axes.slm_plus_u[0]] = 2.0  # the limit is moved out
    jog.continuous(rig.card, 0, 1)
    rig.ticks(5)
    assert rig.real("psp_cnt") == pytest.approx(here + 25)


def stopping(side: int, sldec_ups2: float) -> tuple[Rig, float]:
    """An axis that a software limit has begun to stop; where the stop alone ends."""
    ends: list[float] = []
    for _ in range(2):
        rig = soft(1.0, -1.0, sldec_ups2=sldec_ups2)
        rig.jog(dec=1000, acc=1000)
        jog.continuous(rig.card, 0, side)
        while not rig.bit(KILL_ALL_MOVES):
            rig.ticks()
        rig.ticks(3)
        if not ends:
            rig.record(while_=ACTIVE)
            ends.append(rig.real("psp_cnt"))
    return rig, ends[0]


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("sldec_ups2", [50.0, 5000.0])
def test_a_jog_inwards_begins_when_the_stop_has_ended(side: int, sldec_ups2: float) -> None:
    rig, stop_cnt = stopping(side, sldec_ups2)
    jog.absolute(rig.card, 0, 0.5 * side)
    path = rig.record(while_=ACTIVE)
    farthest = max(abs(each) for each in path)
    assert farthest == pytest.approx(abs(stop_cnt), abs=0.2), "with SLDEC, not JOG DEC"
    assert rig.real("jog_cnt") == 500.0 * side


def test_increments_during_the_stop_add_up() -> None:
    rig, _ = stopping(1, 50.0)
    jog.absolute(rig.card, 0, 0.75)
    for _ in range(2):
        rig.ticks(2)
        jog.incremental(rig.card, 0, -0.125)
    rig.record(while_=ACTIVE)
    assert rig.real("jog_cnt") == 500.0


def test_an_increment_during_the_stop_begins_where_the_axis_is() -> None:
    rig, _ = stopping(1, 50.0)
    rig.ticks()
    here = rig.real("jog_cnt")
    jog.incremental(rig.card, 0, -0.5)
    rig.record(while_=ACTIVE)
    assert rig.real("jog_cnt") == pytest.approx(here - 500.0)


@pytest.mark.parametrize("by", ["off", "kill"])
def test_a_jog_that_waits_for_the_end_of_the_stop_can_be_taken_back(by: str) -> None:
    rig, stop_cnt = stopping(1, 50.0)
    jog.absolute(rig.card, 0, 0.5)
    rig.ticks(2)
    if by == "off":
        jog.off(rig.card, 0)
    else:
        rig.bit(KAMR, True)
    rig.record(while_=ACTIVE)
    assert rig.real("psp_cnt") > 1000
    if by == "off":
        assert rig.real("psp_cnt") == stop_cnt
    rig.seconds(0.2)
    assert rig.real("psp_cnt") > 1000


def test_the_last_jog_command_during_the_stop_counts() -> None:
    rig, _ = stopping(1, 50.0)
    jog.absolute(rig.card, 0, 0.5)
    jog.continuous(rig.card, 0, -1)
    rig.seconds(0.5)
    assert rig.real("psp_cnt") < 400
    jog.off(rig.card, 0)
    rig, _ = stopping(1, 50.0)
    jog.continuous(rig.card, 0, -1)
    jog.absolute(rig.card, 0, 0.5)
    rig.record(while_=ACTIVE)
    assert rig.real("jog_cnt") == 500.0


def test_a_jog_that_turns_too_late_is_stopped_at_the_software_limit() -> None:
    rig = soft(1.0, -1.0, sldec_ups2=10_000.0)
    rig.jog(dec=1, acc=1000)
    jog.continuous(rig.card, 0, 1)
    rig.ticks(150)
    jog.absolute(rig.card, 0, 0.0)  # at 1 unit/s^2 it would turn at 50
    path = rig.record(while_=ACTIVE)
    assert rig.bit(POSITIVE_SOFT_MET)
    assert max(path) == rig.real("psp_cnt") == pytest.approx(1008, abs=8)


def test_a_kill_that_passes_a_software_limit_keeps_its_rate() -> None:
    ends = []
    for minus_u in (-1.0, -100.0):
        rig = soft(100.0, minus_u, sldec_ups2=10_000.0)
        rig.F[axes.hldec_ups2[0]] = 50.0
        jog.continuous(rig.card, 0, -1)
        rig.ticks(150)
        rig.bit(KAMR, True)
        rig.record(while_=ACTIVE)
        ends.append((rig.real("psp_cnt"), rig.bit(POSITIVE_SOFT_MET + 1)))
    assert ends[0][0] == ends[1][0] < -1500
    assert [met for _, met in ends] == [True, False]


@pytest.mark.parametrize("by_flag", [False, True])
@pytest.mark.parametrize("side", [1, -1])
def test_homing_towards_an_active_limit_searches_the_other_way_at_once(
    side: int, by_flag: bool
) -> None:
    rig = limited()
    rig.bit(POSITIVE_SWITCH if side > 0 else NEGATIVE_SWITCH, True)
    rig.ticks(2)
    if by_flag:
        rig.bit(17161, side < 0)
        rig.bit(17160, True)
    else:
        jog.home(rig.card, 0, side)
    for _ in range(50):
        rig.ticks()
        assert rig.real("psp_cnt") * side <= 0.0
    assert (rig.bit(HOMING), rig.bit(KAMR)) == (True, False)
    assert rig.real("psp_velocity_cps") == pytest.approx(-side * 10_000.0)
    rig.bit(POSITIVE_SWITCH, side < 0)
    rig.bit(NEGATIVE_SWITCH, side > 0)
    rig.ticks(5)
    assert (rig.bit(HOMING), rig.bit(FAILED), rig.bit(KAMR)) == (False, True, True)


def test_homing_between_two_active_limits_fails_where_it_is() -> None:
    rig = limited()
    rig.bit(POSITIVE_SWITCH, True)
    rig.bit(NEGATIVE_SWITCH, True)
    rig.ticks(2)
    jog.home(rig.card, 0, 1)
    rig.ticks(20)
    assert (rig.bit(HOMING), rig.bit(FAILED), rig.bit(KAMR)) == (False, True, True)
    assert rig.real("psp_cnt") == 0.0


@pytest.mark.parametrize("ppu", [0.5, 1.0, -0.5, -1.0])
@pytest.mark.parametrize("side", [1, -1])
def test_an_axis_with_few_pulses_per_unit_stops_at_its_software_limits(
    ppu: float, side: int
) -> None:
    rig = soft(20.0, -20.0, ppu=ppu)
    jog.continuous(rig.card, 0, side)
    rig.seconds(4.0)
    place_u = rig.F[axes.jog_cnt[0]] / ppu
    assert 20.0 <= side * place_u <= 20.0 + 10.0 * 2 * 0.0005
    assert rig.bit(POSITIVE_SOFT_MET) is (side > 0)
