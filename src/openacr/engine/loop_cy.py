"""Run the card for a number of ticks, until Python is needed.

One tick: the machine moves for one servo period, the servo interrupt runs, then the
background (programs and command channels) until it has nothing more to do in this tick.
The caller handles the reason for the return and calls again; the work continues at
the same point of the same tick.
"""

from openacr.basic.vm.scheduler_cy import EXECUTED, scheduler_step
from openacr.engine.quiet_cy import plcs_step, quiet_step, quiet_stir
from openacr.engine.trace_cy import trace_tick
from openacr.engine.watch_cy import watch_fired
from openacr.map.numbers import (
    ENGI_BASE,
    ENGI_IN_TICK,
    ENGI_STATEMENTS,
    ENGI_STOP,
    ENGI_TICKS_LEFT,
    ENGI_TRACE_EVERY,
    ENGI_TRACE_ROW,
    ENGI_TRACE_ROWS,
    ENGI_TRACE_WAIT,
    ENGI_UNTIL_MASK,
    ENGI_UNTIL_STATE,
    ENGI_UNTIL_WORD,
    ENGI_WATCH_COUNT,
    KRI_AXES,
    KRI_BASE,
    KRI_MOVES_WAITING,
    MDVF_BASE,
    MDVF_DUE_TK,
    MSI_BASE,
    MSI_QUEUED,
    MSI_ROOM_BELOW,
    MSI_STRIDE,
    PF_BLOCK_CONTROL,
    PF_BLOCK_MODE,
    PF_HALT_REQUEST_FLAG,
    PF_PAUSE_CONTROL,
    PF_PAUSE_MODE,
    PF_RUN_REQUEST_FLAG,
    PF_STEP_CONTROL,
    PF_STEP_EDGE_DETECT,
    PF_WORD,
    PLC_COUNT,
    PLF_HALT_REQUEST,
    PLF_RUN_REQUEST,
    PLF_WORD,
    STRM_ESCAPE_REQUEST,
    STRM_OPEN_REQUEST,
    SYSI_BASE,
    SYSI_SLOW_PHASE,
    SYSI_TICK_HIGH,
    SYSI_TICK_LOW,
    W_COM1,
    W_COM2,
    W_DPCB,
    W_FIFO,
)
from openacr.network.wake_cy import networks_due
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
    PF_RUN_REQUEST_FLAG
    | PF_HALT_REQUEST_FLAG
    | PF_BLOCK_CONTROL
    | PF_BLOCK_MODE
    | PF_PAUSE_CONTROL
    | PF_PAUSE_MODE
    | PF_STEP_CONTROL
    | PF_STEP_EDGE_DETECT
)
CHANNEL_REQUESTS = STRM_OPEN_REQUEST | STRM_ESCAPE_REQUEST


def until_met(I: I32) -> bool:
    """Whether the flag the caller waits for has its state."""
    e: int = ENGI_BASE
    word: int = I[e + ENGI_UNTIL_WORD]
    if word <= 0:
        return False
    on: int = 1 if I[word] & I[e + ENGI_UNTIL_MASK] else 0
    return on == I[e + ENGI_UNTIL_STATE]


def requests_pending(I: I32) -> bool:
    """Whether, in this slow scan, flags of a program, PLC or channel request something."""
    if I[SYSI_BASE + SYSI_SLOW_PHASE]:
        return False
    if (I[W_FIFO] | I[W_COM1] | I[W_COM2] | I[W_DPCB]) & CHANNEL_REQUESTS:
        return True
    for n in range(PLC_COUNT):
        if I[PLF_WORD + n] & (PLF_RUN_REQUEST | PLF_HALT_REQUEST):
            return True
    for p in range(PROGRAMS):
        flags: int = I[PF_WORD + p]
        if flags & CONTROLS and (
            flags & (PF_RUN_REQUEST_FLAG | PF_HALT_REQUEST_FLAG)
            or (flags & PF_BLOCK_CONTROL != 0) != (flags & PF_BLOCK_MODE != 0)
            or (flags & PF_PAUSE_CONTROL != 0) != (flags & PF_PAUSE_MODE != 0)
            or (flags & PF_STEP_CONTROL != 0) != (flags & PF_STEP_EDGE_DETECT != 0)
        ):
            return True
    return False


def room_made(I: I32) -> bool:
    """Whether a master for which binary moves wait has room in its buffer."""
    waiting: int = I[KRI_BASE + KRI_MOVES_WAITING]
    m: int = 0
    while waiting:
        if waiting & 1:
            i: int = MSI_BASE + m * MSI_STRIDE
            if I[i + MSI_QUEUED] < I[i + MSI_ROOM_BELOW]:
                return True
        waiting = waiting >> 1
        m += 1
    return False


def engine_run(F: F64, I: I32, S: F32, code: I32, nums: F64, trace: F64, seen: I32) -> int:
    """Run until the requested ticks are done or Python is needed; return the reason."""
    e: int = ENGI_BASE
    quiet_stir(seen)  # the caller may have changed anything
    axes: int = I[KRI_BASE + KRI_AXES]
    while True:
        number: int = I[SYSI_BASE + SYSI_TICK_HIGH] * 2147483648 + I[SYSI_BASE + SYSI_TICK_LOW]
        if I[e + ENGI_IN_TICK] == SERVO_DONE:
            I[e + ENGI_IN_TICK] = DEVICES_DONE
            due: float = F[MDVF_BASE + MDVF_DUE_TK]
            if due > 0.0 and float(number) >= due:
                return DEVICES
        if I[e + ENGI_IN_TICK] == DEVICES_DONE:
            I[e + ENGI_IN_TICK] = NETWORKS_DONE
            if networks_due(F, I, number):
                return NETWORKS
        if I[e + ENGI_IN_TICK] == NETWORKS_DONE:
            I[e + ENGI_IN_TICK] = REQUESTS_DONE
            if requests_pending(I):
                return REQUESTS
        if I[e + ENGI_IN_TICK] and I[KRI_BASE + KRI_MOVES_WAITING] and room_made(I):
            return ROOM
        if I[e + ENGI_IN_TICK]:
            thread: int = scheduler_step(F, I, S, code, nums, number)
            if thread:
                return THREAD + thread - 1
            if I[e + ENGI_IN_TICK] == EXECUTED:
                quiet_stir(seen)
            I[e + ENGI_IN_TICK] = 0
            if until_met(I):
                I[e + ENGI_UNTIL_WORD] = 0
                return UNTIL_MET
            if I[e + ENGI_WATCH_COUNT] and watch_fired(F, I, S):
                I[e + ENGI_STOP] = 0
                return WATCH
            if I[e + ENGI_STOP]:
                I[e + ENGI_STOP] = 0
                return STOPPED
        if I[e + ENGI_TICKS_LEFT] <= 0:
            return DONE
        if (
            I[e + ENGI_TRACE_EVERY] > 0
            and I[e + ENGI_TRACE_WAIT] <= 1
            and I[e + ENGI_TRACE_ROW] >= I[e + ENGI_TRACE_ROWS]
        ):
            return TRACE_FULL
        I[e + ENGI_TICKS_LEFT] -= 1
        I[e + ENGI_STATEMENTS] = 0
        quiet_step(F, I, S, seen, axes)
        plcs_step(F, I, seen)
        if I[e + ENGI_TRACE_EVERY] > 0:
            trace_tick(F, I, S, trace)
        I[e + ENGI_IN_TICK] = SERVO_DONE
