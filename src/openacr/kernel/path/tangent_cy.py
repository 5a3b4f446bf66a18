"""TANG along curves: an axis in degrees that looks where the first two slaves go.

At a part f of the path it stands at

    tangent(f) + offset - lag (1 - f),

the full turn chosen nearest to where it is. `lag` is what it was off at the beginning by
less than the turn limit. Row `tang` of a move holds: units per pulse of the two slaves,
pulses per degree of the axis, offset and lag in degrees.
"""

from openacr.cmath import atan2, rint
from openacr.kernel.path.bezier_cy import bezier_slope, is_bezier
from openacr.kernel.path.curve_cy import DEGREES, curve_slope
from openacr.map.rows import axes, masters, moves
from openacr.views import F64, I32

__all__ = ["tangent_deg"]

UNITS_0 = 0
UNITS_1 = 1
SCALE = 2
OFFSET_DEG = 3
LAG_DEG = 4
BESIDE = 1e-6  # at its very ends a spline stands still


def tangent_slope(F: F64, I: I32, record: int, s: int, part: float) -> float:
    """Change of slave s with the parameter of its curve, in pulses."""
    if not I[moves.slaves[record]] & (1 << s):
        return 0.0
    if not I[moves.curved[record]] & (1 << s):
        return F[moves.delta_cnt[record] + s]
    if is_bezier(I, record):
        return bezier_slope(F, I, record, s, part + (0.5 - part) * BESIDE)
    return curve_slope(F, I, record, s, part)


def tangent_deg(F: F64, I: I32, record: int, x_unit: float, y_unit: float, part: float) -> float:
    """Direction of the first two slaves at a parameter of the curve, -1000 without any."""
    x: float = tangent_slope(F, I, record, 0, part) * x_unit
    y: float = tangent_slope(F, I, record, 1, part) * y_unit
    if x == 0.0 and y == 0.0:
        return -1000.0
    return atan2(y, x) * DEGREES


def tangent_place(F: F64, I: I32, m: int, record: int, rest: float, along: float) -> None:
    """Turn the tangential axis; `along` is what is left of the parameter of the curve."""
    t: int = moves.tang[record]
    s: int = I[moves.tang_slave[record]] - 1
    axis: int = I[masters.slave_axis[m] + s]
    angle_deg: float = tangent_deg(F, I, record, F[t + UNITS_0], F[t + UNITS_1], 1.0 - along)
    if axis < 0 or angle_deg < -999.0:
        return
    a: int = axes.position_cnt[axis]
    now_deg: float = F[a] / F[t + SCALE]
    turn_deg: float = angle_deg + F[t + OFFSET_DEG] - now_deg
    turn_deg -= 360.0 * rint(turn_deg / 360.0)
    F[a] = (now_deg + turn_deg - F[t + LAG_DEG] * rest) * F[t + SCALE]
