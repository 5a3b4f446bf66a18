"""The switches and buttons of the panel that steer a run: hold, start, block skip."""

from collections.abc import Callable

from openacr.errors import UserError
from openacr.mill.hands import Hands
from openacr.mill.host import RunHost
from openacr.mill.machine import Look
from openacr.mill.panel import Panel
from openacr.mill.retracing import Retrace
from openacr.mill.states import State, Status
from openacr.mill.watching import Edges


class Switches:
    """What is switched at one machine; commands that do not fit its state are only said."""

    def __init__(
        self,
        panel: Panel,
        host: RunHost,
        *,
        hands: Hands,
        retrace: Retrace,
        status: Status,
        say: Callable[[str], None],
    ) -> None:
        self._panel = panel
        self._host = host
        self._hands = hands
        self._retrace = retrace
        self._status = status
        self._say = say
        self._edges = Edges(panel)

    def keep(self, look: Look, *, pause: Callable[[], None], start: Callable[[], None]) -> None:
        """Do what the switches say at this look."""
        wiring = self._panel.settings.wiring
        self._host.is_skipping = self._panel.is_in(look, wiring.block_skip)
        # Every look counts: a button that is held down when a hold ends starts nothing.
        is_started = self._edges.rose(look, wiring.cycle_start)
        is_held_now = self._edges.rose(look, wiring.feed_hold)
        if self._panel.is_in(look, wiring.feed_hold):
            self._hold(pause, is_new=is_held_now)
        elif is_started and self._status.state in (State.PAUSED, State.HOLD):
            try:
                start()
            except UserError as refused:
                self._say(str(refused))

    def _hold(self, pause: Callable[[], None], *, is_new: bool) -> None:
        self._retrace.stop()
        if is_new and self._hands.is_active:
            self._hands.stop()
        if self._status.is_under_way:
            pause()
