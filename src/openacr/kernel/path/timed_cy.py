"""TMOV: the cruising speed with which a move takes exactly the time it is given.

Trapezoids from rest to rest have a closed form: with c = (1/ACC + 1/STP)/2 the time is
t = L/V + c V, so V = 2 L / (t + sqrt(t^2 - 4 c L)). Everything else is found by bisection
on plans, whose time falls as their cruising speed rises.
"""

from openacr.cmath import sqrt
from openacr.kernel.path.path_cy import move_final_ups, move_limit, move_record
from openacr.kernel.profile.profile_cy import profile_plan
from openacr.map.rows import masters, moves, profiles
from openacr.map.words import mf2
from openacr.views import F32, F64, I32

BISECTIONS = 60
SLACK = 1e-9


def plan_seconds(F: F64, I: I32, m: int, cruise_ups: float) -> float:
    """Time the present move takes with a cruising speed, from where it is."""
    record: int = move_record(I, m)
    profile_plan(
        F,
        I,
        m,
        F[moves.length_u[record]],
        cruise_ups,
        move_final_ups(F, I, m, move_record(I, m)),
        F[moves.acc_ups2[record]],
        F[moves.dec_ups2[record]],
        F[moves.stp_ups2[record]],
        F[moves.jrk_ups3[record]],
    )
    total_s: float = 0.0
    for k in range(I[profiles.seg_count[m]]):
        total_s += F[profiles.seg_time_s[m] + k]
    return total_s


def timed_closed(F: F64, m: int, record: int, time_s: float) -> float:
    """Speed of a trapezoid from rest to rest, -1 where the move is not."""
    acc_ups2: float = F[moves.acc_ups2[record]]
    stp_ups2: float = F[moves.stp_ups2[record]]
    if (
        acc_ups2 <= 0.0
        or stp_ups2 <= 0.0
        or F[moves.jrk_ups3[record]] > 0.0
        or F[moves.fvel_ups[record]] > 0.0
    ):
        return -1.0
    if F[profiles.velocity[m]] != 0.0:
        return -1.0
    length_u: float = F[moves.length_u[record]]
    square_s2: float = time_s * time_s - 2.0 * (1.0 / acc_ups2 + 1.0 / stp_ups2) * length_u
    return 2.0 * length_u / (time_s + sqrt(max(square_s2, 0.0)))


def move_timed(F: F64, I: I32, S: F32, m: int) -> None:
    """Give the present move, which has just begun, the speed for its time.

    Where even its programmed speed is too slow it keeps that, and Short Time is set.
    """
    record: int = move_record(I, m)
    time_s: float = F[moves.tmov_s[record]]
    bound_ups: float = move_limit(F, I, S, m, record, 1.0)
    if not bound_ups > 0.0 or F[moves.length_u[record]] <= 0.0:
        return
    word2: int = mf2.word[m]
    if plan_seconds(F, I, m, bound_ups) > time_s * (1.0 + SLACK):
        I[word2] |= mf2.MASTER_SHORT_TIME
        return
    I[word2] &= ~mf2.MASTER_SHORT_TIME
    velocity_ups: float = timed_closed(F, m, record, time_s)
    if velocity_ups < 0.0:
        low_ups: float = 0.0
        velocity_ups = bound_ups
        for _ in range(BISECTIONS):
            middle_ups: float = (low_ups + velocity_ups) / 2.0
            if plan_seconds(F, I, m, middle_ups) > time_s:
                low_ups = middle_ups
            else:
                velocity_ups = middle_ups
    F[moves.vel_ups[record]] = velocity_ups
    S[masters.tmov_velocity[m]] = velocity_ups
