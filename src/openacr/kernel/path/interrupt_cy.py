"""Flags and captures that start a move (TRG) or end it early (INT)."""

from openacr.kernel.path.path_cy import SLAVE_COUNT, move_record, move_stop_rate
from openacr.kernel.profile.profile_cy import profile_stop
from openacr.kernel.profile.ramps_cy import STOPPING, ramp_distance
from openacr.map.numbers import FLAG_LAST, FLAG_WORD_BASE
from openacr.map.rows import axes, masters, moves, profiles
from openacr.map.words import af1, mf1
from openacr.views import F32, F64, I32

__all__ = ["cut_left", "master_cut"]

# Row cut: what is still to be gone of a path that TRJ has cut.
CUT = 1  # the path slows to rest; what is beyond goes with the move
CUT_DUE = 2  # not yet, for one move more: a rounded corner is passed first; 3: for two, and so on


def flag_state(I: I32, wanted: int) -> bool:
    """Whether flag `wanted - 1` is set or, for a negative number, flag `-wanted - 1` clear."""
    number: int = (wanted if wanted > 0 else -wanted) - 1
    if not 0 <= number <= FLAG_LAST:
        return False
    is_set: bool = (I[FLAG_WORD_BASE + (number >> 5)] >> (number & 31)) & 1 != 0
    return is_set == (wanted > 0)


def response_period(I: I32, m: int) -> int:
    """Ticks from one look at the flag of an INT to the next, -1 never."""
    period: int = I[masters.int_response_period[m]]
    if period < 0:
        return -1
    return max(period, 1)


def cut_left(I: I32, m: int) -> int:
    """How many moves at the head of the buffer are those of a path that is cut or to be cut."""
    if I[masters.cut[m]] >= CUT_DUE:
        return I[masters.cut[m]] - CUT
    return I[masters.section_cnt[m]] if I[masters.cut[m]] else 0


def stop_distance(F: F64, m: int, rate_ups2: float, jerk_ups3: float) -> float:
    """How far the path goes until it has come to rest."""
    velocity_ups: float = F[profiles.velocity[m]]
    if rate_ups2 <= 0.0:
        return 0.0
    if jerk_ups3 <= 0.0:
        return velocity_ups * velocity_ups / (2.0 * rate_ups2)
    return ramp_distance(velocity_ups, F[profiles.accel[m]], 0.0, rate_ups2, jerk_ups3)


def cut_due(F: F64, I: I32, S: F32, m: int) -> None:
    """Cut the path on the line it is on, if it comes to rest before the next rounded corner."""
    left: int = cut_left(I, m)
    record: int = move_record(I, m)
    gone_u: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    if gone_u < F[masters.corner_in_u[m]] or F[masters.corner_out_u[m]] > 0.0:
        return
    rate_ups2: float = move_stop_rate(F, record)
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    room_u: float = F[masters.section_u[m]] - F[profiles.distance[m]]
    if stop_distance(F, m, rate_ups2, jerk_ups3) >= room_u:
        return
    I[masters.piece[m]] = 0
    profile_stop(F, I, m, F[masters.section_u[m]], rate_ups2, jerk_ups3, STOPPING)
    I[masters.section_cnt[m]] = left
    I[masters.cut[m]] = CUT


def master_cut(F: F64, I: I32, S: F32, m: int) -> None:
    """Slow the path to rest with STP (DEC if that is 0) and drop the rest of the move.

    Where its target is nearer than that, the move goes on to it.
    """
    record: int = move_record(I, m)
    if I[profiles.kind[m]] == STOPPING:
        return
    rate_ups2: float = move_stop_rate(F, move_record(I, m))
    if I[masters.piece[m]]:
        I[masters.piece[m]] = 0
        F[masters.section_u[m]] = F[masters.origin_u[m]] + F[moves.length_u[record]]
    end_u: float = F[masters.section_u[m]]
    profile_stop(F, I, m, end_u, rate_ups2, F[moves.jrk_ups3[record]], STOPPING)
    I[masters.cut[m]] = 1


def cut_end(F: F64, I: I32, m: int) -> None:
    """A move has ended before its target: its slaves are wanted where they are.

    Those that take part in a waiting move keep the end of that one as planned end.
    """
    waiting: int = 0
    for k in range(1, I[masters.queued[m]]):
        place: int = I[masters.head[m]] + k
        if place >= I[masters.size[m]]:
            place -= I[masters.size[m]]
        waiting |= I[moves.slaves[I[masters.first[m]] + place]]
    slaves: int = I[moves.slaves[move_record(I, m)]]
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if slaves & (1 << s) and axis >= 0:
            F[axes.target_cnt[axis]] = F[axes.position_cnt[axis]]
            if not waiting & (1 << s):
                F[masters.target_cnt[m] + s] = F[axes.position_cnt[axis]]


def interrupt_step(F: F64, I: I32, S: F32, m: int) -> None:
    """INT: look at the flag of the present move every response period."""
    if I[masters.cut[m]] == CUT or I[masters.response[m]] < 0:
        return
    I[masters.response[m]] -= 1
    if I[masters.response[m]] > 0:
        return
    I[masters.response[m]] = response_period(I, m)
    if flag_state(I, I[moves.interrupt[move_record(I, m)]]):
        master_cut(F, I, S, m)


def move_barred(I: I32, m: int) -> bool:
    """Whether the move at the head may not begin yet; a trigger that has come is used up."""
    word: int = mf1.word[m]
    flags: int = I[word]
    if flags & mf1.START_MOVE_INHIBIT and not I[masters.step_go[m]]:
        return True
    if not flags & mf1.TRG_PENDING:
        return False
    record: int = move_record(I, m)
    bit: int = I[moves.trigger[record]]
    axis: int = I[moves.trigger_axis[record]] - 1
    if bit == 0 and axis < 0:  # the trigger is meant for a later move
        return False
    came: bool = flag_state(I, bit) if bit else I[af1.word[axis]] & af1.CAPTURE_COMPLETE != 0
    if came:
        I[moves.trigger[record]] = 0
        I[moves.trigger_axis[record]] = 0
        I[word] = flags & ~mf1.TRG_PENDING
    return not came
