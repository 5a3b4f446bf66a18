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
from openacr.map import numbers as at
from openacr.map.rows import engine, kernel, programs, scheduler, system
from openacr.map.words import pf
from openacr.views import F32, F64, I32

__all__ = ["advance", "scheduler_step", "slice_ticks"]

STATEMENTS_PER_SLICE = 10
SLICE_S = 0.001

# State of a thread.
THREAD_IDLE = 0
THREAD_READY = 1
THREAD_WAITING = 2
THREAD_HELD = 3  # before a line, in pause or block mode
THREAD_AWAY = 4  # its statement is being executed while ticks go on

# How far the present tick has got.
PHASE_TICK = 0
PHASE_CHANNELS = 1
PHASE_PROGRAM = 2

# Places of the ring: programs 0-7, communications, programs 8-15.
SLOT_CHANNELS = 8
SLOT_LOW = 9
SLOTS = 10

EXECUTED = 5  # progress within the tick (see engine/loop_cy.py): statements were executed

WAIT_FLAGS = pf.PROGRAM_DWELLING | pf.PROGRAM_INHIBITED | pf.MOVE_PENDING


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
    if I[scheduler.phase] == PHASE_TICK:
        if I[kernel.kinematics]:
            thread = kinematics_step(F, I, S, code, nums, tick)
            if thread:
                return thread + 1
        if I[scheduler.programs] == 0 and I[scheduler.channels] == 0:
            I[scheduler.ticks_left] = 0
            return 0
        I[scheduler.ticks_left] = I[scheduler.ticks_left] - 1
        if I[scheduler.ticks_left] > 0:
            return 0
        begin_slice(F, I)
    while I[scheduler.phase] == PHASE_CHANNELS:
        thread = I[scheduler.cursor]
        if thread >= 2 * programs.COUNT:
            I[scheduler.phase] = PHASE_PROGRAM
        elif advance(F, I, S, code, nums, thread, tick):
            return thread + 1
        else:
            thread += 1
            I[scheduler.cursor] = thread
            if thread < 2 * programs.COUNT:
                I[at.THI_BASE + thread * at.THI_STRIDE + at.THI_BUDGET] = STATEMENTS_PER_SLICE
    thread = I[scheduler.thread]
    if thread >= 0:
        called = advance(F, I, S, code, nums, thread, tick)
        if called:
            return thread + 1
    I[scheduler.phase] = PHASE_TICK
    return 0


def begin_slice(F: F64, I: I32) -> None:
    """Choose who owns the next slice and give every thread fresh statements."""
    thread: int = next_owner(I)
    I[scheduler.ticks_left] = slice_ticks(F[system.period_s])
    I[scheduler.thread] = thread
    if thread >= 0:
        I[at.THI_BASE + thread * at.THI_STRIDE + at.THI_BUDGET] = STATEMENTS_PER_SLICE
    I[scheduler.cursor] = programs.COUNT
    I[at.THI_BASE + programs.COUNT * at.THI_STRIDE + at.THI_BUDGET] = STATEMENTS_PER_SLICE
    I[scheduler.phase] = PHASE_CHANNELS


def next_owner(I: I32) -> int:
    """Move on in the ring: the program that owns the next slice, -1 for communications."""
    running: int = I[scheduler.programs]
    slot: int = I[scheduler.slot]
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
    I[scheduler.slot] = slot
    return thread


def next_low(I: I32, running: int) -> int:
    """The program 8 to 15 whose turn it is; one that dwells or is inhibited keeps the turn."""
    thread: int = I[scheduler.low]
    rows: int = at.THI_BASE + thread * at.THI_STRIDE
    if thread >= 8 and (running >> thread) & 1 and I[rows + at.THI_STATE] == THREAD_WAITING:
        if is_program_wait(I[rows + at.THI_WAIT_KIND]):
            return thread
    thread = thread + 1 if 8 <= thread < 15 else 8
    while not (running >> thread) & 1:
        thread = thread + 1 if thread < 15 else 8
    I[scheduler.low] = thread
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
    rows: int = at.THI_BASE + t * at.THI_STRIDE
    event: int = 0
    if I[rows + at.THI_STATE] == THREAD_WAITING:
        end_wait(F, I, S, t, tick)
    elif I[rows + at.THI_STATE] == THREAD_HELD:
        release(I, t)
    if I[rows + at.THI_STATE] != THREAD_READY:
        return 0
    if I[engine.in_tick]:  # else the line of a host is executed between ticks
        I[engine.in_tick] = EXECUTED
    event = vm_run(F, I, S, code, nums, t, I[rows + at.THI_BUDGET], tick)
    if event == VM_SLICE:
        return 0
    if event == VM_WAIT:
        I[rows + at.THI_STATE] = THREAD_WAITING
        show_wait(I, t, I[rows + at.THI_WAIT_SHOW])
        return 0
    if event == VM_LINE:
        I[engine.line_announced] = 0 - (t + 1)
        return 1
    I[rows + at.THI_EVENT] = event
    if event == VM_END:
        I[rows + at.THI_STATE] = THREAD_IDLE
    return 1


def flags_of(I: I32, t: int) -> int:
    """Where the program flags of thread t stand; channels show theirs nowhere."""
    return (
        at.PF_WORD + t
        if t < programs.COUNT
        else at.THI_BASE + t * at.THI_STRIDE + at.THI_SPARE_FLAGS
    )


def show_wait(I: I32, t: int, flag: int) -> None:
    """Show that thread t waits (flag), or that it does not (0)."""
    place: int = flags_of(I, t)
    I[place] = (I[place] & ~WAIT_FLAGS) | flag


def end_wait(F: F64, I: I32, S: F32, t: int, tick: int) -> None:
    """Make a waiting thread ready if its wait is over."""
    rows: int = at.THI_BASE + t * at.THI_STRIDE
    over: int = wait_is_over(F, I, S, t, tick)
    program: int = I[rows + at.THI_LOCALS]
    if over == 0:
        return
    if over == 2 and program >= 0:
        I[at.PF_WORD + program] = I[at.PF_WORD + program] | pf.PROGRAM_TIMEOUT
    I[rows + at.THI_STATE] = THREAD_READY
    show_wait(I, t, 0)


def release(I: I32, t: int) -> None:
    """Let a program that stopped before a line go on, if pause and block mode allow it."""
    rows: int = at.THI_BASE + t * at.THI_STRIDE
    flags: int = I[at.PF_WORD + t]
    if flags & pf.PAUSE_MODE:
        return
    if flags & pf.BLOCK_MODE and not flags & pf.STEP_REQUEST_FLAG:
        return
    I[at.PF_WORD + t] = flags & ~(
        pf.PAUSE_MODE_WAITING | pf.BLOCK_MODE_WAITING | pf.STEP_REQUEST_FLAG
    )
    I[rows + at.THI_PASSED] = 1
    I[rows + at.THI_STATE] = THREAD_READY
