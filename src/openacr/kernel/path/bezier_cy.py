"""Moves along rational Bezier curves: the moves of which SPLINE and NURB are made.

With u from 0 to 1 and the Bernstein polynomials B_k of degree n, a slave stands at

    target + sum B_k(u) w_k q_k / sum B_k(u) w_k,

where q_k are its poles relative to the target, so that u = 1 is exactly the target. The
poles take the rows of the waves of other curves: pole k of slave s is row k of the six.

In time modes the path of the master is u itself. In velocity modes it is the arc

    s(u) = integral of |c'(u)| du,    c' weighted with VECDEF, in units,

measured by Gauss-Legendre quadrature over ARCS equal parts; the u of an arc is found by
Newton's method inside its part, kept in a bracket because |c'| may vanish at the ends of a
spline.
"""

from openacr.cmath import fabs, sqrt
from openacr.map.rows import curves, moves
from openacr.views import F64, I32

__all__ = ["bezier_measure", "bezier_position", "bezier_slope", "bezier_speed", "bezier_u"]

CURVE_TIMED = 4
CURVE_PATH = 5
SLAVES = 16
ARCS = 8
PART = 0.125
STEPS = 60
SAMPLES = 32
SAMPLE = 0.03125
CLOSE = 1e-14
# Nodes and weights of Gauss-Legendre quadrature of five points on (-1, 1).
NODE_1 = 0.5384693101056831
NODE_2 = 0.9061798459386640
WEIGHT_0 = 0.5688888888888889
WEIGHT_1 = 0.4786286704993665
WEIGHT_2 = 0.2369268850561891


def is_bezier(I: I32, record: int) -> bool:
    """Whether a move is a piece of SPLINE or NURB."""
    return I[moves.curve[record]] >= CURVE_TIMED


def is_timed(I: I32, record: int) -> bool:
    """Whether the path of a move is time instead of a distance."""
    return I[moves.curve[record]] == CURVE_TIMED


def weight_sum(F: F64, record: int, degree: int, u: float) -> float:
    """Sum of B_k(u) w_k."""
    w: int = curves.pole_weight[record]
    total: float = F[w]
    power: float = 1.0
    for k in range(1, degree + 1):
        power = power * u * (degree - k + 1) / k
        total = total * (1.0 - u) + power * F[w + k]
    return total


def weight_rise(F: F64, record: int, degree: int, u: float) -> float:
    """Derivative of `weight_sum` after u."""
    w: int = curves.pole_weight[record]
    total: float = F[w + 1] - F[w]
    power: float = 1.0
    for k in range(1, degree):
        power = power * u * (degree - k) / k
        total = total * (1.0 - u) + power * (F[w + k + 1] - F[w + k])
    return total * degree


def pole(F: F64, record: int, s: int, k: int) -> float:
    """Pole k of slave s times its weight."""
    return F[curves.amplitude_cnt[record] + k * SLAVES + s] * F[curves.pole_weight[record] + k]


def pole_sum(F: F64, record: int, s: int, degree: int, u: float) -> float:
    """Sum of B_k(u) w_k q_k of slave s."""
    total_cnt: float = pole(F, record, s, 0)
    power: float = 1.0
    for k in range(1, degree + 1):
        power = power * u * (degree - k + 1) / k
        total_cnt = total_cnt * (1.0 - u) + power * pole(F, record, s, k)
    return total_cnt


def pole_rise(F: F64, record: int, s: int, degree: int, u: float) -> float:
    """Derivative of `pole_sum` after u."""
    total_cnt: float = pole(F, record, s, 1) - pole(F, record, s, 0)
    power: float = 1.0
    for k in range(1, degree):
        power = power * u * (degree - k) / k
        total_cnt = total_cnt * (1.0 - u) + power * (
            pole(F, record, s, k + 1) - pole(F, record, s, k)
        )
    return total_cnt * degree


def bezier_position(F: F64, I: I32, record: int, s: int, u: float) -> float:
    """Position of slave s at u."""
    target_cnt: float = F[moves.target_cnt[record] + s]
    degree: int = I[moves.degree[record]]
    if u >= 1.0:
        return target_cnt
    return target_cnt + pole_sum(F, record, s, degree, u) / weight_sum(F, record, degree, u)


def bezier_slope(F: F64, I: I32, record: int, s: int, u: float) -> float:
    """Change of the position of slave s with u."""
    degree: int = I[moves.degree[record]]
    below: float = weight_sum(F, record, degree, u)
    rise: float = pole_rise(F, record, s, degree, u) * below
    turn: float = pole_sum(F, record, s, degree, u) * weight_rise(F, record, degree, u)
    return (rise - turn) / (below * below)


def bezier_speed(F: F64, I: I32, record: int, u: float) -> float:
    """Change of the weighted distance [units] with u."""
    curved: int = I[moves.curved[record]]
    square: float = 0.0
    for s in range(SLAVES):
        if curved & (1 << s):
            weight: float = F[moves.weight[record] + s]
            if weight != 0.0:
                slope_u: float = weight * bezier_slope(F, I, record, s, u)
                square += slope_u * slope_u
    return sqrt(square)


def bezier_arc(F: F64, I: I32, record: int, a: float, b: float) -> float:
    """Length of the curve from u = a to b."""
    half: float = (b - a) / 2.0
    mid: float = (a + b) / 2.0
    total_u: float = WEIGHT_0 * bezier_speed(F, I, record, mid)
    total_u += WEIGHT_1 * bezier_speed(F, I, record, mid - half * NODE_1)
    total_u += WEIGHT_1 * bezier_speed(F, I, record, mid + half * NODE_1)
    total_u += WEIGHT_2 * bezier_speed(F, I, record, mid - half * NODE_2)
    total_u += WEIGHT_2 * bezier_speed(F, I, record, mid + half * NODE_2)
    return total_u * half


def bezier_measure(F: F64, I: I32, record: int) -> float:
    """Note the arcs of a curve whose poles are known; return its length."""
    w: int = curves.arc_u[record]
    total_u: float = 0.0
    for k in range(ARCS):
        total_u += bezier_arc(F, I, record, k * PART, (k + 1) * PART)
        F[w + k] = total_u
    return total_u


def bezier_u(F: F64, I: I32, record: int, part: float) -> float:
    """The u at a part of the path of a move, both from 0 to 1."""
    if part <= 0.0 or part >= 1.0 or is_timed(I, record):
        return part
    w: int = curves.arc_u[record]
    length_u: float = F[w + ARCS - 1]
    gone_u: float = part * length_u
    k: int = 0
    while k < ARCS - 1 and F[w + k] < gone_u:
        k += 1
    before_u: float = F[w + k - 1] if k > 0 else 0.0
    first: float = k * PART
    low: float = first
    high: float = first + PART
    width_u: float = F[w + k] - before_u
    u: float = low
    if width_u > 0.0:
        u = low + (high - low) * (gone_u - before_u) / width_u
    for _ in range(STEPS):
        off_u: float = before_u + bezier_arc(F, I, record, first, u) - gone_u
        if fabs(off_u) <= CLOSE * length_u:
            break
        if off_u > 0.0:
            high = u
        else:
            low = u
        speed_u: float = bezier_speed(F, I, record, u)
        u = u - off_u / speed_u if speed_u > 0.0 else low
        if not low < u < high:
            u = (low + high) / 2.0
    return u


def bezier_steepest(F: F64, I: I32, record: int, s: int) -> float:
    """The largest_cnt change of the position of slave s with the part of the path, sampled."""
    length_u: float = F[curves.arc_u[record] + ARCS - 1]
    timed: bool = is_timed(I, record)
    largest_cnt: float = 0.0
    for k in range(SAMPLES + 1):
        slope_cnt: float = fabs(bezier_slope(F, I, record, s, k * SAMPLE))
        if not timed:
            speed_u: float = bezier_speed(F, I, record, k * SAMPLE)
            slope_cnt = slope_cnt * length_u / speed_u if speed_u > CLOSE * length_u else 0.0
        largest_cnt = max(largest_cnt, slope_cnt)
    return largest_cnt
