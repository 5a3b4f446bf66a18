"""The rotor of a stepper motor by itself: friction, damping, loss of step."""

import math

import pytest
from tests.plant.conftest import Rig

from openacr.map.rows import stepper_outputs

COUNTS = 2000
INERTIA = 5e-5
ACCEL_PER_NM = COUNTS / (2 * math.pi * INERTIA)
PITCH = COUNTS * 4 / 200


def rig(load: str = "", torque: str = "[[0.0, 0.5]]", damping: float = 0.2) -> Rig:
    return Rig(
        "[[axis]]\nnumber = 0\n"
        f"motor = {{ inertia_kgm2 = {INERTIA} }}\nload = {{ {load} }}\n"
        f'drive = {{ mode = "stepper", output = 3, steps_per_rev = {COUNTS},'
        f" torque_nm = {torque}, damping = {damping} }}\n"
    )


def send(made: Rig, pulses: float, ticks: int = 1) -> None:
    """Pulses on the stepper output, the same count in every period."""
    for _ in range(ticks):
        made.memory.F[stepper_outputs.pulses[3]] += pulses
        made.turn()


@pytest.mark.parametrize("direction", [1, -1])
def test_dry_friction_brakes_a_coasting_rotor_and_holds_it(direction: int) -> None:
    made = rig("coulomb_nm = 0.01")
    made.enable(0, False)
    made.throw(direction * 1000.0)
    made.turn()
    assert made.velocity == pytest.approx(direction * (1000.0 - 0.01 * ACCEL_PER_NM * 0.0005))
    made.turn(ticks=200)
    assert made.velocity == 0.0
    made.turn(ticks=10)
    assert made.velocity == 0.0


@pytest.mark.parametrize("direction", [1, -1])
def test_viscous_friction_brakes_with_the_speed(direction: int) -> None:
    made = rig("viscous_nms = 1e-4")
    made.enable(0, False)
    made.throw(direction * 1000.0)
    made.turn(ticks=200)
    assert made.velocity == pytest.approx(
        direction * 1000.0 * math.exp(-1e-4 / INERTIA * 0.1), rel=0.01
    )


@pytest.mark.parametrize("direction", [1, -1])
def test_a_field_that_is_too_quick_passes_by(direction: int) -> None:
    made = rig()
    send(made, direction * 100, ticks=400)  # 100 rev/s from rest
    assert abs(made.velocity) < 0.02 * 100 * COUNTS
    send(made, 0, ticks=4000)
    slipped = (400 * 100 * direction - (made.position - 0.5)) / PITCH
    assert slipped == pytest.approx(round(slipped), abs=0.01)
    assert abs(slipped) > 400


@pytest.mark.parametrize("direction", [1, -1])
def test_without_damping_it_swings_about_the_field_and_with_it_it_settles(direction: int) -> None:
    free, damped = rig(damping=0.0), rig(damping=0.2)
    for made in (free, damped):
        send(made, direction * 5)
        made.turn(ticks=400)
    assert abs(damped.velocity) < 1e-3
    assert damped.position == pytest.approx(0.5 + direction * 5, abs=1e-3)
    swing = []
    for _ in range(40):
        free.turn()
        swing.append(abs(free.velocity))
    omega = math.sqrt(0.5 * ACCEL_PER_NM * 2 * math.pi / PITCH)
    assert max(swing) == pytest.approx(5 * omega, rel=0.1)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_torque_beyond_half_a_pitch_lets_it_slip_into_the_next_position(direction: int) -> None:
    made = rig()
    send(
        made, direction * 0.6 * PITCH
    )  # at once: it falls back to where the field holds it, a pitch on
    made.turn(ticks=1000)
    assert made.position == pytest.approx(0.5 - direction * 0.4 * PITCH, abs=1e-3)
    made = rig()
    send(made, direction * 0.4 * PITCH)
    made.turn(ticks=1000)
    assert made.position == pytest.approx(0.5 + direction * 0.4 * PITCH, abs=1e-3)


@pytest.mark.parametrize("direction", [1, -1])
def test_at_a_constant_speed_the_rotor_is_at_the_field(direction: int) -> None:
    made = rig()
    for speed in (1, 2, 3, 4, 5):
        send(made, direction * speed, ticks=100)
    send(made, direction * 5, ticks=200)
    field = 0.5 + direction * (100 * 15 + 1000)
    assert made.position == pytest.approx(field, abs=1.0)
    assert made.velocity == pytest.approx(direction * 5 / 0.0005, rel=1e-3)
