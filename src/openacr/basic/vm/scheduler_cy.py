"""Who executes when: time slices of programs and command channels.

The ring has one slice for each running program 0 to 7, one for communications and one
that the running programs 8 to 15 share in rotation. A slice lasts 1 ms; at its beginning
its program executes up to ten statements, fewer if it has to wait. Command channels are
served at the beginning of every slice, so that hosts are answered at once.

`scheduler_step` is called once per tick. It comes back with thread + 1 when Python has to
deal with that thread (row event says why) and is then called again for the same tick.
"""

from openacr.basic.vm.kinematics_cy import kinematics_step
from openacr.basic.vm.opcodes_cy import (
    VM_END,
    VM_LINE,
    VM_SLICE,
    VM_WAIT,
)
from openacr.basic.vm.vm_cy import vm_run
from openacr.basic.vm.waits_cy import (
    WAIT_BIT_CLEAR,
    WAIT_BIT_SET,
    WAIT_PARAMETER_ABOVE,
    WAIT_PARAMETER_BELOW,
    WAIT_TIME,
    wait_is_over,
)
from openacr.cmath import rint
from openacr.map.numbers import (
    ENGI_BASE,
    ENGI_IN_TICK,
    ENGI_LINE_ANNOUNCED,
    KRI_BASE,
    KRI_KINEMATICS,
    PF_BLOCK_MODE,
    PF_BLOCK_MODE_WAITING,
    PF_MOVE_PENDING,
    PF_PAUSE_MODE,
    PF_PAUSE_MODE_WAITING,
    PF_PROGRAM_DWELLING,
    PF_PROGRAM_INHIBITED,
    PF_PROGRAM_TIMEOUT,
    PF_STEP_REQUEST_FLAG,
    PF_WORD,
    PROG_COUNT,
    SCHI_BASE,
    SCHI_CHANNELS,
    SCHI_CURSOR,
    SCHI_LOW,
    SCHI_PHASE,
    SCHI_PROGRAMS,
    SCHI_SLOT,
    SCHI_THREAD,
    SCHI_TICKS_LEFT,
    SYSF_BASE,
    SYSF_PERIOD_S,
    THI_BASE,
    THI_BUDGET,
    THI_EVENT,
    THI_LOCALS,
    THI_PASSED,
    THI_SPARE_FLAGS,
    THI_STATE,
    THI_STRIDE,
    THI_WAIT_KIND,
    THI_WAIT_SHOW,
)
from openacr.views import F32, F64, I32

__all__ = ["advance", "scheduler_step", "slice_ticks"]

STATEMENTS_PER_SLICE = 10
SLICE_S = 0.001

# State of a thread.
THREAD_IDLE = 0
THREAD_READY = 1
THREAD_WAITING = 2
THREAD_HELD = 3  # before a line, in pause or block mode

# How far the present tick has got.
PHASE_TICK = 0
PHASE_CHANNELS = 1
PHASE_PROGRAM = 2

# Places of the ring: programs 0-7, communications, programs 8-15.
SLOT_CHANNELS = 8
SLOT_LOW = 9
SLOTS = 10

EXECUTED = 5  # progress within the tick (see engine/loop_cy.py): statements were executed

WAIT_FLAGS = PF_PROGRAM_DWELLING | PF_PROGRAM_INHIBITED | PF_MOVE_PENDING


def slice_ticks(period_s: float) -> int:
    """Ticks of one slice: 1 ms, at least one tick."""
    if not (period_s > 0.0):
        return 1
    ticks: int = int(rint(SLICE_S / period_s))
    return ticks if ticks > 1 else 1


def scheduler_step(F: F64, I: I32, S: F32, code: I32, nums: F64, tick: int) -> int:
    """Execute what is due in this tick; thread + 1 if Python is needed, 0 when done."""
    thread: int = 0
    called: int = 0
    if I[SCHI_BASE + SCHI_PHASE] == PHASE_TICK:
        if I[KRI_BASE + KRI_KINEMATICS]:
            thread = kinematics_step(F, I, S, code, nums, tick)
            if thread:
                return thread + 1
        if I[SCHI_BASE + SCHI_PROGRAMS] == 0 and I[SCHI_BASE + SCHI_CHANNELS] == 0:
            I[SCHI_BASE + SCHI_TICKS_LEFT] = 0
            return 0
        I[SCHI_BASE + SCHI_TICKS_LEFT] = I[SCHI_BASE + SCHI_TICKS_LEFT] - 1
        if I[SCHI_BASE + SCHI_TICKS_LEFT] > 0:
            return 0
        begin_slice(F, I)
    while I[SCHI_BASE + SCHI_PHASE] == PHASE_CHANNELS:
        thread = I[SCHI_BASE + SCHI_CURSOR]
        if thread >= 2 * PROG_COUNT:
            I[SCHI_BASE + SCHI_PHASE] = PHASE_PROGRAM
        elif advance(F, I, S, code, nums, thread, tick):
            return thread + 1
        else:
            thread += 1
            I[SCHI_BASE + SCHI_CURSOR] = thread
            if thread < 2 * PROG_COUNT:
                I[THI_BASE + thread * THI_STRIDE + THI_BUDGET] = STATEMENTS_PER_SLICE
    thread = I[SCHI_BASE + SCHI_THREAD]
    if thread >= 0:
        called = advance(F, I, S, code, nums, thread, tick)
        if called:
            return thread + 1
    I[SCHI_BASE + SCHI_PHASE] = PHASE_TICK
    return 0


def begin_slice(F: F64, I: I32) -> None:
    """Choose who owns the next slice and give every thread fresh statements."""
    thread: int = next_owner(I)
    I[SCHI_BASE + SCHI_TICKS_LEFT] = slice_ticks(F[SYSF_BASE + SYSF_PERIOD_S])
    I[SCHI_BASE + SCHI_THREAD] = thread
    if thread >= 0:
        I[THI_BASE + thread * THI_STRIDE + THI_BUDGET] = STATEMENTS_PER_SLICE
    I[SCHI_BASE + SCHI_CURSOR] = PROG_COUNT
    I[THI_BASE + PROG_COUNT * THI_STRIDE + THI_BUDGET] = STATEMENTS_PER_SLICE
    I[SCHI_BASE + SCHI_PHASE] = PHASE_CHANNELS


def next_owner(I: I32) -> int:
    """Move on in the ring: the program that owns the next slice, -1 for communications."""
    running: int = I[SCHI_BASE + SCHI_PROGRAMS]
    slot: int = I[SCHI_BASE + SCHI_SLOT]
    seen: int = 0
    thread: int = -1
    while seen < SLOTS:
        seen += 1
        slot = slot + 1 if slot < SLOTS - 1 else 0
        if slot == SLOT_CHANNELS:
            seen = SLOTS
        elif slot == SLOT_LOW:
            if running >> 8:
                thread = next_low(I, running)
                seen = SLOTS
        elif (running >> slot) & 1:
            thread = slot
            seen = SLOTS
    I[SCHI_BASE + SCHI_SLOT] = slot
    return thread


def next_low(I: I32, running: int) -> int:
    """The program 8 to 15 whose turn it is; one that dwells or is inhibited keeps the turn."""
    thread: int = I[SCHI_BASE + SCHI_LOW]
    rows: int = THI_BASE + thread * THI_STRIDE
    if thread >= 8 and (running >> thread) & 1 and I[rows + THI_STATE] == THREAD_WAITING:
        if is_program_wait(I[rows + THI_WAIT_KIND]):
            return thread
    thread = thread + 1 if 8 <= thread < 15 else 8
    while not (running >> thread) & 1:
        thread = thread + 1 if thread < 15 else 8
    I[SCHI_BASE + SCHI_LOW] = thread
    return thread


def is_program_wait(kind: int) -> bool:
    """Whether this is the wait of DWL, INH or IHPOS."""
    return (
        kind == WAIT_TIME
        or kind == WAIT_BIT_SET
        or kind == WAIT_BIT_CLEAR
        or kind == WAIT_PARAMETER_ABOVE
        or kind == WAIT_PARAMETER_BELOW
    )


def advance(F: F64, I: I32, S: F32, code: I32, nums: F64, t: int, tick: int) -> int:
    """Let thread t go on; 1 if Python is needed (row event says what for), else 0."""
    rows: int = THI_BASE + t * THI_STRIDE
    event: int = 0
    if I[rows + THI_STATE] == THREAD_WAITING:
        end_wait(F, I, S, t, tick)
    elif I[rows + THI_STATE] == THREAD_HELD:
        release(I, t)
    if I[rows + THI_STATE] != THREAD_READY:
        return 0
    if I[ENGI_BASE + ENGI_IN_TICK]:  # else the line of a host is executed between ticks
        I[ENGI_BASE + ENGI_IN_TICK] = EXECUTED
    event = vm_run(F, I, S, code, nums, t, I[rows + THI_BUDGET], tick)
    if event == VM_SLICE:
        return 0
    if event == VM_WAIT:
        I[rows + THI_STATE] = THREAD_WAITING
        show_wait(I, t, I[rows + THI_WAIT_SHOW])
        return 0
    if event == VM_LINE:
        I[ENGI_BASE + ENGI_LINE_ANNOUNCED] = 0 - (t + 1)
        return 1
    I[rows + THI_EVENT] = event
    if event == VM_END:
        I[rows + THI_STATE] = THREAD_IDLE
    return 1


def flags_of(I: I32, t: int) -> int:
    """Where the program flags of thread t stand; channels show theirs nowhere."""
    return PF_WORD + t if t < PROG_COUNT else THI_BASE + t * THI_STRIDE + THI_SPARE_FLAGS


def show_wait(I: I32, t: int, flag: int) -> None:
    """Show that thread t waits (flag), or that it does not (0)."""
    at: int = flags_of(I, t)
    I[at] = (I[at] & ~WAIT_FLAGS) | flag


def end_wait(F: F64, I: I32, S: F32, t: int, tick: int) -> None:
    """Make a waiting thread ready if its wait is over."""
    rows: int = THI_BASE + t * THI_STRIDE
    over: int = wait_is_over(F, I, S, t, tick)
    program: int = I[rows + THI_LOCALS]
    if over == 0:
        return
    if over == 2 and program >= 0:
        I[PF_WORD + program] = I[PF_WORD + program] | PF_PROGRAM_TIMEOUT
    I[rows + THI_STATE] = THREAD_READY
    show_wait(I, t, 0)


def release(I: I32, t: int) -> None:
    """Let a program that stopped before a line go on, if pause and block mode allow it."""
    rows: int = THI_BASE + t * THI_STRIDE
    flags: int = I[PF_WORD + t]
    if flags & PF_PAUSE_MODE:
        return
    if flags & PF_BLOCK_MODE and not flags & PF_STEP_REQUEST_FLAG:
        return
    I[PF_WORD + t] = flags & ~(PF_PAUSE_MODE_WAITING | PF_BLOCK_MODE_WAITING | PF_STEP_REQUEST_FLAG)
    I[rows + THI_PASSED] = 1
    I[rows + THI_STATE] = THREAD_READY
