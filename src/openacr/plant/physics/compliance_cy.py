"""Loads on an elastic shaft: motor and load swing against each other.

Motor and load with the inertias J1 and J2 on a spring make two movements that do not affect each
other: that of their common centre, which is the motor on a rigid shaft (`drive_cy.py`, with all
friction), and the flexion y of the motor about it. A torque that accelerates the centre by u
has

    y'' = (J2 / J1) u - 2 s y' - w^2 y

with the resonance w and the damping s of both on their spring. The motor, and so the encoder, is
at the sum of the two. With the motor held the load would swing at the antiresonance
w sqrt(J1 / (J1 + J2)).

The torque is constant during a tick of the length t, so y goes towards y0 = (J2 / J1) u / w^2 by

    y - y0 <- e (c + s d) (y - y0) + e d y'         e = exp(-s t)
    y'     <- e (c - s d) y' - w^2 e d (y - y0)     c = cos(v t), d = sin(v t) / v, v^2 = w^2 - s^2
"""

from openacr.cmath import cos, exp, sin, sqrt
from openacr.map.rows import compliant_loads, motors
from openacr.plant.physics.drive_cy import clamp_accel
from openacr.views import F64

SLOWEST_RAD2_S2 = 1e-6  # a damping ratio is below 1; a snapshot may have any

__all__ = ["flex", "flexion", "is_compliant"]


def is_compliant(F: F64, n: int) -> bool:
    """Whether the load of motor n is on an elastic shaft."""
    return F[compliant_loads.resonance_rad_s[n]] > 0.0


def flexion(F: F64, n: int) -> float:
    """How far motor n is from where it would be on a rigid shaft [counts]."""
    return F[compliant_loads.flex_cnt[n]]


def flex(F: F64, n: int, ready: int, velocity: float, dt: float) -> None:
    """Advance the flexion of motor n by one tick; `velocity` [counts/s] of the centre before it."""
    if F[compliant_loads.cached_dt_s[n]] != dt:
        _cache_factors(F, n, dt)
    resonance: float = F[compliant_loads.resonance_rad_s[n]]
    stiffness: float = resonance * resonance
    place: float = F[compliant_loads.flex_cnt[n]]
    speed: float = F[compliant_loads.flex_cps[n]]
    rest: float = 0.0
    if ready != 0:
        rest = F[compliant_loads.inertia_ratio[n]] * _push(F, n, velocity) / stiffness
    by_speed: float = F[compliant_loads.place_of_speed_s[n]]
    away: float = place - rest
    kept: float = F[compliant_loads.keep_place[n]] * away
    F[compliant_loads.flex_cnt[n]] = rest + kept + by_speed * speed
    F[compliant_loads.flex_cps[n]] = (
        F[compliant_loads.keep_speed[n]] * speed - stiffness * by_speed * away
    )


def _push(F: F64, n: int, velocity: float) -> float:
    """Acceleration of the centre by the torque of the motor, as its drive and supply allow."""
    peak: float = F[motors.peak_accel[n]]
    push: float = clamp_accel(F[motors.volts[n]] * F[motors.accel_per_volt[n]], peak)
    supply: float = F[motors.supply_accel[n]]
    if supply > 0.0:
        back_emf: float = F[motors.back_emf_per_s[n]] * velocity
        if push > 0.0 and push > supply - back_emf:
            push = supply - back_emf
        elif push < 0.0 and push < -supply - back_emf:
            push = -supply - back_emf
    return push


def _cache_factors(F: F64, n: int, dt: float) -> None:
    """Factors of one step; they change only with the length of the tick."""
    resonance: float = F[compliant_loads.resonance_rad_s[n]]
    damping: float = F[compliant_loads.damping_per_s[n]]
    swing2: float = resonance * resonance - damping * damping
    if swing2 < SLOWEST_RAD2_S2:
        swing2 = SLOWEST_RAD2_S2
    swing: float = sqrt(swing2)
    decay: float = exp(-damping * dt)
    c: float = cos(swing * dt)
    d: float = sin(swing * dt) / swing
    F[compliant_loads.keep_place[n]] = decay * (c + damping * d)
    F[compliant_loads.place_of_speed_s[n]] = decay * d
    F[compliant_loads.keep_speed[n]] = decay * (c - damping * d)
    F[compliant_loads.cached_dt_s[n]] = dt
