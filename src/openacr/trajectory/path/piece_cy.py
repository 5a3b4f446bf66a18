"""Lines, arcs and helices as rows of numbers, and points on them.

A row of `E` holds length, axes of the circle (or -1), centre, radii at both ends, angle of the
start, sweep, tolerance, feed, and the start and end points. Distances below 0 and above the length
continue the curve.
"""

from openacr.cmath import cos, sin, sqrt
from openacr.views import F64

E_LENGTH = 0
E_FIRST = 1  # axis, -1 for a line
E_SECOND = 2
E_CENTRE = 3  # on both axes
E_RADIUS = 5
E_RADIUS_END = 6
E_ANGLE = 7
E_SWEEP = 8
E_TOLERANCE = 9
E_FEED = 10
E_POINTS = 11  # start, then end

__all__ = ["piece_point"]


def piece_point(E: F64, o: int, axes: int, s: float, Q: F64, at: int) -> None:
    """Write the point at distance s of the piece E[o] ... to Q[at], one number per axis."""
    share: float = s / E[o + E_LENGTH]
    for k in range(axes):
        start: float = E[o + E_POINTS + k]
        Q[at + k] = start + (E[o + E_POINTS + axes + k] - start) * share
    if E[o + E_FIRST] >= 0.0:
        r: float = E[o + E_RADIUS] + (E[o + E_RADIUS_END] - E[o + E_RADIUS]) * share
        angle: float = E[o + E_ANGLE] + E[o + E_SWEEP] * share
        Q[at + int(E[o + E_FIRST])] = E[o + E_CENTRE] + r * cos(angle)
        Q[at + int(E[o + E_SECOND])] = E[o + E_CENTRE + 1] + r * sin(angle)


def distance_to_line(Q: F64, at: int, N: F64, a: int, b: int, axes: int) -> float:
    """The distance of a point from the line between the points N[a] and N[b]."""
    along: float = 0.0
    length2: float = 0.0
    for k in range(axes):
        d: float = N[b + k] - N[a + k]
        along += (Q[at + k] - N[a + k]) * d
        length2 += d * d
    share: float = along / length2 if length2 > 0.0 else 0.0
    if share < 0.0:
        share = 0.0
    if share > 1.0:
        share = 1.0
    off2: float = 0.0
    for k in range(axes):
        off: float = Q[at + k] - (N[a + k] + share * (N[b + k] - N[a + k]))
        off2 += off * off
    return sqrt(off2)
