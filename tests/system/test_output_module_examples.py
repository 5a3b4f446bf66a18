"""The guide's output module examples, line by line: every axis they set up moves its own output."""

import pytest

from openacr import Controller
from openacr.plant.describe.load import parse_world

STEPPERS = range(6156, 6271, 16)  # P6156 + 16 n: the pulses of stepper output n


BRUSHLESS_AND_STEPPERS = """
CONFIG ENC4 DAC4 STEPPER4 NONE
ATTACH AXIS0 ENC0 CMT0 ENC0
ATTACH AXIS1 ENC2 CMT1 ENC2
ATTACH AXIS4 STEPPER4 STEPPER4
ATTACH AXIS5 STEPPER5 STEPPER5
ATTACH AXIS6 STEPPER6 STEPPER6
ATTACH AXIS7 STEPPER7 STEPPER7
AXIS2 OFF
AXIS3 OFF
CMT0 ENC0 ENC1
CMT0 DAC0 DAC1
CMT1 ENC2 ENC3
CMT1 DAC2 DAC3
"""


# Two brushless motors on encoders 0 and 2 whose magnets stand where their commutators begin.
BRUSHLESS = "".join(
    f"""
[[axis]]
number = {number}
encoder_lines = 1024
motor = {{ inertia_kgm2 = 2.0e-5, torque_nm_per_a = 0.0771, pole_pairs = 2 }}
load = {{ viscous_nms = 1.5e-4 }}

[axis.drive]
mode = "phases"
dacs = [{number}, {number + 1}]
amps_per_volt = 2.0
peak_amps = 20.0
"""
    for number in (0, 2)
)


def restarted(example: str, card: Controller | None = None) -> Controller:
    """A card that was given the lines of an example, ESAVE and REBOOT, and took all of them."""
    card = card or Controller()
    card.send("ECHO 4\r")
    for line in (*example.strip().splitlines(), "ESAVE"):
        notice = "CONFIG acts after ESAVE and REBOOT\r\n" if line.startswith("CONFIG") else ""
        assert card.send(f"{line}\r") == notice, line
    card.send("REBOOT\r")
    card.advance(1)
    card.send("ECHO 4\r")
    return card


def move(card: Controller, axes: dict[int, float]) -> None:
    """Move each axis to a position of its own, in pulses."""
    lines = ["PROG0", "ATTACH MASTER0"]
    for slave, axis in enumerate(axes):
        lines.append(f'ATTACH SLAVE{slave} AXIS{axis} "{"ABCDUXYZ"[slave]}"')
    targets = [f"{'ABCDUXYZ'[slave]}{target:g}" for slave, target in enumerate(axes.values())]
    lines += ["VEL 5000", "ACC 50000", "DEC 50000", "STP 50000", " ".join(targets)]
    card.send("".join(f"{line}\r" for line in lines))
    card.advance(seconds=2)


def pulses(card: Controller) -> list[float]:
    return [card.p[row] for row in STEPPERS]


def actual(card: Controller, axis: int) -> float:
    return card.p[12290 + 256 * axis]


@pytest.mark.req("ACR-OUTMOD-03")
def test_example_3_moves_two_brushless_servos_and_four_steppers() -> None:
    card = restarted(BRUSHLESS_AND_STEPPERS, Controller(world=parse_world(BRUSHLESS)))
    assert card.send("AXIS2\rAXIS3\rCMT0 ENC\rCMT0 DAC\rCMT1 ENC\rCMT1 DAC\r").splitlines() == [
        *("OFF", "OFF", "0,1", "0,1", "2,3", "2,3")
    ]
    card.send("CMT0 PPR 1024\rCMT0 ERPMR 2\rCMT0 ANG 120\rCMT0 MODE 1\rCMT0 ON\r")
    card.send("CMT1 PPR 1024\rCMT1 ERPMR 2\rCMT1 ANG 120\rCMT1 MODE 1\rCMT1 ON\r")
    for axis in (0, 1):
        card.send(f"AXIS{axis} PGAIN 0.05\rAXIS{axis} DGAIN 0.0005\rAXIS{axis} DWIDTH 0\r")
    move(card, {0: 1000, 1: 1100, 4: 400, 5: 500, 6: 600, 7: 700})
    assert pulses(card) == [0, 0, 0, 0, 400, 500, 600, 700]
    assert [actual(card, axis) for axis in (0, 1)] == pytest.approx([1000, 1100], abs=1)
    assert [actual(card, axis) for axis in (4, 5, 6, 7)] == [400, 500, 600, 700]


@pytest.mark.parametrize(
    ("modules", "dacs", "steppers"),
    [
        ("DAC4 DAC4", {0, 1, 2, 3, 4, 5, 6, 7}, set()),
        ("DAC2 DAC2", {0, 1, 4, 5}, set()),
        ("NONE DAC4", {4, 5, 6, 7}, set()),
        ("STEPPER2 DAC2", {4, 5}, {0, 1}),
        ("STEPPER4 STEPPER2", set(), {0, 1, 2, 3, 4, 5}),
        ("DACSTEP2 STEPPER4", {0, 1}, {0, 1, 4, 5, 6, 7}),
        ("DACSTEP4 DAC2", {0, 1, 2, 3, 4, 5}, {0, 1, 2, 3}),
    ],
)
def test_outputs_are_numbered_by_the_socket_of_their_module(
    modules: str, dacs: set[int], steppers: set[int]
) -> None:
    card = Controller()
    card.send(f"CONFIG ENC8 {modules} ADC8\rESAVE\rREBOOT\r")
    card.send("".join(f"AXIS{n} OFF\rP{6400 + 16 * n}=5\r" for n in range(8)))
    card.advance(2)
    assert {n for n in range(8) if card.p[6400 + 16 * n] == 5} == dacs
    card.send("".join(f"ATTACH AXIS{n} STEPPER{n} STEPPER{n}\rAXIS{n} ON\r" for n in range(8)))
    move(card, dict.fromkeys(range(8), 100.0))
    assert {n for n, count in enumerate(pulses(card)) if count == 100} == steppers
