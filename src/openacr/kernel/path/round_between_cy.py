"""Which corners of a path are rounded: decided for good when the move after a corner is appended.

A corner with a tolerance counts if LOOK is on at that time or if its move, a binary one, brings
the tolerance along; else the move ends as without LOOK. What LOOK is switched to later says
nothing about it: the path may be within the corner by then, or too near to stop.

With jerk a path that is under way may already be too fast for a corner that comes late: the
corner itself takes a part of the line on which the path was to stop, and the speeds that the
moves before it allow become lower with it. It is accepted only if the backward pass with it still
leads to a speed that the path reaches from where it is; otherwise the path stops there, as it had
planned to.
"""

from openacr.cmath import sqrt
from openacr.kernel.path.interrupt_cy import cut_left
from openacr.kernel.path.lookahead_cy import (
    APART,
    AS_LOOK,
    JOINED,
    STOPS,
    look_active,
    look_beyond,
    look_record,
)
from openacr.kernel.path.path_cy import MARK_ROUNDS, move_record
from openacr.kernel.path.round_corner_cy import SLACK
from openacr.kernel.path.round_cy import (
    round_end,
    round_first,
    round_planned,
    round_through,
    round_where,
)
from openacr.kernel.path.round_law_cy import (
    SHARE,
    STRAIGHT,
    round_accel,
    round_cap,
    round_pays,
    round_point,
    round_straight,
    round_turn,
)
from openacr.kernel.path.round_pass_cy import CORNER_AFTER, LINE, round_exit2
from openacr.kernel.path.round_run_cy import round_rate
from openacr.kernel.path.round_settle_cy import round_arrives
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

__all__ = ["round_again", "round_between"]

REACH = 0.5  # of the shorter of two lines: corners may touch each other in the middle of a line
REACH_JRK = 0.25  # with jerk: half of a line is left to change the speed on
FEEDHOLDING = 1  # see hold_cy


def round_between(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> None:
    """Decide the corner between a move and the one just appended to it."""
    # Given without LOOK, a move keeps its final velocity: the path may be too near to stop.
    active: bool = look_active(I, m) and F[moves.fvel_ups[a]] <= 0.0
    round_decide(F, I, S, m, a, b, active)


def round_again(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> None:
    """Decide a corner once more, of a path at rest whose moves lie elsewhere now."""
    round_decide(F, I, S, m, a, b, look_beyond(I, m, a))


def round_decide(F: F64, I: I32, S: F32, m: int, a: int, b: int, active: bool) -> None:
    """Find how a corner is rounded; where LOOK is not `active` it is by a move that says so."""
    F[moves.corner_u[a]] = 0.0
    F[moves.corner_turn[a]] = 0.0
    F[moves.corner_u[b]] = 0.0
    F[moves.corner_turn[b]] = 0.0
    I[moves.ahead[a]] = AS_LOOK
    tolerance_u: float = F[moves.tolerance_u[a]]
    if not tolerance_u > 0.0:
        return
    if F[moves.turn_deg[a]] > 0.0 and round_point(F, I, a) and round_straight(F, I, b):
        I[moves.ahead[a]] = STOPS if active else APART  # a point has no length to round on
        return
    if not round_straight(F, I, a) or not round_straight(F, I, b):
        return
    # What a TRJ has cut comes to rest; where the move after it begins is not known yet.
    if I[masters.cut[m]] and I[masters.queued[m]] <= cut_left(I, m) + 1:
        I[moves.ahead[a]] = STOPS
        return
    I[moves.ahead[a]] = STOPS if active else APART
    if not active and not I[moves.marks[a]] & MARK_ROUNDS:
        return
    turn: float = round_turn(F, I, S, m, a, b)
    if turn <= STRAIGHT:
        round_take(F, I, S, m, a, 0.0)
        return
    F[moves.corner_turn[a]] = turn
    jerk_ups3: float = F[moves.jrk_ups3[a]]
    shorter_u: float = min(F[moves.length_u[a]], F[moves.length_u[b]])
    reach_u: float = min(4.0 * tolerance_u / turn, REACH * shorter_u)
    if jerk_ups3 > 0.0 or F[moves.jrk_ups3[b]] > 0.0:
        jerk_ups3 = min(jerk_ups3, F[moves.jrk_ups3[b]])
        if jerk_ups3 <= 0.0:  # only one of the two has a limit of jerk
            return
        reach_u = min(6.0 * tolerance_u / turn, REACH_JRK * shorter_u)
    limit_ups2: float = round_accel(F, a)
    other_ups2: float = round_accel(F, b)
    if limit_ups2 <= 0.0 or 0.0 < other_ups2 < limit_ups2:
        limit_ups2 = other_ups2
    F[moves.corner_ups[a]] = round_cap(turn, reach_u, limit_ups2, jerk_ups3)
    if jerk_ups3 <= 0.0 or round_pays(F, a, b, reach_u, limit_ups2, jerk_ups3):
        round_take(F, I, S, m, a, reach_u)


def round_take(F: F64, I: I32, S: F32, m: int, a: int, reach_u: float) -> None:
    """Round the corner at the end of the buffer if the path can still come to it, else stop there.

    A `reach_u` of 0 goes straight on.
    """
    F[moves.corner_u[a]] = reach_u
    refused: int = I[moves.ahead[a]]
    I[moves.ahead[a]] = JOINED
    I[masters.queued[m]] += 1  # as if the move after the corner were there already
    in_time: bool = round_keeps(F, I, S, m)
    I[masters.queued[m]] -= 1
    if not in_time:
        F[moves.corner_u[a]] = 0.0
        I[moves.ahead[a]] = refused


def round_keeps(F: F64, I: I32, S: F32, m: int) -> bool:
    """Whether the path, from where it is, keeps within what lies ahead of it now."""
    record: int = move_record(I, m)
    if not I[masters.moving[m]] or not round_through(F, I, m, record):
        return True
    if F[masters.corner_out_u[m]] > 0.0 and I[masters.queued[m]] <= 1:  # within a corner
        return False
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    part: int = round_where(F, I, m)
    cap_ups: float = F[masters.look_cap_ups[m]]
    first: int = round_first(F, I, S, m, part)
    F[masters.look_cap_ups[m]] = cap_ups  # that of the plan in force
    end_u: float = round_end(F, I, m, part, first)
    room_u: float = end_u - F[profiles.distance[m]]
    w_v2: float = round_exit2(F, I, S, m, part, first)
    leaving_ups: float = sqrt(w_v2)
    top_ups: float = leaving_ups * (1.0 + SLACK)
    end_ups: float = F[profiles.end_velocity[m]]
    if room_u <= 0.0:
        return False
    if part == CORNER_AFTER and F[masters.corner_out_u[m]] <= 0.0:  # its beginning is passed
        return False
    if part != LINE:
        return end_ups <= top_ups
    if I[masters.hold[m]] == FEEDHOLDING:
        return F[profiles.end_distance[m]] <= end_u and end_ups <= top_ups
    if round_planned(F, I, m, end_u, leaving_ups):
        return True
    rate_ups2: float = round_rate(F, look_record(I, m, first), w_v2)
    if jerk_ups3 <= 0.0:
        velocity_ups: float = F[profiles.velocity[m]]
        return velocity_ups * velocity_ups <= w_v2 + 2.0 * rate_ups2 * room_u * SHARE
    return round_arrives(F, m, room_u * SHARE, leaving_ups, rate_ups2, jerk_ups3)
