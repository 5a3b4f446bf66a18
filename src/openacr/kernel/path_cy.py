"""The present move of a master: its vector, its speed, and where its slaves stand.

The profile of a master advances along the vector of the present move; every slave that
takes part stands at

    target - delta * (1 - s/L),

which is exactly the target at s = L; those on a curve where curve_cy says.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.kernel.axis_cy import axis_scale
from openacr.kernel.bezier_cy import is_bezier, is_timed
from openacr.kernel.corner_cy import corner_enter, corner_place
from openacr.kernel.curve_cy import (
    DEGREES,
    curve_longest_deg,
    curve_position,
    curve_rest,
    curve_shape,
    curve_slope,
    curve_steepest,
)
from openacr.kernel.tangent_cy import tangent_place
from openacr.map.numbers import (
    AX_BASE,
    AX_COUNT,
    AX_MAX_VELOCITY_LIMIT,
    AX_STRIDE,
    AXF_BASE,
    AXF_POSITION_CNT,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    MA_BASE,
    MA_FEEDRATE_OVERRIDE,
    MA_MANUAL_VECTOR,
    MA_RAPID_FEEDRATE_OVERRIDE,
    MA_STRIDE,
    MA_USER_VELOCITY,
    MA_VEL_LIMIT,
    MF1_FOV_ROV_LOCK_ACTIVE,
    MF1_FVEL_ZERO_ACTIVE,
    MF1_WORD,
    MF1_WORD_HIGH,
    MF2_SLAVEMAXVEL,
    MF2_WORD,
    MF2_WORD_HIGH,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_DELTA_CNT,
    MQF_ENTER,
    MQF_FVEL_UPS,
    MQF_LEAVE,
    MQF_LENGTH_U,
    MQF_MAXVEL_UPS,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQF_VEL_UPS,
    MQF_WEIGHT,
    MQI_BASE,
    MQI_CURVE,
    MQI_CURVED,
    MQI_MARKS,
    MQI_RAPID,
    MQI_RELATIVE,
    MQI_SLAVES,
    MQI_STRIDE,
    MQI_TANG,
    MSF_BASE,
    MSF_LOOK_CAP_UPS,
    MSF_ORIGIN_U,
    MSF_STRETCH_U,
    MSF_STRIDE,
    MSF_TARGET_CNT,
    MSI_BASE,
    MSI_FIRST,
    MSI_HEAD,
    MSI_PIECE,
    MSI_ROUNDING,
    MSI_SLAVE_AXIS,
    MSI_STRETCH,
    MSI_STRIDE,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["move_directions", "move_shape", "path_slope", "path_turn_deg"]

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


def master_word(m: int) -> int:
    """Parameter number of the flag word of master m."""
    return MF1_WORD + m if m < 8 else MF1_WORD_HIGH + m


def master_word2(m: int) -> int:
    """Parameter number of the secondary flag word of master m."""
    return MF2_WORD + m if m < 8 else MF2_WORD_HIGH + m


def move_record(I: I32, m: int) -> int:
    """Index of the record of the present move of master m."""
    i: int = MSI_BASE + m * MSI_STRIDE
    return I[i + MSI_FIRST] + I[i + MSI_HEAD]


def master_limit(F: F64, I: I32, S: F32, m: int) -> float:
    """Cruising speed wanted now [units/s]: the move's own under override and limits."""
    record: int = move_record(I, m)
    velocity: float = F[MQF_BASE + record * MQF_STRIDE + MQF_VEL_UPS]
    if not velocity > 0.0:  # accepted while VEL was 0: takes over the first VEL above it
        velocity = S[MA_BASE + m * MA_STRIDE + MA_USER_VELOCITY]
        F[MQF_BASE + record * MQF_STRIDE + MQF_VEL_UPS] = velocity
    velocity = move_limit(F, I, S, m, record, move_override(I, S, m, record))
    cap: float = F[MSF_BASE + m * MSF_STRIDE + MSF_LOOK_CAP_UPS]
    return min(velocity, cap) if cap > 0.0 else velocity


def move_override(I: I32, S: F32, m: int, record: int) -> float:
    """FOV, or ROV of a rapid move; 1 while they are locked."""
    p: int = MA_BASE + m * MA_STRIDE
    if I[master_word(m)] & MF1_FOV_ROV_LOCK_ACTIVE:
        return 1.0
    if I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS] & MARK_OVERRIDE_LOCKED:
        return 1.0
    if I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID]:
        return S[p + MA_RAPID_FEEDRATE_OVERRIDE]
    return S[p + MA_FEEDRATE_OVERRIDE]


def move_limit(F: F64, I: I32, S: F32, m: int, record: int, override: float) -> float:
    """Cruising speed of a move [units/s] with an override.

    The comparisons are written so that what is no number counts as 0 or as no limit.
    """
    q: int = MQF_BASE + record * MQF_STRIDE
    velocity: float = F[q + MQF_VEL_UPS] * override
    limit: float = S[MA_BASE + m * MA_STRIDE + MA_VEL_LIMIT]
    if limit > 0.0 and not is_timed(I, record):
        velocity = min(velocity, limit)
    if F[q + MQF_MAXVEL_UPS] > 0.0:
        velocity = min(velocity, F[q + MQF_MAXVEL_UPS])
    return velocity if velocity > 0.0 else 0.0


def move_stop_rate(F: F64, record: int) -> float:
    """Rate at which a move is ended early: STP, DEC where that is 0."""
    q: int = MQF_BASE + record * MQF_STRIDE
    return F[q + MQF_STP_UPS2] if F[q + MQF_STP_UPS2] > 0.0 else F[q + MQF_DEC_UPS2]


def move_final_ups(F: F64, I: I32, m: int, record: int) -> float:
    """Final velocity of a move [units/s]: FVEL, or 0 while FVEL Zero is active or comes with it."""
    if I[master_word(m)] & MF1_FVEL_ZERO_ACTIVE:
        return 0.0
    marks: int = I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS]
    if record != move_record(I, m) and marks & MARK_FINAL_ZERO:
        return 0.0
    return F[MQF_BASE + record * MQF_STRIDE + MQF_FVEL_UPS]


def move_geometry(F: F64, I: I32, S: F32, m: int) -> None:
    """Lay the present move out from where the axes are; its path begins anew."""
    record: int = move_record(I, m)
    if I[MSI_BASE + m * MSI_STRIDE + MSI_ROUNDING]:
        corner_enter(F, I, m, record)
    I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE] = 0
    move_shape(F, I, S, m, record, False)
    F[MSF_BASE + m * MSF_STRIDE + MSF_ORIGIN_U] = 0.0
    length: float = F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]
    F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U] = length
    F[MSF_BASE + m * MSF_STRIDE + MSF_LOOK_CAP_UPS] = 0.0
    I[MSI_BASE + m * MSI_STRIDE + MSI_STRETCH] = 1


def move_shape(F: F64, I: I32, S: F32, m: int, record: int, planned: bool) -> None:
    """Displacements, vector length and axis limits of a move.

    It starts where the axes are or, while it is only `planned`, where the move before it
    ends. L = sqrt(arc^2 + sum (w d)^2) over the slaves on straight lines; sines alone are
    as long as their sweep in degrees. Without any weight L is the manual vector, without
    that the longest single displacement, so that no displacement is a jump.
    """
    q: int = MQF_BASE + record * MQF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    relative: int = I[MQI_BASE + record * MQI_STRIDE + MQI_RELATIVE]
    curved: int = I[MQI_BASE + record * MQI_STRIDE + MQI_CURVED]
    square: float = 0.0
    longest: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            position: float = F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT]
            if planned:
                position = F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + s]
            if relative & (1 << s):
                F[q + MQF_TARGET_CNT + s] = position + F[q + MQF_DELTA_CNT + s]
            else:
                F[q + MQF_DELTA_CNT + s] = F[q + MQF_TARGET_CNT + s] - position
            if not planned:
                F[AXF_BASE + axis * AXF_STRIDE + AXF_TARGET_CNT] = F[q + MQF_TARGET_CNT + s]
            if not curved & (1 << s):
                travel: float = fabs(F[q + MQF_DELTA_CNT + s]) / fabs(axis_scale(S, axis))
                square += F[q + MQF_WEIGHT + s] * F[q + MQF_WEIGHT + s] * travel * travel
                longest = max(longest, travel)
    if curved:
        arc: float = curve_shape(F, I, S, m, record, not planned)
        square += arc * arc
        longest = max(longest, arc)
    length: float = sqrt(square)
    if curved == slaves and I[MQI_BASE + record * MQI_STRIDE + MQI_CURVE] == 0:
        length = curve_longest_deg(F, I, record)
    if length <= 0.0 and longest > 0.0:
        length = S[MA_BASE + m * MA_STRIDE + MA_MANUAL_VECTOR]
        if not 0.0 < length < FAR_U:
            length = longest
    F[q + MQF_LENGTH_U] = length
    F[q + MQF_MAXVEL_UPS] = 0.0
    if I[master_word2(m)] & MF2_SLAVEMAXVEL:
        move_maxvel(F, I, S, m, record)


def move_maxvel(F: F64, I: I32, S: F32, m: int, record: int) -> None:
    """Bound of the path speed by MAXVEL of the axes: the least v_i L/|dp_i/df|."""
    i: int = MSI_BASE + m * MSI_STRIDE
    q: int = MQF_BASE + record * MQF_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    curved: int = I[MQI_BASE + record * MQI_STRIDE + MQI_CURVED]
    bound: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            limit: float = S[AX_BASE + axis * AX_STRIDE + AX_MAX_VELOCITY_LIMIT]
            travel: float = fabs(F[q + MQF_DELTA_CNT + s])
            if curved & (1 << s):
                travel = curve_steepest(F, I, record, s)
            travel = travel / fabs(axis_scale(S, axis))
            if limit > 0.0 and travel > 0.0:
                speed: float = limit * F[q + MQF_LENGTH_U] / travel
                if bound <= 0.0 or speed < bound:
                    bound = speed
    F[q + MQF_MAXVEL_UPS] = bound


def path_slope(F: F64, I: I32, record: int, s: int, part: float) -> float:
    """Change of the position of slave s [pulses] with the part of a move."""
    if not I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES] & (1 << s):
        return 0.0
    if I[MQI_BASE + record * MQI_STRIDE + MQI_CURVED] & (1 << s):
        return curve_slope(F, I, record, s, part)
    return F[MQF_BASE + record * MQF_STRIDE + MQF_DELTA_CNT + s]


def move_directions(F: F64, I: I32, S: F32, m: int, record: int) -> None:
    """Note where the path of a move heads at its beginning and end, as unit vectors."""
    path_direction(F, I, S, m, record, 0.0, MQF_ENTER)
    path_direction(F, I, S, m, record, 1.0, MQF_LEAVE)


def path_direction(F: F64, I: I32, S: F32, m: int, record: int, part: float, row: int) -> None:
    """Write the direction of the first three slaves at a part of a move; 0 without any."""
    q: int = MQF_BASE + record * MQF_STRIDE
    square: float = 0.0
    if is_bezier(I, record):  # at its very ends it may stand still
        part = part + (0.5 - part) * BESIDE
    for s in range(3):
        axis: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        slope: float = 0.0
        if axis >= 0:
            slope = path_slope(F, I, record, s, part) / axis_scale(S, axis)
        F[q + row + s] = slope
        square += slope * slope
    if square > 0.0:
        for s in range(3):
            F[q + row + s] = F[q + row + s] / sqrt(square)


def path_turn_deg(F: F64, before: int, after: int) -> float:
    """Angle between the end of one move and the beginning of the next."""
    a: int = MQF_BASE + before * MQF_STRIDE + MQF_LEAVE
    b: int = MQF_BASE + after * MQF_STRIDE + MQF_ENTER
    x: float = F[a + 1] * F[b + 2] - F[a + 2] * F[b + 1]
    y: float = F[a + 2] * F[b] - F[a] * F[b + 2]
    z: float = F[a] * F[b + 1] - F[a + 1] * F[b]
    along: float = F[a] * F[b] + F[a + 1] * F[b + 1] + F[a + 2] * F[b + 2]
    return atan2(sqrt(x * x + y * y + z * z), along) * DEGREES


def master_place(F: F64, I: I32, m: int) -> None:
    """Put the slaves of the present move where the path is."""
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    length: float = F[q + MQF_LENGTH_U]
    rest: float = 0.0
    gone: float = F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE]
    origin: float = F[MSF_BASE + m * MSF_STRIDE + MSF_ORIGIN_U]
    piece: bool = I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE] != 0
    if piece or gone < F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U]:
        rest = 1.0 - (gone - origin) / length
    move_place(F, I, m, record, rest)
    if I[MSI_BASE + m * MSI_STRIDE + MSI_ROUNDING]:
        slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
        corner_place(F, I, m, slaves, gone - origin, length * rest)


def move_place(F: F64, I: I32, m: int, record: int, rest: float) -> None:
    """Put the slaves of a move where they are when `rest` of it (1 to 0) is still to go."""
    q: int = MQF_BASE + record * MQF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    curved: int = I[MQI_BASE + record * MQI_STRIDE + MQI_CURVED]
    along: float = rest
    if curved:
        along = curve_rest(F, I, record, rest)
    s: int = 0
    while slaves:
        if slaves & 1:
            axis: int = I[i + MSI_SLAVE_AXIS + s]
            if 0 <= axis < AX_COUNT:
                position: float = F[q + MQF_TARGET_CNT + s] - F[q + MQF_DELTA_CNT + s] * rest
                if curved & (1 << s):
                    position = curve_position(F, I, record, s, along)
                F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT] = position
        slaves = slaves >> 1
        s += 1
    if I[MQI_BASE + record * MQI_STRIDE + MQI_TANG]:
        tangent_place(F, I, m, record, rest, along)
