"""A course: the path of one chain of moves with its time law, evaluated at any time.

Three tables: `C` control points of the path (spline_cy.py), `Z` rows of the time law
(law_cy.py), and the head `H`, which says how they are to be read.
"""

from openacr.trajectory.course.law_cy import ROW, T_ROW, law_distance
from openacr.trajectory.path.spline_cy import spline_point
from openacr.views import F64

H_AXES = 0
H_POINTS = 1  # rows of C
H_STEP = 2  # distance between control points
H_ORIGIN = 3  # distance at which C begins
H_LENGTH = 4  # distance at which the path ends; very large while that is unknown
H_ROWS = 5  # rows of Z
H_START = 6  # first point of the path, then its last one
OPEN = 1e300

__all__ = ["course_add", "course_fill"]


def course_point(H: F64, C: F64, Z: F64, t: float, Q: F64, at: int) -> None:
    """Write where the course is at time t; at rest exactly the first or last point."""
    axes: int = int(H[H_AXES])
    s: float = law_distance(Z, int(H[H_ROWS]), t)
    if t <= Z[T_ROW] and s <= 0.0:
        for k in range(axes):
            Q[at + k] = H[H_START + k]
    elif s >= H[H_LENGTH] and t >= course_end_s(H, Z):
        for k in range(axes):
            Q[at + k] = H[H_START + axes + k]
    else:
        spline_point(C, int(H[H_POINTS]), axes, H[H_STEP], s - H[H_ORIGIN], Q, at)


def course_gone_u(H: F64, Z: F64, t: float) -> float:
    """The distance at time t, without swings before the start and after the end."""
    s: float = law_distance(Z, int(H[H_ROWS]), t)
    if s < 0.0:
        return 0.0
    return H[H_LENGTH] if s > H[H_LENGTH] else s


def course_end_s(H: F64, Z: F64) -> float:
    """The time of the last row of the law."""
    return Z[ROW * (int(H[H_ROWS]) - 1) + T_ROW]


def course_fill(
    H: F64, C: F64, Z: F64, t: float, period_s: float, count: int, X: F64, U: F64
) -> None:
    """Write the points at t, t + period ... to `count` rows of X, and their distances to U."""
    axes: int = int(H[H_AXES])
    for i in range(count):
        now: float = t + float(i) * period_s
        U[i] = course_gone_u(H, Z, now)
        course_point(H, C, Z, now, X, i * axes)


def course_add(
    H: F64, C: F64, Z: F64, t: float, period_s: float, count: int, X: F64, U: F64
) -> None:
    """Add displacements from the first point, at t, t + period ..., to X, and distances to U.

    X has room for one more row.
    """
    axes: int = int(H[H_AXES])
    room: int = count * axes
    for i in range(count):
        now: float = t + float(i) * period_s
        U[i] = U[i] + course_gone_u(H, Z, now)
        course_point(H, C, Z, now, X, room)
        for k in range(axes):
            X[i * axes + k] = X[i * axes + k] + (X[room + k] - H[H_START + k])
