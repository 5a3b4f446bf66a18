"""Backward pass through the rounded corners and lines of all moves that wait.

It begins with rest a few moves ahead; if no corner and no feed has capped it on its way
here, those few were not enough, and it begins farther ahead.

A binary move with a tolerance of its own is planned through the corner at its end though LOOK
is off; the chain of such moves ends with the first other one, as that one ends without LOOK.
"""

from openacr.kernel.path.lookahead_cy import (
    look_beyond,
    look_corner,
    look_final,
    look_rate,
    look_record,
    look_speed,
)
from openacr.kernel.path.round_law_cy import (
    STRAIGHT,
    line_start2,
    round_accel,
    round_limit,
    round_ramp2,
)
from openacr.map.rows import masters, moves
from openacr.views import F32, F64, I32

__all__ = ["round_exit2"]

CORNER_BEFORE = 0  # parts of a move
LINE = 1
CORNER_AFTER = 2
FEW = 16  # moves the backward pass looks at first


def round_join2(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Speed squared at a corner that is not rounded."""
    if I[moves.ahead[a]]:  # straight on
        speed_ups: float = min(look_speed(F, I, S, m, a), look_speed(F, I, S, m, b))
        return speed_ups * speed_ups
    if F[moves.tolerance_u[a]] > 0.0 and F[moves.corner_turn[a]] > STRAIGHT:
        return 0.0  # the next move has come too late
    law_ups: float = look_corner(F, I, S, m, a, b)
    return law_ups * law_ups


def round_cap2(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Highest speed squared at the corner between moves a and b, rounded or not."""
    if F[moves.corner_u[a]] > 0.0:
        return F[moves.corner_ups[a]] * F[moves.corner_ups[a]]
    return round_join2(F, I, S, m, a, b)


def round_half2(
    F: F64, corner: int, r: int, reach_u: float, jerk_ups3: float, w_v2: float
) -> float:
    """Highest speed squared at the other end of the half of a corner that is in move r."""
    turn: float = F[moves.corner_turn[corner]]
    cap_ups: float = F[moves.corner_ups[corner]]
    limit_ups2: float = round_limit(turn, reach_u, cap_ups, round_accel(F, r), jerk_ups3)
    return round_ramp2(turn, reach_u, limit_ups2, jerk_ups3, w_v2)


def round_pass(F: F64, I: I32, S: F32, m: int, part: int, far: int, last: int) -> float:
    """Backward pass from move `far` of up to `last` to the end of a piece of the present one.

    Not capped before it, the result is negative if moves beyond `far` might change it.
    """
    k: int = far
    r: int = look_record(I, m, k)
    w_v2: float = 0.0
    rate_ups2: float = look_rate(F, r)
    capped: bool = far >= last
    if far >= last:
        w_v2 = look_final(F, I, S, m, r)
        w_v2 = w_v2 * w_v2
        rate_ups2 = F[moves.stp_ups2[r]]
    while True:
        speed_ups: float = look_speed(F, I, S, m, r)
        top_v2: float = speed_ups * speed_ups
        jerk_ups3: float = F[moves.jrk_ups3[r]]
        reach_u: float = F[moves.corner_u[r]] if k < last else 0.0
        before_u: float = F[masters.corner_in_u[m]]
        a: int = r
        if k > 0:
            a = look_record(I, m, k - 1)
            before_u = F[moves.corner_u[a]]
        if w_v2 >= top_v2:
            w_v2 = top_v2
            capped = True
        if k == 0 and part == CORNER_AFTER:
            break
        if reach_u > 0.0:
            w_v2 = round_half2(F, r, r, reach_u, jerk_ups3, w_v2)
            cap_v2: float = min(F[moves.corner_ups[r]] * F[moves.corner_ups[r]], top_v2)
            if w_v2 >= cap_v2:
                w_v2 = cap_v2
                capped = True
        if k == 0 and part == LINE:
            break
        w_v2 = line_start2(F[moves.length_u[r]] - reach_u - before_u, w_v2, rate_ups2, jerk_ups3)
        if w_v2 >= top_v2:
            w_v2 = top_v2
            capped = True
        if k == 0:
            break
        corner_v2: float = round_cap2(F, I, S, m, a, r)
        if before_u > 0.0:
            w_v2 = round_half2(F, a, r, before_u, jerk_ups3, min(w_v2, corner_v2))
        if w_v2 >= corner_v2:
            w_v2 = corner_v2
            capped = True
        rate_ups2 = look_rate(F, a)
        r = a
        k -= 1
    return w_v2 if capped else -1.0


def round_last(I: I32, m: int) -> int:
    """Moves from the present one to the last that plans may run through."""
    last: int = I[masters.queued[m]] - 1
    k: int = 0
    while k < last and look_beyond(I, m, look_record(I, m, k)):
        k += 1
    return k


def round_exit2(F: F64, I: I32, S: F32, m: int, part: int) -> float:
    """Highest speed squared at the end of a piece of the present move."""
    last: int = round_last(I, m)
    far: int = min(FEW, last)
    w_v2: float = round_pass(F, I, S, m, part, far, last)
    while w_v2 < 0.0 and far < last:
        far = min(2 * far, last)
        w_v2 = round_pass(F, I, S, m, part, far, last)
    return max(w_v2, 0.0)
