"""The loop on the wall clock: one tick a period, with Python beside it and never waited for.

It runs on a thread of its own without Python's lock and owns the state of the machine. Three
things go between it and Python, all in memory that both see, each number written by one side:

* the state: row SEQUENCE is odd while a tick is computed, so that a copy can be seen to be whole;
* lists of what handlers have changed: Python moves GIVEN, the loop TAKEN, one list a period;
* what Python is wanted for: counts from ASKED on, and threads in the state THREAD_AWAY.

A tick that cannot begin within its own period is not executed twice in the next one: the periods
that follow are shorter by a SLEW_PART until the time is made up, so that no axis leaps.
"""

from openacr.basic.vm.scheduler_cy import THREAD_AWAY
from openacr.csystem import fence, now_ns, wait_until_ns
from openacr.engine.changes_cy import changes_take
from openacr.engine.loop_cy import (
    DEVICES,
    DONE,
    NETWORKS,
    REQUESTS,
    ROOM,
    THREAD,
    TRACE_FULL,
    engine_run,
)
from openacr.fieldbus.machine.exchange_cy import (
    STEER_NS,
    bus_exchange,
    bus_give,
    bus_take,
    counters_begin,
)
from openacr.map import numbers as at
from openacr.map.numbers import MEMORY_BYTES
from openacr.map.rows import axes, engine, kernel, scheduler, system
from openacr.map.words import af1, af4, mf1
from openacr.views import F32, F64, I32, U8

__all__ = ["realtime_due", "realtime_give", "realtime_run", "realtime_sequence", "realtime_step"]
__unlocked__ = ["realtime_run"]

# Rows of H, the numbers that both sides see; the writer in brackets.
SEQUENCE = 0  # [loop]
GIVEN = 1  # lists that Python has given [Python]
TAKEN = 2  # lists that the loop has taken [loop]
BEAT = 3  # Python is alive [Python]
HEARD = 4  # the latest beat that was heard [loop]
END = 5  # 1: the loop is to bring all to rest and to end, 2: to end at once [Python]
STATE = 6  # [loop]
CODE = 7  # which of the two buffers of compiled programs is valid [loop]
PASSED = 8  # what the loop has passed over, bits [loop]
IS_SILENT = 9  # 1 while programs get no slices [loop]
RESTING = 10  # ticks at rest while the loop ends [loop]
FROM_ZERO = 11  # how often all figures were to begin at 0 [Python]
ASKED = 12  # how often each of these four was wanted [loop]
ASKED_REQUESTS = 12
ASKED_ROOM = 13
ASKED_NETWORKS = 14
ASKED_DEVICES = 15
LISTS = 16  # from here on 3 rows for each list: first entry, count, code buffer plus 1
LIST_ROWS = 3
QUEUE = 64
BEGUN = 208  # how often they have begun at 0 [loop]
H_ROWS = 209
WRAP = 1073741823  # counts begin anew after this one; even and odd stay what they are

# Rows of N, doubles: settings of Python, then figures of the loop.
SILENCE_S = 0  # without a beat for this time, programs get no slices
GONE_S = 1  # and after this time the loop ends as if Python had ended
QUIET_S = 2  # since the latest beat
OWED_NS = 3  # missed time that is still to be made up
LOST_NS = 4  # missed time that will not be
CYCLES = 5
MISSED = 6
WORST_WAKE_NS = 7
WORST_WORK_NS = 8
WORST_TAKE_NS = 9  # to take one list over
MADE_UP = 10  # missed time is made up; 0: it is lost at once
WAKE = 16  # histograms, a bin a microsecond, the last takes the rest
BINS = 4000
WORK = 4016
N_ROWS = 8016

AT_ONCE = 2

# States of the loop.
RUNNING = 0
ENDING = 1  # all motion is killed
ENDED = 2

# What was passed over.
PASSED_TRACE = 1  # the recording is full and has ended
PASSED_KINEMATICS = 2  # an INVK program needs Python: its master is killed

WHOLE = -1  # count of a list that is the whole state
FIRST_KINEMATICS = 32  # thread
SLEW_PART = 32.0
MOST_OWED_NS = 250000000
REST_TK = 20  # at rest that long: it has come to stay
WORDS = MEMORY_BYTES // 4


def realtime_due(N: F64, due: int, period: int, now: int) -> int:
    """When the tick after the one that was due at `due` is due; times in nanoseconds.

    Whole periods that have passed meanwhile are counted, and made up bit by bit.
    """
    following: int = due + period
    owed: int = int(N[OWED_NS])
    if now >= following + period:
        missed: int = int(float(now - following) / float(period))
        N[MISSED] += float(missed)
        owed += missed * period
        following += missed * period
        if owed > MOST_OWED_NS or N[MADE_UP] == 0.0:
            N[LOST_NS] += float(owed)
            owed = 0
    if owed > 0:
        cut: int = int(float(period) / SLEW_PART)
        cut = min(cut, owed)
        owed -= cut
        following -= cut
    N[OWED_NS] = float(owed)
    return following


def figures_begin(H: I32, N: F64, BN: F64) -> None:
    """Let all figures of the loop and of the bus begin at 0, if Python has asked for it."""
    if H[BEGUN] == H[FROM_ZERO]:
        return
    H[BEGUN] = H[FROM_ZERO]
    for k in range(LOST_NS, WORST_TAKE_NS + 1):
        N[k] = 0.0
    for k in range(WAKE, N_ROWS):
        N[k] = 0.0
    counters_begin(BN)


def realtime_sequence(H: I32) -> int:
    """The sequence, read between what was read before and what is read after."""
    fence()
    found: int = H[SEQUENCE]
    fence()
    return found


def realtime_give(H: I32) -> None:
    """The list in the next place of the queue is complete: the loop may take it."""
    fence()
    H[GIVEN] = (H[GIVEN] + 1) & WRAP


def sequence_step(H: I32) -> None:
    """A tick begins to be computed, or is done."""
    fence()
    H[SEQUENCE] = (H[SEQUENCE] + 1) & WRAP
    fence()


def count(N: F64, first: int, worst: int, ns: int) -> None:
    """Add a time to a histogram."""
    place: int = int(float(ns) / 1000.0)
    place = max(0, min(place, BINS - 1))
    N[first + place] += 1.0
    N[worst] = max(N[worst], float(ns))


def list_take(F: F64, I: I32, S: F32, L: I32, D: F64, R: I32, H: I32) -> None:
    """Take the next list over, if there is one; at most one a period."""
    k: int = LISTS + LIST_ROWS * (H[TAKEN] & (QUEUE - 1))
    entries: int = H[k + 1]
    if entries == WHOLE:
        for word in range(WORDS):
            I[word] = R[word]
    else:
        changes_take(F, I, S, L, D, H[k], entries)
    if H[k + 2]:
        H[CODE] = H[k + 2] - 1
    H[TAKEN] = (H[TAKEN] + 1) & WRAP


def thread_leave(I: I32, H: I32, t: int) -> None:
    """A thread needs Python: it waits for it. The joints of a master cannot wait."""
    if I[engine.line_announced] < 0:
        I[engine.line_announced] = t + 1  # no line stops here
        return
    I[at.THI_BASE + t * at.THI_STRIDE + at.THI_STATE] = THREAD_AWAY
    if t >= FIRST_KINEMATICS:
        m: int = t - FIRST_KINEMATICS
        mask: int = 1
        mask = mask << m
        I[kernel.kinematics] = I[kernel.kinematics] & ~mask
        I[mf1.word[m]] = I[mf1.word[m]] | mf1.KILL_ALL_MOVES_REQUEST
        H[PASSED] = H[PASSED] | PASSED_KINEMATICS


def realtime_tick(
    F: F64, I: I32, S: F32, code: I32, nums: F64, trace: F64, seen: I32, log: I32, H: I32
) -> None:
    """One tick to its end; what needs Python is left for it."""
    room: int = 0
    reason: int = THREAD
    I[engine.ticks_left] = 1
    while reason != DONE:
        reason = engine_run(F, I, S, code, nums, trace, seen, log)
        if reason >= THREAD:
            thread_leave(I, H, reason - THREAD)
        elif reason == ROOM:
            H[ASKED_ROOM] = (H[ASKED_ROOM] + 1) & WRAP
            room = I[kernel.moves_waiting]
            I[kernel.moves_waiting] = 0  # or the engine would ask again in this tick
        elif reason == REQUESTS:
            H[ASKED_REQUESTS] = (H[ASKED_REQUESTS] + 1) & WRAP
        elif reason == NETWORKS:
            H[ASKED_NETWORKS] = (H[ASKED_NETWORKS] + 1) & WRAP
        elif reason == DEVICES:
            H[ASKED_DEVICES] = (H[ASKED_DEVICES] + 1) & WRAP
        elif reason == TRACE_FULL:
            I[engine.trace_every] = 0
            H[PASSED] = H[PASSED] | PASSED_TRACE
    I[kernel.moves_waiting] = I[kernel.moves_waiting] | room


def listen(F: F64, H: I32, N: F64) -> None:
    """Whether Python is there: programs without it get no slices, later everything ends."""
    if H[BEAT] != H[HEARD]:
        H[HEARD] = H[BEAT]
        N[QUIET_S] = 0.0
    else:
        N[QUIET_S] += F[system.period_s]
    H[IS_SILENT] = 1 if N[QUIET_S] > N[SILENCE_S] or H[STATE] != RUNNING else 0
    if H[STATE] == RUNNING and (H[END] or N[QUIET_S] > N[GONE_S]):
        H[STATE] = ENDING


def motion_kill(I: I32) -> None:
    """Ask for a kill of every axis and of every path."""
    for n in range(I[kernel.axes]):
        I[af4.word[n]] = I[af4.word[n]] | af4.KILL_ALL_MOTION_REQUEST
    for m in range(I[kernel.masters]):
        I[mf1.word[m]] = I[mf1.word[m]] | mf1.KILL_ALL_MOVES_REQUEST


def is_at_rest(F: F64, I: I32) -> bool:
    """Whether no path, jog or follower moves a setpoint."""
    for m in range(I[kernel.masters]):
        if I[mf1.word[m]] & mf1.IN_MOTION:
            return False
    for n in range(I[kernel.axes]):
        if I[af1.word[n]] & af1.JOG_ACTIVE or F[axes.psp_velocity_cps[n]] != 0.0:
            return False
    return True


def realtime_step(
    F: F64, I: I32, S: F32, code: I32, nums: F64, code_b: I32, nums_b: F64, trace: F64,
    seen: I32, log: I32, L: I32, D: F64, R: I32, H: I32, N: F64, B: I32, BN: F64, X: U8, Y: U8,
) -> None:  # fmt: skip
    """All that is done in one period but to wait for its beginning, and for the frame of a bus."""
    sequence_step(H)
    figures_begin(H, N, BN)
    bus_take(F, I, B, BN, Y, now_ns())
    if H[TAKEN] != H[GIVEN]:
        fence()
        begun: int = now_ns()
        list_take(F, I, S, L, D, R, H)
        N[WORST_TAKE_NS] = max(N[WORST_TAKE_NS], float(now_ns() - begun))
    listen(F, H, N)
    if H[STATE] == ENDING:
        motion_kill(I)
    programs: int = I[scheduler.programs]
    channels: int = I[scheduler.channels]
    if H[IS_SILENT]:
        I[scheduler.programs] = 0
        I[scheduler.channels] = 0
    if H[CODE]:
        realtime_tick(F, I, S, code_b, nums_b, trace, seen, log, H)
    else:
        realtime_tick(F, I, S, code, nums, trace, seen, log, H)
    I[scheduler.programs] = programs
    I[scheduler.channels] = channels
    bus_give(F, I, S, B, BN, X)
    if H[STATE] == ENDING:
        H[RESTING] = H[RESTING] + 1 if is_at_rest(F, I) else 0
        if H[RESTING] >= REST_TK:
            H[STATE] = ENDED
    N[CYCLES] += 1.0
    sequence_step(H)


def realtime_run(
    F: F64, I: I32, S: F32, code: I32, nums: F64, code_b: I32, nums_b: F64, trace: F64,
    seen: I32, log: I32, L: I32, D: F64, R: I32, H: I32, N: F64, B: I32, BN: F64, X: U8, Y: U8,
) -> None:  # fmt: skip
    """Live one tick a period until all is at rest after the end was asked for."""
    due: int = now_ns()
    while H[STATE] != ENDED and H[END] != AT_ONCE:
        due += int(BN[STEER_NS])
        due = realtime_due(N, due, int(1e9 * F[system.period_s] + 0.5), now_ns())
        wait_until_ns(due)
        woken: int = now_ns()
        bus_exchange(B, BN, X, Y, woken)
        begun: int = now_ns()
        realtime_step(
            F, I, S, code, nums, code_b, nums_b, trace, seen, log, L, D, R, H, N, B, BN, X, Y
        )  # fmt: skip
        count(N, WAKE, WORST_WAKE_NS, woken - due)
        count(N, WORK, WORST_WORK_NS, now_ns() - begun)
