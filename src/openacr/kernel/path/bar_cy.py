"""Moves that may not begin yet, or not at all, on a path that looks ahead.

Start Move Inhibit and SYNC keep the next move from beginning, Block Skip leaves it out. A path
that runs on from one move into the next without a stop comes to rest before it in time: the
junction in front of it becomes a stop. Where there is no room left for that the move counts as
begun, as the path is bound to run into it. Then Inhibit and SYNC act on the next junction before
which there is room, while Block Skip is meant for that one move and comes too late.
"""

from openacr.kernel.path.bezier_cy import is_timed
from openacr.kernel.path.keeps_cy import path_keeps
from openacr.kernel.path.lookahead_cy import (
    STOPS,
    look_beyond,
    look_record,
    look_through,
    same_curve,
)
from openacr.kernel.path.path_cy import MARK_BLOCK_SKIP, move_record
from openacr.kernel.path.round_cy import round_through
from openacr.kernel.path.sync_cy import sync_bars
from openacr.map.rows import masters, moves
from openacr.map.words import mf1, mf2
from openacr.views import F32, F64, I32


def path_bar(F: F64, I: I32, S: F32, m: int) -> None:
    """Let a path under way stop before moves that may not begin or are to be left out."""
    inhibited: bool = I[mf1.word[m]] & mf1.START_MOVE_INHIBIT != 0 or sync_bars(I, m)
    skips: bool = I[mf2.word[m]] & mf2.BLOCK_SKIP_INPUT != 0
    if not inhibited and not skips:
        return
    present: int = move_record(I, m)
    if I[masters.cut[m]] or not (round_through(F, I, m, present) or look_through(F, I, m, present)):
        return
    for k in range(I[masters.queued[m]] - 1):
        a: int = look_record(I, m, k)
        b: int = look_record(I, m, k + 1)
        if I[moves.ahead[a]] == STOPS or not look_beyond(I, m, a):
            return
        if (inhibited or skip_waits(I, m, k, b)) and bar_here(F, I, S, m, k, a, b):
            I[masters.look_dirty[m]] = 1
            return


def bar_here(F: F64, I: I32, S: F32, m: int, k: int, a: int, b: int) -> bool:
    """Make the junction between a and b a stop, for good, if the path comes to rest there."""
    if same_curve(I, a, b) or is_timed(I, a):
        return False
    if k == 0 and F[masters.corner_out_u[m]] > 0.0:  # within the corner
        return False
    decided: int = I[moves.ahead[a]]
    reach_u: float = F[moves.corner_u[a]]
    I[moves.ahead[a]] = STOPS
    F[moves.corner_u[a]] = 0.0
    if path_keeps(F, I, S, m):
        return True
    I[moves.ahead[a]] = decided
    F[moves.corner_u[a]] = reach_u
    return False


def path_passes(I: I32, m: int, velocity_ups: float) -> bool:
    """Whether the path runs into the move at the head at speed, as it was planned to."""
    if velocity_ups <= 0.0:
        return False
    before: int = I[masters.head[m]] - 1
    if before < 0:
        before = I[masters.size[m]] - 1
    before += I[masters.first[m]]
    if same_curve(I, before, move_record(I, m)):
        return True
    if is_timed(I, before):  # it is left at rest, whatever its speed in time
        return False
    return I[moves.ahead[before]] != STOPS and look_beyond(I, m, before)


def skip_waits(I: I32, m: int, k: int, record: int) -> bool:
    """Whether Check stands for the move k + 1 places after the present one."""
    if I[moves.marks[record]] & MARK_BLOCK_SKIP:
        return True
    return k == 0 and I[mf2.word[m]] & mf2.BLOCK_SKIP_CHECK != 0


def skip_take(I: I32, m: int) -> bool:
    """Use up Check for the move at the head; True if with Input that leaves the move out."""
    word2: int = mf2.word[m]
    flags: int = I[word2]
    if I[moves.marks[move_record(I, m)]] & MARK_BLOCK_SKIP:
        flags |= mf2.BLOCK_SKIP_CHECK
    if not flags & mf2.BLOCK_SKIP_CHECK:
        return False
    I[word2] = flags & ~mf2.BLOCK_SKIP_CHECK
    return flags & mf2.BLOCK_SKIP_INPUT != 0
