"""Why an axis does not move: every cause of the guide, seen and removed."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    """A card at PROG0 with the axis X, drive signals in use and enabled."""
    console = Console()
    console.type("DIM P(10)", "SET 8468", "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"')
    console.type("PPU X1000", "VEL 10", "ACC 0", "DEC 0", "STP 0")
    console.card.advance(seconds=0.2)
    console.type("DRIVE ON X")
    console.card.advance(seconds=0.2)
    return console


def moves(card: Console, target: float, *, seconds: float = 1.0) -> bool:
    """Whether a move to a target arrives."""
    card.type(f"X{target}")
    card.card.advance(seconds=seconds)
    return bool(card.card.p[12288] == round(target * 1000))


def test_nothing_is_wrong_to_begin_with(card: Console) -> None:
    assert moves(card, 1)


@pytest.mark.req("ACR-TRB-22")
def test_cause_1_a_limit_was_encountered_and_its_kill_is_still_set(card: Console) -> None:
    card.type("HLIM X3", "X5")
    card.card.advance(seconds=0.2)
    card.type("SET 0")
    card.card.advance(seconds=0.1)
    assert card.type("X-1") == "Associated Slave Kill Motion Request Active"
    card.type("CLR 16132", "CLR 8467", "CLR 522")
    assert card.type("X5") == "Hard limit"  # the switch is still active
    assert moves(card, -1)
    card.type("CLR 0")
    card.card.advance(seconds=0.01)
    assert moves(card, 1)
    card.type("SLIM X3", "SLM X(2,-2)", "X5")
    card.card.advance(seconds=0.5)
    card.type("JOG VEL X10", "JOG INC X-1")  # jog off the software limit
    card.card.advance(seconds=0.5)
    assert card.type("X1") == "Master Kill All Moves Request Active"
    card.type("CLR 16140", "CLR 522")
    assert moves(card, 1)


@pytest.mark.req("ACR-TRB-15")
def test_cause_2_kill_all_moves_of_the_master(card: Console) -> None:
    card.type("SET 522")
    card.card.advance(seconds=0.1)
    assert card.type("X1") == "Master Kill All Moves Request Active"
    card.type("CLR 522", "CLR 8467")
    assert moves(card, 1)


@pytest.mark.req("ACR-TRB-16")
@pytest.mark.parametrize(("axis", "position"), [(0, 12288), (7, 14080), (8, 14336), (15, 16128)])
def test_cause_3_the_kill_request_of_the_axis(axis: int, position: int) -> None:
    card = Console("ACR8020")
    card.type("PROG0", "ATTACH MASTER0", f'ATTACH SLAVE0 AXIS{axis} "X"')
    card.type("PPU X1000", "VEL 10", "ACC 0", "DEC 0", "STP 0", "X2")
    card.card.advance(seconds=0.1)
    kill = 8467 + 32 * axis
    card.type(f"SET {kill}")
    card.card.advance(seconds=0.1)
    stopped = card.card.p[position]
    assert 0 < stopped < 2000
    assert card.type("X1") == "Associated Slave Kill Motion Request Active"
    card.type(f"CLR {kill}")
    assert card.type("X1") == "Master Kill All Moves Request Active"
    card.type("CLR 522")
    assert card.type("X/0.5") == ""
    card.card.advance(seconds=0.5)
    assert card.card.p[position] == stopped + 500


@pytest.mark.req("ACR-TRB-17")
def test_cause_4_feed_hold(card: Console) -> None:
    card.type("VEL 1", "X1")
    card.type("SET 520")
    card.card.advance(seconds=2)
    assert card.card.bit[519]
    assert card.card.p[12288] < 1000
    card.type("SET 521")
    card.card.advance(seconds=2)
    assert not card.card.bit[519]
    assert card.card.p[12288] == 1000


@pytest.mark.req("ACR-TRB-18")
def test_cause_5_the_slave_is_not_attached(card: Console) -> None:
    card.type("DETACH")
    assert card.type("ATTACH") == ""
    assert card.type("X1") == "Unknown command"
    card.type("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"')
    assert card.type("ATTACH") == 'ATTACH MASTER0|ATTACH SLAVE0 AXIS0 "X"'


@pytest.mark.req("ACR-TRB-19")
def test_cause_6_a_velocity_of_zero(card: Console) -> None:
    card.type("VEL 0")
    assert not moves(card, 1)
    card.type("VEL 10")  # also for the move that is waiting
    card.card.advance(seconds=1)
    assert card.card.p[12288] == 1000
    card.type("JOG VEL X0", "JOG ACC X0", "JOG DEC X0", "JOG FWD X")
    card.card.advance(seconds=0.5)
    assert card.card.p[12290] == pytest.approx(1000, abs=2)
    card.type("JOG VEL X1")
    card.card.advance(seconds=0.5)
    assert card.card.p[12290] > 1100


@pytest.mark.req("ACR-TRB-20")
def test_cause_7_a_feedrate_override_of_zero(card: Console) -> None:
    card.type("FOV 0")
    assert not moves(card, 1)
    card.type("FOV 1")
    card.card.advance(seconds=1)
    assert card.card.p[12288] == 1000


@pytest.mark.req("ACR-TRB-07", "ACR-TRB-08")
def test_the_motion_enable_input_is_latched_and_bars_the_drive(card: Console) -> None:
    card.card.bit[5646] = True
    card.card.advance(seconds=0.2)
    assert card.card.bit[5645]
    card.type("DRIVE ON X")
    card.card.advance(seconds=0.2)
    assert card.type("DRIVE X").startswith("DRIVE OFF X")
    card.card.bit[5646] = False
    card.card.advance(seconds=0.2)
    assert card.card.bit[5645]  # stays until it is cleared
    card.type("SET 5647")
    card.card.advance(seconds=0.2)
    assert not card.card.bit[5645]
    assert not card.card.bit[5647]


@pytest.mark.req("ACR-TRB-11")
def test_with_an_open_servo_loop_the_drive_is_on_but_holds_nothing(card: Console) -> None:
    card.type("SET 785")
    card.type("X1")
    card.card.advance(seconds=1)
    assert card.card.p[12288] == 1000
    assert abs(card.card.p[12290]) < 5
    assert card.type("DRIVE X") == "DRIVE ON X"


@pytest.mark.req("ACR-TRB-12")
def test_a_torque_limit_of_zero_holds_nothing_and_of_1_a_tenth(card: Console) -> None:
    card.type("TLM X0", "X1")
    card.card.advance(seconds=1)
    assert abs(card.card.p[12290]) < 5
    card.type("TLM X1")
    peak = 0.0
    for _ in range(200):
        card.card.advance(ticks=5)
        peak = max(peak, abs(card.card.p[6400]))
    assert peak == pytest.approx(1.0)  # of 10 V
    assert card.card.p[12290] == pytest.approx(1000, abs=2)
    card.type("TLM X10", "PGAIN X0", "X2")
    card.card.advance(seconds=1)
    assert card.card.p[12290] == pytest.approx(1000, abs=2)


@pytest.mark.req("ACR-TRB-10")
def test_an_excess_error_disables_the_drive_when_its_response_is_enabled(card: Console) -> None:
    card.type("EXC X0.1", "SET 8469", "CLR 8470", "TLM X0", "VEL 1", "X5")
    card.card.advance(seconds=1)
    assert not card.card.bit[769]  # Not Excess Error
    assert card.type("DRIVE X") == "DRIVE OFF X FAULT"


@pytest.mark.req("ACR-TRB-24")
@pytest.mark.parametrize("turn", ["DAC0 GAIN -3276.8", "ENC0 MULT -4"])
def test_one_wrong_sign_runs_away_until_the_excess_error_stops_it(card: Console, turn: str) -> None:
    card.type("EXC X0.5", "SET 8469", "CLR 8470", turn, "X0.01")
    card.card.advance(seconds=1)
    assert card.type("DRIVE X") == "DRIVE OFF X FAULT"
    assert not card.card.bit[769]


@pytest.mark.req("ACR-TRB-24")
def test_two_wrong_signs_are_right_again(card: Console) -> None:
    card.type("EXC X0.5", "SET 8469", "DAC0 GAIN -3276.8", "ENC0 MULT -4")
    assert moves(card, 1)
    assert card.type("DRIVE X") == "DRIVE ON X"
    assert card.card.p[12290] == 1000
