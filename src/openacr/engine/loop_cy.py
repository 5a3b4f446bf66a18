"""Run the card for a number of ticks, as long as nothing needs Python.

One tick: the world outside moves for one servo period, the servo interrupt runs, then the
background (programs and command channels) until it has nothing more to do in this tick.
Whoever calls deals with the reason for coming back and calls again; the work goes on at
the same place of the same tick.
"""

from openacr.basic.scheduler_cy import scheduler_step
from openacr.kernel.tick_cy import tick
from openacr.map.numbers import (
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_STRIDE,
    AXF_BASE,
    AXF_PSP_VELOCITY_CPS,
    AXF_SSP_CNT,
    AXF_STRIDE,
    ENGI_BASE,
    ENGI_IN_TICK,
    ENGI_TICKS_LEFT,
    ENGI_TRACE_EVERY,
    ENGI_TRACE_ROW,
    ENGI_TRACE_ROWS,
    ENGI_TRACE_WAIT,
    ENGI_UNTIL_MASK,
    ENGI_UNTIL_STATE,
    ENGI_UNTIL_WORD,
    KRI_AXES,
    KRI_BASE,
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
    SYSF_BASE,
    SYSF_PERIOD_S,
    SYSF_TIME_S,
    SYSI_BASE,
    SYSI_SLOW_PHASE,
    SYSI_TICK_HIGH,
    SYSI_TICK_LOW,
    W_INPUTS,
    W_OUTPUTS,
)
from openacr.plant.step_cy import plant_step
from openacr.plc.scan_cy import plc_step
from openacr.views import F32, F64, I32

__all__ = ["engine_run"]

# Reasons for coming back; THREAD + t: thread t needs Python.
DONE = 0
UNTIL_MET = 1
TRACE_FULL = 2
REQUESTS = 3  # control flags of a program or PLC want something
THREAD = 16

# How far the present tick has got (row in_tick); 0: not begun.
SERVO_DONE = 1
REQUESTS_DONE = 2

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

TRACE_HEAD = 3  # time, input word, output word
TRACE_AXIS = 3  # setpoint, actual position, velocity


def trace_sample(F: F64, I: I32, trace: F64) -> None:
    """Append one sample to the trace."""
    e: int = ENGI_BASE
    axes: int = I[KRI_BASE + KRI_AXES]
    at: int = I[e + ENGI_TRACE_ROW] * (TRACE_HEAD + TRACE_AXIS * axes)
    I[e + ENGI_TRACE_ROW] += 1
    trace[at] = F[SYSF_BASE + SYSF_TIME_S]
    trace[at + 1] = I[W_INPUTS]
    trace[at + 2] = I[W_OUTPUTS]
    at += TRACE_HEAD
    for n in range(axes):
        a: int = AXF_BASE + n * AXF_STRIDE
        trace[at] = F[a + AXF_SSP_CNT]
        trace[at + 1] = I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
        trace[at + 2] = F[a + AXF_PSP_VELOCITY_CPS]
        at += TRACE_AXIS


def trace_due(I: I32) -> bool:
    """Whether this tick is to be sampled."""
    e: int = ENGI_BASE
    if I[e + ENGI_TRACE_EVERY] <= 0:
        return False
    I[e + ENGI_TRACE_WAIT] -= 1
    if I[e + ENGI_TRACE_WAIT] > 0:
        return False
    I[e + ENGI_TRACE_WAIT] = I[e + ENGI_TRACE_EVERY]
    return True


def until_met(I: I32) -> bool:
    """Whether the flag the caller waits for has its state."""
    e: int = ENGI_BASE
    word: int = I[e + ENGI_UNTIL_WORD]
    if word <= 0:
        return False
    on: int = 1 if I[word] & I[e + ENGI_UNTIL_MASK] else 0
    return on == I[e + ENGI_UNTIL_STATE]


def requests_pending(I: I32) -> bool:
    """Whether, in this slow scan, the control flags of some program or PLC want something."""
    if I[SYSI_BASE + SYSI_SLOW_PHASE]:
        return False
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


def engine_run(F: F64, I: I32, S: F32, code: I32, nums: F64, trace: F64) -> int:
    """Run until the ticks asked for are done or somebody is needed; return the reason."""
    e: int = ENGI_BASE
    axes: int = I[KRI_BASE + KRI_AXES]
    while True:
        if I[e + ENGI_IN_TICK] == SERVO_DONE:
            I[e + ENGI_IN_TICK] = REQUESTS_DONE
            if requests_pending(I):
                return REQUESTS
        if I[e + ENGI_IN_TICK]:
            number: int = I[SYSI_BASE + SYSI_TICK_HIGH] * 2147483648 + I[SYSI_BASE + SYSI_TICK_LOW]
            thread: int = scheduler_step(F, I, S, code, nums, number)
            if thread:
                return THREAD + thread - 1
            I[e + ENGI_IN_TICK] = 0
            if until_met(I):
                I[e + ENGI_UNTIL_WORD] = 0
                return UNTIL_MET
        if I[e + ENGI_TICKS_LEFT] <= 0:
            return DONE
        if I[e + ENGI_TRACE_EVERY] and I[e + ENGI_TRACE_ROW] >= I[e + ENGI_TRACE_ROWS]:
            return TRACE_FULL
        I[e + ENGI_TICKS_LEFT] -= 1
        plant_step(F, I, S, axes, F[SYSF_BASE + SYSF_PERIOD_S])
        tick(F, I, S)
        plc_step(F, I)
        if trace_due(I):
            trace_sample(F, I, trace)
        I[e + ENGI_IN_TICK] = SERVO_DONE
