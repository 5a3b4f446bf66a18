"""The servo tuning tutorial: what each gain step does to a one-revolution step response.

The guide shows pictures, not numbers; the trends are what can be asserted: a higher PGAIN
answers faster, DGAIN takes oscillation away, load inertia slows and weakens the damping.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from openacr.controller import Controller
from openacr.plant.describe.load import parse_world

MOTOR_KGM2 = 1.5e-5
MACHINE = """
[[axis]]
number = 0
name = "X"
counts_per_rev = 8000

[axis.motor]
inertia_kgm2 = {motor}
torque_nm_per_a = 0.25
resistance_ohm = 2.0

[axis.load]
inertia_kgm2 = {load}
viscous_nms = 8e-4

[axis.drive]
mode = "torque"
amps_per_volt = 1.0
peak_amps = 10.0
"""
STEP_CNT = 400


@dataclass(frozen=True)
class Response:
    """A step response: time to 90 % of the step, overshoot, time outside 5 % of the step."""

    rise_s: float
    overshoot: float
    settle_s: float


def response(pgain: float, dgain: float, *, load_ratio: float = 0.0) -> Response:
    world = parse_world(MACHINE.format(motor=MOTOR_KGM2, load=MOTOR_KGM2 * load_ratio))
    card = Controller(world=world)
    card.send(f"AXIS0 MULT 4\rAXIS0 PGAIN {pgain}\rAXIS0 DGAIN {dgain}\r")
    card.record(1)
    card.p[12288] = STEP_CNT  # a step of the commanded position
    card.advance(seconds=2.0)
    trace = card.trace()
    actual = trace.axes[0].actual_u / STEP_CNT
    outside = np.nonzero(np.abs(actual - 1.0) > 0.05)[0]
    risen = int(np.argmax(actual >= 0.9))
    return Response(
        rise_s=float(trace.time_s[risen]) if actual.max() >= 0.9 else 2.0,
        overshoot=float(actual.max() - 1.0),
        settle_s=float(trace.time_s[outside[-1]]) if outside.size else 0.0,
    )


@pytest.mark.req("ACR-TUT-09")
def test_the_gain_steps_of_the_tutorial_change_the_response_as_described() -> None:
    soft = response(0.0003, 0)
    stiffer = response(0.0005, 0)
    assert stiffer.rise_s < soft.rise_s  # more responsive
    assert stiffer.overshoot > 0.2  # but under-damped
    damped = response(0.0005, 0.00001)
    assert damped.overshoot < stiffer.overshoot / 2
    assert damped.settle_s < stiffer.settle_s
    faster = response(0.001, 0.00001)
    assert faster.rise_s < damped.rise_s
    hard = response(0.005, 0.00001)
    assert hard.rise_s < faster.rise_s
    assert hard.overshoot > faster.overshoot  # oscillates again
    calmed = response(0.005, 0.00003)
    assert calmed.overshoot < hard.overshoot / 2
    assert calmed.settle_s < hard.settle_s


@pytest.mark.req("ACR-TUT-09", "ACR-TUT-10")
def test_a_load_slows_and_weakens_the_damping_and_higher_gains_bring_both_back() -> None:
    unloaded = response(0.005, 0.00003)
    loaded = response(0.005, 0.00003, load_ratio=9)
    assert loaded.rise_s > unloaded.rise_s
    assert loaded.overshoot > unloaded.overshoot
    assert loaded.settle_s > unloaded.settle_s
    harder = response(0.02, 0.00003, load_ratio=9)
    assert harder.rise_s < loaded.rise_s
    final = response(0.02, 0.00015, load_ratio=9)
    assert final.overshoot < harder.overshoot / 2
    assert final.settle_s < harder.settle_s
    assert final.rise_s < loaded.rise_s
