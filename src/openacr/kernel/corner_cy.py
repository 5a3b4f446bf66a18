"""Rounded corners: how far the path leaves its corner, and where that puts the slaves.

With a path tolerance the corner between two straight moves is rounded from T before it to
T behind it. The path keeps its own distance s; only the position is lifted off the corner:

    p(s) = line(s) + (u2 - u1) g(|x|),      x = s - corner,  u1, u2 directions per unit of s
    p''(s) = (u2 - u1) w(x)                 w a window of area 1 over [-T, T], g'' = w

Without jerk the window is a box, which makes the corner a parabola: at constant speed its
acceleration is constant, the fastest way round a corner there is. With jerk it is a triangle.

    box        w = 1/(2T)           g = (T - x)^2 / (4T)      g(0) = T/4
    triangle   w = (1 - x/T)/T      g = (T - x)^3 / (6T^2)    g(0) = T/6

g(0) |u2 - u1| is how far the path stays off its corner: the tolerance gives T.
"""

from openacr.cmath import fabs
from openacr.map.numbers import (
    AXF_BASE,
    AXF_POSITION_CNT,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    MQF_BASE,
    MQF_DELTA_CNT,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MQI_BASE,
    MQI_SLAVES,
    MQI_STRIDE,
    MSF_BASE,
    MSF_CORNER_IN_CNT,
    MSF_CORNER_IN_TURN,
    MSF_CORNER_IN_U,
    MSF_CORNER_IN_UPS,
    MSF_CORNER_OUT_CNT,
    MSF_CORNER_OUT_TURN,
    MSF_CORNER_OUT_U,
    MSF_CORNER_OUT_UPS,
    MSF_STRIDE,
    MSI_BASE,
    MSI_CORNER_NEXT,
    MSI_CORNER_SMOOTH_IN,
    MSI_CORNER_SMOOTH_OUT,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
)
from openacr.views import F64, I32

SLAVE_COUNT = 16


def corner_lift(x: float, reach: float, smooth: int) -> float:
    """How far the path is lifted off at distance x from a corner rounded from `reach`."""
    left: float = reach - x
    if left <= 0.0 or reach <= 0.0:
        return 0.0
    if smooth:
        return left * left * left / (6.0 * reach * reach)
    return left * left / (4.0 * reach)


def corner_open(F: F64, I: I32, m: int, a: int, b: int, reach: float, smooth: int) -> None:
    """The path comes to the rounded corner between records a and b: note its two directions."""
    f: int = MSF_BASE + m * MSF_STRIDE
    p: int = MQF_BASE + a * MQF_STRIDE
    q: int = MQF_BASE + b * MQF_STRIDE
    first: int = I[MQI_BASE + a * MQI_STRIDE + MQI_SLAVES]
    second: int = I[MQI_BASE + b * MQI_STRIDE + MQI_SLAVES]
    for s in range(SLAVE_COUNT):
        turn: float = 0.0
        if second & (1 << s) and F[q + MQF_LENGTH_U] > 0.0:
            turn += F[q + MQF_DELTA_CNT + s] / F[q + MQF_LENGTH_U]
        if first & (1 << s) and F[p + MQF_LENGTH_U] > 0.0:
            turn -= F[p + MQF_DELTA_CNT + s] / F[p + MQF_LENGTH_U]
        F[f + MSF_CORNER_OUT_CNT + s] = turn
    F[f + MSF_CORNER_OUT_U] = reach
    I[MSI_BASE + m * MSI_STRIDE + MSI_CORNER_SMOOTH_OUT] = smooth


def corner_pass(F: F64, I: I32, m: int, record: int) -> None:
    """The move in front of a corner has ended; `record` is to leave it."""
    f: int = MSF_BASE + m * MSF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    I[i + MSI_CORNER_NEXT] = 0
    if F[f + MSF_CORNER_OUT_U] <= 0.0:
        return
    for s in range(SLAVE_COUNT):
        F[f + MSF_CORNER_IN_CNT + s] = F[f + MSF_CORNER_OUT_CNT + s]
    F[f + MSF_CORNER_IN_U] = F[f + MSF_CORNER_OUT_U]
    F[f + MSF_CORNER_IN_TURN] = F[f + MSF_CORNER_OUT_TURN]
    F[f + MSF_CORNER_IN_UPS] = F[f + MSF_CORNER_OUT_UPS]
    F[f + MSF_CORNER_OUT_U] = 0.0
    I[i + MSI_CORNER_SMOOTH_IN] = I[i + MSI_CORNER_SMOOTH_OUT]
    I[i + MSI_CORNER_NEXT] = record + 1


def corner_enter(F: F64, I: I32, m: int, record: int) -> None:
    """A move begins: behind its corner from the corner itself, else from where the axes are."""
    f: int = MSF_BASE + m * MSF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    F[f + MSF_CORNER_OUT_U] = 0.0
    if I[i + MSI_CORNER_NEXT] != record + 1:
        F[f + MSF_CORNER_IN_U] = 0.0
    elif F[f + MSF_CORNER_IN_U] > 0.0:
        for s in range(SLAVE_COUNT):
            axis: int = I[i + MSI_SLAVE_AXIS + s]
            if axis >= 0 and F[f + MSF_CORNER_IN_CNT + s] != 0.0:
                a: int = AXF_BASE + axis * AXF_STRIDE
                F[a + AXF_POSITION_CNT] = F[a + AXF_TARGET_CNT]
    I[i + MSI_CORNER_NEXT] = 0


def corner_drop(F: F64, I: I32, m: int) -> None:
    """No corner is under way any more."""
    F[MSF_BASE + m * MSF_STRIDE + MSF_CORNER_IN_U] = 0.0
    F[MSF_BASE + m * MSF_STRIDE + MSF_CORNER_OUT_U] = 0.0
    I[MSI_BASE + m * MSI_STRIDE + MSI_CORNER_NEXT] = 0


def corner_place(F: F64, I: I32, m: int, slaves: int, gone: float, left: float) -> None:
    """Lift the slaves off the corners in front of and behind the path.

    Those of `slaves` stand where the present move puts them, the others at their targets.
    """
    f: int = MSF_BASE + m * MSF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    if F[f + MSF_CORNER_IN_U] <= 0.0 and F[f + MSF_CORNER_OUT_U] <= 0.0:
        return
    behind: float = corner_lift(gone, F[f + MSF_CORNER_IN_U], I[i + MSI_CORNER_SMOOTH_IN])
    ahead: float = corner_lift(left, F[f + MSF_CORNER_OUT_U], I[i + MSI_CORNER_SMOOTH_OUT])
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        turn: float = 0.0
        lift: float = 0.0
        if F[f + MSF_CORNER_IN_U] > 0.0:
            turn = fabs(F[f + MSF_CORNER_IN_CNT + s])
            lift = behind * F[f + MSF_CORNER_IN_CNT + s]
        if F[f + MSF_CORNER_OUT_U] > 0.0:
            turn += fabs(F[f + MSF_CORNER_OUT_CNT + s])
            lift += ahead * F[f + MSF_CORNER_OUT_CNT + s]
        if axis >= 0 and turn > 0.0:
            a: int = AXF_BASE + axis * AXF_STRIDE
            if not slaves & (1 << s):
                F[a + AXF_POSITION_CNT] = F[a + AXF_TARGET_CNT]
            F[a + AXF_POSITION_CNT] += lift
