"""Arcs in their plane: centre, radii and sweep, of numbers alone.

With the chord from the start a to the end z, |z - a| = c, and a radius R:

    centre   m = (a + z) / 2 + sqrt(R^2 - c^2 / 4) n      n: unit normal of the chord, to its left
                                                          for short arcs to the left
    radii    |a - m|, |z - m|
    sweep    angle(z - m) - angle(a - m), in (0, 2 pi] in the direction of the arc

An arc begins at an index `i` of F (`rows/arcs.py`): its ends and centre, then what is computed
of them.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.cnc.rows import arcs
from openacr.views import F64

__all__ = ["arc_about", "arc_centre", "arc_is_near"]

ARC_DONE = 0
ARC_SAME = 1  # start and end are one point
ARC_APART = 2  # the ends are farther apart than two radii
ARC_SMALL = 3  # the centre is on the start or on the end

ARC_NEAREST = 1.0e-6  # units: points closer than this are equal
ARC_NO_TURN = 1.0e-12  # radians
ARC_TURN = 6.283185307179586
ZX = 18  # planes; 17 is XY
YZ = 19
NEAR_SHARE = 0.001  # of the larger radius: radii are equal within it


def arc_distance(x0: float, y0: float, x1: float, y1: float) -> float:
    """The distance of two points of the plane."""
    return sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))


def arc_centre(F: F64, i: int, radius: float, direction: int, epsilon: float) -> int:
    """Find the centre by the radius, negative for arcs of more than half a turn."""
    dx: float = F[i + arcs.X1] - F[i + arcs.X0]
    dy: float = F[i + arcs.Y1] - F[i + arcs.Y0]
    chord: float = sqrt(dx * dx + dy * dy)
    if chord < ARC_NEAREST:
        return ARC_SAME
    if chord > 2.0 * fabs(radius) + epsilon:
        return ARC_APART
    square: float = radius * radius - chord * chord / 4.0
    height: float = sqrt(square) if square > 0.0 else 0.0
    side: float = height / chord
    if (direction < 0) != (radius < 0.0):
        side = -side
    F[i + arcs.CX] = (F[i + arcs.X0] + F[i + arcs.X1]) / 2.0 - dy * side
    F[i + arcs.CY] = (F[i + arcs.Y0] + F[i + arcs.Y1]) / 2.0 + dx * side
    return ARC_DONE


def arc_about(F: F64, i: int, direction: int) -> int:
    """Find radii and sweep of an arc with its centre."""
    F[i + arcs.R0] = arc_distance(F[i + arcs.X0], F[i + arcs.Y0], F[i + arcs.CX], F[i + arcs.CY])
    F[i + arcs.R1] = arc_distance(F[i + arcs.X1], F[i + arcs.Y1], F[i + arcs.CX], F[i + arcs.CY])
    if F[i + arcs.R0] < ARC_NEAREST or F[i + arcs.R1] < ARC_NEAREST:
        return ARC_SMALL
    turn: float = 0.0
    if arc_distance(F[i + arcs.X0], F[i + arcs.Y0], F[i + arcs.X1], F[i + arcs.Y1]) >= ARC_NEAREST:
        turn = atan2(F[i + arcs.Y1] - F[i + arcs.CY], F[i + arcs.X1] - F[i + arcs.CX])
        turn -= atan2(F[i + arcs.Y0] - F[i + arcs.CY], F[i + arcs.X0] - F[i + arcs.CX])
    if direction < 0:
        turn = -turn
    if fabs(turn) < ARC_NO_TURN:
        turn = ARC_TURN
    elif turn < 0.0:
        turn += ARC_TURN
    F[i + arcs.SWEEP_RAD] = -turn if direction < 0 else turn
    return ARC_DONE


def arc_is_near(one: float, other: float, near_u: float) -> bool:
    """Whether two radii are equal, as rounded numbers are."""
    larger: float = one if one > other else other
    share: float = NEAR_SHARE * larger
    return fabs(one - other) <= (near_u if near_u > share else share)


def plane_first(plane: int) -> int:
    """The first axis of a plane."""
    if plane == ZX:
        return 2
    return 1 if plane == YZ else 0


def plane_second(plane: int) -> int:
    """The second axis of a plane."""
    if plane == ZX:
        return 0
    return 2 if plane == YZ else 1
