"""Bands, limit switches and software limits by command."""

import pytest
from tests.basic.motion_bench import Bench

POSITIVE_HARD, NEGATIVE_HARD, POSITIVE_SOFT = 16132, 16133, 16140
KAMR, KILL_MOVES = 8467, 522
ACTIVE, IN_MOTION = 792, 516
CURRENT, PSP, JOG = 12288, 12294, 12297


def bench(*lines: str) -> Bench:
    """Axes X and Y of 1000 pulses per unit on one master, Z on another."""
    made = Bench("X", "Y")
    made.attach(1, (2, "Z"))
    made.all("PPU X1000 Y1000", "PPU AXIS2 1000", "ACC 0 DEC 0 STP 0 VEL 10")
    made.all("JOG ACC X0 Y0 : JOG DEC X0 Y0 : JOG VEL X10 Y10")
    return made.all(*lines)


# hardware limits


@pytest.mark.parametrize(
    ("mode", "positive", "negative"),
    [
        pytest.param(0, False, False, marks=pytest.mark.req("ACR-LIM-06")),
        pytest.param(1, True, False, marks=pytest.mark.req("ACR-LIM-07")),
        pytest.param(2, False, True, marks=pytest.mark.req("ACR-LIM-08")),
        pytest.param(3, True, True, marks=pytest.mark.req("ACR-LIM-09")),
    ],
)
def test_hlim_chooses_the_switches_that_stop_an_axis(
    mode: int, positive: bool, negative: bool
) -> None:
    for line, switch, latch, stops in (
        ("JOG FWD X", 0, POSITIVE_HARD, positive),
        ("JOG REV X", 1, NEGATIVE_HARD, negative),
    ):
        made = bench(f"HLIM X{mode}", line).ticks(10)
        made.all(f"SET {switch}").ticks(5)
        here = made.p(JOG)
        made.ticks(50)
        assert (made.p(JOG) == here, made.bit(latch), made.bit(KAMR)) == (stops, stops, stops)


@pytest.mark.parametrize("move", ["X20", "X/20"])
@pytest.mark.req("ACR-LIM-01", "ACR-LIM-04", "ACR-LIM-18", "ACR-KAMR-12", "ACR-KAMR-32")
def test_a_hardware_limit_kills_absolute_and_incremental_moves(move: str) -> None:
    made = bench("HLIM X3 : HLDEC X100", move).seconds(0.1)
    made.all("SET 0").seconds(0.2)
    assert (made.bit(POSITIVE_HARD), made.bit(KAMR), made.bit(KILL_MOVES)) == (True, True, True)
    assert made.type("X0") == "Associated Slave Kill Motion Request Active"
    made.all("CLR 8467 CLR 8499", "CLR 522")
    assert made.type("X/1") == "Hard limit"
    made.all("X0")
    made.until_clear(IN_MOTION)
    assert made.p(CURRENT) == 0
    assert made.bit(POSITIVE_HARD)


@pytest.mark.req("ACR-LIM-04")
@pytest.mark.parametrize(("side", "latch"), [(0, 16132), (1, 16133)])
@pytest.mark.parametrize(("cleared", "left"), [(8467, 8499), (8499, 8467)])
def test_every_kill_of_the_master_has_to_be_cleared_before_motion(
    side: int, latch: int, cleared: int, left: int
) -> None:
    made = bench("HLIM X3 : HLDEC X100", f"X{-20 if side else 20}").seconds(0.1)
    made.all(f"SET {side}").seconds(0.2)
    assert [made.bit(flag) for flag in (latch, 16132 + 16133 - latch)] == [True, False]
    made.all(f"CLR {cleared}", "CLR 522")
    killed = "Associated Slave Kill Motion Request Active"
    assert [made.type(line) for line in ("X0", "Y1", "JOG FWD Y")] == [killed] * 3
    made.all(f"CLR {left}", "CLR 522", "X0 Y1")
    made.until_clear(IN_MOTION)
    assert (made.p(CURRENT), made.p(CURRENT + 256)) == (0, 1000)


@pytest.mark.req("ACR-LIM-02", "ACR-KAMR-07", "ACR-KAMR-08")
def test_a_limit_stops_the_axes_of_its_master_and_no_others() -> None:
    made = bench("HLIM X1", "AXIS2 JOG VEL 10", "JOG FWD X Y AXIS2").ticks(10)
    made.all("SET 0").ticks(3)
    stopped = [made.p(JOG + 256 * axis) for axis in range(3)]
    made.ticks(200)
    moved = [made.p(JOG + 256 * axis) - stopped[axis] for axis in range(3)]
    assert moved[:2] == [0, 0]
    assert moved[2] > 0


@pytest.mark.req("ACR-LIM-16", "ACR-LIM-20")
def test_an_inverted_limit_is_active_while_its_input_is_off() -> None:
    made = bench("HLIM X3", "SET 16144 SET 16145").ticks(2)
    assert (made.bit(16128), made.bit(16129)) == (True, True)
    made.all("SET 0 SET 1").ticks(1)
    assert (made.bit(16128), made.bit(16136)) == (False, True)
    made.ticks(1)
    assert (made.bit(16128), made.bit(16136)) == (False, False)
    made.all("JOG FWD X").ticks(10)
    made.all("CLR 0").ticks(3)
    assert made.bit(POSITIVE_HARD)


@pytest.mark.req("ACR-LIM-20")
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("which", [0, 1, 2])  # positive, negative, home
def test_the_present_and_the_previous_state_of_each_input_can_be_read(
    axis: int, which: int
) -> None:
    made = bench().ticks(2)
    present = 16128 + 32 * axis + which
    seen = []
    for line in ("SET", "SET", "CLR", "CLR"):
        made.all(f"{line} {3 * axis + which}").ticks(1)
        seen.append((made.bit(present), made.bit(present + 8)))
    assert seen == [(True, False), (True, True), (False, True), (False, False)]
    assert made.p(4600) == made.p(4601) == 0


@pytest.mark.req("ACR-LIM-17")
def test_the_quinary_flags_are_readable_as_a_word() -> None:
    made = bench("HLIM X1")
    assert made.p(4600) == 1 << 20
    made.all("P4600 = 0")
    assert made.type("HLIM X") == "0"


@pytest.mark.req("ACR-LIM-19")
def test_hardware_latches_stay_and_software_latches_clear_inside() -> None:
    made = bench("HLIM X1", "JOG FWD X").ticks(10)
    made.all("SET 0").ticks(3)
    made.all("CLR 0").ticks(200)
    assert made.bit(POSITIVE_HARD)
    soft = bench("SLIM X1 : SLM X(1,-1)", "JOG FWD X").seconds(0.2)
    assert (soft.bit(POSITIVE_SOFT), soft.bit(ACTIVE)) == (True, False)
    soft.all("JOG REV X").seconds(0.1)
    assert not soft.bit(POSITIVE_SOFT)


# software limits


@pytest.mark.parametrize(
    ("mode", "upper", "lower"),
    [
        pytest.param(0, 30, -5, marks=pytest.mark.req("ACR-LIM-10")),
        pytest.param(1, 24, -5, marks=pytest.mark.req("ACR-LIM-11")),
        pytest.param(2, 30, 0, marks=pytest.mark.req("ACR-LIM-12")),
        pytest.param(3, 24, 0, marks=pytest.mark.req("ACR-LIM-13")),
    ],
)
def test_slim_chooses_the_limits_that_stop_a_move(mode: int, upper: int, lower: int) -> None:
    for target, end in ((30, upper), (-5, lower)):
        made = bench(f"SLIM X{mode} : SLM X(24,0)", "VEL 100", f"X{target}").seconds(0.4)
        assert made.p(PSP) == pytest.approx(1000 * end, abs=101)


@pytest.mark.req("ACR-LIM-05", "ACR-KAMR-12")
def test_after_a_software_limit_inward_motion_is_possible_without_kamr() -> None:
    made = bench("SLIM X3 : SLM X(1,-1)", "X5").seconds(0.3)
    assert (made.bit(POSITIVE_SOFT), made.bit(KAMR), made.bit(KILL_MOVES)) == (True, False, True)
    assert made.type("JOG FWD X") == "Soft limit"
    assert made.type("X/1") == "Master Kill All Moves Request Active"
    made.all("CLR 522")
    assert made.type("X/1") == "Soft limit"
    made.all("X/-0.5")
    made.until_clear(IN_MOTION)
    assert not made.bit(POSITIVE_SOFT)


def test_after_a_software_limit_an_inward_jog_needs_no_clearing() -> None:
    made = bench("SLIM X3 : SLM X(1,-1)", "X5").seconds(0.3)
    assert made.type("JOG REV X") == ""
    made.ticks(20)
    assert made.p(PSP) < 1000


def test_what_follows_a_source_is_stopped_again_beyond_a_software_limit() -> None:
    made = bench("SLM X(1,-1)", "SLIM X3", "SLDEC X10000", "GEAR SRC X P12550", "GEAR PPU X1000")
    made.all("JOG FWD Y", "GEAR ON X").seconds(0.5)
    place = made.psp(0)
    assert 1000 <= place < 1020
    made.all("CLR 522", "JOG FWD Y", "GEAR ON X").ticks(40)
    assert place < made.psp(0) < place + 30
    assert made.type("AXIS0 GEAR") == "OFF"


def test_the_jog_flag_starts_no_jog_farther_out() -> None:
    made = bench("SLM X(1,-1)", "SLIM X3", "JOG FWD X").seconds(0.5)
    place = made.psp(0)
    made.all("CLR 522", "SET 796").ticks(20)
    assert (made.psp(0), made.bit(796)) == (place, False)
    made.all("SET 797").ticks(20)
    assert made.psp(0) == pytest.approx(place - 100)


def test_a_software_limit_switched_off_bars_nothing() -> None:
    made = bench("SLM X(1,-1)", "SLIM X3", "JOG FWD X").seconds(0.5)
    assert made.type("JOG FWD X") == "Soft limit"
    made.all("SLIM X0").ticks(1)
    made.all("JOG FWD X").ticks(20)
    assert made.psp(0) == pytest.approx(1100, abs=10)


def test_limits_follow_the_units_of_an_axis_with_negative_ppu() -> None:
    made = bench("PPU X-1000", "SLM X(1,-1)", "SLIM X3", "JOG FWD X").seconds(0.5)
    assert made.p(12294) == pytest.approx(-1000, abs=10)
    assert made.type("JOG FWD X") == "Soft limit"
    made.all("JOG REV X").seconds(0.5)
    assert made.p(12294) == pytest.approx(1000, abs=10)


@pytest.mark.req("ACR-LIM-22")
def test_a_software_limit_before_the_switch_keeps_the_axis_off_it() -> None:
    made = bench("SLIM X1 : SLM X(2,0) : SLDEC X100 : HLIM X1 : HLDEC X1000", "X10")
    while made.bit(IN_MOTION) or made.bit(ACTIVE):
        made.ticks(1)
        if made.p(PSP) > 3000:  # where the switch would be
            made.all("SET 0")
    assert (made.bit(POSITIVE_SOFT), made.bit(POSITIVE_HARD)) == (True, False)
    assert made.p(PSP) == pytest.approx(2500, abs=11)
