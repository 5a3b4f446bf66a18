"""What threads wait for: times, flags, parameters and rows, kept as numbers."""

from openacr import messages
from openacr.basic.vm.values_cy import (
    read_bit,
    read_parameter,
    whole_index,
)
from openacr.cmath import (
    ceil,
)
from openacr.map import numbers as at
from openacr.map.rows import system
from openacr.map.words import pf
from openacr.views import F32, F64, I32

__all__ = ["wait_is_over"]

# What a thread waits for; the numbers of basic.run.WaitKind.
WAIT_TIME = 1
WAIT_BIT_SET = 2
WAIT_BIT_CLEAR = 3
WAIT_PARAMETER_ABOVE = 4
WAIT_PARAMETER_BELOW = 5
WAIT_ROW_ABOVE = 6
WAIT_ROW_BELOW = 7
WAIT_NEXT_SLICE = 8


def start_wait(
    F: F64,
    I: I32,
    t: int,
    kind: int,
    operand: int,
    value: float,
    seconds: float,
    tick: int,
) -> None:
    """Note what thread t waits for, with a time limit if seconds is positive."""
    rows: int = at.THI_BASE + t * at.THI_STRIDE
    reals: int = at.THF_BASE + t * at.THF_STRIDE
    period: float = F[system.period_s]
    show: int = pf.PROGRAM_DWELLING if kind == WAIT_TIME else pf.PROGRAM_INHIBITED
    I[rows + at.THI_WAIT_KIND] = kind
    I[rows + at.THI_WAIT_OPERAND] = operand
    I[rows + at.THI_WAIT_SHOW] = show
    F[reals + at.THF_WAIT_VALUE] = value
    F[reals + at.THF_WAIT_DEADLINE_TK] = 0.0
    if seconds > 0.0 and period > 0.0:
        F[reals + at.THF_WAIT_DEADLINE_TK] = float(tick) + ceil(seconds / period - 1.0e-6)


def wait_is_over(F: F64, I: I32, S: F32, t: int, tick: int) -> int:
    """1 if what thread t waits for has come, 2 if its time is up, else 0."""
    rows: int = at.THI_BASE + t * at.THI_STRIDE
    reals: int = at.THF_BASE + t * at.THF_STRIDE
    kind: int = I[rows + at.THI_WAIT_KIND]
    operand: int = I[rows + at.THI_WAIT_OPERAND]
    value: float = F[reals + at.THF_WAIT_VALUE]
    deadline: float = F[reals + at.THF_WAIT_DEADLINE_TK]
    present: float = 0.0
    met: bool = False
    if kind == WAIT_BIT_SET:
        met = read_bit(I, operand) == 1
    elif kind == WAIT_BIT_CLEAR:
        met = read_bit(I, operand) == 0
    elif kind == WAIT_ROW_ABOVE:
        met = float(I[operand]) > value
    elif kind == WAIT_ROW_BELOW:
        met = float(I[operand]) < value
    elif kind == WAIT_PARAMETER_ABOVE or kind == WAIT_PARAMETER_BELOW:
        if read_parameter(F, I, S, operand, reals + at.THF_RESULT) != 0:
            return 1  # it was freed meanwhile: nothing to wait for
        present = F[reals + at.THF_RESULT]
        met = present > value if kind == WAIT_PARAMETER_ABOVE else present < value
    if met:
        return 1
    if deadline > 0.0 and float(tick) >= deadline:
        return 1 if kind == WAIT_TIME or kind == WAIT_NEXT_SLICE else 2
    return 0


def inhibit(F: F64, I: I32, t: int, for_clear: int, place: int, tick: int) -> int:
    """INH of the flag F[place] for at most F[place + 1] seconds: 1 to wait, 0 to go on, -error.

    A number below 0 that was computed means the clear state, too.
    """
    number: int = whole_index(F[place])
    wanted: int = 0 if for_clear else 1
    if number < 0:
        number = 0 - number
        wanted = 1 - wanted
    state: int = read_bit(I, number)
    if state < 0:
        return -messages.INVALID_BIT.number
    if state == wanted:
        return 0
    start_wait(F, I, t, WAIT_BIT_SET if wanted else WAIT_BIT_CLEAR, number, 0.0, F[place + 1], tick)
    return 1


def inhibit_position(F: F64, I: I32, S: F32, t: int, for_below: int, place: int, tick: int) -> int:
    """IHPOS of the parameter F[place] and the setpoint F[place + 1].

    For at most F[place + 2] seconds; 1 to wait, 0 to go on, -error.
    """
    number: int = whole_index(F[place])
    program: int = I[at.THI_BASE + t * at.THI_STRIDE + at.THI_LOCALS]
    kind: int = WAIT_PARAMETER_BELOW if for_below else WAIT_PARAMETER_ABOVE
    if program >= 0:
        I[at.PF_WORD + program] = I[at.PF_WORD + program] & ~pf.PROGRAM_TIMEOUT
    error: int = read_parameter(F, I, S, number, place + 3)
    if error:
        return -error
    start_wait(F, I, t, kind, number, F[place + 1], F[place + 2], tick)
    return 0 if wait_is_over(F, I, S, t, tick) else 1
