"""Run the card for a number of ticks, until Python is needed.

One tick: the machine moves for one servo period, the servo interrupt runs, then the
background (programs and command channels) until it has nothing more to do in this tick.
The caller handles the reason for the return and calls again; the work continues at
the same point of the same tick.
"""

from openacr.basic.vm.scheduler_cy import EXECUTED, scheduler_step
from openacr.engine.alone_cy import CALM, LATER, alone, alone_begin, alone_end
from openacr.engine.change_log_cy import WORDS, changes_note
from openacr.engine.quiet_cy import (
    IN_FULL,
    LEFT,
    LEFT_OUT,
    WAIT,
    is_unattended,
    plcs_step,
    quiet_begin,
    quiet_end,
    quiet_rest,
    quiet_stir,
)
from openacr.engine.trace_cy import trace_tick
from openacr.engine.watch_cy import watch_fired
from openacr.kernel.axis.modules_cy import missing_outputs_step
from openacr.kernel.tick_cy import tick
from openacr.map import numbers as at
from openacr.map.rows import engine, kernel, machine_devices, plcs, system
from openacr.map.words import pf, plf, strm
from openacr.network.wake_cy import networks_due
from openacr.plant.physics.step_cy import plant_step
from openacr.views import F32, F64, I32

__all__ = ["engine_run"]

# Reasons for returning; THREAD + t: thread t needs Python.
DONE = 0
UNTIL_MET = 1
TRACE_FULL = 2
REQUESTS = 3  # control flags of a program, PLC or channel request something
STOPPED = 4  # the end of a tick at which the caller wanted to be called
WATCH = 5  # a watched value has changed in the completed tick
ROOM = 6  # binary moves wait, and the buffer of their master has room
NETWORKS = 7  # a network needs service
DEVICES = 8  # a device of the machine is due
THREAD = 16

# Progress within the current tick (row in_tick); 0: not begun.
SERVO_DONE = 1
DEVICES_DONE = 2
NETWORKS_DONE = 3
REQUESTS_DONE = 4  # `EXECUTED` of the scheduler follows

PROGRAMS = 16
CONTROLS = (
    pf.RUN_REQUEST_FLAG
    | pf.HALT_REQUEST_FLAG
    | pf.BLOCK_CONTROL
    | pf.BLOCK_MODE
    | pf.PAUSE_CONTROL
    | pf.PAUSE_MODE
    | pf.STEP_CONTROL
    | pf.STEP_EDGE_DETECT
)
CHANNEL_REQUESTS = strm.OPEN_REQUEST | strm.ESCAPE_REQUEST


def until_met(I: I32) -> bool:
    """Whether the flag the caller waits for has its state."""
    word: int = I[engine.until_word]
    if word <= 0:
        return False
    on: int = 1 if I[word] & I[engine.until_mask] else 0
    return on == I[engine.until_state]


def requests_pending(I: I32) -> bool:
    """Whether, in this slow scan, flags of a program, PLC or channel request something."""
    if I[system.slow_phase]:
        return False
    if (I[at.W_FIFO] | I[at.W_COM1] | I[at.W_COM2] | I[at.W_DPCB]) & CHANNEL_REQUESTS:
        return True
    for n in range(plcs.COUNT):
        if I[at.PLF_WORD + n] & (plf.RUN_REQUEST | plf.HALT_REQUEST):
            return True
    for p in range(PROGRAMS):
        flags: int = I[at.PF_WORD + p]
        if flags & CONTROLS and (
            flags & (pf.RUN_REQUEST_FLAG | pf.HALT_REQUEST_FLAG)
            or (flags & pf.BLOCK_CONTROL != 0) != (flags & pf.BLOCK_MODE != 0)
            or (flags & pf.PAUSE_CONTROL != 0) != (flags & pf.PAUSE_MODE != 0)
            or (flags & pf.STEP_CONTROL != 0) != (flags & pf.STEP_EDGE_DETECT != 0)
        ):
            return True
    return False


def room_made(I: I32) -> bool:
    """Whether a master for which binary moves wait has room in its buffer."""
    waiting: int = I[kernel.moves_waiting]
    m: int = 0
    while waiting:
        if waiting & 1:
            i: int = at.MSI_BASE + m * at.MSI_STRIDE
            if I[i + at.MSI_QUEUED] < I[i + at.MSI_ROOM_BELOW]:
                return True
        waiting = waiting >> 1
        m += 1
    return False


def engine_run(
    F: F64, I: I32, S: F32, code: I32, nums: F64, trace: F64, seen: I32, log: I32
) -> int:
    """Run until the requested ticks are done or Python is needed; return the reason."""
    reason: int = ticks_run(F, I, S, code, nums, trace, seen, log)
    alone_end(F, I, S)
    return reason


def ticks_run(F: F64, I: I32, S: F32, code: I32, nums: F64, trace: F64, seen: I32, log: I32) -> int:
    """Run as `engine_run`; what the interrupt has left out remains to be shown."""
    quiet_stir(seen)  # the caller may have changed anything
    calm: int = 0
    axes: int = I[kernel.axes]
    while True:
        number: int = I[system.tick_high] * 2147483648 + I[system.tick_low]
        if I[engine.in_tick] == SERVO_DONE:
            I[engine.in_tick] = DEVICES_DONE
            due: float = F[machine_devices.due_tk]
            if due > 0.0 and float(number) >= due:
                return DEVICES
        if I[engine.in_tick] == DEVICES_DONE:
            I[engine.in_tick] = NETWORKS_DONE
            if networks_due(F, I, number):
                return NETWORKS
        if I[engine.in_tick] == NETWORKS_DONE:
            I[engine.in_tick] = REQUESTS_DONE
            if requests_pending(I):
                return REQUESTS
        if I[engine.in_tick] and I[kernel.moves_waiting] and room_made(I):
            return ROOM
        if I[engine.in_tick]:
            thread: int = scheduler_step(F, I, S, code, nums, number)
            if thread:
                return THREAD + thread - 1
            if I[engine.in_tick] == EXECUTED:
                quiet_stir(seen)
                calm = 0
            I[engine.in_tick] = 0
            if log[WORDS] and seen[LEFT_OUT] == 0:
                changes_note(I, log)
            if until_met(I):
                I[engine.until_word] = 0
                return UNTIL_MET
            if I[engine.watch_count] and watch_fired(F, I, S):
                I[engine.stop] = 0
                return WATCH
            if I[engine.stop]:
                I[engine.stop] = 0
                return STOPPED
        if is_unattended(I, seen):
            quiet_rest(F, I, seen, axes, number)
        if I[engine.ticks_left] <= 0:
            return DONE
        if (
            I[engine.trace_every] > 0
            and I[engine.trace_wait] <= 1
            and I[engine.trace_row] >= I[engine.trace_rows]
        ):
            return TRACE_FULL
        I[engine.ticks_left] -= 1
        I[engine.statements] = 0
        calm += 1
        if calm == CALM and not alone(I):
            calm = -LATER
        alone_begin(F, I, S, calm)
        trial: int = IN_FULL
        if seen[WAIT] > 0:
            seen[WAIT] -= 1
        else:
            trial = quiet_begin(F, I, S, seen, axes)
        if trial != LEFT:
            if I[kernel.missing_dacs]:
                missing_outputs_step(I, S)  # programs may have written some
            plant_step(F, I, S, axes, F[system.period_s])
            tick(F, I, S)
            if trial != IN_FULL:
                quiet_end(I, seen, axes, trial)
        plcs_step(F, I, seen)
        if I[engine.trace_every] > 0:
            trace_tick(F, I, S, trace)
        I[engine.in_tick] = SERVO_DONE
