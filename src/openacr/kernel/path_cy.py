"""The present move of a master: its vector, its speed, and where its slaves stand.

The profile of a master advances along the vector of the present move; every slave that
takes part stands at

    target - delta * (1 - s/L),

which is exactly the target at s = L.
"""

from openacr.cmath import fabs, sqrt
from openacr.kernel.axis_cy import axis_scale
from openacr.kernel.profile_cy import profile_plan
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
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_DELTA_CNT,
    MQF_FVEL_UPS,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_MAXVEL_UPS,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQF_VEL_UPS,
    MQF_WEIGHT,
    MQI_BASE,
    MQI_RAPID,
    MQI_RELATIVE,
    MQI_SLAVES,
    MQI_STRIDE,
    MSI_BASE,
    MSI_HEAD,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
)
from openacr.views import F32, F64, I32

RING = 16  # moves per master (map/hidden/motion.py)
SLAVE_COUNT = 16
FAR_U = 1e30


def master_word(m: int) -> int:
    """Parameter number of the flag word of master m."""
    return MF1_WORD + m if m < 8 else MF1_WORD_HIGH + m


def master_word2(m: int) -> int:
    """Parameter number of the secondary flag word of master m."""
    return MF2_WORD + m if m < 8 else MF2_WORD_HIGH + m


def move_record(I: I32, m: int) -> int:
    """Index of the record of the present move of master m."""
    return m * RING + I[MSI_BASE + m * MSI_STRIDE + MSI_HEAD]


def master_limit(F: F64, I: I32, S: F32, m: int) -> float:
    """Cruising speed wanted now [units/s]: the move's own under override and limits.

    The comparisons are written so that what is no number counts as 0 or as no limit.
    """
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    p: int = MA_BASE + m * MA_STRIDE
    velocity: float = F[q + MQF_VEL_UPS]
    if not velocity > 0.0:  # accepted while VEL was 0: takes over the first VEL above it
        velocity = S[p + MA_USER_VELOCITY]
        F[q + MQF_VEL_UPS] = velocity
    if not I[master_word(m)] & MF1_FOV_ROV_LOCK_ACTIVE:
        if I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID]:
            velocity *= S[p + MA_RAPID_FEEDRATE_OVERRIDE]
        else:
            velocity *= S[p + MA_FEEDRATE_OVERRIDE]
    if S[p + MA_VEL_LIMIT] > 0.0:
        velocity = min(velocity, S[p + MA_VEL_LIMIT])
    if F[q + MQF_MAXVEL_UPS] > 0.0:
        velocity = min(velocity, F[q + MQF_MAXVEL_UPS])
    return velocity if velocity > 0.0 else 0.0


def master_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the present move of master m from where it is."""
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    final: float = F[q + MQF_FVEL_UPS]
    if I[master_word(m)] & MF1_FVEL_ZERO_ACTIVE:
        final = 0.0
    profile_plan(
        F,
        I,
        m,
        F[q + MQF_LENGTH_U],
        master_limit(F, I, S, m),
        final,
        F[q + MQF_ACC_UPS2],
        F[q + MQF_DEC_UPS2],
        F[q + MQF_STP_UPS2],
        F[q + MQF_JRK_UPS3],
    )


def move_geometry(F: F64, I: I32, S: F32, m: int) -> None:
    """Vector length and axis limits of the present move from where the axes are.

    L = sqrt(sum (w d)^2) over the moving slaves; without any weight the manual vector,
    without that the longest single displacement, so that no displacement is a jump.
    """
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    relative: int = I[MQI_BASE + record * MQI_STRIDE + MQI_RELATIVE]
    square: float = 0.0
    longest: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            position: float = F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT]
            if relative & (1 << s):
                F[q + MQF_TARGET_CNT + s] = position + F[q + MQF_DELTA_CNT + s]
            else:
                F[q + MQF_DELTA_CNT + s] = F[q + MQF_TARGET_CNT + s] - position
            F[AXF_BASE + axis * AXF_STRIDE + AXF_TARGET_CNT] = F[q + MQF_TARGET_CNT + s]
            travel: float = fabs(F[q + MQF_DELTA_CNT + s]) / fabs(axis_scale(S, axis))
            square += F[q + MQF_WEIGHT + s] * F[q + MQF_WEIGHT + s] * travel * travel
            longest = max(longest, travel)
    length: float = sqrt(square)
    if length <= 0.0 and longest > 0.0:
        length = S[MA_BASE + m * MA_STRIDE + MA_MANUAL_VECTOR]
        if not 0.0 < length < FAR_U:
            length = longest
    F[q + MQF_LENGTH_U] = length
    F[q + MQF_MAXVEL_UPS] = 0.0
    if I[master_word2(m)] & MF2_SLAVEMAXVEL:
        move_maxvel(F, I, S, m, q, slaves)


def move_maxvel(F: F64, I: I32, S: F32, m: int, q: int, slaves: int) -> None:
    """Bound of the path speed by MAXVEL of the axes: the least v_i L/|d_i|."""
    i: int = MSI_BASE + m * MSI_STRIDE
    bound: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            limit: float = S[AX_BASE + axis * AX_STRIDE + AX_MAX_VELOCITY_LIMIT]
            travel: float = fabs(F[q + MQF_DELTA_CNT + s]) / fabs(axis_scale(S, axis))
            if limit > 0.0 and travel > 0.0:
                speed: float = limit * F[q + MQF_LENGTH_U] / travel
                if bound <= 0.0 or speed < bound:
                    bound = speed
    F[q + MQF_MAXVEL_UPS] = bound


def master_place(F: F64, I: I32, m: int) -> None:
    """Put the slaves of the present move where the path is."""
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    length: float = F[q + MQF_LENGTH_U]
    rest: float = 0.0
    if length > 0.0:
        rest = 1.0 - F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE] / length
    s: int = 0
    while slaves:
        if slaves & 1:
            axis: int = I[i + MSI_SLAVE_AXIS + s]
            if 0 <= axis < AX_COUNT:
                F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT] = (
                    F[q + MQF_TARGET_CNT + s] - F[q + MQF_DELTA_CNT + s] * rest
                )
        slaves = slaves >> 1
        s += 1
