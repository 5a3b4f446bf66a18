"""Access to a card's values from Python: `card.p[12288]`, `card.bit[516]`, `card.axis(0)`."""

from collections.abc import Callable
from typing import Self

from msgspec import Struct

from openacr.map.memory import Memory
from openacr.map.rows import axes
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of


class Parameters:
    """Parameters by number; `note` is called for every write."""

    def __init__(self, memory: Memory, note: Callable[[int, float], None]) -> None:
        self._memory, self._note = memory, note

    def __getitem__(self, number: int) -> int | float:
        return self._memory.read(number)

    def __setitem__(self, number: int, value: float) -> None:
        self._memory.write(number, value)
        self._note(number, value)


class Bits:
    """Flags by number; `note` is called for every write."""

    def __init__(self, memory: Memory, note: Callable[[int, float], None]) -> None:
        self._memory, self._note = memory, note

    def __getitem__(self, number: int) -> bool:
        return self._memory.bit(number)

    def __setitem__(self, number: int, on: bool) -> None:
        self._memory.set_bit(number, on)
        self._note(number, on)


class AxisView:
    """One axis, read in programming units (`_u`) or pulses (`_cnt`)."""

    def __init__(self, card: Card, number: int) -> None:
        self._card = card
        self.number = number

    @property
    def commanded_u(self) -> float:
        """Secondary setpoint: the position commanded to the servo loop."""
        ssp = self._card.memory.F[axes.ssp_cnt[self.number]]
        return ssp / scale_of(self._card, self.number)

    @property
    def commanded_cnt(self) -> int:
        """Secondary setpoint as P12295 shows it."""
        return self._card.memory.I[axes.secondary_setpoint[self.number]]

    @property
    def actual_u(self) -> float:
        """Actual position."""
        return self.actual_cnt / scale_of(self._card, self.number)

    @property
    def actual_cnt(self) -> int:
        """Actual position as P12290 shows it."""
        return self._card.memory.I[axes.actual_position[self.number]]

    @property
    def velocity_ups(self) -> float:
        """Commanded velocity, jog, gear and cam included."""
        velocity = self._card.memory.F[axes.psp_velocity_cps[self.number]]
        return velocity / scale_of(self._card, self.number)

    @property
    def following_error(self) -> int:
        """Following error as P12291 shows it [pulses]."""
        return self._card.memory.I[axes.following_error[self.number]]


class AxisStatistics(Struct, frozen=True):
    """Totals of an axis since power-up, in its units."""

    position_u: float
    actual_u: float
    distance_u: float
    peak_velocity_ups: float
    peak_following_error_u: float

    @classmethod
    def of(cls, card: Card, axis: int) -> Self:
        """Those of an axis at this tick."""
        scale = abs(scale_of(card, axis))
        view = AxisView(card, axis)
        memory = card.memory.F
        return cls(
            view.commanded_u,
            view.actual_u,
            memory[axes.travel_cnt[axis]] / scale,
            memory[axes.peak_velocity_cps[axis]] / scale,
            memory[axes.peak_error_cnt[axis]] / scale,
        )
