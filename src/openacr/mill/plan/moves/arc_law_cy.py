"""Which speed and which change of speed an arc leaves to the axes of its plane.

On a radius r the path turns with v^2 / r, across the change of speed a. Over its sweep an arc
points anywhere, so both together have to be within the limit A of the weakest axis:

    (v^2 / r)^2 + a^2 <= A^2

A move has one ramp. The highest speed takes TURNING of A for the turn; half of A is left then to
change speed, so that a feed hold takes at most twice as long as on a line. Slower arcs have a
greater ramp.

A spiral has the radius r + k phi at the angle phi, and passes it at the even angular speed
w = v / r_mean. Its acceleration is

    across  w^2 r - w' k        along  w' r + 2 w^2 k

that is (w' r, -w' k) of the change of speed and (2 w^2 k, w^2 r) of the turn; the cosine between
the two is `arc_skew`.
"""

from openacr.cmath import fabs, sqrt

__all__ = ["arc_bend", "arc_ramp", "arc_skew", "arc_speed", "arc_widening"]

TURNING = 0.8660254037844386  # sqrt(3)/2: leaves half of the limit to the ramp


def arc_growth(begin_u: float, end_u: float, sweep_rad: float) -> float:
    """The change of the radius by angle, k above [u/rad]."""
    return fabs(end_u - begin_u) / fabs(sweep_rad)


def arc_bend(begin_u: float, end_u: float, sweep_rad: float, share: float) -> float:
    """The acceleration of the turn by the square of the vector speed [1/u].

    `share` is the part of the vector speed that goes along the plane of the arc.
    """
    growth: float = arc_growth(begin_u, end_u, sweep_rad)
    mean: float = 0.5 * (begin_u + end_u)
    most: float = begin_u if begin_u > end_u else end_u
    return sqrt(most * most + 4.0 * growth * growth) * (share / mean) * (share / mean)


def arc_widening(begin_u: float, end_u: float, sweep_rad: float) -> float:
    """The acceleration along the path by that of the vector: 1, more where a spiral is widest."""
    growth: float = arc_growth(begin_u, end_u, sweep_rad)
    most: float = begin_u if begin_u > end_u else end_u
    return sqrt(most * most + growth * growth) / (0.5 * (begin_u + end_u))


def arc_skew(begin_u: float, end_u: float, sweep_rad: float) -> float:
    """The largest cosine between turn and change of speed: 0 on a circle, at most 1/3."""
    growth: float = arc_growth(begin_u, end_u, sweep_rad)
    least: float = begin_u if begin_u < end_u else end_u
    if growth * growth * 2.0 >= least * least:
        return 1.0 / 3.0
    q: float = growth / least
    return q / sqrt((1.0 + q * q) * (1.0 + 4.0 * q * q))


def arc_speed(limit_ups2: float, bend_per_u: float) -> float:
    """The highest vector speed on an arc [units/s]."""
    return sqrt(TURNING * limit_ups2 / bend_per_u)


def arc_ramp(
    limit_ups2: float, bend_per_u: float, widening: float, skew: float, speed_ups: float
) -> float:
    """What is left to change the vector speed at up to `speed_ups` [units/s2].

    Speeds above `arc_speed` count as this one.
    """
    turn: float = bend_per_u * speed_ups * speed_ups
    turn = turn if turn < TURNING * limit_ups2 else TURNING * limit_ups2
    rest: float = limit_ups2 * limit_ups2 - turn * turn * (1.0 - skew * skew)
    return (sqrt(rest) - skew * turn) / widening
