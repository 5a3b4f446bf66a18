"""Run the card for a number of ticks, as long as nothing needs Python.

One tick: the world outside moves for one servo period, the servo interrupt runs, then the
background (programs and command channels) until it has nothing more to do in this tick.
Whoever calls deals with the reason for coming back and calls again; the work goes on at
the same place of the same tick.
"""

from openacr.basic.scheduler_cy import scheduler_step
from openacr.kernel.modules_cy import missing_outputs_step
from openacr.kernel.tick_cy import tick
from openacr.map.numbers import (
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_PPU,
    AX_STRIDE,
    AXF_BASE,
    AXF_PSP_VELOCITY_CPS,
    AXF_SSP_CNT,
    AXF_STRIDE,
    ENGI_BASE,
    ENGI_IN_TICK,
    ENGI_STOP,
    ENGI_TICKS_LEFT,
    ENGI_TRACE_EVERY,
    ENGI_TRACE_PEAKS,
    ENGI_TRACE_ROW,
    ENGI_TRACE_ROWS,
    ENGI_TRACE_WAIT,
    ENGI_UNTIL_MASK,
    ENGI_UNTIL_STATE,
    ENGI_UNTIL_WORD,
    ENGI_WATCH_COUNT,
    KRI_AXES,
    KRI_BASE,
    KRI_MISSING_DACS,
    KRI_MOVES_WAITING,
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
    SYSF_BASE,
    SYSF_PERIOD_S,
    SYSF_TIME_S,
    SYSI_BASE,
    SYSI_SLOW_PHASE,
    SYSI_TICK_HIGH,
    SYSI_TICK_LOW,
    W_INPUTS,
    W_OUTPUTS,
    WAT_COUNT,
    WATF_BASE,
    WATF_BOUND,
    WATF_STRIDE,
    WATI_BASE,
    WATI_IS_ABOVE,
    WATI_KIND,
    WATI_MASK,
    WATI_ROW,
    WATI_STATE,
    WATI_STRIDE,
)
from openacr.network.wake_cy import networks_due
from openacr.plant.step_cy import plant_step
from openacr.plc.scan_cy import plc_step
from openacr.views import F32, F64, I32

__all__ = ["engine_run", "watch_fired"]

# Reasons for coming back; THREAD + t: thread t needs Python.
DONE = 0
UNTIL_MET = 1
TRACE_FULL = 2
REQUESTS = 3  # control flags of a program or PLC want something
STOPPED = 4  # the tick is over at whose end somebody wanted to look
WATCH = 5  # something watched has changed in the tick that is over
ROOM = 6  # binary moves wait, and the buffer of their master has room
NETWORKS = 7  # something on a network is due
THREAD = 16

# How far the present tick has got (row in_tick); 0: not begun.
SERVO_DONE = 1
NETWORKS_DONE = 2
REQUESTS_DONE = 3

# Where a watched value is: masked bits of a word, or a number that is compared.
WATCH_WORD = 0
WATCH_LONG = 1
WATCH_FP32 = 2
WATCH_FP64 = 3
WATCH_AXIS = 4  # actual position in units; row: the first parameter of the axis

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
TRACE_AXIS = 4  # setpoint, actual position, velocity, following error


def trace_place(F: F64, I: I32, trace: F64, row: int) -> None:
    """Write time, inputs, outputs and the positions of this tick into a row of the trace."""
    axes: int = I[KRI_BASE + KRI_AXES]
    at: int = row * (TRACE_HEAD + TRACE_AXIS * axes)
    trace[at] = F[SYSF_BASE + SYSF_TIME_S]
    trace[at + 1] = I[W_INPUTS]
    trace[at + 2] = I[W_OUTPUTS]
    at += TRACE_HEAD
    for n in range(axes):
        trace[at] = F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT]
        trace[at + 1] = I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
        at += TRACE_AXIS


def trace_rates(F: F64, I: I32, trace: F64, low: int, high: int, first: bool) -> None:
    """Keep the lowest velocities and following errors in one row, the highest in another."""
    axes: int = I[KRI_BASE + KRI_AXES]
    columns: int = TRACE_HEAD + TRACE_AXIS * axes
    for n in range(axes):
        a: int = AXF_BASE + n * AXF_STRIDE
        place: int = TRACE_HEAD + TRACE_AXIS * n + 2
        lowest: int = low * columns + place
        highest: int = high * columns + place
        velocity: float = F[a + AXF_PSP_VELOCITY_CPS]
        error: float = F[a + AXF_SSP_CNT] - I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
        if first or velocity < trace[lowest]:
            trace[lowest] = velocity
        if first or velocity > trace[highest]:
            trace[highest] = velocity
        if first or error < trace[lowest + 1]:
            trace[lowest + 1] = error
        if first or error > trace[highest + 1]:
            trace[highest + 1] = error


def trace_tick(F: F64, I: I32, trace: F64) -> None:
    """Record this tick if it is its turn.

    To keep the peaks, rows are written in pairs for twice the time between two samples. The
    positions are those of the begin and the middle of that time; velocity and following
    error are the lowest and highest of all its ticks.
    """
    e: int = ENGI_BASE
    every: int = I[e + ENGI_TRACE_EVERY]
    row: int = I[e + ENGI_TRACE_ROW]
    I[e + ENGI_TRACE_WAIT] -= 1
    wait: int = I[e + ENGI_TRACE_WAIT]
    if wait <= 0:
        pair: int = 1 if I[e + ENGI_TRACE_PEAKS] else 0
        trace_place(F, I, trace, row)
        trace_place(F, I, trace, row + pair)
        trace_rates(F, I, trace, row, row + pair, True)
        I[e + ENGI_TRACE_ROW] = row + 1 + pair
        I[e + ENGI_TRACE_WAIT] = every + every * pair
    elif I[e + ENGI_TRACE_PEAKS] and row >= 2:
        if wait == every:
            trace_place(F, I, trace, row - 1)
        trace_rates(F, I, trace, row - 2, row - 1, False)


def until_met(I: I32) -> bool:
    """Whether the flag the caller waits for has its state."""
    e: int = ENGI_BASE
    word: int = I[e + ENGI_UNTIL_WORD]
    if word <= 0:
        return False
    on: int = 1 if I[word] & I[e + ENGI_UNTIL_MASK] else 0
    return on == I[e + ENGI_UNTIL_STATE]


def watch_value(F: F64, I: I32, S: F32, kind: int, row: int) -> float:
    """The watched number."""
    value: float = 0.0
    if kind == WATCH_LONG:
        value = I[row]
    elif kind == WATCH_FP32:
        value = S[row]
    elif kind == WATCH_FP64:
        value = F[row]
    elif kind == WATCH_AXIS:
        value = I[row + AX_ACTUAL_POSITION]
        ppu: float = S[row + AX_PPU]
        if ppu != 0.0:
            value /= ppu
    return value


def watch_state(F: F64, I: I32, S: F32, n: int) -> int:
    """The masked bits of a word, or whether a number is beyond its bound."""
    w: int = WATI_BASE + n * WATI_STRIDE
    row: int = I[w + WATI_ROW]
    if I[w + WATI_KIND] == WATCH_WORD:
        return I[row] & I[w + WATI_MASK]
    value: float = watch_value(F, I, S, I[w + WATI_KIND], row)
    bound: float = F[WATF_BASE + n * WATF_STRIDE + WATF_BOUND]
    if I[w + WATI_IS_ABOVE]:
        return 1 if value > bound else 0
    return 1 if value < bound else 0


def watch_fired(F: F64, I: I32, S: F32) -> bool:
    """Whether something watched has changed since the last look."""
    fired: bool = False
    for n in range(min(I[ENGI_BASE + ENGI_WATCH_COUNT], WAT_COUNT)):
        state: int = watch_state(F, I, S, n)
        w: int = WATI_BASE + n * WATI_STRIDE
        if state != I[w + WATI_STATE]:
            I[w + WATI_STATE] = state
            fired = True
    return fired


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


def engine_run(F: F64, I: I32, S: F32, code: I32, nums: F64, trace: F64) -> int:
    """Run until the ticks asked for are done or somebody is needed; return the reason."""
    e: int = ENGI_BASE
    axes: int = I[KRI_BASE + KRI_AXES]
    while True:
        number: int = I[SYSI_BASE + SYSI_TICK_HIGH] * 2147483648 + I[SYSI_BASE + SYSI_TICK_LOW]
        if I[e + ENGI_IN_TICK] == SERVO_DONE:
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
        if I[KRI_BASE + KRI_MISSING_DACS]:
            missing_outputs_step(I, S)  # programs may have written some
        plant_step(F, I, S, axes, F[SYSF_BASE + SYSF_PERIOD_S])
        tick(F, I, S)
        plc_step(F, I)
        if I[e + ENGI_TRACE_EVERY] > 0:
            trace_tick(F, I, trace)
        I[e + ENGI_IN_TICK] = SERVO_DONE
