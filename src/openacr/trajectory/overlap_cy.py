"""Two courses overlapped in time at a sharp corner.

Each comes to rest at the corner on its own path; the second one starts `tau` before the first
has ended,
and their displacements are added. Near the corner, with both in the phase of the jerk Je,

    velocity = f u1 + g u2,   f = Je (tau/2 - t)^2/2,   g = Je (tau/2 + t)^2/2,   |t| <= tau/2

so that the jerk is Je (u1 + u2) and the tool passes the corner at the distance

    d = |u2 - u1| Je tau^3 / 48

Setpoints are control points of a B-spline in time with the knots D apart (setpoints.py), which adds
D^2/6 of the acceleration. Ends may swing out first (end_law.py). The longest tau that keeps the
tolerance and every limit is found by trying, with the sums of both courses on the grid on which
they are sent.
"""

from openacr.cmath import fabs, floor, sqrt
from openacr.trajectory.course_cy import H_AXES, H_START, course_end_s, course_point
from openacr.trajectory.piece_cy import distance_to_line
from openacr.views import F64

P_PERIOD = 0  # D
P_BEGIN = 1  # time of the stream at which the first course begins
P_TOLERANCE = 2
P_SPEED = 3  # highest speed along the path
P_TOOL = 4  # highest speed of the axes that carry the tool
P_LONGEST = 5  # longest overlap to be tried
P_AXES = 6  # velocities, accelerations, jerks, and 1 where the tool is carried: one per axis each
AROUND = 4  # points before and after the overlap that are examined
NEARLY = 1.0 + 1e-9
SCANS = 24  # from above: ends that swing out fit at long overlaps, and hardly at shorter ones
TRIES = 8

__all__ = ["overlap_time"]


def points_keep_limits(X: F64, count: int, axes: int, P: F64) -> int:
    """Whether `count` control points keep the speeds and the limits of every axis."""
    D: float = P[P_PERIOD]
    for i in range(count - 1):
        along2: float = 0.0
        tool2: float = 0.0
        for k in range(axes):
            o: int = i * axes + k
            d0: float = X[o + axes] - X[o]
            along2 += d0 * d0
            tool2 += P[P_AXES + 3 * axes + k] * d0 * d0
            if fabs(d0) > P[P_AXES + k] * D * NEARLY:
                return 0
            if i + 2 < count:
                d1: float = X[o + 2 * axes] - X[o + axes]
                if fabs(d1 - d0) > P[P_AXES + axes + k] * D * D * NEARLY:
                    return 0
                if i + 3 < count:
                    d2: float = X[o + 3 * axes] - X[o + 2 * axes]
                    bend: float = fabs(d2 - 2.0 * d1 + d0)
                    if bend > P[P_AXES + 2 * axes + k] * D * D * D * NEARLY + 1e-12:
                        return 0
        if sqrt(along2) > P[P_SPEED] * D * NEARLY or sqrt(tool2) > P[P_TOOL] * D * NEARLY:
            return 0
    return 1


def points_are_near(
    X: F64, count: int, axes: int, vertex: F64, N: F64, lines: int, off: float, Q: F64
) -> int:
    """Whether the B-spline of control points is nowhere further than `off` from a polyline N.

    It is examined at its knots and between them. The vertex may not be further from it, either.
    """
    nearest: float = 1e300
    for i in range(2 * count - 5):
        o: int = (i >> 1) * axes
        for k in range(axes):
            Q[k] = Q[axes + k]
            if i & 1:
                Q[axes + k] = (
                    X[o + k] + 23.0 * (X[o + axes + k] + X[o + 2 * axes + k]) + X[o + 3 * axes + k]
                ) / 48.0
            else:
                Q[axes + k] = (X[o + k] + 4.0 * X[o + axes + k] + X[o + 2 * axes + k]) / 6.0
        least: float = 1e300
        for n in range(lines):
            apart: float = distance_to_line(Q, axes, N, n * axes, (n + 1) * axes, axes)
            if apart < least:
                least = apart
        if least > off:
            return 0
        if i > 0:
            apart = distance_to_line(vertex, H_START, Q, 0, axes, axes)
            if apart < nearest:
                nearest = apart
    return 1 if nearest <= off else 0


def overlap_fits(
    H: F64,
    C: F64,
    Z: F64,
    HN: F64,
    CN: F64,
    ZN: F64,
    N: F64,
    lines: int,
    P: F64,
    tau: float,
    X: F64,
    Q: F64,
) -> int:
    """Whether two courses may overlap by tau; the examined sums are left in X."""
    axes: int = int(H[H_AXES])
    D: float = P[P_PERIOD]
    end: float = P[P_BEGIN] + course_end_s(H, Z)
    first: float = floor((end - tau) / D) - float(AROUND)
    count: int = int(floor(end / D) - first) + AROUND + 2
    for i in range(count):
        t: float = (first + float(i)) * D
        course_point(H, C, Z, t - P[P_BEGIN], Q, 0)
        course_point(HN, CN, ZN, t - (end - tau), Q, axes)
        for k in range(axes):
            X[i * axes + k] = Q[k] + (Q[axes + k] - HN[H_START + k])
    if not points_keep_limits(X, count, axes, P):
        return 0
    return points_are_near(X, count, axes, HN, N, lines, P[P_TOLERANCE], Q)


def overlap_time(
    H: F64, C: F64, Z: F64, HN: F64, CN: F64, ZN: F64, N: F64, lines: int, P: F64, X: F64, Q: F64
) -> float:
    """The longest time by which the course HN, CN, ZN may begin before H, C, Z has ended, s.

    X has room for the points of the longest overlap and 12 more, Q for four.
    """
    longest: float = P[P_LONGEST]
    high: float = longest
    low: float = longest
    for n in range(1, SCANS):
        if overlap_fits(H, C, Z, HN, CN, ZN, N, lines, P, low, X, Q):
            break
        high = low
        low = longest * (1.0 - float(n) / float(SCANS))
    else:
        low = 0.0
    if low == longest:
        return low
    for _ in range(TRIES):
        tau: float = 0.5 * (low + high)
        if overlap_fits(H, C, Z, HN, CN, ZN, N, lines, P, tau, X, Q):
            low = tau
        else:
            high = tau
    return low
