"""Backward pass through the rounded corners and lines of all moves that wait.

It begins with rest a few moves ahead; if no corner and no feed has capped it on its way
here, those few were not enough, and it begins farther ahead.

A binary move with a tolerance of its own is planned through the corner at its end though LOOK
is off; the chain of such moves ends with the first other one, as that one ends without LOOK.
"""

from openacr.kernel.path.lookahead_cy import look_final, look_rate, look_record, look_speed
from openacr.kernel.path.round_law_cy import (
    ENDLESS,
    line_start2,
    round_accel,
    round_limit,
    round_ramp2,
)
from openacr.kernel.path.round_run_cy import (
    round_join,
    round_last,
    round_merges,
    round_rate,
    round_turning,
)
from openacr.map.rows import masters, moves
from openacr.views import F32, F64, I32

__all__ = ["round_exit2"]

CORNER_BEFORE = 0  # parts of a move
LINE = 1
CORNER_AFTER = 2
FEW = 16  # moves the backward pass looks at first


def round_cap2(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Highest speed squared at the corner between moves a and b, rounded or not."""
    if F[moves.corner_u[a]] > 0.0:
        return F[moves.corner_ups[a]] * F[moves.corner_ups[a]]
    law_ups: float = round_join(F, I, S, m, a, b)
    return law_ups * law_ups


def round_half2(
    F: F64, corner: int, r: int, reach_u: float, jerk_ups3: float, w_v2: float
) -> float:
    """Highest speed squared at the other end of the half of a corner that is in move r."""
    turn: float = F[moves.corner_turn[corner]]
    cap_ups: float = F[moves.corner_ups[corner]]
    limit_ups2: float = round_limit(turn, reach_u, cap_ups, round_accel(F, r), jerk_ups3)
    return round_ramp2(turn, reach_u, limit_ups2, jerk_ups3, w_v2)


def round_line2(
    F: F64, r: int, length_u: float, w_v2: float, rate_ups2: float, capped: bool
) -> float:
    """Highest speed squared at the beginning of a run that ends with move r.

    As long as moves farther ahead might still raise `w_v2`, nothing that a higher one forbids.
    """
    jerk_ups3: float = F[moves.jrk_ups3[r]]
    if not capped and jerk_ups3 > 0.0:
        least_ups: float = round_turning(length_u, rate_ups2, jerk_ups3)
        w_v2 = max(w_v2, least_ups * least_ups)
    return line_start2(length_u, w_v2, rate_ups2, jerk_ups3)


def round_pass(F: F64, I: I32, S: F32, m: int, part: int, first: int, far: int, last: int) -> float:
    """Backward pass from move `far` of up to `last` to the end of a piece of the present one.

    The end of a line is in move `first`. Not capped before it, the result is negative if moves
    beyond `far` might change it.
    """
    k: int = far
    r: int = look_record(I, m, k)
    w_v2: float = 0.0
    rate_ups2: float = min(look_rate(F, r), round_rate(F, r, 0.0))
    capped: bool = far >= last
    run_u: float = 0.0  # of the moves of a run after this one
    run_v2: float = ENDLESS
    if far >= last:
        w_v2 = look_final(F, I, S, m, r)
        w_v2 = w_v2 * w_v2
        rate_ups2 = F[moves.stp_ups2[r]]
    while True:
        speed_ups: float = look_speed(F, I, S, m, r)
        top_v2: float = min(speed_ups * speed_ups, run_v2)
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
        if k == first and part == LINE:
            break
        run_u += F[moves.length_u[r]] - reach_u - before_u
        if k > 0 and round_merges(F, I, S, m, a, r):
            run_v2 = min(run_v2, round_cap2(F, I, S, m, a, r))
            r = a
            k -= 1
            continue
        w_v2 = round_line2(F, r, run_u, w_v2, rate_ups2, capped)
        run_u = 0.0
        run_v2 = ENDLESS
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
        rate_ups2 = round_rate(F, a, w_v2)
        r = a
        k -= 1
    return w_v2 if capped else -1.0


def round_exit2(F: F64, I: I32, S: F32, m: int, part: int, first: int) -> float:
    """Highest speed squared at the end of a piece of the present move, or of a run to `first`."""
    last: int = round_last(I, m)
    far: int = min(first + FEW, last)
    w_v2: float = round_pass(F, I, S, m, part, first, far, last)
    while w_v2 < 0.0 and far < last:
        far = min(2 * far, last)
        w_v2 = round_pass(F, I, S, m, part, first, far, last)
    return max(w_v2, 0.0)
