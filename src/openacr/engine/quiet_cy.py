"""Ticks that change nothing but the clocks: tried once, then left out.

What the machine and the servo interrupt do in a tick is a function f of the state X alone, and
at rest it gives X again. Of the clocks it looks at one thing only: whether the slow scan is due.
So once

    f(X) = X        but for the clocks

has been seen of a tick without the scan and of one with it, it holds for every later tick in
which X is the same. Of those the clocks alone have to advance, and the result is equal to the
bit. Programs, channels, PLCs, networks and devices are attended in each tick as ever; what they
change ends the rest, and it has to be seen again.

A trial costs a copy of the state and a comparison: as much as some hundred ticks of a card at
rest. It is made after `PAUSE` ticks without a disturbance, and a rest too short to be worth it
doubles the pause, so that what never rests loses nothing that could be measured.

The rows of `seen` from FIRST on are the copy; below FIRST, where the state has the kinds of the
parameters, it keeps what is known of the rest.
"""

from openacr.kernel.axis.servo_cy import idle_enough, idle_step, servo_counts
from openacr.kernel.path.master_cy import master_busy
from openacr.kernel.sources.clock_cy import clock_step
from openacr.kernel.sources.source_cy import DISARMED, FROM_PARAMETER
from openacr.map.numbers import (
    FLAG_LAST,
    FLAG_WORD_BASE,
    HEAP_BYTE_BASE,
    MSF_BASE,
    P_GLOBAL_SYSTEM_CLOCK,
    PRF_BASE,
    THF_BASE,
    W_FSTAT,
    W_MISC_INPUTS,
    W_MISC_OUTPUTS,
    WATF_BASE,
)
from openacr.map.rows import (
    axes,
    engine,
    kernel,
    machine_devices,
    network_master,
    networks,
    sampler,
    scheduler,
    sources,
    system,
    triggers,
)
from openacr.map.words import mo
from openacr.network.wake_cy import RUNNING
from openacr.plc.scan_cy import PLC_ACTED, PLC_IDLE, plc_step
from openacr.views import F32, F64, I32

__all__ = ["quiet_stir"]

# What is known of the rest, in rows of `seen`.
KNOWN = 0  # the kinds of ticks that were seen to change nothing: PLAIN, SCAN
LEFT_OUT = 1  # ticks since the rest began
WAIT = 2  # ticks until the next trial
PAUSE = 3  # ticks without a disturbance before a trial; 0: no tick is ever left out
NO_PLC = 4  # 1 if no PLC had anything to do in the tick before

# What is done with a tick: left out, executed, or executed as a trial of its kind.
LEFT = -1
IN_FULL = 0
PLAIN = 1
SCAN = 2  # the slow scan is due
PLCS_IDLE = 4  # no PLC has anything to count: as nothing changes, none will have
FIRST_PAUSE = 250
LONGEST_PAUSE = 16000
WORTH = 2000  # ticks left out that are worth their trials
NEVER = 2147483647

# The copy. Profiles, which change with the master or jog that runs them alone, stacks of programs
# and their heap are not part of it.
FIRST = 4096
FIRST_END = 2 * PRF_BASE
SECOND = 2 * MSF_BASE
SECOND_END = 2 * THF_BASE
THIRD = 2 * WATF_BASE
END = HEAP_BYTE_BASE // 4
BLOCK = 1024
FLAGS_END = FLAG_WORD_BASE + FLAG_LAST // 32 + 1


def quiet_begin(F: F64, I: I32, S: F32, seen: I32, axis_count: int) -> int:
    """A tick begins: LEFT if nothing but the clocks would change, and they have advanced.

    Else it is to be executed in full; if it is a trial, its kind, for `quiet_end`.
    """
    phase: int = I[system.slow_phase] + 1
    kind: int = PLAIN if phase < I[kernel.slow_ticks] else SCAN
    if seen[KNOWN] & kind:
        clocks_step(F, I, axis_count, phase if kind == PLAIN else 0)
        seen[LEFT_OUT] = min(seen[LEFT_OUT] + 1, NEVER)
        return LEFT
    if not quiet_may_be(F, I, S):
        seen[KNOWN] = 0
        seen[WAIT] = FIRST_PAUSE
        return IN_FULL
    quiet_copy(I, seen, FIRST, FIRST_END)
    quiet_copy(I, seen, SECOND, SECOND_END)
    quiet_copy(I, seen, THIRD, END)
    return kind


def quiet_end(I: I32, seen: I32, axis_count: int, kind: int) -> None:
    """A trial ends: note whether its kind of tick changes nothing."""
    clocks_copy(I, seen, axis_count)
    if (
        quiet_same(I, seen, THIRD, END)
        and quiet_same(I, seen, SECOND, SECOND_END)
        and quiet_same(I, seen, FIRST, FIRST_END)
    ):
        seen[KNOWN] |= kind
    else:
        quiet_stir(seen)


def quiet_rest(F: F64, I: I32, seen: I32, axis_count: int, number: int) -> None:
    """Let ticks pass that nothing attends, up to the last one before something is due.

    Both kinds of ticks are known to change nothing, and no request was set at the latest scan.
    """
    left: int = I[engine.ticks_left]
    devices_tk: float = F[machine_devices.due_tk]
    networks_tk: float = F[networks.due_tk]
    next_tk: float = float(number + 1)
    phase: int = I[system.slow_phase]
    scan_at: int = I[kernel.slow_ticks]
    while (
        left > 0
        and (devices_tk <= 0.0 or next_tk < devices_tk)
        and (networks_tk <= 0.0 or next_tk < networks_tk)
    ):
        phase += 1
        if phase >= scan_at:
            phase = 0
        clocks_step(F, I, axis_count, phase)
        left -= 1
        next_tk += 1.0
    seen[LEFT_OUT] = min(seen[LEFT_OUT] + I[engine.ticks_left] - left, NEVER)
    I[engine.ticks_left] = left


def is_unattended(I: I32, seen: I32) -> bool:
    """Whether only clocks would advance in the ticks to come: nothing runs, waits or watches."""
    return (
        seen[KNOWN] == PLAIN | SCAN | PLCS_IDLE
        and I[scheduler.programs] == 0
        and I[scheduler.channels] == 0
        and I[engine.until_word] <= 0
        and I[engine.watch_count] == 0
        and I[engine.stop] == 0
        and I[engine.trace_every] <= 0
        and I[kernel.moves_waiting] == 0
        and I[network_master.phase] != RUNNING
    )


def clocks_step(F: F64, I: I32, axis_count: int, phase: int) -> None:
    """What a tick changes of a card at rest; `phase`: ticks since the slow scan."""
    period_s: float = F[system.period_s]
    clock_step(F, I, period_s)
    I[system.slow_phase] = phase
    for n in range(axis_count):
        if servo_counts(I, n):
            idle_step(F, n, period_s)


def quiet_stir(seen: I32) -> None:
    """Something has changed, or may have: a rest has to be seen again."""
    pause: int = seen[PAUSE]
    seen[KNOWN] = 0
    if pause == 0:
        seen[WAIT] = NEVER
        return
    if seen[LEFT_OUT] >= WORTH:
        pause = FIRST_PAUSE
    elif seen[WAIT] == 0:  # trials were made
        pause = min(2 * pause, LONGEST_PAUSE)
    seen[LEFT_OUT] = 0
    seen[PAUSE] = pause
    seen[WAIT] = pause


def quiet_may_be(F: F64, I: I32, S: F32) -> bool:
    """Whether the interrupt has nothing to follow but the state: no samples, clocks, triggers."""
    if I[W_FSTAT] | I[sampler.armed_old] | I[kernel.kinematics]:
        return False
    if I[W_MISC_OUTPUTS] & mo.SAMPLE_TRIGGER_ARMED:
        return False
    for m in range(I[kernel.masters]):
        if master_busy(I, m):
            return False
    for n in range(I[kernel.axes]):
        if I[axes.hlbit[n]] >> 5 == W_MISC_INPUTS - FLAG_WORD_BASE:
            return False  # its limits follow the pulses of the clock
        if servo_counts(I, n) and not idle_enough(F, S, n):
            return False  # its integral is still held
    for t in range(sources.COUNT):  # it may be a clock or the count of a PLC
        if I[sources.kind[t]] == FROM_PARAMETER:
            return False
    for t in range(triggers.COUNT):
        if I[triggers.kind[t]] != DISARMED:
            return False
    return True


def quiet_copy(I: I32, seen: I32, first: int, end: int) -> None:
    """Copy rows of the state."""
    for k in range(first, end):
        seen[k] = I[k]


def clocks_copy(I: I32, seen: I32, axis_count: int) -> None:
    """Copy the clocks alone: they may differ."""
    row_copy(I, seen, system.tick_low)
    row_copy(I, seen, system.tick_high)
    row_copy(I, seen, system.slow_phase)
    row_copy(I, seen, P_GLOBAL_SYSTEM_CLOCK)
    row_copy(I, seen, W_MISC_INPUTS)  # nothing but the pulses of the clock changes there
    real_copy(I, seen, system.time_s)
    real_copy(I, seen, kernel.millisecond_phase)
    for n in range(axis_count):
        real_copy(I, seen, axes.idle_s[n])


def row_copy(I: I32, seen: I32, row: int) -> None:
    """Copy one integer."""
    seen[row] = I[row]


def real_copy(I: I32, seen: I32, row: int) -> None:
    """Copy one number of 64 bits, which two integers share."""
    seen[2 * row] = I[2 * row]
    seen[2 * row + 1] = I[2 * row + 1]


def quiet_same(I: I32, seen: I32, first: int, end: int) -> bool:
    """Whether these rows of the state are those of the copy."""
    start: int = first
    while start < end:
        differs: int = 0
        for k in range(start, min(start + BLOCK, end)):
            differs |= I[k] ^ seen[k]
        if differs:
            return False
        start += BLOCK
    return True


def plcs_step(F: F64, I: I32, seen: I32) -> None:
    """The PLCs; what they change ends the rest. Only who writes gives an idle one work."""
    if seen[KNOWN] & PLCS_IDLE:
        return
    done: int = PLC_IDLE
    if not (seen[NO_PLC] and I[kernel.untouched]):
        done = plc_step(F, I)
        seen[NO_PLC] = 1 if done == PLC_IDLE else 0
    if seen[KNOWN] == 0:
        return
    if done == PLC_IDLE:
        seen[KNOWN] |= PLCS_IDLE
    elif done == PLC_ACTED and flags_stirred(I, seen):
        quiet_stir(seen)


def flags_stirred(I: I32, seen: I32) -> bool:
    """Whether a PLC has changed a flag since the rest began."""
    row_copy(I, seen, W_MISC_INPUTS)
    return not quiet_same(I, seen, FLAG_WORD_BASE, FLAGS_END)
