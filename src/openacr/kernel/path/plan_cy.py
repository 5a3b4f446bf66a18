"""Plan the path of a master from where it is: the present move, or all that look-ahead joins."""

from openacr.kernel.path.lookahead_cy import (
    AS_LOOK,
    BY_LOOK,
    look_active,
    look_rate,
    look_record,
    look_scan,
    look_through,
)
from openacr.kernel.path.path_cy import master_limit, move_final_ups, move_record
from openacr.kernel.path.round_corner_cy import round_decelerate
from openacr.kernel.path.round_cy import round_plan, round_through
from openacr.kernel.profile.profile_cy import profile_plan
from openacr.kernel.profile.ramps_cy import ramp_distance
from openacr.map.rows import masters, moves, profiles
from openacr.map.words import mf1, mf4
from openacr.views import F32, F64, I32

__all__ = ["master_plan"]

ROUNDING = 1e-6  # of a distance


def master_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the present move of master m from where it is."""
    record: int = move_record(I, m)
    I[masters.final_zero[m]] = I[mf1.word[m]] & mf1.FVEL_ZERO_ACTIVE
    if round_through(F, I, m, record):
        round_plan(F, I, S, m)
        return
    I[masters.piece[m]] = 0
    if not look_active(I, m) and look_before(I, m, record):
        look_leave(F, I, S, m)
    if look_through(F, I, m, record):
        look_scan(F, I, S, m)
        look_plan(F, I, S, m)
        return
    F[masters.section_u[m]] = F[masters.origin_u[m]] + F[moves.length_u[record]]
    F[masters.look_cap_ups[m]] = 0.0
    I[masters.section_cnt[m]] = 1
    profile_plan(
        F,
        I,
        m,
        F[masters.section_u[m]],
        master_limit(F, I, S, m),
        move_final_ups(F, I, m, record),
        F[moves.acc_ups2[record]],
        F[moves.dec_ups2[record]],
        F[moves.stp_ups2[record]],
        F[moves.jrk_ups3[record]],
    )


def look_before(I: I32, m: int, record: int) -> bool:
    """Whether LOOK has planned the path to go on beyond a move, or into it."""
    before: int = I[masters.head[m]] - 1
    if before < 0:
        before = I[masters.size[m]] - 1
    before += I[masters.first[m]]
    return I[moves.ahead[record]] == BY_LOOK or I[moves.ahead[before]] == BY_LOOK


def look_leave(F: F64, I: I32, S: F32, m: int) -> None:
    """LOOK was switched off under way: its law rules on to the first junction with room before it.

    From there on the moves end as without LOOK.
    """
    queued: int = I[masters.queued[m]]
    for k in range(queued):
        if I[moves.ahead[look_record(I, m, k)]] == BY_LOOK:
            I[moves.ahead[look_record(I, m, k)]] = AS_LOOK
    for k in range(queued - 1):
        look_scan(F, I, S, m)
        if look_fits(F, I, m):
            return
        if I[moves.ahead[look_record(I, m, k)]] == AS_LOOK:
            I[moves.ahead[look_record(I, m, k)]] = BY_LOOK


def look_fits(F: F64, I: I32, m: int) -> bool:
    """Whether the path slows down to the speed at the end of the section that was found."""
    section: int = I[masters.section_cnt[m]]
    last: int = look_record(I, m, section - 1)
    velocity_ups: float = F[profiles.velocity[m]]
    leaving_ups: float = min(F[masters.look_exit_ups[m]], velocity_ups)
    rate_ups2: float = F[moves.stp_ups2[last]]
    if section < I[masters.queued[m]] and I[moves.ahead[last]] != AS_LOOK:
        rate_ups2 = look_rate(F, last)
    if rate_ups2 <= 0.0:
        return True
    room_u: float = (F[masters.section_u[m]] - F[profiles.distance[m]]) * (1.0 + ROUNDING)
    jerk_ups3: float = F[moves.jrk_ups3[last]]
    if jerk_ups3 <= 0.0:
        change_v2: float = velocity_ups * velocity_ups - leaving_ups * leaving_ups
        return change_v2 <= 2.0 * rate_ups2 * room_u
    accel_ups2: float = F[profiles.accel[m]]
    return ramp_distance(velocity_ups, accel_ups2, leaving_ups, rate_ups2, jerk_ups3) <= room_u


def look_rebase(F: F64, m: int) -> None:
    """Count the path from the beginning of the present move again."""
    origin_u: float = F[masters.origin_u[m]]
    F[profiles.distance[m]] -= origin_u
    F[masters.section_u[m]] -= origin_u
    F[masters.origin_u[m]] = 0.0


def look_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan through the section that was found, to its end or to the junction there.

    A path already slower there than the junction allows arrives with the speed it has.
    """
    section: int = I[masters.section_cnt[m]]
    last: int = look_record(I, m, section - 1)
    record: int = move_record(I, m)
    limit_ups: float = master_limit(F, I, S, m)
    leaving_ups: float = F[masters.look_exit_ups[m]]
    rate_ups2: float = F[moves.stp_ups2[last]]
    ends: bool = section >= I[masters.queued[m]]
    if not ends:
        rate_ups2 = look_rate(F, last) if leaving_ups < limit_ups else 0.0
    I[mf4.word[m]] &= ~mf4.LOOK_AHEAD_SLOWDOWN
    if not ends and leaving_ups < limit_ups:
        I[mf4.word[m]] |= mf4.LOOK_AHEAD_SLOWDOWN
    profile_plan(
        F,
        I,
        m,
        F[masters.section_u[m]],
        limit_ups,
        leaving_ups,
        F[moves.acc_ups2[record]],
        F[moves.dec_ups2[record]],
        rate_ups2,
        F[moves.jrk_ups3[record]],
    )
    if not ends:
        round_decelerate(I, m)


def look_refresh(F: F64, I: I32, S: F32, m: int) -> None:
    """The buffer has changed: plan again if that makes a difference to the present plan."""
    I[masters.look_dirty[m]] = 0
    if round_through(F, I, m, move_record(I, m)):
        round_plan(F, I, S, m)
        return
    if not look_active(I, m) and look_before(I, m, move_record(I, m)):
        master_plan(F, I, S, m)
        return
    if not look_through(F, I, m, move_record(I, m)):
        return
    end_u: float = F[masters.section_u[m]]
    cap_ups: float = F[masters.look_cap_ups[m]]
    leaving_ups: float = F[masters.look_exit_ups[m]]
    look_scan(F, I, S, m)
    if (
        end_u != F[masters.section_u[m]]
        or cap_ups != F[masters.look_cap_ups[m]]
        or leaving_ups != F[masters.look_exit_ups[m]]
    ):
        look_rebase(F, m)
        look_plan(F, I, S, m)
