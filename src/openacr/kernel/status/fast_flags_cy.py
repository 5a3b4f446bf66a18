"""Fast limit flags: with BIT5632 the servo interrupt refreshes what the axes choose.

Bits 24 to 29 of the secondary flags of an axis choose one group of its limit flags each
(Not Excess Error, Not In Position, ...), bit 31 all limit flags of its master. One group
takes its turn per tick, for all axes that chose it: three groups chosen by any axis are
refreshed every three ticks. The slow scan goes on beside it.
"""

from openacr.kernel.status.slow_cy import axis_bands, master_bands
from openacr.map.rows import axes, kernel
from openacr.map.words import af1, af2
from openacr.views import F32, F64, I32

FIRST_BIT = 24
GROUPS = 8  # the seventh is reserved
OF_MASTERS = 7


def fast_chosen(I: I32, n: int) -> int:
    """Groups axis n chooses, bit 0 for the first."""
    word: int = af2.word[n]
    return (I[word] >> FIRST_BIT) & 0xBF


def fast_group_flag(group: int) -> int:
    """The limit flag of an axis a group stands for."""
    if group == 0:
        return af1.NOT_EXCESS_ERROR
    if group == 1:
        return af1.NOT_IN_POSITION
    if group == 2:
        return af1.WITHIN_A_LIMIT
    if group == 3:
        return af1.NOT_WITHIN_B_LIMIT
    if group == 4:
        return af1.NOT_TORQUE_LIMIT
    return af1.NOT_IN_TORQUE_BAND


def fast_next(I: I32, axis_count: int) -> int:
    """The group whose turn it is: the next after the last that some axis chooses; -1 none."""
    chosen: int = 0
    for n in range(axis_count):
        chosen |= fast_chosen(I, n)
    if chosen == 0:
        return -1
    group: int = I[kernel.fast_group] & (GROUPS - 1)
    for _ in range(GROUPS):
        group = (group + 1) & (GROUPS - 1)
        if (chosen >> group) & 1:
            break
    return group


def fast_flags_step(F: F64, I: I32, S: F32, axis_count: int) -> None:
    """Refresh the group whose turn it is."""
    group: int = fast_next(I, axis_count)
    if group < 0:
        return
    I[kernel.fast_group] = group
    for n in range(axis_count):
        if (fast_chosen(I, n) >> group) & 1:
            if group == OF_MASTERS:
                m: int = I[axes.master[n]]
                if m >= 0:
                    master_bands(I, m)
            else:
                axis_bands(F, I, S, n, fast_group_flag(group))
