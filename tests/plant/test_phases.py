"""Brushless motors: the two phase voltages of a commutator against the one of a plain motor."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.plant.conftest import Rig

from openacr.errors import SourceError
from openacr.map.rows import dacs, motors
from openacr.plant.describe.load import parse_world

COUNTS = 4000
AXIS = '[[axis]]\nnumber = 0\nname = "X"\ncounts_per_rev = 4000\n'
LOAD = "load = { viscous_nms = 4e-4, coulomb_nm = 0.01 }\n"
PLAIN = 'drive = { mode = "torque", amps_per_volt = 1.5, peak_amps = 6.0, supply_v = 80.0 }\n'
PHASES = PLAIN.replace('"torque"', '"phases", dacs = [2, 5]')
PER_VOLT = 1.5 * 0.5 / 2e-5 * COUNTS / (2 * math.pi)  # counts/s^2


def motor(more: str = "") -> str:
    return f"motor = {{ inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5, resistance_ohm = 4.0{more} }}\n"


def brushless(
    poles: int = 2, phases: int = 3, zero_deg: float = 0.0, keys: str = "", load: str = LOAD
) -> Rig:
    rotor = f", pole_pairs = {poles}, phases = {phases}, electrical_zero_deg = {zero_deg}"
    return Rig(AXIS + PHASES + motor(rotor) + load + keys)


def put(rig: Rig, first_v: float, second_v: float) -> None:
    """Put voltages on both phases and let one tick pass."""
    for dac, volts in ((2, first_v), (5, second_v)):
        rig.memory.S[dacs.dac_output[dac]] = volts
    rig.turn()


def angle_deg(rig: Rig, poles: int, zero_deg: float, sign: int = 1, initial: float = 0.0) -> float:
    """Electrical angle of the rotor, from where the shaft stands."""
    turns = initial + sign * (rig.position - 0.5) / COUNTS
    return zero_deg + 360 * poles * turns


def commutate(rig: Rig, volts: float, angle: float, phases: int) -> None:
    """What a right commutator puts out, to the step of the converters."""
    between = 120 if phases == 3 else 90
    put(
        rig,
        volts * math.sin(math.radians(angle)),
        volts * math.sin(math.radians(angle + between)),
    )


@given(
    poles=st.integers(1, 12),
    phases=st.sampled_from([2, 3]),
    zero_deg=st.floats(-360, 360),
    initial=st.floats(-5, 5),
    direction=st.sampled_from(["up", "down"]),
    volts=st.lists(st.floats(-10, 10), min_size=1, max_size=6),
)
def test_a_right_commutator_makes_it_a_plain_motor(
    poles: int, phases: int, zero_deg: float, initial: float, direction: str, volts: list[float]
) -> None:
    keys = f'initial = {initial}\nencoder_direction = "{direction}"\n'
    plain = Rig(AXIS + keys + PLAIN + motor() + LOAD)
    rig = brushless(poles, phases, zero_deg, keys)
    sign = 1 if direction == "up" else -1
    for value in volts:
        for _ in range(10):
            commutate(rig, value, angle_deg(rig, poles, zero_deg, sign, initial), phases)
            plain.turn(value)
    # the rounding of both converters, 0.3 mV, over 10 ticks each
    slack = 4e-4 * PER_VOLT * 0.005 * len(volts)
    assert rig.velocity == pytest.approx(plain.velocity, abs=slack)


@pytest.mark.parametrize("phases", [2, 3])
@pytest.mark.parametrize("off_deg", [-150, -90, -30, 0, 45, 60, 90, 180])
def test_a_field_that_is_off_loses_the_cosine_of_the_torque(off_deg: float, phases: int) -> None:
    rig = brushless(3, phases, 77.0, load="")
    commutate(rig, 2.0, angle_deg(rig, 3, 77.0) + off_deg, phases)
    expected = 2.0 * math.cos(math.radians(off_deg)) * PER_VOLT * rig.period_s
    assert rig.velocity == pytest.approx(expected, abs=4e-4 * PER_VOLT * rig.period_s)


@pytest.mark.parametrize("angle", range(0, 360, 25))
def test_swapped_phases_push_with_the_angle_that_the_field_lags(angle: int) -> None:
    rig = brushless(1, 3, angle, load="")
    put(rig, 3 * math.sin(math.radians(angle + 120)), 3 * math.sin(math.radians(angle)))
    expected = -3 * math.cos(math.radians(2 * angle + 120)) * PER_VOLT * rig.period_s
    assert rig.velocity == pytest.approx(expected, abs=1e-3 * PER_VOLT * rig.period_s)


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(0, 360))
def test_three_phases_are_two_and_what_they_leave_for_the_third(
    first_v: float, second_v: float, angle: float
) -> None:
    rig = brushless(1, 3, angle, load="")
    put(rig, first_v, second_v)
    volts = (first_v, second_v, -first_v - second_v)
    shapes = [math.sin(math.radians(angle + 120 * phase)) for phase in range(3)]
    wanted = 2 / 3 * sum(v * shape for v, shape in zip(volts, shapes, strict=True))
    amplitude = math.sqrt(2 / 3 * sum(v * v for v in volts))
    limited = wanted * min(1.0, 4.0 / max(amplitude, 1e-9))  # 6 A at 1.5 A/V
    assert rig.get(motors.volts) == pytest.approx(limited, abs=1e-3)


def test_the_rotor_settles_where_a_standing_field_holds_it() -> None:
    rig = brushless(2, 2, 20.0, load="load = { viscous_nms = 2e-3 }\n")
    for _ in range(3000):
        put(rig, 0.5, 0.0)  # 0.5 sin(theta): no torque at 180 degrees, stable there
    assert angle_deg(rig, 2, 20.0) == pytest.approx(180.0, abs=0.2)
    assert abs(rig.velocity) < 1.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (PHASES + motor(), "axis X: the motor has no pole_pairs"),
        (PHASES, "axis X: the motor is missing"),
        (PLAIN + motor(", pole_pairs = 2"), "a drive that commutates has no use for pole_pairs"),
        (PHASES + motor(", pole_pairs = 2") + "dac = 1\n", "outputs of their own"),
        (
            PHASES.replace("[2, 5]", "[2, 2]") + motor(", pole_pairs = 2"),
            "both phases are on analog output 2",
        ),
        (PHASES + motor(", pole_pairs = 2, phases = 4"), "phases is 4; it must be a whole number"),
        (PHASES.replace(", dacs = [2, 5]", ""), "lacks the key 'dacs'"),
    ],
)
def test_contradictions_are_refused_by_name(text: str, said: str) -> None:
    with pytest.raises(SourceError) as caught:
        parse_world(AXIS + text)
    assert said in str(caught.value)
