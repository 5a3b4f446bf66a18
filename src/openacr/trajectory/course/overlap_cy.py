"""Two courses overlapped in time at a sharp corner.

Each comes to rest at the corner on its own path. The second begins `tau` before the first has
ended, and their displacements are added. Near the corner, with both in the phase of the jerk Je,

    velocity = f u1 + g u2,   f = Je (tau/2 - t)^2/2,   g = Je (tau/2 + t)^2/2,   |t| <= tau/2

so that the jerk is Je (u1 + u2), and the tool passes the corner at the distance

    d = |u2 - u1| Je tau^3 / 48

Setpoints are control points of a B-spline in time with the knots D apart (setpoints.py), which adds
D^2/6 of the acceleration. Ends may swing out first (end_law.py). The longest tau that keeps the
tolerance and every limit is found by trying, with the sums of both courses on the grid on which
they are sent.

`P`: numbers, then what has a number for each axis: limits, room, the programmed path around the
corner, the sums.
"""

from openacr.cmath import fabs, floor, sqrt
from openacr.trajectory.course.course_cy import H_AXES, H_START, course_end_s, course_point
from openacr.trajectory.path.piece_cy import distance_to_line
from openacr.views import F64

P_PERIOD_S = 0  # D
P_BEGIN_S = 1  # time of the stream at which the first course begins
P_TOLERANCE_U = 2
P_SPEED_UPS = 3  # highest speed along the path
P_TOOL_UPS = 4  # highest speed of the axes that carry the tool
P_LONGEST_S = 5  # longest overlap to be tried
P_LINES = 6  # lines of the programmed path around the corner
P_LIMITS = 7  # velocities, accelerations, jerks, and 1 where the tool is carried: by axis each
LIMITS = 4
ROOM = 4  # for points of which something is computed
AROUND = 4  # points before and after the overlap that are examined
NEARLY = 1.0 + 1e-9
SCANS = 24  # from above: ends that swing out fit at long overlaps, and hardly at shorter ones
TRIES = 8

__all__ = ["overlap_time"]


def overlap_room(axes: int) -> int:
    """Where room for ROOM points begins in P."""
    return P_LIMITS + LIMITS * axes


def overlap_near(axes: int) -> int:
    """Where the programmed path around the corner begins in P, point after point."""
    return overlap_room(axes) + ROOM * axes


def overlap_sums(P: F64, axes: int) -> int:
    """Where the sums of both courses begin in P, point after point."""
    return overlap_near(axes) + (int(P[P_LINES]) + 1) * axes


def points_keep_limits(P: F64, axes: int, count: int) -> int:
    """Whether the first `count` sums keep the speeds and the limits of every axis."""
    sums: int = overlap_sums(P, axes)
    D: float = P[P_PERIOD_S]
    for i in range(count - 1):
        along2: float = 0.0
        tool2: float = 0.0
        for k in range(axes):
            o: int = sums + i * axes + k
            d0: float = P[o + axes] - P[o]
            along2 += d0 * d0
            tool2 += P[P_LIMITS + 3 * axes + k] * d0 * d0
            if fabs(d0) > P[P_LIMITS + k] * D * NEARLY:
                return 0
            if i + 2 < count:
                d1: float = P[o + 2 * axes] - P[o + axes]
                if fabs(d1 - d0) > P[P_LIMITS + axes + k] * D * D * NEARLY:
                    return 0
                if i + 3 < count:
                    d2: float = P[o + 3 * axes] - P[o + 2 * axes]
                    bend: float = fabs(d2 - 2.0 * d1 + d0)
                    if bend > P[P_LIMITS + 2 * axes + k] * D * D * D * NEARLY + 1e-12:
                        return 0
        if sqrt(along2) > P[P_SPEED_UPS] * D * NEARLY or sqrt(tool2) > P[P_TOOL_UPS] * D * NEARLY:
            return 0
    return 1


def points_are_near(P: F64, axes: int, count: int, vertex: F64) -> int:
    """Whether the B-spline of the first `count` sums keeps the tolerance of the programmed path.

    It is examined at its knots and between them. The vertex may not be further from it, either.
    """
    off: float = P[P_TOLERANCE_U]
    sums: int = overlap_sums(P, axes)
    near: int = overlap_near(axes)
    before: int = overlap_room(axes)
    now: int = before + axes
    nearest: float = 1e300
    for i in range(2 * count - 5):
        for k in range(axes):
            o: int = sums + (i >> 1) * axes + k
            P[before + k] = P[now + k]
            if i & 1:
                P[now + k] = (
                    P[o] + 23.0 * (P[o + axes] + P[o + 2 * axes]) + P[o + 3 * axes]
                ) / 48.0
            else:
                P[now + k] = (P[o] + 4.0 * P[o + axes] + P[o + 2 * axes]) / 6.0
        least: float = 1e300
        for n in range(int(P[P_LINES])):
            line: int = near + n * axes
            apart: float = distance_to_line(P, now, P, line, line + axes, axes)
            if apart < least:
                least = apart
        if least > off:
            return 0
        if i > 0:
            apart = distance_to_line(vertex, H_START, P, before, now, axes)
            if apart < nearest:
                nearest = apart
    return 1 if nearest <= off else 0


def overlap_fits(H: F64, C: F64, Z: F64, HN: F64, CN: F64, ZN: F64, P: F64, tau: float) -> int:
    """Whether two courses may overlap by tau; the examined sums are left in P."""
    axes: int = int(H[H_AXES])
    D: float = P[P_PERIOD_S]
    one: int = overlap_room(axes)
    other: int = one + axes
    end: float = P[P_BEGIN_S] + course_end_s(H, Z)
    first: float = floor((end - tau) / D) - float(AROUND)
    count: int = int(floor(end / D) - first) + AROUND + 2
    for i in range(count):
        t: float = (first + float(i)) * D
        course_point(H, C, Z, t - P[P_BEGIN_S], P, one)
        course_point(HN, CN, ZN, t - (end - tau), P, other)
        sums: int = overlap_sums(P, axes) + i * axes
        for k in range(axes):
            P[sums + k] = P[one + k] + (P[other + k] - HN[H_START + k])
    if not points_keep_limits(P, axes, count):
        return 0
    return points_are_near(P, axes, count, HN)


def overlap_time(H: F64, C: F64, Z: F64, HN: F64, CN: F64, ZN: F64, P: F64) -> float:
    """The longest time by which the course HN, CN, ZN may begin before H, C, Z has ended, s.

    P has room for the sums of the longest overlap and 12 more.
    """
    longest: float = P[P_LONGEST_S]
    high: float = longest
    low: float = longest
    for n in range(1, SCANS):
        if overlap_fits(H, C, Z, HN, CN, ZN, P, low):
            break
        high = low
        low = longest * (1.0 - float(n) / float(SCANS))
    else:
        low = 0.0
    if low == longest:
        return low
    for _ in range(TRIES):
        tau: float = 0.5 * (low + high)
        if overlap_fits(H, C, Z, HN, CN, ZN, P, tau):
            low = tau
        else:
            high = tau
    return low
