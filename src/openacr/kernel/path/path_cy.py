"""The present move of a master: its vector, its speed, and where its slaves stand.

The profile of a master advances along the vector of the present move; every slave that
takes part stands at

    target - delta * (1 - s/L),

which is exactly the target at s = L; those on a curve where curve_cy says.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.bezier_cy import is_bezier, is_timed
from openacr.kernel.path.corner_cy import corner_enter, corner_place
from openacr.kernel.path.curve_cy import (
    DEGREES,
    curve_longest_deg,
    curve_position,
    curve_rest,
    curve_shape,
    curve_slope,
    curve_steepest,
)
from openacr.kernel.path.tangent_cy import tangent_place
from openacr.map.rows import axes, masters, moves, profiles
from openacr.map.words import mf1, mf2
from openacr.views import F32, F64, I32

__all__ = ["move_directions", "move_shape", "path_join", "path_slope"]

SLAVE_COUNT = 16
# What a binary move brings along for its own time (row marks).
MARK_OVERRIDE_LOCKED = 1
MARK_COUNT_UP = 2
MARK_COUNT_DOWN = 4
MARK_INTERRUPT = 8
MARK_BLOCK_SKIP = 16
# What a piece of a curve brings along.
MARK_CURVE_BEGIN = 32
MARK_NURB = 64
MARK_TURN = 128  # a turn of the tangential axis between two moves
MARK_ROUNDS = 256  # a binary move brings its path tolerance along
MARK_FINAL_ZERO = 512  # its final velocity is 0 (FVEL lockout)
MARK_INTERRUPT_LENT = 1024  # it has set Interrupt On Move, for itself alone
BESIDE = 1e-3
FAR_U = 1e30


def move_record(I: I32, m: int) -> int:
    """Index of the record of the present move of master m."""
    return I[masters.first[m]] + I[masters.head[m]]


def master_limit(F: F64, I: I32, S: F32, m: int) -> float:
    """Cruising speed wanted now [units/s]: the move's own under override and limits."""
    record: int = move_record(I, m)
    velocity_ups: float = F[moves.vel_ups[record]]
    if not velocity_ups > 0.0:  # accepted while VEL was 0: takes over the first VEL above it
        velocity_ups = S[masters.user_velocity[m]]
        F[moves.vel_ups[record]] = velocity_ups
    velocity_ups = move_limit(F, I, S, m, record, move_override(I, S, m, record))
    cap_ups: float = F[masters.look_cap_ups[m]]
    return min(velocity_ups, cap_ups) if cap_ups > 0.0 else velocity_ups


def move_override(I: I32, S: F32, m: int, record: int) -> float:
    """FOV, or ROV of a rapid move; 1 while they are locked."""
    if I[mf1.word[m]] & mf1.FOV_ROV_LOCK_ACTIVE:
        return 1.0
    if I[moves.marks[record]] & MARK_OVERRIDE_LOCKED:
        return 1.0
    if I[moves.rapid[record]]:
        return S[masters.rapid_feedrate_override[m]]
    return S[masters.feedrate_override[m]]


def move_limit(F: F64, I: I32, S: F32, m: int, record: int, override: float) -> float:
    """Cruising speed of a move [units/s] with an override.

    The comparisons are written so that what is no number counts as 0 or as no limit.
    """
    velocity_ups: float = F[moves.vel_ups[record]] * override
    limit_ups: float = S[masters.vel_limit[m]]
    if limit_ups > 0.0 and not is_timed(I, record):
        velocity_ups = min(velocity_ups, limit_ups)
    if F[moves.maxvel_ups[record]] > 0.0:
        velocity_ups = min(velocity_ups, F[moves.maxvel_ups[record]])
    return velocity_ups if velocity_ups > 0.0 else 0.0


def move_stop_rate(F: F64, record: int) -> float:
    """Rate at which a move is ended early: STP, DEC where that is 0."""
    return (
        F[moves.stp_ups2[record]] if F[moves.stp_ups2[record]] > 0.0 else F[moves.dec_ups2[record]]
    )


def move_final_ups(F: F64, I: I32, m: int, record: int) -> float:
    """Final velocity of a move [units/s]: FVEL, or 0 while FVEL Zero is active or comes with it."""
    if I[mf1.word[m]] & mf1.FVEL_ZERO_ACTIVE:
        return 0.0
    marks: int = I[moves.marks[record]]
    if record != move_record(I, m) and marks & MARK_FINAL_ZERO:
        return 0.0
    return F[moves.fvel_ups[record]]


def move_geometry(F: F64, I: I32, S: F32, m: int) -> None:
    """Lay the present move out from where the axes are; its path begins anew."""
    record: int = move_record(I, m)
    if I[masters.rounding[m]]:
        corner_enter(F, I, m, record)
    I[masters.piece[m]] = 0
    move_shape(F, I, S, m, record, False)
    F[masters.origin_u[m]] = 0.0
    length_u: float = F[moves.length_u[record]]
    F[masters.section_u[m]] = length_u
    F[masters.look_cap_ups[m]] = 0.0
    I[masters.section_cnt[m]] = 1


def move_shape(F: F64, I: I32, S: F32, m: int, record: int, planned: bool) -> None:
    """Displacements, vector length and axis limits of a move.

    It starts where the axes are or, while it is only `planned`, where the move before it
    ends. L = sqrt(arc^2 + sum (w d)^2) over the slaves on straight lines; sines alone are
    as long as their sweep in degrees. Without any weight L is the manual vector, without
    that the longest single displacement, so that no displacement is a jump.
    """
    slaves: int = I[moves.slaves[record]]
    relative: int = I[moves.relative[record]]
    curved: int = I[moves.curved[record]]
    square_u2: float = 0.0
    longest_u: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if slaves & (1 << s) and axis >= 0:
            position_cnt: float = F[axes.position_cnt[axis]]
            if planned:
                position_cnt = F[masters.target_cnt[m] + s]
            if relative & (1 << s):
                F[moves.target_cnt[record] + s] = position_cnt + F[moves.delta_cnt[record] + s]
            else:
                F[moves.delta_cnt[record] + s] = F[moves.target_cnt[record] + s] - position_cnt
            if not planned:
                F[axes.target_cnt[axis]] = F[moves.target_cnt[record] + s]
            if not curved & (1 << s):
                travel_u: float = fabs(F[moves.delta_cnt[record] + s]) / fabs(axis_scale(S, axis))
                square_u2 += (
                    F[moves.weight[record] + s] * F[moves.weight[record] + s] * travel_u * travel_u
                )
                longest_u = max(longest_u, travel_u)
    if curved:
        arc_u: float = curve_shape(F, I, S, m, record, not planned)
        square_u2 += arc_u * arc_u
        longest_u = max(longest_u, arc_u)
    length_u: float = sqrt(square_u2)
    if curved == slaves and I[moves.curve[record]] == 0:
        length_u = curve_longest_deg(F, I, record)
    if length_u <= 0.0 and longest_u > 0.0:
        length_u = S[masters.manual_vector[m]]
        if not 0.0 < length_u < FAR_U:
            length_u = longest_u
    F[moves.length_u[record]] = length_u
    F[moves.maxvel_ups[record]] = 0.0
    if I[mf2.word[m]] & mf2.SLAVEMAXVEL:
        move_maxvel(F, I, S, m, record)


def moves_lead(F: F64, I: I32, m: int) -> None:
    """After moves were dropped: what is appended now begins where those that are left lead."""
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            F[masters.target_cnt[m] + s] = F[axes.target_cnt[axis]]
            for k in range(1, I[masters.queued[m]]):
                place: int = I[masters.head[m]] + k
                if place >= I[masters.size[m]]:
                    place -= I[masters.size[m]]
                record: int = I[masters.first[m]] + place
                if I[moves.slaves[record]] & (1 << s):
                    F[masters.target_cnt[m] + s] = F[moves.target_cnt[record] + s]


def move_maxvel(F: F64, I: I32, S: F32, m: int, record: int) -> None:
    """Bound of the path speed by MAXVEL of the axes: the least v_i L/|dp_i/df|."""
    slaves: int = I[moves.slaves[record]]
    curved: int = I[moves.curved[record]]
    bound_ups: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if slaves & (1 << s) and axis >= 0:
            limit_ups: float = S[axes.max_velocity_limit[axis]]
            travel_u: float = fabs(F[moves.delta_cnt[record] + s])
            if curved & (1 << s):
                travel_u = curve_steepest(F, I, record, s)
            travel_u = travel_u / fabs(axis_scale(S, axis))
            if limit_ups > 0.0 and travel_u > 0.0:
                speed_ups: float = limit_ups * F[moves.length_u[record]] / travel_u
                if bound_ups <= 0.0 or speed_ups < bound_ups:
                    bound_ups = speed_ups
    F[moves.maxvel_ups[record]] = bound_ups


def path_slope(F: F64, I: I32, record: int, s: int, part: float) -> float:
    """Change of the position of slave s [pulses] with the part of a move."""
    if not I[moves.slaves[record]] & (1 << s):
        return 0.0
    if I[moves.curved[record]] & (1 << s):
        return curve_slope(F, I, record, s, part)
    return F[moves.delta_cnt[record] + s]


def move_directions(F: F64, I: I32, S: F32, m: int, record: int) -> None:
    """Note where the path of a move heads at its beginning and end, as unit vectors."""
    path_direction(F, I, S, m, record, 0.0, moves.enter[record])
    path_direction(F, I, S, m, record, 1.0, moves.leave[record])


def path_direction(F: F64, I: I32, S: F32, m: int, record: int, part: float, place: int) -> None:
    """Write the direction of the first three slaves at a part of a move; 0 without any."""
    square_u2: float = 0.0
    if is_bezier(I, record):  # at its very ends it may stand still
        part = part + (0.5 - part) * BESIDE
    for s in range(3):
        axis: int = I[masters.slave_axis[m] + s]
        slope_u: float = 0.0
        if axis >= 0:
            slope_u = path_slope(F, I, record, s, part) / axis_scale(S, axis)
        F[place + s] = slope_u
        square_u2 += slope_u * slope_u
    if square_u2 > 0.0:
        for s in range(3):
            F[place + s] = F[place + s] / sqrt(square_u2)


def path_join(F: F64, I: I32, S: F32, m: int, before: int, after: int) -> None:
    """Note by how much the path turns between two moves that follow each other.

    A move that goes nowhere heads where the one before it does, so that the turn of the path at
    its place is not lost.
    """
    if F[moves.length_u[after]] <= 0.0:
        for s in range(3):
            F[moves.enter[after] + s] = F[moves.leave[before] + s]
            F[moves.leave[after] + s] = F[moves.leave[before] + s]
    F[moves.turn_deg[before]] = path_turn_deg(F, I, S, m, before, after)


def path_turn_deg(F: F64, I: I32, S: F32, m: int, before: int, after: int) -> float:
    """Angle between the end of one move and the beginning of the next.

    It is that of the first three slaves; where neither move has any of them, that of the others.
    """
    a: int = moves.leave[before]
    b: int = moves.enter[after]
    if F[moves.length_u[before]] > 0.0 and F[moves.length_u[after]] > 0.0:
        if not heads(F, a) and not heads(F, b):
            return others_turn_deg(F, I, S, m, before, after)
        if not heads(F, a) or not heads(F, b):
            return 90.0
    x: float = F[a + 1] * F[b + 2] - F[a + 2] * F[b + 1]
    y: float = F[a + 2] * F[b] - F[a] * F[b + 2]
    z: float = F[a] * F[b + 1] - F[a + 1] * F[b]
    along: float = F[a] * F[b] + F[a + 1] * F[b + 1] + F[a + 2] * F[b + 2]
    return atan2(sqrt(x * x + y * y + z * z), along) * DEGREES


def heads(F: F64, place: int) -> bool:
    """Whether a direction that was noted is one: the first three slaves take part."""
    return F[place] != 0.0 or F[place + 1] != 0.0 or F[place + 2] != 0.0


def others_turn_deg(F: F64, I: I32, S: F32, m: int, before: int, after: int) -> float:
    """Angle between two moves in which none of the first three slaves takes part."""
    along: float = 0.0
    before2: float = 0.0
    after2: float = 0.0
    for s in range(3, SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            old: float = path_slope(F, I, before, s, 1.0) / axis_scale(S, axis)
            new: float = path_slope(F, I, after, s, 0.0) / axis_scale(S, axis)
            along += old * new
            before2 += old * old
            after2 += new * new
    across2: float = before2 * after2 - along * along
    return atan2(sqrt(max(across2, 0.0)), along) * DEGREES


def master_place(F: F64, I: I32, m: int) -> None:
    """Put the slaves of the present move where the path is."""
    record: int = move_record(I, m)
    length_u: float = F[moves.length_u[record]]
    rest: float = 0.0
    gone_u: float = F[profiles.distance[m]]
    origin_u: float = F[masters.origin_u[m]]
    piece: bool = I[masters.piece[m]] != 0
    if piece or gone_u < F[masters.section_u[m]]:
        rest = 1.0 - (gone_u - origin_u) / length_u
    move_place(F, I, m, record, rest)
    if I[masters.rounding[m]]:
        slaves: int = I[moves.slaves[record]]
        corner_place(F, I, m, slaves, gone_u - origin_u, length_u * rest)


def move_place(F: F64, I: I32, m: int, record: int, rest: float) -> None:
    """Put the slaves of a move where they are when `rest` of it (1 to 0) is still to go."""
    slaves: int = I[moves.slaves[record]]
    curved: int = I[moves.curved[record]]
    along: float = rest
    if curved:
        along = curve_rest(F, I, record, rest)
    s: int = 0
    while slaves:
        if slaves & 1:
            axis: int = I[masters.slave_axis[m] + s]
            if 0 <= axis < axes.COUNT:
                position_cnt: float = (
                    F[moves.target_cnt[record] + s] - F[moves.delta_cnt[record] + s] * rest
                )
                if curved & (1 << s):
                    position_cnt = curve_position(F, I, record, s, along)
                F[axes.position_cnt[axis]] = position_cnt
        slaves = slaves >> 1
        s += 1
    if I[moves.tang_slave[record]]:
        tangent_place(F, I, m, record, rest, along)
