"""The time of a card: its servo interrupts, and their length."""

from __future__ import annotations

from dataclasses import dataclass

from openacr.map.memory import Memory
from openacr.map.rows import system


@dataclass(slots=True)
class Clock:
    """The ticks of a card, read from its memory; a tick is a servo interrupt."""

    memory: Memory
    before_tk: int = 0  # ticks before the latest restart of the card

    @property
    def tick(self) -> int:
        """Ticks since power-up or the latest restart."""
        rows = self.memory.I
        return rows[system.tick_high] * 2**31 + rows[system.tick_low]

    @property
    def lived_tk(self) -> int:
        """Ticks this card has run in total; a restart does not reset the count."""
        rows = self.memory.I
        return self.before_tk + rows[system.tick_high] * 2**31 + rows[system.tick_low]

    @property
    def period_s(self) -> float:
        """Servo period, the length of a tick [s]."""
        return self.memory.F[system.period_s]

    @property
    def time_s(self) -> float:
        """Simulated seconds since power-up or the latest restart."""
        return self.tick * self.period_s

    @property
    def lived_s(self) -> float:
        """Simulated seconds this card has run in total, at the present period."""
        return self.lived_tk * self.period_s

    def ticks(self, time_s: float) -> int:
        """The number of ticks nearest to a time, at least 1."""
        return max(1, round(time_s / self.period_s))
