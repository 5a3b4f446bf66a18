"""Plan the path of a master from where it is: the present move, or all that look-ahead joins."""

from openacr.kernel.path.lookahead_cy import (
    look_rate,
    look_record,
    look_scan,
    look_through,
)
from openacr.kernel.path.path_cy import master_limit, move_final_ups, move_record
from openacr.kernel.path.round_corner_cy import round_decelerate
from openacr.kernel.path.round_cy import round_plan, round_through
from openacr.kernel.profile.profile_cy import profile_plan
from openacr.map.rows import masters, moves, profiles
from openacr.map.words import mf1, mf4
from openacr.views import F32, F64, I32

__all__ = ["master_plan"]


def master_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the present move of master m from where it is."""
    record: int = move_record(I, m)
    I[masters.final_zero[m]] = I[mf1.word[m]] & mf1.FVEL_ZERO_ACTIVE
    if round_through(F, I, m, record):
        round_plan(F, I, S, m)
        return
    I[masters.piece[m]] = 0
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
