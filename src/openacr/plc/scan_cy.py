"""The PLC part of the servo interrupt: timers, counters, latches, then the scans that are due.

A scan knows one logic value R and a stack of saved results. Between two output
instructions they build a rung, e.g. two contacts in parallel with two others:

    LD 0      R = b0                          saved: -
    AND 1     R = b0 & b1                     saved: -
    LD 2      R = b2                          saved: b0 & b1
    AND 3     R = b2 & b3                     saved: b0 & b1
    OR LD     R = (b0 & b1) | (b2 & b3)       saved: -
    OUT 32    flag 32 = R

The compiler has checked that no rung takes more than it has saved and saves at most 16
results. So the stack is one integer with a bit for each result, the newest lowest, and a
new rung empties it by writing 0. All operands are flags 0 to 8191.

The objects are evaluated before the scans: an input written by a scan acts in the next
interrupt, and a timer of n ms is seen by the scan exactly n ms after the one that set it.

For coverage a scan notes in the words of its instructions what they have seen: contacts that
were on and off, outputs that had power and had none.
"""

from openacr.map import numbers as at
from openacr.map.flags_cy import flag_bit, put_flag
from openacr.map.rows import plcs, system
from openacr.map.words import plf
from openacr.views import F64, I32

__all__ = ["plc_scan", "plc_step"]

# An instruction is one word: its operation, NEGATED where the operand (or the result) is
# inverted first, four bits for what noted scans have seen, and above them the operand. The
# first four load or combine a flag.
OP_START = 1  # LD at the start of a rung
OP_LOAD = 2
OP_AND = 3
OP_OR = 4
OP_AND_BLOCK = 5
OP_OR_BLOCK = 6
OP_NOT = 7
OP_OUT = 8
OP_SET = 9
OP_CLEAR = 10
OP_TIMER = 11
OP_COUNTER = 12
OP_LATCH = 13
OPERATION = 15
NEGATED = 16
SEEN_OFF = 32  # a contact; an output without power; SEEN_ON: the other state
SEEN_ON = 64
FIRST_SEEN_OFF = 128  # the first of the two inputs of a counter or latch
FIRST_SEEN_ON = 256
SEEN = SEEN_OFF | SEEN_ON | FIRST_SEEN_OFF | FIRST_SEEN_ON
OPERAND_SHIFT = 9

INPUTS = (
    plf.TIMER_INPUT
    | plf.TIMER_OUTPUT
    | plf.COUNTER_CLOCK
    | plf.COUNTER_RESET
    | plf.LATCH_SET
    | plf.LATCH_RESET
)
EPS_MS = 1e-9

# What a step has done.
PLC_IDLE = 0
PLC_WAITED = 1
PLC_ACTED = 2


def plc_put_inputs(I: I32, n: int, inputs: int, on: int) -> None:
    """Set exactly those flags of object n out of `inputs` that are in `on`."""
    I[at.PLF_WORD + n] = (I[at.PLF_WORD + n] & ~inputs) | on


def plc_scan(I: I32, n: int) -> None:
    """One scan of PLC n, from its first instruction to its last."""
    rows: int = at.PCI_BASE + n * at.PCI_STRIDE
    first: int = rows + at.PCI_CODE
    end: int = first + I[rows + at.PCI_LENGTH]
    if not I[rows + at.PCI_NOTED]:
        plc_execute(I, first, end, 0)
        return
    results: int = 0
    for k in range(first, end):
        plc_note(I, k, results)
        results = plc_execute(I, k, k + 1, results)


def plc_note(I: I32, k: int, results: int) -> None:
    """Note the state of the contact, or the power of the output, that is executed next."""
    word: int = I[k]
    op: int = word & OPERATION
    on: int = results & 1
    if op <= OP_OR:
        on = flag_bit(I, word >> OPERAND_SHIFT) ^ (1 if word & NEGATED else 0)
    elif op == OP_COUNTER or op == OP_LATCH:
        word |= FIRST_SEEN_ON if results & 2 else FIRST_SEEN_OFF
    I[k] = word | (SEEN_ON if on else SEEN_OFF)


def plc_execute(I: I32, first: int, end: int, results: int) -> int:
    """Execute instructions with R in the lowest bit and the saved results above it."""
    r: int = results & 1
    saved: int = results >> 1
    for k in range(first, end):
        word: int = I[k]
        op: int = word & OPERATION
        operand: int = word >> OPERAND_SHIFT
        negated: int = 1 if word & NEGATED else 0
        if op <= OP_OR:
            state: int = flag_bit(I, operand) ^ negated
            if op == OP_AND:
                r &= state
            elif op == OP_OR:
                r |= state
            else:
                saved = (saved << 1) | r if op == OP_LOAD else 0
                r = state
        elif op == OP_OUT:
            if flag_bit(I, operand) != r ^ negated:  # most outputs stay as they are
                put_flag(I, operand, r != negated)
        elif op == OP_AND_BLOCK:
            r &= saved & 1
            saved >>= 1
        elif op == OP_OR_BLOCK:
            r |= saved & 1
            saved >>= 1
        elif op == OP_NOT:
            r ^= 1
        else:
            plc_drive(I, op, operand, saved & 1, r)
            if op == OP_COUNTER or op == OP_LATCH:
                saved >>= 1
    return (saved << 1) | r


def plc_drive(I: I32, op: int, operand: int, first: int, r: int) -> None:
    """Set and clear a flag, or give an object its inputs; the first of two blocks is `first`."""
    if op == OP_SET or op == OP_CLEAR:
        if r:
            put_flag(I, operand, op == OP_SET)
    elif op == OP_TIMER:
        plc_put_inputs(I, operand, plf.TIMER_INPUT, plf.TIMER_INPUT if r else 0)
    elif op == OP_COUNTER:
        plc_put_inputs(
            I,
            operand,
            plf.COUNTER_CLOCK | plf.COUNTER_RESET,
            (plf.COUNTER_CLOCK if first else 0) | (plf.COUNTER_RESET if r else 0),
        )
    elif op == OP_LATCH:
        plc_put_inputs(
            I,
            operand,
            plf.LATCH_SET | plf.LATCH_RESET,
            (plf.LATCH_SET if first else 0) | (plf.LATCH_RESET if r else 0),
        )


def plc_timer(F: F64, I: I32, n: int, period_ms: float) -> None:
    """TIM n: its count goes down once per millisecond while the input is set."""
    count: int = at.TIM_BASE + n * at.TIM_STRIDE + at.TIM_TIMER_COUNT
    phase: int = at.PCF_BASE + n * at.PCF_STRIDE + at.PCF_TIMER_MS
    if not I[at.PLF_WORD + n] & plf.TIMER_INPUT:
        I[count] = I[at.TIM_BASE + n * at.TIM_STRIDE + at.TIM_TIMER_PRELOAD]
        F[phase] = 0.0
        I[at.PLF_WORD + n] &= ~plf.TIMER_OUTPUT
        return
    if I[count] > 0:
        passed: float = F[phase] + period_ms
        while passed >= 1.0 - EPS_MS and I[count] > 0:
            passed -= 1.0
            I[count] -= 1
        F[phase] = max(passed, 0.0)
    if I[count] <= 0:
        I[at.PLF_WORD + n] |= plf.TIMER_OUTPUT


def plc_counter(I: I32, n: int) -> None:
    """CNT n: its count goes down at every rising edge of the clock.

    A counter that was never reset takes its preload at the first edge.
    """
    flags: int = I[at.PLF_WORD + n]
    preload: int = I[at.CNT_BASE + n * at.CNT_STRIDE + at.CNT_COUNTER_PRELOAD]
    count: int = at.CNT_BASE + n * at.CNT_STRIDE + at.CNT_COUNTER_COUNT
    old: int = at.PCI_BASE + n * at.PCI_STRIDE + at.PCI_CLOCK_OLD
    clock: int = 1 if flags & plf.COUNTER_CLOCK else 0
    if flags & plf.COUNTER_RESET:
        I[count] = preload
        I[at.PLF_WORD + n] = flags & ~plf.COUNTER_OUTPUT
    elif clock and not I[old] and not flags & plf.COUNTER_OUTPUT:
        if I[count] <= 0:
            I[count] = preload
        if I[count] > 0:
            I[count] -= 1
        if I[count] <= 0:
            I[at.PLF_WORD + n] = flags | plf.COUNTER_OUTPUT
    I[old] = clock


def plc_latch(I: I32, n: int) -> None:
    """KR n: set by one input, cleared by the other, which is the stronger."""
    flags: int = I[at.PLF_WORD + n]
    if flags & plf.LATCH_RESET:
        I[at.PLF_WORD + n] = flags & ~plf.LATCH_OUTPUT
    elif flags & plf.LATCH_SET:
        I[at.PLF_WORD + n] = flags | plf.LATCH_OUTPUT


def plc_step(F: F64, I: I32) -> int:
    """Update timers, counters and latches, then run the scans due; idle, only a few reads.

    PLC_IDLE while there is nothing to update or run, PLC_WAITED if scans have come nearer,
    PLC_ACTED if flags may have changed.
    """
    running: int = 0
    done: int = PLC_IDLE
    for n in range(plcs.COUNT):
        flags: int = I[at.PLF_WORD + n]
        running |= flags & plf.PLC_RUNNING
        preload: int = I[at.TIM_BASE + n * at.TIM_STRIDE + at.TIM_TIMER_PRELOAD]
        if (
            flags & INPUTS
            or I[at.TIM_BASE + n * at.TIM_STRIDE + at.TIM_TIMER_COUNT] != preload
            or I[at.PCI_BASE + n * at.PCI_STRIDE + at.PCI_CLOCK_OLD]
            or F[at.PCF_BASE + n * at.PCF_STRIDE + at.PCF_TIMER_MS]
        ):
            done = PLC_ACTED
            plc_timer(F, I, n, F[system.period_s] * 1000.0)
            plc_counter(I, n)
            plc_latch(I, n)
    if not running:
        return done
    for n in range(plcs.COUNT):
        if I[at.PLF_WORD + n] & plf.PLC_RUNNING:
            count: int = at.PLC_BASE + n * at.PLC_STRIDE + at.PLC_TICK_COUNT
            if I[count] > 0:
                I[count] -= 1
            if I[count] <= 0:
                done = PLC_ACTED
                plc_scan(I, n)
                I[at.PLF_WORD + n] &= ~plf.FIRST_SCAN
                I[count] = max(I[at.PLC_BASE + n * at.PLC_STRIDE + at.PLC_TICK_PRELOAD], 1)
    return PLC_WAITED if done == PLC_IDLE else done
