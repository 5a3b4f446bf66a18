"""Real time of a machine: a card in this process is advanced, a real one advances itself."""

from openacr.client import Card
from openacr.client.links import Host
from openacr.io.pacing import Pacer

IDLE_S = 0.002  # longest sleep beside a card in this process
IDLE_REAL_S = 0.005


class OwnTime:
    """Beside a card that keeps its own time."""

    idle_s = IDLE_REAL_S

    def begin(self, now_s: float) -> None:
        """Nothing to begin."""

    def advance(self, card: Card, now_s: float) -> float:
        """The clock that polls are timed by: the wall clock."""
        return now_s


class Paced:
    """Advances a card in this process to the present."""

    idle_s = IDLE_S

    def __init__(self, controller: Host, speed: float = 1.0) -> None:
        self._controller = controller
        self._pacer = Pacer(controller.period_s, speed)
        self._noted_tk = controller.lived_tk

    def begin(self, now_s: float) -> None:
        """Let time begin: what passed before, at the set-up of the card, does not count."""
        self._noted_tk = self._controller.lived_tk
        self._pacer.start(now_s)

    def advance(self, card: Card, now_s: float) -> float:
        """Advance the card to now; the clock that polls are timed by: card time.

        Exchanges with the card have advanced it as well; that is taken off what is due.
        """
        self._note()
        if ticks := self._pacer.due_tk(now_s):
            card.pause(ticks * self._controller.period_s)
            self._note()
        return self._noted_tk * self._controller.period_s

    def _note(self) -> None:
        lived_tk = self._controller.lived_tk
        self._pacer.advanced(lived_tk - self._noted_tk)
        self._noted_tk = lived_tk

    def report(self) -> str:
        """The accuracy of real time so far."""
        return str(self._pacer.report())


Pace = OwnTime | Paced
