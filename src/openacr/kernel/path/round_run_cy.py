"""Runs of a path under a jerk limit: moves that are gone through as one line.

Straight joints of moves with one speed and the same ramps are no reason to take the acceleration
back to 0: one plan runs through them, from the corner before the first move to the corner ahead
of the last.

    |-- corner before --|------ move ------|---- move ----|---- move ----|-- corner ahead --|
                        '------------------- run -------------------------'
"""

from openacr.cmath import exp, log
from openacr.kernel.path.lookahead_cy import (
    FREE,
    JOINED,
    look_alike,
    look_beyond,
    look_corner,
    look_rate,
    look_record,
    look_speed,
)
from openacr.kernel.path.path_cy import move_stop_rate
from openacr.map.rows import masters, moves
from openacr.views import F32, F64, I32

__all__ = ["round_run"]

TURNING = 0.31498026247371824  # (27/32)^(1/3) / 3, see round_turning


def round_join(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Speed at a corner that is not rounded."""
    if I[moves.ahead[a]] == JOINED:  # straight on
        return min(look_speed(F, I, S, m, a), look_speed(F, I, S, m, b))
    return look_corner(F, I, S, m, a, b)


def round_merges(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> bool:
    """Whether, under jerk, the joint of two moves is within a run."""
    if F[moves.jrk_ups3[a]] <= 0.0 or F[moves.corner_u[a]] > 0.0:
        return False
    return look_alike(F, I, S, m, a, b, round_join(F, I, S, m, a, b))


def round_last(I: I32, m: int) -> int:
    """Moves from the present one to the last that plans may run through."""
    last: int = I[masters.queued[m]] - 1
    k: int = 0
    while k < last and look_beyond(I, m, look_record(I, m, k)):
        k += 1
    return k


def round_run(F: F64, I: I32, S: F32, m: int) -> int:
    """Moves from the present one to the last of its run; note the speed its joints allow."""
    last: int = round_last(I, m)
    cap_ups: float = 0.0
    k: int = 0
    a: int = look_record(I, m, 0)
    while k < last:
        b: int = look_record(I, m, k + 1)
        if not round_merges(F, I, S, m, a, b):
            break
        joint_ups: float = round_join(F, I, S, m, a, b)
        if joint_ups < look_speed(F, I, S, m, a) * FREE and (cap_ups <= 0.0 or joint_ups < cap_ups):
            cap_ups = joint_ups
        a = b
        k += 1
    F[masters.look_cap_ups[m]] = cap_ups
    return k


def round_rate(F: F64, record: int, leaving_v2: float) -> float:
    """The ramp at the end of a run: STP where the path comes to rest, as it does without LOOK."""
    if leaving_v2 <= 0.0:
        return move_stop_rate(F, record)
    return look_rate(F, record)


def round_turning(length_u: float, rate_ups2: float, jerk_ups3: float) -> float:
    """The end speed to which a ramp that fits into a length begins at the lowest speed.

    Ramps from v to e under jerk J that do not reach their rate take (v + e) sqrt((v - e)/J), the
    longest of them that to e = v/3: v^3 = 27/32 J length^2. Of those that do it is that to
    e = rate^2/(2 J). To higher speeds, ramps may begin the faster the higher these are.
    """
    if rate_ups2 <= 0.0 or length_u <= 0.0:
        return 0.0
    third_ups: float = TURNING * exp(log(jerk_ups3 * length_u * length_u) / 3.0)
    return min(third_ups, rate_ups2 * rate_ups2 / (2.0 * jerk_ups3))
