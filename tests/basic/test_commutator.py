"""CMT: commutators share the output of an axis out to two phases."""

import math
from collections.abc import Callable

import pytest
from tests.basic.motion_bench import Bench

from openacr.compiled import pick
from openacr.kernel.axis import commutator_cy
from openacr.map.rows import axes, commutators, dacs, encoders
from openacr.map.words import cmf, ef

_step = pick(commutator_cy.commutator_step)
SHAPES = [commutator_cy.phase_shape, pick(commutator_cy.phase_shape)]
U = 4.0  # V, put out by the open loop through the torque limit


@pytest.fixture
def bench() -> Bench:
    """Axis X on commutator 0 with encoder 2 and analog outputs 4 and 5, pushing against nothing."""
    bench = Bench("X")
    bench.all("ATTACH AXIS0 ENC2 CMT0", "CMT0 ENC2 ENC3", "CMT0 DAC4 DAC5", "CMT0 PPR 1000")
    return bench


def push(bench: Bench, position: int, volts: float = U) -> tuple[float, float]:
    """Phase voltages where encoder 2 has counted to `position` and the loop gives `volts`."""
    memory = bench.memory
    memory.I[encoders.parameters[2]] = position
    _step(memory.I, memory.S, 0, 0, volts)
    return memory.S[dacs.parameters[4]], memory.S[dacs.parameters[5]]


def test_sinusoidal_phases_follow_the_electrical_angle(bench: Bench) -> None:
    bench.all("CMT0 MODE 1", "CMT0 ERPMR 2", "CMT0 ON")
    for position in (0, 125, 250, 777, -400, 12345):
        angle = 2 * math.pi * 2 * position / 1000
        expected = (U * math.sin(angle), U * math.sin(angle + 2 * math.pi / 3))
        assert push(bench, position) == pytest.approx(expected, abs=1e-5)


def test_shift_multiplier_and_angle_take_part(bench: Bench) -> None:
    bench.all("CMT0 MODE 1", "ENC2 MULT 4", "CMT0 SHIFT 1000", "CMT0 ANG 90", "CMT0 ON")
    assert push(bench, 0) == pytest.approx((U, 0.0), abs=1e-5)  # a quarter of 4000 counts
    bench.all("CMT0 OFFSET (0.5,-0.25)")
    assert push(bench, 0) == pytest.approx((U + 0.5, -0.25), abs=1e-5)


def test_presets_and_wraps_of_the_encoder_do_not_turn_the_magnets(bench: Bench) -> None:
    bench.all("CMT0 MODE 1", "CMT0 ON")
    expected = push(bench, 130)
    bench.all("ENC2 ROTARY 100")
    assert bench.p(6176) == 30
    assert push(bench, 30) == expected
    bench.all("ENC2 RES 75")
    assert push(bench, 75) == expected
    assert push(bench, 95) == pytest.approx(
        (U * math.sin(0.3 * math.pi), U * math.sin(0.3 * math.pi + 2 * math.pi / 3)), abs=1e-5
    )


def test_trapezoidal_phases_are_six_steps(bench: Bench) -> None:
    bench.all("CMT0 ON")
    phases = [push(bench, round(1000 * (sector + 0.5) / 6)) for sector in range(6)]
    assert phases == [(U, 0), (U, -U), (0, -U), (-U, 0), (-U, U), (0, U)]


@pytest.mark.parametrize("shape", SHAPES)
def test_steps_and_sines_are_periodic(shape: Callable[[float, int], float]) -> None:
    angles = (-360.0, 0.0, 59.9, 120.0, 180.0, 299.0, 300.0)
    assert [shape(angle, 0) for angle in angles] == [1, 1, 1, 0, -1, -1, 0]
    assert shape(-30.0, 1) == pytest.approx(-0.5)


def test_a_commutator_that_is_off_puts_nothing_out(bench: Bench) -> None:
    assert push(bench, 250) == (0, 0)
    bench.all("CMT0 ON")
    assert push(bench, 100)[0] == U
    assert bench.type("CMT0") == "ON"
    bench.all("CMT0 OFF")
    assert push(bench, 100) == (0, 0)
    assert bench.type("CMT0") == "OFF"


def test_too_much_speed_error_and_encoder_faults_turn_it_off(bench: Bench) -> None:
    memory = bench.memory
    speed = encoders.encoder_velocity[2]
    bench.all("CMT0 MAXRPM 3000", "P16398=50", "CMT0 ON")
    memory.I[speed] = 49_000  # 2940 rev/min
    assert push(bench, 0)[0] == U
    memory.I[speed] = 51_000
    assert push(bench, 0) == (0, 0)
    assert memory.I[cmf.word[0]] == cmf.CMT_MOTOR_OVERSPEED
    memory.I[speed] = 0
    bench.all("CMT0 ON")
    assert memory.I[cmf.word[0]] == cmf.CMT_COMMUTATOR_ON
    memory.I[axes.following_error[0]] = -51
    assert push(bench, 0) == (0, 0)
    assert memory.I[cmf.word[0]] == cmf.CMT_FOLLOWING_ERROR
    memory.I[axes.following_error[0]] = 0
    memory.I[ef.word[2]] = ef.ENCODER_SIGNAL_LOST
    bench.all("CMT0 ON", "SET 3588")  # not checked
    assert push(bench, 0)[0] == U
    bench.all("CLR 3588")
    assert push(bench, 0) == (0, 0)


def test_the_current_limit_bounds_the_phases(bench: Bench) -> None:
    bench.all("P16406=2", "CMT0 MAXAMP 3", "CMT0 ON")  # 2 A per volt
    assert push(bench, 0)[0] == 1.5
    assert push(bench, 0, -U)[0] == -1.5
    assert bench.type("?P16418") == "-3"


def test_the_servo_loop_of_an_axis_drives_its_commutator(bench: Bench) -> None:
    bench.all("AXIS4 OFF", "AXIS5 OFF", "CMT0 ON", "CMT0 ANG 0", "X1000")
    bench.ticks(3)
    volts = bench.memory.S[axes.output_signal[0]]
    assert bench.memory.S[commutators.commandsignal[0]] == volts
    assert bench.memory.S[dacs.parameters[4]] == pytest.approx(volts)


@pytest.mark.parametrize(
    ("line", "value"),
    [("PPR", "512"), ("ERPMR", "4"), ("ANG", "90"), ("SHIFT", "-7"), ("MAXRPM", "3000.5"),
     ("MAXAMP", "2.5"), ("HSEN", "1"), ("MODE", "1"), ("OFFSET", "0.5,-1")],
)  # fmt: skip
def test_settings_are_reported_and_refused_where_there_is_no_such_commutator(
    bench: Bench, line: str, value: str
) -> None:
    written = f"({value})" if "," in value else value
    assert bench.type(f"CMT3 {line} {written}") == ""
    assert bench.type(f"CMT3 {line}") == value
    assert bench.type(f"CMT8 {line}") == "Invalid argument"


def test_channels_may_repeat_their_word_and_must_exist(bench: Bench) -> None:
    assert bench.type("CMT1 ENC4 ENC5") == ""
    assert bench.type("CMT1 ENC") == "4,5"
    assert bench.type("CMT1 DAC 6 7 CMT1 ADC 2") == ""
    assert (bench.type("CMT1 DAC"), bench.type("CMT1 ADC")) == ("6,7", "2,0")
    assert bench.type("CMT1 DAC 6 99") == "Invalid argument"
    assert bench.type("CMT1 DAC") == "6,7"
    assert bench.type("CMT1 MODE 2") == "Invalid argument"
