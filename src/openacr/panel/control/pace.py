"""Real time of a machine: a card in this process is advanced, a real one advances itself."""

from collections.abc import Callable

from openacr.client import Card
from openacr.client.links import Host
from openacr.io.pacing import Pacer

IDLE_S = 0.002  # longest sleep beside a card in this process
IDLE_REAL_S = 0.005


Sampler = tuple[float, Callable[[], None]]  # time between two samples, and what takes one


class OwnTime:
    """Beside a card that keeps its own time."""

    idle_s = IDLE_REAL_S

    def __init__(self) -> None:
        self._sample_s = 0.0

    def begin(self, now_s: float) -> None:
        """Nothing to begin."""

    def advance(self, card: Card, now_s: float, sampler: Sampler | None = None) -> float:
        """The clock that polls are timed by: the wall clock."""
        if sampler is None:
            self._sample_s = 0.0
        elif now_s >= self._sample_s:
            self._sample_s = now_s + sampler[0]
            sampler[1]()
        return now_s


class Paced:
    """Advances a card in this process to the present."""

    idle_s = IDLE_S

    def __init__(self, controller: Host, speed: float = 1.0) -> None:
        self._controller = controller
        self._pacer = Pacer(controller.period_s, speed)
        self._noted_tk = controller.lived_tk
        self._sample_tk: int | None = None  # when the next sample is due

    def begin(self, now_s: float) -> None:
        """Let time begin: what passed before, at the set-up of the card, does not count."""
        self._noted_tk = self._controller.lived_tk
        self._pacer.start(now_s)

    def advance(self, card: Card, now_s: float, sampler: Sampler | None = None) -> float:
        """Advance the card to now, with samples; the clock that polls are timed by: card time.

        Exchanges with the card have advanced it as well; that is taken off what is due.
        """
        self._note()
        if ticks := self._pacer.due_tk(now_s):
            self._run(card, ticks, sampler)
        return self._noted_tk * self._controller.period_s

    def _run(self, card: Card, ticks: int, sampler: Sampler | None) -> None:
        """Let ticks pass, stopping at every sample."""
        period_s, end_tk = self._controller.period_s, self._noted_tk + ticks
        if sampler is None:
            self._sample_tk = None
        while self._noted_tk < end_tk:
            left_tk = end_tk - self._noted_tk
            if sampler is not None:
                every_tk = max(1, round(sampler[0] / period_s))
                if self._sample_tk is None:
                    self._sample_tk = self._noted_tk
                while self._sample_tk <= self._noted_tk:
                    self._sample_tk += every_tk
                    sampler[1]()
                left_tk = min(left_tk, self._sample_tk - self._noted_tk)
            card.pause(left_tk * period_s)
            self._note()

    def _note(self) -> None:
        lived_tk = self._controller.lived_tk
        self._pacer.advanced(lived_tk - self._noted_tk)
        self._noted_tk = lived_tk

    def report(self) -> str:
        """The accuracy of real time so far."""
        return str(self._pacer.report())


Pace = OwnTime | Paced
