"""Stepper motors: a stepped field pulls the rotor along, and loses it beyond its torque.

The pulses of a stepper output turn the field, evenly within a servo period. The rotor is held at
the field as by a spring that repeats every four full steps,

    a = A(v) sin(theta) - D (v - v_field) cos(theta),    theta = 2 pi (field - rotor) / pitch,

limited to A(v), the pull-out torque at the speed v of the rotor as an acceleration of its load;
the second part is the damping of drive and motor. A load that asks for more slips into another of
the stable positions, or out of step altogether: the field passes by, its torque averages out, and
friction brings the rotor to rest. It falls into step again once the field is slow enough. What was
lost stays lost: the card cannot detect it, unless an encoder counts the shaft.

The motion is integrated in steps that are short against the oscillation of the rotor.
"""

from openacr.cmath import cos, fabs, sin
from openacr.map import numbers as at
from openacr.views import F64, I32

STEPS_OF_OSCILLATION = 8.0  # in a radian of it
LEAST_STEPS = 4
MOST_STEPS = 400


def stepper_motor(F: F64, I: I32, n: int, ready: int, dt: float) -> None:
    """Advance stepper motor n by `dt` seconds; without a ready drive it coasts."""
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    t: int = at.PLTF_BASE + n * at.PLTF_STRIDE
    output: int = I[at.PLI_BASE + n * at.PLI_STRIDE + at.PLI_DAC]
    pulses: float = F[at.STOF_BASE + output * at.STOF_STRIDE + at.STOF_PULSES]
    turned: float = (pulses - F[t + at.PLTF_PULSES_SEEN]) * F[t + at.PLTF_COUNTS_PER_PULSE]
    field: float = F[t + at.PLTF_FIELD_CNT]
    F[t + at.PLTF_PULSES_SEEN] = pulses
    F[t + at.PLTF_FIELD_CNT] = field + turned
    count: int = int(F[t + at.PLTF_STIFFNESS_PER_S] * dt * STEPS_OF_OSCILLATION) + LEAST_STEPS
    if count > MOST_STEPS:
        count = MOST_STEPS
    k: int = 0
    push: float = 0.0
    for k in range(count):
        push = 0.0
        if ready != 0:
            push = _pull(F, I, n, field + turned * (k + 1.0) / count, turned / dt)
        _rotor_step(F, f, push, dt / count)


def _pull(F: F64, I: I32, n: int, field: float, field_cps: float) -> float:
    """Acceleration that the field gives to rotor n."""
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    t: int = at.PLTF_BASE + n * at.PLTF_STRIDE
    v: float = F[f + at.PLF_VELOCITY_CPS]
    theta: float = (field - F[f + at.PLF_POSITION_CNT]) * F[t + at.PLTF_RADIANS_PER_CNT]
    limit: float = pull_out_accel(F, I, n, fabs(v))
    push: float = limit * sin(theta) - F[t + at.PLTF_DAMPING_PER_S] * (v - field_cps) * cos(theta)
    if push > limit:
        return limit
    if push < -limit:
        return -limit
    return push


def pull_out_accel(F: F64, I: I32, n: int, speed_cps: float) -> float:
    """Highest acceleration of motor n at a speed, on lines between the points of its curve."""
    t: int = at.PLTF_BASE + n * at.PLTF_STRIDE
    last: int = I[at.PLTI_BASE + n * at.PLTI_STRIDE + at.PLTI_POINTS] - 1
    k: int = 0
    for k in range(last):
        slow: float = F[t + at.PLTF_SPEED_CPS + k]
        fast: float = F[t + at.PLTF_SPEED_CPS + k + 1]
        if speed_cps < fast:
            share: float = max(0.0, speed_cps - slow) / (fast - slow)
            return F[t + at.PLTF_ACCEL + k] * (1.0 - share) + F[t + at.PLTF_ACCEL + k + 1] * share
    return F[t + at.PLTF_ACCEL + last]


def _rotor_step(F: F64, f: int, push: float, h: float) -> None:
    """One short step of the rotor with its friction: the new speed moves it."""
    v: float = F[f + at.PLF_VELOCITY_CPS]
    if v == 0.0 and fabs(push) <= F[f + at.PLF_STATIC_ACCEL]:
        return
    friction: float = F[f + at.PLF_COULOMB_ACCEL]
    if v < 0.0 or (v == 0.0 and push < 0.0):
        friction = -friction
    new: float = (v + (push - friction) * h) / (1.0 + F[f + at.PLF_VISCOUS_PER_S] * h)
    if v * new < 0.0 and fabs(push) <= F[f + at.PLF_STATIC_ACCEL]:
        new = 0.0
    F[f + at.PLF_VELOCITY_CPS] = new
    F[f + at.PLF_POSITION_CNT] += new * h
