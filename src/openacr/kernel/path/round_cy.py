"""Plan a path with rounded corners: piece by piece, fast as the acceleration allows.

Rounded corners (corner_cy) divide every move into up to three parts:

    |-- corner before --|------ line ------|-- corner ahead --|
    0                  Tin              L - Tout              L

On the line the ramps of the move apply, in a corner what round_law_cy says; round_pass_cy
looks ahead.

With a jerk limit the speed in corners is constant, whatever happens: a change of override or
a feedhold that cannot be done with in front of a corner continues after it. Only a path that
starts from rest just before one speeds up in it, softly, to half of what it allows.
"""

from openacr.cmath import fabs, sqrt
from openacr.kernel.path.bezier_cy import is_bezier
from openacr.kernel.path.corner_cy import corner_open
from openacr.kernel.path.lookahead_cy import look_active, look_beyond, look_plain, look_record
from openacr.kernel.path.path_cy import master_limit, move_record
from openacr.kernel.path.round_corner_cy import (
    LINGER,
    SLACK,
    STEADY,
    round_corner,
    round_decelerate,
)
from openacr.kernel.path.round_law_cy import round_accel
from openacr.kernel.path.round_pass_cy import (
    CORNER_AFTER,
    CORNER_BEFORE,
    LINE,
    round_exit2,
)
from openacr.kernel.path.round_run_cy import round_last, round_rate, round_run
from openacr.kernel.path.round_settle_cy import round_even, round_reached, round_settle
from openacr.kernel.profile.profile_cy import profile_plan
from openacr.kernel.profile.ramps_cy import rest_speed
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

__all__ = ["round_part", "round_plan", "round_through"]


def round_through(F: F64, I: I32, m: int, record: int) -> bool:
    """Whether the present move is planned in parts."""
    if not I[masters.rounding[m]]:
        return False
    if not look_plain(F, I, record) or is_bezier(I, record):
        return False
    if look_active(I, m) or look_beyond(I, m, record):
        return True
    return F[masters.corner_in_u[m]] > 0.0


def round_where(F: F64, I: I32, m: int) -> int:
    """The part of the present move in which the path is."""
    length_u: float = F[moves.length_u[move_record(I, m)]]
    gone_u: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    if gone_u < F[masters.corner_in_u[m]] - SLACK * length_u:
        return CORNER_BEFORE
    reach_u: float = round_reach(F, I, m, 0)
    if reach_u <= 0.0 or gone_u < length_u - reach_u - SLACK * length_u:
        return LINE
    return CORNER_AFTER


def round_part(F: F64, I: I32, m: int) -> int:
    """The part of the present move in which the path is; open the corner ahead."""
    part: int = round_where(F, I, m)
    if part == CORNER_AFTER and F[masters.corner_out_u[m]] <= 0.0 and I[masters.queued[m]] > 1:
        record: int = move_record(I, m)
        smooth: int = 1 if F[moves.jrk_ups3[record]] > 0.0 else 0
        corner_open(F, I, m, record, look_record(I, m, 1), F[moves.corner_u[record]], smooth)
        F[masters.corner_out_turn[m]] = F[moves.corner_turn[record]]
        F[masters.corner_out_ups[m]] = F[moves.corner_ups[record]]
    return part


def round_reach(F: F64, I: I32, m: int, first: int) -> float:
    """From how far before its end the move `first` places after the present one is rounded."""
    if first == 0 and F[masters.corner_out_u[m]] > 0.0:
        return F[masters.corner_out_u[m]]
    record: int = look_record(I, m, first)
    if I[masters.queued[m]] > first + 1:
        return F[moves.corner_u[record]]
    return 0.0


def round_first(F: F64, I: I32, S: F32, m: int, part: int) -> int:
    """Moves from the present one to the one in which its piece ends: with jerk lines are runs."""
    F[masters.look_cap_ups[m]] = 0.0
    if part == LINE and F[moves.jrk_ups3[move_record(I, m)]] > 0.0:
        return round_run(F, I, S, m)
    return 0


def round_end(F: F64, I: I32, m: int, part: int, first: int) -> float:
    """Where a piece of the present move ends, or that of a run to move `first`."""
    if part == CORNER_BEFORE:
        return F[masters.origin_u[m]] + F[masters.corner_in_u[m]]
    length_u: float = 0.0
    for k in range(first + 1):
        length_u += F[moves.length_u[look_record(I, m, k)]]
    if part == LINE:
        length_u -= round_reach(F, I, m, first)
    return F[masters.origin_u[m]] + length_u


def round_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the piece of the present move in which the path is."""
    record: int = move_record(I, m)
    part: int = round_part(F, I, m)
    first: int = round_first(F, I, S, m, part)
    reach_u: float = round_reach(F, I, m, first)
    I[masters.piece[m]] = 0
    if part == CORNER_BEFORE or (part == LINE and reach_u > 0.0):
        I[masters.piece[m]] = 1
    F[masters.section_u[m]] = round_end(F, I, m, part, first)
    I[masters.section_cnt[m]] = first + 1
    w_v2: float = round_exit2(F, I, S, m, part, first)
    F[masters.look_exit_ups[m]] = sqrt(w_v2)
    limit_ups: float = master_limit(F, I, S, m)
    if part == LINE:
        round_line(F, I, m, first, limit_ups, sqrt(w_v2))
    elif part == CORNER_BEFORE:
        cap_ups: float = F[masters.corner_in_ups[m]]
        round_corner(
            F,
            I,
            m,
            record,
            limit_ups,
            w_v2,
            F[masters.corner_in_turn[m]],
            F[masters.corner_in_u[m]],
            cap_ups,
        )
    else:
        cap_ups = F[masters.corner_out_ups[m]]
        round_corner(
            F, I, m, record, limit_ups, w_v2, F[masters.corner_out_turn[m]], reach_u, cap_ups
        )
    F[profiles.target_velocity[m]] = limit_ups


def round_line(F: F64, I: I32, m: int, first: int, limit_ups: float, leaving_ups: float) -> None:
    """Plan the line of the present move, to the corner ahead or the end of the path."""
    record: int = look_record(I, m, first)
    acc_ups2: float = F[moves.acc_ups2[record]]
    dec_ups2: float = F[moves.dec_ups2[record]]
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    end_u: float = F[masters.section_u[m]]
    room_u: float = end_u - F[profiles.distance[m]]
    ends: bool = round_last(I, m) == first
    rate_ups2: float = F[moves.stp_ups2[record]]
    if not ends:
        rate_ups2 = round_rate(F, record, leaving_ups)
    if not ends and leaving_ups > 0.0:
        if jerk_ups3 > 0.0 and acc_ups2 > 0.0:  # corners are entered without acceleration
            reached_ups: float = round_reached(
                F, m, room_u * (1.0 - SLACK), limit_ups, acc_ups2, jerk_ups3
            )
            if 0.0 <= reached_ups <= min(leaving_ups, limit_ups):
                round_even(F, I, m, end_u, reached_ups, acc_ups2, rate_ups2, jerk_ups3)
                return
        if jerk_ups3 > 0.0 and rate_ups2 > 0.0:
            wanted_ups: float = min(leaving_ups, limit_ups)
            reached_ups = round_settle(F, m, room_u, wanted_ups, leaving_ups, rate_ups2, jerk_ups3)
            if round_planned(F, I, m, end_u, leaving_ups):
                misses: bool = reached_ups < 0.0 or reached_ups > leaving_ups * (1.0 + SLACK)
                settled: bool = F[profiles.target_velocity[m]] == limit_ups
                if misses or (settled and reached_ups < F[profiles.end_velocity[m]]):
                    return
            if reached_ups == 0.0 and limit_ups > 0.0:
                leaving_ups = 0.0  # there is room for nothing but a stop at its end
            elif reached_ups >= 0.0 and reached_ups != wanted_ups:
                if limit_ups <= 0.0 and I[masters.piece[m]]:
                    rest_ups: float = rest_speed(
                        F[profiles.velocity[m]], F[profiles.accel[m]], jerk_ups3
                    )
                    reached_ups = max(reached_ups, min(LINGER * leaving_ups, rest_ups))
                round_even(F, I, m, end_u, reached_ups, acc_ups2, rate_ups2, jerk_ups3)
                return
        if leaving_ups >= limit_ups:
            rate_ups2 = 0.0
    profile_plan(F, I, m, end_u, limit_ups, leaving_ups, acc_ups2, dec_ups2, rate_ups2, jerk_ups3)
    if not ends:
        round_decelerate(I, m)


def round_planned(F: F64, I: I32, m: int, end_u: float, leaving_ups: float) -> bool:
    """Whether the present plan leads to `end_u` with `leaving_ups` at most and no acceleration."""
    if I[profiles.seg_count[m]] <= 0 or F[profiles.end_distance[m]] != end_u:
        return False
    steady_ups2: float = STEADY * round_accel(F, move_record(I, m))
    if fabs(F[profiles.plan_accel[m]]) > steady_ups2:
        return False
    return F[profiles.end_velocity[m]] <= leaving_ups * (1.0 + SLACK)
