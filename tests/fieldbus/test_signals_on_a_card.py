"""Signals of a bus beside positions: markers and probes of drives, torque limits, voltages."""

import pytest
from tests.fieldbus.bus_rig import OnBus

from openacr.errors import SourceError
from openacr.fieldbus.ethercat.emulated.terminals import FULL_SCALE, Analog
from openacr.map import numbers as at
from openacr.map.rows import adcs, analogs, axes
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

RAMP = ("ACC 400000 DEC 400000 STP 400000 VEL 40000",)


def machine(bus: str = "", more: str = "", axes_: int = 1) -> str:
    text = '[bus]\ninterface = "none"\ncycle = 2\n' + more
    for n in range(axes_):
        text += (
            f'[[axis]]\nnumber = {n}\nname = "{"XY"[n]}"\ncounts_per_rev = 4000\nmarker = 0.25\n'
            f'drive = {{ mode = "exact" }}\n[axis.bus]\nposition = {n}\nmode = "csp"\n{bus}\n'
        )
    return text


def capture(made: OnBus, mode: int, target: int, axis: str = "X") -> int:
    """Arm a capture, move there; the captured position."""
    made.send(f"INTCAP {axis}{mode}", f"{axis}{target}")
    made.card.advance(3000)
    n = "XY".index(axis)
    assert made.card.memory.I[axes.capture_mode[n]] == -1
    return made.card.memory.I[axes.hardware_capture[n]]


# --- markers ----------------------------------------------------------------------------------


def test_a_marker_is_captured_to_the_count_by_probe_2_of_the_drive() -> None:
    made = OnBus(machine("marker = true"))
    made.switch_on()
    made.send(*RAMP)
    assert capture(made, 0, 3000) == 1000
    assert capture(made, 0, 6000) == 5000


def test_a_marker_is_not_captured_without_its_key() -> None:
    made = OnBus(machine())
    made.switch_on()
    made.send(*RAMP, "INTCAP X0", "X3000")
    made.card.advance(3000)
    assert made.card.memory.I[axes.capture_mode[0]] == 0


def test_the_falling_edge_of_a_marker_is_asked_of_the_drive() -> None:
    made = OnBus(machine("marker = true"))
    made.switch_on()
    made.send(*RAMP)
    assert capture(made, 4, 3000) == 1000


def test_the_second_marker_is_that_of_the_drive_of_the_other_axis_of_the_pair() -> None:
    made = OnBus(machine("marker = true", axes_=2))
    made.switch_on(0)
    made.switch_on(1)
    made.send(*RAMP, "INTCAP X1", "Y3000")
    made.card.advance(3000)
    assert made.card.memory.I[axes.capture_mode[0]] == -1
    assert made.card.memory.I[axes.hardware_capture[0]] == 0


def test_probe_and_marker_of_a_drive_are_captured_beside_each_other() -> None:
    made = OnBus(machine("marker = true\nprobe = true"))
    made.switch_on()
    made.send(*RAMP, "INTCAP X2", "X8000")
    made.card.advance(300)
    made.drive().probe.touch(True)
    made.card.advance(2000)
    assert made.card.memory.I[axes.capture_mode[0]] == -1
    touched = made.card.memory.I[axes.hardware_capture[0]]
    assert touched == made.drive().objects.probed[0].number
    assert capture(made, 0, 3000) == 5000


def test_a_capture_that_is_armed_again_at_once_is_served_again() -> None:
    made = OnBus(machine("marker = true"))
    made.switch_on()
    made.send(*RAMP, "X12000")
    seen = []
    for _ in range(3000):
        if made.card.memory.I[axes.capture_mode[0]] == -1:
            seen.append(made.card.memory.I[axes.hardware_capture[0]])
            made.card.memory.I[axes.capture_mode[0]] = 0  # before the drive hears that it was off
        made.card.advance(1)
    assert seen[1:] == [1000, 5000, 9000]


# --- torque -----------------------------------------------------------------------------------


def test_the_torque_limit_of_the_card_is_that_of_the_drive() -> None:
    made = OnBus(machine("torque_limit = 300.0"))
    made.switch_on()
    assert made.drive().objects.max_torque.number == 3000
    made.send("TLM X(4,-2)")
    made.card.advance(4)
    assert made.drive().objects.max_torque.number == 600
    made.send("TLM X(1,-8)")
    made.card.advance(4)
    assert made.drive().objects.max_torque.number == 300


def test_without_a_torque_limit_the_drive_keeps_its_own() -> None:
    made = OnBus(machine())
    own = made.drive().objects.max_torque.number
    made.send("TLM X1")
    made.switch_on()
    made.card.advance(4)
    assert made.drive().objects.max_torque.number == own


def test_a_torque_limit_beyond_16_bits_is_the_highest() -> None:
    made = OnBus(machine("torque_limit = 65535.0"))
    made.switch_on()
    assert made.drive().objects.max_torque.number == 65535


@pytest.mark.parametrize(
    ("mode", "most"), [("cst", 3276.7), ("cst", -3276.7), ("csv", 214748364.7)]
)
def test_a_voltage_may_ask_for_the_largest_target_and_no_more(mode: str, most: float) -> None:
    text = machine().replace('mode = "csp"', f'mode = "{mode}"\nper_volt = PER')
    parse_world(text.replace("PER", f"{most:.2f}"))
    with pytest.raises(SourceError, match=r"10 V ask for .* per_volt at most"):
        parse_world(text.replace("PER", f"{most * 1.0001:.2f}"))


def test_a_drive_that_gives_less_torque_than_10_v_ask_for_is_named(
    caplog: pytest.LogCaptureFixture,
) -> None:
    text = "motor = { inertia_kgm2 = 2.0e-5, torque_nm_per_a = 0.1 }\n[axis.bus]"
    drive = 'drive = { mode = "torque", amps_per_volt = 2.0, peak_amps = 18.0 }'
    made = machine().replace('mode = "csp"', 'mode = "cst"\nper_volt = {}')
    made = made.replace('drive = { mode = "exact" }', drive).replace("[axis.bus]", text)
    OnBus(made.replace("{}", "300.0"))
    assert caplog.text == ""
    OnBus(made.replace("{}", "301.0"))
    assert "the drive of axis X: 10 V ask for a torque of 3010, the drive gives" in caplog.text


# --- voltages ---------------------------------------------------------------------------------

ANALOG = (
    "[[bus.terminal]]\nposition = 1\nadcs_from = 2\nadcs = 3\ndacs_from = 8\ndacs = 2\n"
    "full_v = {full}\n"
)


def dac_output(n: int) -> int:
    return at.DAC_BASE + n * at.DAC_STRIDE + at.DAC_DAC_OUTPUT


def on_analog(full: float = 10.0) -> tuple[OnBus, Analog]:
    made = OnBus(machine(more=ANALOG.format(full=full)), analog=1)
    terminal = made.segment.slaves[1]
    assert isinstance(terminal, Analog)
    return made, terminal


def test_voltages_of_a_terminal_are_at_the_analog_inputs_of_the_card() -> None:
    made, terminal = on_analog()
    terminal.set_input(0, 2.5)
    terminal.set_input(2, -7.5)
    made.card.advance(4)
    volts = [made.card.memory.F[analogs.volts[n]] for n in range(8)]
    assert volts == pytest.approx([0, 0, 2.5, 0, -7.5, 0, 0, 0], abs=10 / FULL_SCALE)
    shown = made.card.memory.S[adcs.adc_input[2]]
    assert shown == pytest.approx(2.5, abs=0.01)


def test_analog_outputs_of_the_card_are_at_a_terminal() -> None:
    made, terminal = on_analog()
    made.card.memory.S[dac_output(8)] = -4.0
    made.card.memory.S[dac_output(9)] = 3.0
    made.card.advance(4)
    assert terminal.outputs == pytest.approx([-4, 3, 0, 0], abs=20 / FULL_SCALE)


def test_the_full_scale_of_a_terminal_is_that_of_the_file_both_ways() -> None:
    made, terminal = on_analog(full=5.0)
    terminal.set_input(1, 10.0)  # all its counts
    made.card.memory.S[dac_output(8)] = 2.5
    made.card.memory.S[dac_output(9)] = -9.0  # more than the terminal has
    made.card.advance(4)
    assert made.card.memory.F[analogs.volts[3]] == pytest.approx(5.0, abs=1e-3)
    assert terminal.outputs == pytest.approx([5, -10.0003, 0, 0], abs=20 / FULL_SCALE)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ("adcs_from = 6\nadcs = 3", "leads to 8, which is not an analog input"),
        ("dacs_from = 15\ndacs = 2", "leads to 16, which is not an analog output"),
        ("adcs = 3", "has only one of adcs and adcs_from"),
        (
            "adcs_from = 0\nadcs = 2\n[[bus.terminal]]\nposition = 2\nadcs_from = 1\nadcs = 1",
            "two signals on ADC1",
        ),
    ],
)
def test_analog_channels_that_the_card_has_not_are_refused(more: str, text: str) -> None:
    with pytest.raises(SourceError, match=text):
        parse_world(machine(more=f"[[bus.terminal]]\nposition = 1\n{more}\n"))


def test_a_voltage_of_the_bus_replaces_the_modelled_one() -> None:
    more = ANALOG.format(full=10.0) + "[[analog]]\ninput = 2\nvolts = 1.0\n"
    more += "[[analog]]\ninput = 6\nvolts = 1.5\n"
    assert [one.input for one in real_world(parse_world(machine(more=more))).analog] == [6]
