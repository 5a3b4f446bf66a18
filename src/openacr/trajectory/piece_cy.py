"""Lines, arcs and helices as rows of numbers, and points on them.

A row of `E` holds length, axes of the circle (or -1), centre, radii at both ends, angle of the
start, sweep,
tolerance, feed, and the start and end points. Distances below 0 and above the length continue
the curve.
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

__all__ = ["piece_point", "pieces_sample"]


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


def tube_narrow(R: F64, i: int, cut: float) -> None:
    """Take a distance off a radius, of which a tenth at least is left."""
    left: float = R[i] - cut
    R[i] = left if left > 0.1 * R[i] else 0.1 * R[i]


def pieces_sample(
    E: F64,
    pieces: int,
    axes: int,
    origin: float,
    first: int,
    count: int,
    step: float,
    share: float,
    X: F64,
    R: F64,
    G: F64,
) -> int:
    """Sample a chain at the distances first*step, (first+1)*step ... from its start.

    The first piece begins at `origin`. Writes points to X, the radius of the tube to R (a share
    of the tolerance), and to G the number of the
    piece of an arc plus 1, 0 on lines. Returns the number of the piece of the last sample.
    """
    size: int = E_POINTS + 2 * axes
    piece: int = 0
    gone: float = origin
    for i in range(count):
        s: float = float(first + i) * step
        before: int = piece
        while piece + 1 < pieces and s > gone + E[piece * size + E_LENGTH]:
            gone += E[piece * size + E_LENGTH]
            piece += 1
        o: int = piece * size
        piece_point(E, o, axes, s - gone, X, i * axes)
        R[i] = share * E[o + E_TOLERANCE]
        G[i] = float(piece + 1) if E[o + E_FIRST] >= 0.0 else 0.0
        for n in range(before + 1, piece + 1):
            if i > 0:  # the samples cut a vertex off: that much of the tube is used up
                cut: float = distance_to_line(
                    E, n * size + E_POINTS, X, (i - 1) * axes, i * axes, axes
                )
                tube_narrow(R, i - 1, cut)
                tube_narrow(R, i, cut)
    return piece
