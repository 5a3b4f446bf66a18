"""Times of the networks, as ticks of the card they belong to."""

from openacr.map.memory import Memory
from openacr.map.rows import system


def tick_of(memory: Memory) -> int:
    """The present tick."""
    rows = memory.I
    return rows[system.tick_high] * 2**31 + rows[system.tick_low]


def later_tk(memory: Memory, after_ms: float) -> int:
    """The tick `after_ms` later, at least the next one."""
    period_s = memory.F[system.period_s]
    return tick_of(memory) + max(1, round(after_ms / 1000 / period_s))
