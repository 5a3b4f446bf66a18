"""The flow stack of a thread: open levels of IF, FOR, WHILE and GOSUB, and where jumps lead."""

from openacr import messages
from openacr.basic.vm.values_cy import (
    whole_index,
)
from openacr.map import numbers as at
from openacr.map.rows import threads
from openacr.views import I32

# Levels of the flow stack.
FLOW_IF = 1
FLOW_FOR = 2
FLOW_WHILE = 3
FLOW_GOSUB = 4


def open_level(I: I32, rows: int, kind: int, start: int, stop: int) -> int:
    """Push a level whose text is the code from start up to stop; an error number or 0."""
    depth: int = I[rows + at.THI_DEPTH]
    if depth >= threads.FLOW_KIND_SIZE:
        return messages.STACK_OVERFLOW.number
    I[rows + at.THI_FLOW_KIND + depth] = kind
    I[rows + at.THI_FLOW_START + depth] = start
    I[rows + at.THI_FLOW_STOP + depth] = stop
    I[rows + at.THI_DEPTH] = depth + 1
    return 0


def is_open(I: I32, rows: int, kind: int, start: int) -> bool:
    """Whether the innermost level is this one."""
    depth: int = I[rows + at.THI_DEPTH] - 1
    return (
        depth >= 0
        and I[rows + at.THI_FLOW_KIND + depth] == kind
        and I[rows + at.THI_FLOW_START + depth] == start
    )


def close_level(I: I32, rows: int, start: int) -> None:
    """Pop the level that begins at start, if it is the innermost one."""
    depth: int = I[rows + at.THI_DEPTH] - 1
    if (
        depth >= 0
        and I[rows + at.THI_FLOW_KIND + depth] != FLOW_GOSUB
        and I[rows + at.THI_FLOW_START + depth] == start
    ):
        I[rows + at.THI_DEPTH] = depth


def break_level(I: I32, rows: int, start: int) -> bool:
    """Pop levels up to and including the loop that begins at start; False if it is not open."""
    depth: int = I[rows + at.THI_DEPTH] - 1
    while depth >= 0 and I[rows + at.THI_FLOW_KIND + depth] != FLOW_GOSUB:
        if (
            I[rows + at.THI_FLOW_START + depth] == start
            and I[rows + at.THI_FLOW_KIND + depth] != FLOW_IF
        ):
            I[rows + at.THI_DEPTH] = depth
            return True
        depth -= 1
    return False


def unwind(I: I32, rows: int, target: int) -> None:
    """Pop the levels of the present routine whose text does not contain the target."""
    depth: int = I[rows + at.THI_DEPTH] - 1
    while (
        depth >= 0
        and I[rows + at.THI_FLOW_KIND + depth] != FLOW_GOSUB
        and not (I[rows + at.THI_FLOW_START + depth] <= target < I[rows + at.THI_FLOW_STOP + depth])
    ):
        depth -= 1
    I[rows + at.THI_DEPTH] = depth + 1


def return_level(I: I32, rows: int) -> int:
    """Pop up to the latest GOSUB and give the place after it, or -1."""
    depth: int = I[rows + at.THI_DEPTH] - 1
    while depth >= 0:
        if I[rows + at.THI_FLOW_KIND + depth] == FLOW_GOSUB:
            I[rows + at.THI_DEPTH] = depth
            return I[rows + at.THI_FLOW_BACK + depth]
        depth -= 1
    return -1


def line_place(I: I32, code: I32, rows: int, base: int, line: float) -> int:
    """The place of a stored line by bisection in the table of (line, place), or -1.

    `base` is where the code of the thread begins.
    """
    number: int = whole_index(line)
    table: int = base + I[rows + at.THI_LINES_AT]
    low: int = 0
    high: int = I[rows + at.THI_LINES_COUNT]
    middle: int = 0
    while low < high:
        middle = (low + high) >> 1
        if code[table + 2 * middle] < number:
            low = middle + 1
        else:
            high = middle
    if low < I[rows + at.THI_LINES_COUNT] and code[table + 2 * low] == number:
        return code[table + 2 * low + 1]
    return -1
