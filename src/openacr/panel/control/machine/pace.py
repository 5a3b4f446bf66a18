"""Real time of a machine: a card in this process is advanced, a real one advances itself."""

import math
from typing import Protocol

from openacr.client.links import Host
from openacr.io.pacing import BURST_S, Pacer

IDLE_S = 0.002  # longest sleep beside a card in this process
IDLE_REAL_S = 0.005
SWIFT = 10.0  # about as fast as a machine that is operated goes


class Passing(Protocol):
    """What lets card time pass."""

    def pause(self, seconds: float) -> None:
        """Let card time pass [s]."""


class OwnTime:
    """Beside a card that keeps its own time."""

    idle_s = IDLE_REAL_S
    speed = 1.0

    def begin(self, now_s: float) -> None:
        """Nothing to begin."""

    def advance(self, card: Passing, now_s: float) -> float:
        """The clock that polls are timed by: the wall clock."""
        return now_s


class Paced:
    """Advances a card in this process to the present."""

    def __init__(self, controller: Host) -> None:
        self._controller = controller
        self.speed = 1.0  # times as fast as real, roughly where it is as fast as it goes
        self._is_fastest = False
        self._pacer = Pacer(controller.period_s)
        self._noted_tk = controller.lived_tk

    @property
    def idle_s(self) -> float:
        """Longest sleep between two steps: as much card time as at the speed of real time."""
        return 0.0 if self._is_fastest else min(IDLE_S, IDLE_S / self.speed)

    def let(self, speed: float, now_s: float) -> None:
        """Let time pass from now on `speed` times as fast as real; infinite: as fast as it goes."""
        self._is_fastest = speed == math.inf
        self.speed = SWIFT if self._is_fastest else speed
        self._pacer = Pacer(self._controller.period_s, self.speed)
        self.begin(now_s)

    def begin(self, now_s: float) -> None:
        """Let time begin: what passed before, at the set-up of the card, does not count."""
        self._noted_tk = self._controller.lived_tk
        self._pacer.start(now_s)

    def advance(self, card: Passing, now_s: float) -> float:
        """Advance the card to now; the clock that polls are timed by: card time.

        Exchanges with the card have advanced it as well; that is taken off what is due.
        """
        self._note()
        if ticks := self._due_tk(now_s):
            card.pause(ticks * self._controller.period_s)
            self._note()
        return self._noted_tk * self._controller.period_s

    def _due_tk(self, now_s: float) -> int:
        if self._is_fastest:
            return max(1, round(BURST_S / self._controller.period_s))
        return self._pacer.due_tk(now_s)

    def _note(self) -> None:
        lived_tk = self._controller.lived_tk
        self._pacer.advanced(lived_tk - self._noted_tk)
        self._noted_tk = lived_tk

    def report(self) -> str:
        """The accuracy of real time so far."""
        return str(self._pacer.report())


Pace = OwnTime | Paced
