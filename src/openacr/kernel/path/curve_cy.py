"""Moves along curves: CIRCW, CIRCCW, TARC, SINE and axes in Sinusoidal Mode.

The moves of SPLINE and NURB are left to bezier_cy. All others are one formula: with
f = s/L from 0 to 1, a slave on a curve stands at

    target - slope (1 - f) + wave(f) - wave(1),
    wave(f) = (amplitude + growth f) sin(phase + sweep f),

which is exactly the target at f = 1 and needs one sine per slave and tick. In a circle the
first axis is a wave a quarter turn ahead of the second, and there is no slope; growth makes
it a spiral. An arc in space is a circle of its own plane: every axis sees it as a wave of
some amplitude and phase. SINE gives phase, sweep and amplitude directly; the slope takes
up whatever start and target leave. Angles are radians, everything else pulses.

The program gives targets and centre (or mid point); start and so radius and angles are
known only when the move begins, or is planned after others.
"""

from openacr.cmath import atan2, cos, fabs, sin, sqrt
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.bezier_cy import (
    bezier_position,
    bezier_slope,
    bezier_steepest,
    bezier_u,
    is_bezier,
)
from openacr.map.rows import axes, curves, masters, moves
from openacr.map.words import mf2
from openacr.views import F32, F64, I32

__all__ = ["curve_slope"]

PI = 3.141592653589793
DEGREES = 57.29577951308232
FULL_TURN_RAD = 1e-6 / DEGREES  # a smaller difference of angles is a full circle

CURVE_NONE = 0
CURVE_CW = 1
CURVE_CCW = 2
CURVE_SPACE = 3
SLAVES = 16


def curve_wave(F: F64, record: int, s: int, part: float) -> float:
    """The wave of slave s at a part of the move."""
    return (F[curves.amplitude_cnt[record] + s] + F[curves.growth_cnt[record] + s] * part) * sin(
        F[curves.phase_rad[record] + s] + F[curves.sweep_rad[record] + s] * part
    )


def curve_rest(F: F64, I: I32, record: int, rest: float) -> float:
    """What `curve_position` takes when `rest` of the path (1 to 0) is still to go."""
    if is_bezier(I, record):
        return 1.0 - bezier_u(F, I, record, 1.0 - rest)
    return rest


def curve_position(F: F64, I: I32, record: int, s: int, rest: float) -> float:
    """Position of slave s of a move when `rest` of it is still to go."""
    if is_bezier(I, record):
        return bezier_position(F, I, record, s, 1.0 - rest)
    return (
        F[moves.target_cnt[record] + s]
        - F[curves.slope_cnt[record] + s] * rest
        + (curve_wave(F, record, s, 1.0 - rest) - F[curves.end_cnt[record] + s])
    )


def curve_slope(F: F64, I: I32, record: int, s: int, part: float) -> float:
    """Change of the position of slave s with the part of the move."""
    if is_bezier(I, record):
        return bezier_slope(F, I, record, s, bezier_u(F, I, record, part))
    angle_rad: float = F[curves.phase_rad[record] + s] + F[curves.sweep_rad[record] + s] * part
    growth_cnt: float = F[curves.growth_cnt[record] + s]
    size_cnt: float = F[curves.amplitude_cnt[record] + s] + growth_cnt * part
    return (
        F[curves.slope_cnt[record] + s]
        + growth_cnt * sin(angle_rad)
        + size_cnt * F[curves.sweep_rad[record] + s] * cos(angle_rad)
    )


def curve_steepest(F: F64, I: I32, record: int, s: int) -> float:
    """A bound of the size of `curve_slope` over the whole move."""
    if is_bezier(I, record):
        return bezier_steepest(F, I, record, s)
    size_cnt: float = F[curves.amplitude_cnt[record] + s]
    growth_cnt: float = F[curves.growth_cnt[record] + s]
    largest_cnt: float = max(fabs(size_cnt), fabs(size_cnt + growth_cnt))
    sweep_rad: float = fabs(F[curves.sweep_rad[record] + s])
    return fabs(F[curves.slope_cnt[record] + s]) + fabs(growth_cnt) + largest_cnt * sweep_rad


def curve_set(
    F: F64,
    record: int,
    s: int,
    amplitude_cnt: float,
    growth_cnt: float,
    phase_rad: float,
    sweep_rad: float,
    closed: bool,
) -> None:
    """Give slave s its wave; a closed one lies on it, else the slope makes up the distance."""
    F[curves.amplitude_cnt[record] + s] = amplitude_cnt
    F[curves.growth_cnt[record] + s] = growth_cnt
    F[curves.phase_rad[record] + s] = phase_rad
    F[curves.sweep_rad[record] + s] = sweep_rad
    F[curves.end_cnt[record] + s] = curve_wave(F, record, s, 1.0)
    slope_cnt: float = 0.0
    if not closed:
        delta_cnt: float = F[moves.delta_cnt[record] + s]
        slope_cnt = delta_cnt - (F[curves.end_cnt[record] + s] - curve_wave(F, record, s, 0.0))
    F[curves.slope_cnt[record] + s] = slope_cnt


def curve_shape(F: F64, I: I32, S: F32, m: int, record: int, shown: bool) -> float:
    """Lay out the waves of a move whose starts are known; return its weighted arc length.

    `shown` publishes the radii of a circle in the parameters of its axes.
    """
    kind: int = I[moves.curve[record]]
    arc_u: float = 0.0
    if is_bezier(I, record):
        return F[curves.span[record]]
    curve_sines(F, I, record)
    if kind == CURVE_CW or kind == CURVE_CCW:
        spiral: bool = I[mf2.word[m]] & mf2.SPIRAL_MODE != 0
        arc_u = curve_circle(F, I, S, m, record, spiral, shown)
    elif kind == CURVE_SPACE:
        arc_u = curve_space(F, I, S, m, record)
    return arc_u * F[moves.weight[record] + I[moves.plane[record]]]


def curve_sines(F: F64, I: I32, record: int) -> None:
    """SINE as given; Sinusoidal Mode is half a wave over the whole move."""
    for s in range(SLAVES):
        if I[moves.half_wave[record]] & (1 << s):
            half_cnt: float = F[moves.delta_cnt[record] + s] / 2.0
            curve_set(F, record, s, half_cnt, 0.0, -PI / 2.0, PI, False)
        elif I[moves.curved[record]] & (1 << s):
            phase_rad: float = F[curves.phase_rad[record] + s]
            sweep_rad: float = F[curves.sweep_rad[record] + s]
            curve_set(
                F, record, s, F[curves.amplitude_cnt[record] + s], 0.0, phase_rad, sweep_rad, False
            )


def curve_longest_deg(F: F64, I: I32, record: int) -> float:
    """The largest sweep of the waves of a move in degrees."""
    longest_deg: float = 0.0
    for s in range(SLAVES):
        if I[moves.curved[record]] & (1 << s):
            sweep_rad: float = F[curves.sweep_rad[record] + s]
            longest_deg = max(longest_deg, fabs(sweep_rad) * DEGREES)
    return longest_deg


def curve_scale(F: F64, I: I32, S: F32, m: int, record: int, place: int) -> float:
    """Pulses per unit of axis `place` of the plane of a curve; an ellipse scales its unit."""
    s: int = I[moves.plane[record] + place]
    axis: int = I[masters.slave_axis[m] + s]
    scale: float = F[curves.radius_scale[record] + place]
    return axis_scale(S, axis) * scale if axis >= 0 else scale


def curve_start(F: F64, I: I32, record: int, place: int) -> float:
    """Start of axis `place` of the plane relative to the given point, in pulses."""
    s: int = I[moves.plane[record] + place]
    start_cnt: float = F[moves.target_cnt[record] + s] - F[moves.delta_cnt[record] + s]
    return start_cnt - F[curves.point_cnt[record] + place]


def curve_circle(F: F64, I: I32, S: F32, m: int, record: int, spiral: bool, shown: bool) -> float:
    """CIRCW and CIRCCW: radius and angles from start, centre and target; return the arc.

    Without Spiral Mode a start beside the circle of the target jumps onto it.
    """
    a: int = I[moves.plane[record]]
    b: int = I[moves.plane[record] + 1]
    scale_a: float = curve_scale(F, I, S, m, record, 0)
    scale_b: float = curve_scale(F, I, S, m, record, 1)
    x0: float = curve_start(F, I, record, 0) / scale_a
    y0: float = curve_start(F, I, record, 1) / scale_b
    x1: float = x0 + F[moves.delta_cnt[record] + a] / scale_a
    y1: float = y0 + F[moves.delta_cnt[record] + b] / scale_b
    first_u: float = sqrt(x0 * x0 + y0 * y0)
    last_u: float = sqrt(x1 * x1 + y1 * y1)
    phase_rad: float = atan2(y0, x0)
    sweep_rad: float = atan2(y1, x1) - phase_rad
    clockwise: bool = I[moves.curve[record]] == CURVE_CW
    if clockwise:
        sweep_rad = -sweep_rad
    if sweep_rad < -FULL_TURN_RAD:
        sweep_rad += 2.0 * PI
    if sweep_rad < FULL_TURN_RAD:
        sweep_rad = 2.0 * PI
    mean_u: float = (first_u + last_u) / 2.0 if spiral else last_u
    arc_u: float = mean_u * sweep_rad
    if shown:
        for place in range(2):
            axis: int = I[masters.slave_axis[m] + I[moves.plane[record] + place]]
            S[axes.start_radius[axis]] = first_u
            S[axes.end_radius[axis]] = last_u
    if clockwise:
        sweep_rad = -sweep_rad
    growth_u: float = 0.0
    if spiral:
        growth_u = last_u - first_u
        last_u = first_u
    curve_set(
        F, record, a, last_u * scale_a, growth_u * scale_a, phase_rad + PI / 2.0, sweep_rad, True
    )
    curve_set(F, record, b, last_u * scale_b, growth_u * scale_b, phase_rad, sweep_rad, True)
    return arc_u


def curve_space(F: F64, I: I32, S: F32, m: int, record: int) -> float:
    """TARC: the circle through start, mid point and target; return the arc, 0 if there is none.

    With a and b leading from the start to mid point and target and n = a x b, the centre
    lies at ((n x a) b^2 + (b x n) a^2) / (2 n^2), and the path from start over mid point to
    target turns about n. u leads from centre to start, v a quarter turn on.
    """
    scale_x: float = curve_scale(F, I, S, m, record, 0)
    scale_y: float = curve_scale(F, I, S, m, record, 1)
    scale_z: float = curve_scale(F, I, S, m, record, 2)
    ax: float = -curve_start(F, I, record, 0) / scale_x
    ay: float = -curve_start(F, I, record, 1) / scale_y
    az: float = -curve_start(F, I, record, 2) / scale_z
    bx: float = F[moves.delta_cnt[record] + I[moves.plane[record]]] / scale_x
    by: float = F[moves.delta_cnt[record] + I[moves.plane[record] + 1]] / scale_y
    bz: float = F[moves.delta_cnt[record] + I[moves.plane[record] + 2]] / scale_z
    nx: float = ay * bz - az * by
    ny: float = az * bx - ax * bz
    nz: float = ax * by - ay * bx
    square: float = nx * nx + ny * ny + nz * nz
    aa: float = ax * ax + ay * ay + az * az
    bb: float = bx * bx + by * by + bz * bz
    if square <= 1e-20 * aa * bb:
        return 0.0
    half: float = -0.5 / square
    ux: float = half * ((ny * az - nz * ay) * bb + (by * nz - bz * ny) * aa)
    uy: float = half * ((nz * ax - nx * az) * bb + (bz * nx - bx * nz) * aa)
    uz: float = half * ((nx * ay - ny * ax) * bb + (bx * ny - by * nx) * aa)
    normal: float = sqrt(square)
    vx: float = (ny * uz - nz * uy) / normal
    vy: float = (nz * ux - nx * uz) / normal
    vz: float = (nx * uy - ny * ux) / normal
    # From the centre the target lies at u + b.
    radius_u: float = sqrt(ux * ux + uy * uy + uz * uz)
    along: float = radius_u * radius_u + bx * ux + by * uy + bz * uz
    sweep_rad: float = atan2(bx * vx + by * vy + bz * vz, along)
    if sweep_rad <= 0.0:
        sweep_rad += 2.0 * PI
    curve_turn(F, I, record, 0, ux * scale_x, vx * scale_x, sweep_rad)
    curve_turn(F, I, record, 1, uy * scale_y, vy * scale_y, sweep_rad)
    curve_turn(F, I, record, 2, uz * scale_z, vz * scale_z, sweep_rad)
    return radius_u * sweep_rad


def curve_turn(
    F: F64, I: I32, record: int, place: int, u: float, v: float, sweep_rad: float
) -> None:
    """Write u cos(t) + v sin(t) as one wave."""
    s: int = I[moves.plane[record] + place]
    curve_set(F, record, s, sqrt(u * u + v * v), 0.0, atan2(u, v), sweep_rad, True)
