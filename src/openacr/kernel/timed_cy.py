"""TMOV: the cruising speed with which a move takes exactly the time it is given.

Trapezoids from rest to rest have a closed form: with c = (1/ACC + 1/STP)/2 the time is
t = L/V + c V, so V = 2 L / (t + sqrt(t^2 - 4 c L)). Everything else is found by bisection
on plans, whose time falls as their cruising speed rises.
"""

from openacr.cmath import sqrt
from openacr.kernel.path_cy import master_word2, move_final_ups, move_limit, move_record
from openacr.kernel.profile_cy import profile_plan
from openacr.map.numbers import (
    MA_BASE,
    MA_STRIDE,
    MA_TMOV_VELOCITY,
    MF2_MASTER_SHORT_TIME,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_FVEL_UPS,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TMOV_S,
    MQF_VEL_UPS,
    PRF_BASE,
    PRF_SEG_TIME_S,
    PRF_STRIDE,
    PRF_VELOCITY,
    PRI_BASE,
    PRI_SEG_COUNT,
    PRI_STRIDE,
)
from openacr.views import F32, F64, I32

BISECTIONS = 60
SLACK = 1e-9


def plan_seconds(F: F64, I: I32, m: int, cruise: float) -> float:
    """Time the present move takes with a cruising speed, from where it is."""
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    profile_plan(
        F,
        I,
        m,
        F[q + MQF_LENGTH_U],
        cruise,
        move_final_ups(F, I, m, move_record(I, m)),
        F[q + MQF_ACC_UPS2],
        F[q + MQF_DEC_UPS2],
        F[q + MQF_STP_UPS2],
        F[q + MQF_JRK_UPS3],
    )
    total: float = 0.0
    for k in range(I[PRI_BASE + m * PRI_STRIDE + PRI_SEG_COUNT]):
        total += F[PRF_BASE + m * PRF_STRIDE + PRF_SEG_TIME_S + k]
    return total


def timed_closed(F: F64, m: int, q: int, time: float) -> float:
    """Speed of a trapezoid from rest to rest, -1 where the move is none."""
    acc: float = F[q + MQF_ACC_UPS2]
    stp: float = F[q + MQF_STP_UPS2]
    if acc <= 0.0 or stp <= 0.0 or F[q + MQF_JRK_UPS3] > 0.0 or F[q + MQF_FVEL_UPS] > 0.0:
        return -1.0
    if F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY] != 0.0:
        return -1.0
    length: float = F[q + MQF_LENGTH_U]
    square: float = time * time - 2.0 * (1.0 / acc + 1.0 / stp) * length
    return 2.0 * length / (time + sqrt(max(square, 0.0)))


def move_timed(F: F64, I: I32, S: F32, m: int) -> None:
    """Give the present move, which has just begun, the speed for its time.

    Where even its programmed speed is too slow it keeps that, and Short Time is set.
    """
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    time: float = F[q + MQF_TMOV_S]
    bound: float = move_limit(F, I, S, m, record, 1.0)
    if not bound > 0.0 or F[q + MQF_LENGTH_U] <= 0.0:
        return
    word2: int = master_word2(m)
    if plan_seconds(F, I, m, bound) > time * (1.0 + SLACK):
        I[word2] |= MF2_MASTER_SHORT_TIME
        return
    I[word2] &= ~MF2_MASTER_SHORT_TIME
    velocity: float = timed_closed(F, m, q, time)
    if velocity < 0.0:
        low: float = 0.0
        velocity = bound
        for _ in range(BISECTIONS):
            middle: float = (low + velocity) / 2.0
            if plan_seconds(F, I, m, middle) > time:
                low = middle
            else:
                velocity = middle
    F[q + MQF_VEL_UPS] = velocity
    S[MA_BASE + m * MA_STRIDE + MA_TMOV_VELOCITY] = velocity
