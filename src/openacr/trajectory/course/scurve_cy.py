"""From rest to rest along a straight line, in closed form.

A ramp from rest to the speed v has five phases of constant jerk:

    -J1 for t0 | J1 for t0 + t1 | J for t2 | 0 for t3 | -J for t4         t4 = (J1 t1 + J t2) / J

J1 <= J rules the first `soft_s` seconds only: there the ramp overlaps the end of another move
in time (overlap_cy.py), and their jerks add. t0 is above 0 where it swings out first (end_law.py).
With the peak acceleration a of a ramp without t3

    t1 <= soft - 2 t0   v = J1 (t1^2/2 (1 + J1/J) - t0^2)
    else                v = v1 + (a^2 - a1^2)/(2J) + a^2/(2J)

with a1 = J1 t1 and v1 = J1 (t1^2/2 - t0^2),
and where a would be above the limit, t3 adds the rest. Braking is the same in reverse, with the
same jerks. The speed reached
is the highest whose two ramps are within the length: the distance of a ramp rises with v.
"""

from openacr.cmath import sqrt
from openacr.trajectory.course.law_cy import A_ROW, ROW, S_ROW, T_ROW, V_ROW
from openacr.views import F64

PHASES = 5
R_TIMES = 0
R_JERKS = 5
R_LENGTH = 10
R_SIZE = 11
MOST_ROWS = 12
HALVINGS = 60

__all__ = ["rest_to_rest"]


def scurve_ramp(
    v: float, A: float, J: float, J1: float, soft_s: float, swing_s: float, R: F64, at: int
) -> None:
    """Write durations, jerks and length of the ramp from rest to the speed v to R[at ...]."""
    soft: float = soft_s - 2.0 * swing_s
    if soft * J1 > A:
        soft = A / J1
    v0: float = v + J1 * swing_s * swing_s
    t1: float = sqrt(2.0 * v0 / (J1 + J1 * J1 / J))
    t2: float = 0.0
    t3: float = 0.0
    if t1 > soft:
        t1 = soft
        a1: float = J1 * soft
        v1: float = 0.5 * a1 * soft
        peak: float = sqrt(J * (v0 - v1) + 0.5 * a1 * a1)
        if peak > A:
            peak = A
            t3 = (v0 - v1 - (A * A - 0.5 * a1 * a1) / J) / A
        t2 = (peak - a1) / J
        if t2 < 0.0:
            t2 = 0.0
        if t3 < 0.0:
            t3 = 0.0
    R[at] = swing_s
    R[at + 1] = swing_s + t1
    R[at + 2] = t2
    R[at + 3] = t3
    R[at + 4] = (J1 * t1 + J * t2) / J
    R[at + R_JERKS] = -J1
    R[at + R_JERKS + 1] = J1
    R[at + R_JERKS + 2] = J
    R[at + R_JERKS + 3] = 0.0
    R[at + R_JERKS + 4] = -J
    s: float = 0.0
    speed: float = 0.0
    a: float = 0.0
    for phase in range(PHASES):
        t: float = R[at + phase]
        j: float = R[at + R_JERKS + phase]
        s += t * (speed + t * (0.5 * a + t * j / 6.0))
        speed += t * (a + 0.5 * j * t)
        a += j * t
    R[at + R_LENGTH] = s


def scurve_length(v: float, A: float, J: float, E: F64, R: F64) -> float:
    """The length of both ramps to the speed v, which are left in R."""
    scurve_ramp(v, A, J, E[0], E[1], E[2], R, 0)
    scurve_ramp(v, A, J, E[3], E[4], E[5], R, R_SIZE)
    return R[R_LENGTH] + R[R_SIZE + R_LENGTH]


def rest_to_rest(length: float, V: float, A: float, J: float, E: F64, R: F64, Z: F64) -> int:
    """Write the law of a straight move to Z, return its count of rows; R is 22 numbers of room.

    E says of start and end: the jerk J1, for how long it rules, and the time t0 of a swing.
    """
    v: float = V
    if scurve_length(V, A, J, E, R) > length:
        low: float = 0.0
        high: float = V
        for _ in range(HALVINGS):
            v = 0.5 * (low + high)
            if scurve_length(v, A, J, E, R) > length:
                high = v
            else:
                low = v
        v = low
    cruise: float = length - scurve_length(v, A, J, E, R)
    Z[T_ROW] = 0.0
    Z[S_ROW] = 0.0
    Z[V_ROW] = 0.0
    Z[A_ROW] = 0.0
    for phase in range(PHASES):
        scurve_row(Z, phase + 1, R[phase], R[R_JERKS + phase])
    t: float = cruise / v if v > 0.0 else 0.0
    top: int = ROW * PHASES
    Z[top + A_ROW] = 0.0
    Z[top + ROW + T_ROW] = Z[top + T_ROW] + t
    Z[top + ROW + S_ROW] = Z[top + S_ROW] + cruise
    Z[top + ROW + V_ROW] = Z[top + V_ROW]
    Z[top + ROW + A_ROW] = 0.0
    for phase in range(PHASES):
        place: int = R_SIZE + PHASES - 1 - phase
        scurve_row(Z, PHASES + 2 + phase, R[place], R[R_JERKS + place])
    end: int = ROW * (MOST_ROWS - 1)
    Z[end + S_ROW] = length
    Z[end + V_ROW] = 0.0
    Z[end + A_ROW] = 0.0
    return MOST_ROWS


def scurve_row(Z: F64, row: int, t: float, j: float) -> None:
    """Write the row after t seconds of the jerk j."""
    i: int = ROW * row
    s: float = Z[i - ROW + S_ROW]
    v: float = Z[i - ROW + V_ROW]
    a: float = Z[i - ROW + A_ROW]
    Z[i + T_ROW] = Z[i - ROW + T_ROW] + t
    Z[i + S_ROW] = s + t * (v + t * (0.5 * a + t * j / 6.0))
    Z[i + V_ROW] = v + t * (a + 0.5 * j * t)
    Z[i + A_ROW] = a + j * t
