"""Gains, dead zone and filters: by command, and what they do to the output."""

import itertools

import pytest
from tests.basic.motion_bench import Bench

from openacr.basic.language.registry import Level
from openacr.map import numbers as at

P_TERM, I_TERM, D_TERM, OUTPUT = 12312, 12313, 12314, 12319
DEAD_BAND = 6405  # tertiary flag 5 of axis 0


@pytest.mark.parametrize(
    ("word", "row", "default"),
    [
        pytest.param("PGAIN", 12304, "0.002441406", marks=pytest.mark.req("ACR-CMD-PGAIN")),
        pytest.param("IGAIN", 12305, "0", marks=pytest.mark.req("ACR-CMD-IGAIN")),
        pytest.param("ILIMIT", 12306, "0", marks=pytest.mark.req("ACR-CMD-ILIMIT")),
        pytest.param("IDELAY", 12307, "0", marks=pytest.mark.req("ACR-CMD-IDELAY")),
        pytest.param("DGAIN", 12308, "0", marks=pytest.mark.req("ACR-CMD-DGAIN")),
        pytest.param("DWIDTH", 12309, "0", marks=pytest.mark.req("ACR-CMD-DWIDTH")),
        pytest.param("FFVEL", 12310, "0", marks=pytest.mark.req("ACR-CMD-FFVEL")),
        pytest.param("FFACC", 12311, "0", marks=pytest.mark.req("ACR-CMD-FFACC")),
        pytest.param("FBVEL", 12352, "0", marks=pytest.mark.req("ACR-CMD-FBVEL")),
        pytest.param("DIP", 12377, "0", marks=pytest.mark.req("ACR-CMD-DIP")),
        pytest.param("DIN", 12378, "0", marks=pytest.mark.req("ACR-CMD-DIN")),
        pytest.param("KVF", 12379, "0", marks=pytest.mark.req("ACR-CMD-KVF")),
        pytest.param("KVI", 12380, "0", marks=pytest.mark.req("ACR-CMD-KVI")),
        pytest.param("KVP", 12381, "0", marks=pytest.mark.req("ACR-CMD-KVP")),
    ],
)
def test_a_gain_is_its_parameter(word: str, row: int, default: str) -> None:
    made = Bench("X", "Y")
    assert made.type(f"{word} X Y") == f"{default}|{default}"
    assert made.type(f"{word} X 0.0001 Y 0.25") == ""
    assert made.type(f"{word} X Y") == "0.0001|0.25"
    assert made.p(row + 256) == 0.25
    made.all(f"P{row} = 3")
    assert made.type(f"AXIS0 {word}") == "3"
    assert made.type(word) == "Syntax error"
    assert made.type(f"{word} Z1") == "Undefined symbol"
    assert made.at(Level.SYS).type(f"{word} AXIS1 7 AXIS1") == "7"
    assert made.type(f"{word} X1") == "Unknown command"


@pytest.mark.parametrize(
    ("word", "row"),
    [
        pytest.param("DZU", 12403, marks=pytest.mark.req("ACR-CMD-DZU")),
        pytest.param("DZL", 12404, marks=pytest.mark.req("ACR-CMD-DZL")),
        pytest.param("FFVC", 12405, marks=pytest.mark.req("ACR-CMD-FFVC")),
    ],
)
def test_a_value_in_pulses_is_a_whole_number(word: str, row: int) -> None:
    made = Bench("X", "Y")
    assert made.type(f"{word} X Y") == "0|0"
    made.all(f"{word} X 12.7 Y 5")
    assert made.type(f"{word} X Y") == "12|5"
    assert (made.p(row), made.p(row + 256)) == (12, 5)
    assert made.type(f"{word} X 3e9") == "Invalid argument"


def test_the_default_gain_is_printed_with_seven_digits() -> None:
    assert Bench("X").type("?P12304 : PGAIN X") == "0.002441406|0.002441406"


# what they do: a motor that never turns, so that the error is what is commanded


def stalled(*lines: str) -> Bench:
    made = Bench("X")
    made.memory.I[at.PLI_BASE + at.PLI_KIND] = 1
    made.all("ACC 0 DEC 0 STP 0 VEL 100000", "TLM X100", "PGAIN X0")
    return made.all(*lines)


def step(made: Bench, pulses: int) -> Bench:
    """Command a position within one tick."""
    made.all(f"VEL 1e9 X{pulses}").ticks(2)
    return made


def test_the_proportional_term_is_the_gain_times_the_error() -> None:
    made = step(stalled("PGAIN X0.01"), 250)
    assert (made.p(12291), made.p(P_TERM), made.p(OUTPUT)) == (250, 2.5, 2.5)


@pytest.mark.req("ACR-CMD-IGAIN", "ACR-CMD-ILIMIT")
def test_the_integral_grows_with_time_up_to_its_limit() -> None:
    made = step(stalled("IGAIN X0.1"), 100).seconds(0.1)
    assert made.p(I_TERM) == 0.0
    made.all("ILIMIT X2").seconds(0.1)
    assert made.p(I_TERM) == pytest.approx(1.0)
    made.seconds(0.5)
    assert made.p(I_TERM) == 2.0


@pytest.mark.req("ACR-CMD-IDELAY")
def test_the_integral_waits_after_motion() -> None:
    made = step(stalled("IGAIN X0.1 : ILIMIT X10 : IDELAY X0.1"), 100).seconds(0.098)
    assert made.p(I_TERM) == 0.0
    made.seconds(0.05)
    assert made.p(I_TERM) == pytest.approx(10 * 0.0485, abs=0.02)


@pytest.mark.req("ACR-CMD-DGAIN", "ACR-CMD-DWIDTH")
def test_the_derivative_is_the_slope_over_its_width() -> None:
    made = stalled("DGAIN X0.001", "VEL 2000", "X1000").ticks(20)
    assert made.p(D_TERM) == pytest.approx(0.001 * 2000)


@pytest.mark.req("ACR-CMD-DWIDTH")
@pytest.mark.parametrize(("width", "period"), [("0", 1), ("0.0012", 2), ("0.005", 10)])
def test_the_slope_is_sampled_once_a_width_or_every_period(width: str, period: int) -> None:
    made = stalled("DGAIN X0.001", f"DWIDTH X{width}", "ACC 1000 VEL 2000", "X1000").ticks(40)
    terms = []
    for _ in range(60):
        terms.append(made.p(D_TERM))
        made.ticks(1)
    steps = [n for n, (old, new) in enumerate(itertools.pairwise(terms)) if old != new]
    assert {later - first for first, later in itertools.pairwise(steps)} == {period}
    grown = 0.001 * 1000 * period * 0.0005  # DGAIN times the gain of speed in a sample
    for first in steps:
        assert terms[first + 1] - terms[first] == pytest.approx(grown, rel=1e-5)


def test_dgain_puts_the_smoothing_into_effect() -> None:
    made = stalled("DGAIN X0.001", "P12402 = 2")
    step(made, 10)
    assert made.p(D_TERM) == 0.0  # the slope of the step has passed
    made.all("DGAIN X0.001")
    made.all("VEL 1e9 X0").ticks(3)
    assert made.p(D_TERM) == pytest.approx(0.001 * -10 / 0.0005 / 4)


@pytest.mark.req("ACR-CMD-FFVEL", "ACR-CMD-FFACC", "ACR-CMD-FFVC")
def test_feedforward_follows_the_command() -> None:
    made = stalled("FFVEL X0.001 : FFACC X0.00001", "ACC 1000 VEL 100", "X1000").ticks(50)
    assert made.p(12355) == pytest.approx(0.01, rel=1e-3)
    speed = made.axis(0, at.AX_VELOCITY)
    assert made.p(12354) == pytest.approx(0.001 * speed)


@pytest.mark.req("ACR-CMD-FFVC")
@pytest.mark.parametrize("velocity", [100, -100])
def test_the_feedforward_is_cut_off_below_its_velocity_and_not_at_it(velocity: int) -> None:
    made = stalled("FFVEL X0.001 : VEL 100", f"X{10 * velocity}").ticks(250)
    for cutoff, term in ((99, 0.001 * velocity), (100, 0.001 * velocity), (101, 0.0)):
        made.all(f"FFVC X{cutoff}")
        shown = [made.ticks(1).p(12354) for _ in range(200)]
        assert shown == [pytest.approx(term)] * 200


@pytest.mark.req("ACR-CMD-DZU", "ACR-CMD-DZL", "ACR-CMD-DIP", "ACR-CMD-DIN")
def test_the_dead_zone_silences_small_errors_at_rest() -> None:
    made = stalled("PGAIN X0.01 : ILIMIT X5 : DZU X20 : DZL X5 : DIP X1.5 : DIN X-2").ticks(2)
    assert made.bit(DEAD_BAND)
    step(made, 15)
    assert (made.bit(DEAD_BAND), made.p(P_TERM)) == (True, 0.0)
    step(made, 25)
    assert (made.bit(DEAD_BAND), made.p(P_TERM), made.p(I_TERM)) == (False, 0.25, 1.5)
    step(made, 2).ticks(2)
    assert made.bit(DEAD_BAND)
    step(made, -25)
    assert (made.bit(DEAD_BAND), made.p(I_TERM)) == (False, -2.0)


@pytest.mark.req("ACR-CMD-KVP", "ACR-CMD-KVF", "ACR-CMD-KVI")
def test_kvp_replaces_the_pid_sum_by_a_velocity_loop() -> None:
    made = step(stalled("PGAIN X0.01 : KVP X3"), 100)
    assert made.p(OUTPUT) == pytest.approx(3.0)
    made.all("KVI X2").seconds(0.1)
    assert made.p(OUTPUT) == pytest.approx(3.0 + 2 * 0.1)
    fed = stalled("KVF X0.001 : KVP X2", "VEL 1000", "X10000").ticks(10)
    assert fed.p(OUTPUT) == pytest.approx(2 * 0.001 * 1000)


# filters


@pytest.mark.req("ACR-CMD-LOPASS")
def test_lopass_is_accepted_at_half_the_servo_rate_and_reported_as_given() -> None:
    made = Bench("X", "Y")
    assert made.type("LOPASS X1000 X Y") == "1000|0"
    assert (made.bit(786), made.bit(818)) == (True, False)
    assert made.p(12340) > 0
    assert made.type("LOPASS X-1") == "Invalid argument"
    made.all("LOPASS X0")
    assert not made.bit(786)


@pytest.mark.req("ACR-CMD-NOTCH")
def test_notch_takes_centre_and_width() -> None:
    made = Bench("X", "Y")
    assert made.type("NOTCH X(500,50)") == ""
    assert made.type("NOTCH X Y") == "500,50|0,0"
    assert made.bit(786)
    assert made.type("AXIS0 NOTCH 0 : NOTCH X") == "0,0"
    assert not made.bit(786)
    for wrong in ("X(-1,5)", "X(5,-1)", "X100"):
        assert made.type(f"NOTCH {wrong}") == "Invalid argument"
    assert made.type("NOTCH X(1,2,3)") == "Syntax error"


@pytest.mark.req("ACR-CMD-LOPASS")
def test_a_low_pass_smooths_the_output() -> None:
    plain, smooth = step(stalled("PGAIN X0.01"), 100), stalled("PGAIN X0.01 : LOPASS X20")
    step(smooth, 100)
    assert plain.p(OUTPUT) == 1.0
    assert 0.0 < smooth.p(OUTPUT) < 0.05
    smooth.seconds(0.2)
    assert smooth.p(OUTPUT) == pytest.approx(1.0, abs=1e-3)
    assert smooth.p(12317) == 1.0


def test_a_new_servo_period_keeps_the_frequency_of_a_filter() -> None:
    made = Bench("X").all("LOPASS X100")
    at_half_ms = made.p(12340)
    made.all("PERIOD 0.001")
    assert made.type("LOPASS X") == "100"
    assert made.p(12340) > 2 * at_half_ms


# the loop as a whole


@pytest.mark.req("ACR-SERVO-05")
def test_the_following_error_is_setpoint_minus_actual_position() -> None:
    made = step(stalled(), 123)
    assert (made.p(12295), made.p(12290), made.p(12291)) == (123, 0, 123)
