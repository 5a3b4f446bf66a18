"""Brushless motors commutated by the card: torque of the phase currents.

Two voltages command the currents of two windings. Of three phases in star the third carries
back what the others bring: c = -(a + b). The rotor, at the electrical angle

    theta = zero + pole pairs * angle of the shaft,

makes a torque with each winding, and they add up to that of the one voltage

    two phases      u = a sin(theta) + b sin(theta + 90)
    three phases    u = 2/3 (a sin(theta) + b sin(theta + 120) + c sin(theta + 240))

on a drive with one: a = v sin(theta), b = v sin(theta + 90 or 120) gives u = v at any angle. A
field that is d degrees off leaves v cos(d): less torque, none at 90 degrees, and a motor that
runs away beyond. A field that turns in the wrong direction, or not at all, lets the rotor settle
where the torque is zero. The drive limits the amplitude of the currents, not each of them.
"""

from openacr.cmath import cos, sin, sqrt
from openacr.map import numbers as at
from openacr.plant.physics.drive_cy import converter_volts
from openacr.views import F32, F64, I32

THREE = 3
THIRD = 0.5773502691896258  # 1 / sqrt(3)


def phase_volts(F: F64, I: I32, S: F32, n: int) -> None:
    """Voltage that would push a motor with one input as its two phases push motor n.

    The two currents are one vector: across the rotor and along it. With b at 120 degrees,
    b = -a/2 + sqrt(3)/2 q, so q = (a + 2 b) / sqrt(3) is the part at 90 degrees to a.
    """
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    b: int = at.PLBF_BASE + n * at.PLBF_STRIDE
    i: int = at.PLBI_BASE + n * at.PLBI_STRIDE
    step: float = F[f + at.PLF_DAC_STEP]
    first: float = converter_volts(S, I[at.PLI_BASE + n * at.PLI_STRIDE + at.PLI_DAC], step)
    second: float = converter_volts(S, I[i + at.PLBI_SECOND_DAC], step)
    first += F[f + at.PLF_OFFSET_V]
    second += F[f + at.PLF_OFFSET_V]
    if I[i + at.PLBI_PHASES] == THREE:
        second = (first + 2.0 * second) * THIRD
    amplitude: float = sqrt(first * first + second * second)
    if amplitude > F[b + at.PLBF_PEAK_V]:
        first *= F[b + at.PLBF_PEAK_V] / amplitude
        second *= F[b + at.PLBF_PEAK_V] / amplitude
    theta: float = (
        F[b + at.PLBF_ZERO_RAD] + F[b + at.PLBF_RADIANS_PER_CNT] * F[f + at.PLF_POSITION_CNT]
    )
    F[f + at.PLF_VOLTS] = first * sin(theta) + second * cos(theta)
