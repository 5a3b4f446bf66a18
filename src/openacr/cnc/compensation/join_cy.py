"""Where the tool goes from one element of a chain to the next.

Element i ends at the corner P with the tangent t1, element j leaves it with t2. The tool
beside them stands at the feet q1 = P + d1 n(t1) and q2 = P + d2 n(t2). With c = t1 x t2:

    d c < 0   outside: the tool rolls about P, from q1 to q2
    d c > 0   inside: it can reach neither foot; it turns where both paths cross

The paths are taken as whole lines and circles. With a circle of radius R' around C:

    and a line at the distance h from C: foot of C on the line -+ sqrt(R'^2 - h^2) along it
    and a circle of radius S' around D = C + L u: C + a u -+ sqrt(R'^2 - a^2) n(u),
        a = (L^2 + R'^2 - S'^2) / 2L

The differences of squares are computed as products, which keeps all digits near tangency.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    PI,
    RADIUS,
    ROLL,
    SHORTEST,
    SWEEP,
    T0X,
    T0Y,
    T1X,
    T1Y,
    TOOL_RADIUS,
    X0,
    X1,
    Y0,
    Y1,
    comp_beyond,
    comp_fit,
    comp_length,
)
from openacr.views import F64

__all__ = ["comp_join", "comp_meet"]

# what comp_join found
JOINED = 0
CROSSING = 1
ROUND = 2  # an arc about P is to be inserted
BRIDGE = 3  # a line is to be inserted: the distances differ
GAP = 4  # a line is to be inserted: the paths do not cross
APART = 5  # the paths do not even come near each other
FORCED = 6  # the paths cross by the root epsilon only

FIT_STEP = 8  # comp_meet adds this many times what comp_fit found

PARALLEL = 1.0e-9
FAR = 1.0e30


def comp_meet(
    F: F64, i: int, j: int, epsilon: float, sweep_epsilon: float, root: float, is_inside: bool
) -> int:
    """Join two elements and check whether the tool's path beside the first one fits."""
    meets: int = comp_join(F, i, j, epsilon, root, is_inside)
    if meets == ROUND:
        F[i + ROLL] = _comp_rolled(F, i, j)
    return meets + FIT_STEP * comp_fit(F, i, epsilon, sweep_epsilon)


def _comp_rolled(F: F64, i: int, j: int) -> float:
    """The sweep of a tool that rolls about P: clockwise where it is on the left."""
    sx: float = F[i + BX] - F[i + X1]
    sy: float = F[i + BY] - F[i + Y1]
    ex: float = F[j + AX] - F[i + X1]
    ey: float = F[j + AY] - F[i + Y1]
    turn: float = -1.0 if F[i + AWAY] > 0.0 else 1.0
    angle: float = turn * atan2(sx * ey - sy * ex, sx * ex + sy * ey)
    if angle < 0.0:
        angle = angle + 2.0 * PI
    return turn * angle


def comp_join(F: F64, i: int, j: int, epsilon: float, root: float, is_inside: bool) -> int:
    """Set the end of the tool's path beside i and its start beside j; say how they meet.

    `is_inside` where elements between them were left out: the tool does not reach P there.
    """
    d1: float = F[i + AWAY]
    d2: float = F[j + AWAY]
    q1x: float = F[i + X1] - d1 * F[i + T1Y]
    q1y: float = F[i + Y1] + d1 * F[i + T1X]
    q2x: float = F[j + X0] - d2 * F[j + T0Y]
    q2y: float = F[j + Y0] + d2 * F[j + T0X]
    c: float = F[i + T1X] * F[j + T0Y] - F[i + T1Y] * F[j + T0X]
    along: float = F[i + T1X] * F[j + T0X] + F[i + T1Y] * F[j + T0Y]
    gap: float = comp_length(q2x - q1x, q2y - q1y)
    F[i + BX] = q1x
    F[i + BY] = q1y
    F[j + AX] = q2x
    F[j + AY] = q2y
    if (gap <= epsilon and along > 0.0) or gap <= SHORTEST:
        F[j + AX] = q1x
        F[j + AY] = q1y
        return JOINED
    if d1 * d2 < 0.0:
        return BRIDGE
    if is_inside or _comp_is_inside(F, i, j, (d1 + d2), c, along):
        return _comp_cross(F, i, j, c, epsilon, root)
    if d1 == d2 and (fabs(c) >= PARALLEL or along < 0.0):
        return ROUND
    return BRIDGE


def _comp_is_inside(F: F64, i: int, j: int, d: float, c: float, along: float) -> bool:
    """Whether the tool is between the elements.

    Where j goes straight back, their curvature decides: seen from P along t2, element i
    has the curvature -k1 and element j k2, and the tool is on the side d of j.
    """
    if fabs(c) >= PARALLEL:
        return d * c > 0.0
    if along > 0.0:
        return False
    return d * (_comp_curvature(F, i) + _comp_curvature(F, j)) < -PARALLEL


def _comp_curvature(F: F64, i: int) -> float:
    if F[i + SWEEP] == 0.0:
        return 0.0
    return 1.0 / F[i + RADIUS] if F[i + SWEEP] > 0.0 else -1.0 / F[i + RADIUS]


def _comp_cross(F: F64, i: int, j: int, c: float, epsilon: float, root: float) -> int:
    """Let both ways end where they cross; see the table of pairs in the module."""
    if F[i + SWEEP] == 0.0 and F[j + SWEEP] == 0.0:
        return _comp_lines(F, i, j, c, epsilon)
    if F[i + SWEEP] == 0.0:
        return _comp_line_circle(F, i, j, i, j, epsilon, root)
    if F[j + SWEEP] == 0.0:
        return _comp_line_circle(F, i, j, j, i, epsilon, root)
    return _comp_circles(F, i, j, epsilon, root)


def _comp_lines(F: F64, i: int, j: int, c: float, epsilon: float) -> int:
    dx: float = F[j + AX] - F[i + BX]
    dy: float = F[j + AY] - F[i + BY]
    if fabs(c) < PARALLEL:  # only where elements were left out
        s: float = dx * F[j + T0X] + dy * F[j + T0Y]
        x: float = F[j + AX] - s * F[j + T0X]
        y: float = F[j + AY] - s * F[j + T0Y]
        return _comp_gap(F, i, j, F[i + BX], F[i + BY], x, y, epsilon)
    u: float = (dx * F[j + T0Y] - dy * F[j + T0X]) / c
    return _comp_at(F, i, j, F[i + BX] + u * F[i + T1X], F[i + BY] + u * F[i + T1Y])


def _comp_line_circle(
    F: F64, i: int, j: int, line: int, arc: int, epsilon: float, root: float
) -> int:
    tx: float = F[line + T0X]
    ty: float = F[line + T0Y]
    px: float = F[line + X0] - F[line + AWAY] * ty
    py: float = F[line + Y0] + F[line + AWAY] * tx
    s: float = (F[arc + CX] - px) * tx + (F[arc + CY] - py) * ty
    fx: float = px + s * tx
    fy: float = py + s * ty
    distance: float = comp_length(fx - F[arc + CX], fy - F[arc + CY])
    radius: float = F[arc + TOOL_RADIUS]
    square: float = (radius - distance) * (radius + distance)
    if square > -root:
        h: float = sqrt(square) if square > 0.0 else 0.0
        _comp_choose(F, i, j, fx - h * tx, fy - h * ty, fx + h * tx, fy + h * ty, epsilon)
        return FORCED if distance - radius > epsilon else CROSSING
    gx: float = F[arc + CX] + (fx - F[arc + CX]) * radius / distance
    gy: float = F[arc + CY] + (fy - F[arc + CY]) * radius / distance
    if line == i:
        return _comp_gap(F, i, j, fx, fy, gx, gy, epsilon)
    return _comp_gap(F, i, j, gx, gy, fx, fy, epsilon)


def _comp_circles(F: F64, i: int, j: int, epsilon: float, root: float) -> int:
    ux: float = F[j + CX] - F[i + CX]
    uy: float = F[j + CY] - F[i + CY]
    distance: float = comp_length(ux, uy)
    r1: float = F[i + TOOL_RADIUS]
    r2: float = F[j + TOOL_RADIUS]
    if distance < SHORTEST:  # about one centre: never crossing
        return _comp_gap(F, i, j, F[i + BX], F[i + BY], F[j + AX], F[j + AY], epsilon)
    ux = ux / distance
    uy = uy / distance
    a: float = 0.5 * (distance + (r1 - r2) * (r1 + r2) / distance)
    square: float = (r1 - a) * (r1 + a)
    fx: float = F[i + CX] + a * ux
    fy: float = F[i + CY] + a * uy
    if square > -root:
        h: float = sqrt(square) if square > 0.0 else 0.0
        _comp_choose(F, i, j, fx - h * uy, fy + h * ux, fx + h * uy, fy - h * ux, epsilon)
        return FORCED if fabs(a) - r1 > epsilon else CROSSING
    # Nearest on the line of centres: between the circles, or beyond the inner one.
    side: float = 1.0
    other: float = -1.0
    if distance < fabs(r1 - r2):
        side = 1.0 if r1 > r2 else -1.0
        other = side
    return _comp_gap(
        F,
        i,
        j,
        F[i + CX] + side * r1 * ux,
        F[i + CY] + side * r1 * uy,
        F[j + CX] + other * r2 * ux,
        F[j + CY] + other * r2 * uy,
        epsilon,
    )


def _comp_choose(
    F: F64, i: int, j: int, ax: float, ay: float, bx: float, by: float, epsilon: float
) -> None:
    """Take the crossing nearest to P of those before the end of i and after the start of j."""
    a: float = _comp_cost(F, i, j, ax, ay, epsilon)
    b: float = _comp_cost(F, i, j, bx, by, epsilon)
    if a <= b:
        _comp_at(F, i, j, ax, ay)
    else:
        _comp_at(F, i, j, bx, by)


def _comp_cost(F: F64, i: int, j: int, x: float, y: float, epsilon: float) -> float:
    beyond: float = comp_beyond(F, i, True, x, y)
    before: float = -comp_beyond(F, j, False, x, y)
    if F[i + SWEEP] != 0.0:
        beyond = beyond * F[i + TOOL_RADIUS]
    if F[j + SWEEP] != 0.0:
        before = before * F[j + TOOL_RADIUS]
    distance: float = comp_length(
        x - 0.5 * (F[i + X1] + F[j + X0]), y - 0.5 * (F[i + Y1] + F[j + Y0])
    )
    return distance if beyond <= epsilon and before <= epsilon else FAR + distance * FAR


def _comp_at(F: F64, i: int, j: int, x: float, y: float) -> int:
    F[i + BX] = x
    F[i + BY] = y
    F[j + AX] = x
    F[j + AY] = y
    return CROSSING


def _comp_gap(
    F: F64, i: int, j: int, ax: float, ay: float, bx: float, by: float, epsilon: float
) -> int:
    """The paths end where they are nearest to each other."""
    gap: float = comp_length(bx - ax, by - ay)
    radius: float = fabs(F[i + AWAY])
    if fabs(F[j + AWAY]) > radius:
        radius = fabs(F[j + AWAY])
    if gap > 2.0 * epsilon and gap > radius:
        return APART
    F[i + BX] = ax
    F[i + BY] = ay
    F[j + AX] = bx
    F[j + AY] = by
    if gap > 2.0 * epsilon:
        return GAP
    F[j + AX] = ax
    F[j + AY] = ay
    return JOINED
