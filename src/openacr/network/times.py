"""Times of the networks, as ticks of the card they belong to."""

from openacr.map import numbers as at
from openacr.map.memory import Memory


def tick_of(memory: Memory) -> int:
    """The present tick."""
    rows = memory.I
    return rows[at.SYSI_BASE + at.SYSI_TICK_HIGH] * 2**31 + rows[at.SYSI_BASE + at.SYSI_TICK_LOW]


def later_tk(memory: Memory, after_ms: float) -> int:
    """The tick `after_ms` later, at least the next one."""
    period_s = memory.F[at.SYSF_BASE + at.SYSF_PERIOD_S]
    return tick_of(memory) + max(1, round(after_ms / 1000 / period_s))
