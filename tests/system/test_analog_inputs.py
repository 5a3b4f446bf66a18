"""Analog inputs of the card: what is wired to them, which of it they measure, how finely."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.kernel.rig import Rig

from openacr.controller import Controller
from openacr.errors import SourceError, UserError
from openacr.map import numbers as at
from openacr.map.rows import adcs, analogs, kernel, motors, plant
from openacr.plant.describe.load import parse_world

FIXED = "[[analog]]\ninput = 0\nvolts = 4.0\n[[analog]]\ninput = 1\nvolts = 1.5\n"
AXIS = """
[[axis]]
number = 0
counts_per_rev = 4000
units_per_rev = 2.0
initial = 3.0
drive = { mode = "ideal", revs_per_s_per_volt = 5.0, lag_s = 0.001 }
"""
SENSOR = "[[analog]]\ninput = 2\naxis = 0\nvolts_per_unit = -0.5\nvolts = 1.0\n"
ADC = [adcs.adc_input[n] for n in range(16)]
STEP_V = 10 / 32767


def card(world: str, *lines: str, model: str = "ACR9000") -> Controller:
    made = Controller(model, world=parse_world(f"[card]\nmodel = '{model}'\n{world}"))
    made.send("SYS\r")
    for line in lines:
        assert made.send(f"{line}\r").count("\r\n") == 1, line
    made.advance(2)
    return made


def reported(made: Controller, line: str) -> str:
    return made.send(f"{line}\r").split("\r\n")[1]


def test_each_input_measures_its_own_channel_against_ground() -> None:
    made = card(FIXED)
    assert [made.p[row] for row in ADC[:3]] == pytest.approx([4.0, 1.5, 0.0], abs=STEP_V)
    assert [reported(made, f"ADC {side} 5") for side in ("POS", "NEG")] == ["5", "-1"]
    assert (made.p[at.P_ADC_POSITIVE_CHANNELS], made.p[at.P_ADC_NEGATIVE_CHANNELS]) == (
        0x76543210,
        -1,
    )


def test_an_input_measures_the_difference_of_the_channels_it_is_given() -> None:
    made = card(FIXED, "ADC POS 6 0", "ADC NEG 6 1", "ADC POS 7 1", "ADC NEG 7 0")
    assert [made.p[ADC[6]], made.p[ADC[7]]] == pytest.approx([2.5, -2.5], abs=STEP_V)
    assert [reported(made, f"ADC {side} 7") for side in ("POS", "NEG")] == ["1", "0"]
    made.send("ADC NEG 6 -1\r")
    made.advance(1)
    assert made.p[ADC[6]] == pytest.approx(4.0, abs=STEP_V)
    assert made.p[at.P_ADC_POSITIVE_CHANNELS] == 0x10543210


@pytest.mark.parametrize(
    "line", ["ADC POS 8 0", "ADC POS 0 8", "ADC POS 0 -1", "ADC NEG 0 8", "ADC NEG -1 0"]
)
def test_channels_that_do_not_exist_are_refused(line: str) -> None:
    assert reported(card(FIXED), line) == "Invalid argument"


def test_gain_offset_and_full_scale() -> None:
    made = card(FIXED.replace("4.0", "12.0"), "ADC0 GAIN 20", "ADC1 GAIN -10", "ADC1 OFFSET 0.25")
    assert made.p[ADC[0]] == 20.0  # beyond 10 V there is nothing more to see
    assert made.p[ADC[1]] == pytest.approx(-1.25, abs=STEP_V)


def test_off_holds_and_max_leaves_inputs_out() -> None:
    made = card(FIXED)
    made.send("ADC OFF\r")
    made.set_analog(6408, 7.0)
    made.advance(5)
    assert made.p[ADC[0]] == pytest.approx(4.0, abs=STEP_V)
    made.send("ADC MAX 1\rADC ON\r")
    made.set_analog(6424, 9.0)
    made.advance(5)
    assert [made.p[row] for row in ADC[:2]] == pytest.approx([7.0, 1.5], abs=STEP_V)


def test_a_loop_through_a_wire_from_an_output() -> None:
    made = card("[[analog]]\ninput = 4\ndac = 3\nvolts = 0.5\n", "AXIS3 OFF", "P6448=2.25")
    made.advance(2)
    assert made.p[ADC[4]] == pytest.approx(2.75, abs=STEP_V)


def test_an_axis_closes_its_loop_on_a_position_sensor() -> None:
    lines = ("ATTACH AXIS0 ADC2 DAC0 ADC2", "DAC0 GAIN -3276.8", "PROG0", "ATTACH MASTER0")
    slave = ('ATTACH SLAVE0 AXIS0 "X"', "PPU X1000", "PGAIN X0.001")
    made = card(AXIS + SENSOR, *lines, *slave)
    assert made.p[ADC[2]] == pytest.approx(1.0 - 0.5 * 3.0, abs=0.01)
    made.send("RES X0\rACC 1 DEC 1 STP 1 VEL 1\rX1\r")
    made.advance(6000)
    assert made.p[ADC[2]] == pytest.approx(0.5, abs=0.003)
    shaft = made.memory.F[motors.position_cnt[0]]
    assert shaft == pytest.approx(-2 * 2000, abs=20)  # 1 V is 2 units the other way


def test_values_written_to_inputs_stay_where_nothing_is_wired() -> None:
    made = card("", "P6408=3.5")
    made.advance(3)
    assert made.p[ADC[0]] == 3.5
    made.set_analog(6408, 1.0)
    made.advance(1)
    assert made.p[ADC[0]] == pytest.approx(1.0, abs=STEP_V)
    for wrong in (6407, 6409, 6536, 6400):
        with pytest.raises(UserError):
            made.set_analog(wrong, 1.0)


@given(
    st.lists(st.floats(-30, 30), min_size=8, max_size=8),
    st.integers(-(2**31), 2**31 - 1),
    st.integers(-(2**31), 2**31 - 1),
    st.integers(0, 1),
)
def test_both_builds_measure_the_same_whatever_the_words_say(
    volts: list[float], plus: int, minus: int, mode: int
) -> None:
    states = []
    for pure in (False, True):
        rig = Rig(1, pure=pure)
        for channel, value in enumerate(volts):
            rig.F[analogs.volts[channel]] = value
        rig.I[plant.analogs] = 8
        rig.I[kernel.adc_mode] = mode
        rig.I[at.P_ADC_POSITIVE_CHANNELS], rig.I[at.P_ADC_NEGATIVE_CHANNELS] = plus, minus
        rig.ticks(1)
        states.append(rig.memory.snapshot())
        open_or_ground = [0.0] * 8
        known = [*volts, *open_or_ground]
        for n in range(8):
            difference = known[plus >> 4 * n & 15] - known[minus >> 4 * n & 15]
            wanted = max(-10.0, min(10.0, difference))
            assert rig.S[ADC[n]] == pytest.approx(wanted, abs=6e-3 if mode == 0 else 4e-4)
    assert states[0] == states[1]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (FIXED + "[[analog]]\ninput = 1\n", "two voltages at analog input 1 (the other is analog"),
        ("[[analog]]\ninput = 8\n", "analog[0].input is 8; it must be a whole number from 0 to 7"),
        ("[[analog]]\ninput = 1\naxis = 2\nvolts_per_unit = 1\n", "there is no axis 2"),
        (AXIS + "[[analog]]\ninput = 1\naxis = 0\n", "axis 0 brings no voltage"),
        ("[[analog]]\ninput = 1\nvolts_per_unit = 1\n", "has a meaning only with axis"),
    ],
)
def test_contradictions_are_refused_by_name(text: str, said: str) -> None:
    with pytest.raises(SourceError) as caught:
        parse_world(text)
    assert said in str(caught.value)
