"""Panel switches that control a run: hold, start, block skip."""

from collections.abc import Callable

from openacr.errors import UserError
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.manual.manual_motion import ManualMotion
from openacr.mill.run.alarm_causes import Edges
from openacr.mill.run.lifecycle import Lifecycle, State
from openacr.mill.run.retracing import Retrace
from openacr.mill.run.run_host import RunHost


class Switches:
    """Polls the panel switches of one machine; a refused command is only reported."""

    def __init__(
        self,
        io: MachineIo,
        host: RunHost,
        *,
        manual: ManualMotion,
        retrace: Retrace,
        lifecycle: Lifecycle,
        say: Callable[[str], None],
    ) -> None:
        self._io = io
        self._host = host
        self._manual = manual
        self._retrace = retrace
        self._lifecycle = lifecycle
        self._say = say
        self._edges = Edges(io)

    def poll(
        self, sample: CardState, *, pause: Callable[[], None], start: Callable[[], None]
    ) -> None:
        """Apply the switches as sampled."""
        wiring = self._io.settings.wiring
        self._host.is_skipping = self._io.is_in(sample, wiring.block_skip)
        # Edges are tracked at every poll: a button held down when a hold ends starts nothing.
        is_started = self._edges.rose(sample, wiring.cycle_start)
        is_held_now = self._edges.rose(sample, wiring.feed_hold)
        if self._io.is_in(sample, wiring.feed_hold):
            self._hold(pause, is_new=is_held_now)
        elif is_started and self._lifecycle.state in (State.PAUSED, State.HOLD):
            try:
                start()
            except UserError as refused:
                self._say(str(refused))

    def _hold(self, pause: Callable[[], None], *, is_new: bool) -> None:
        self._retrace.stop()
        if is_new and self._manual.is_active:
            self._manual.stop()
        if self._lifecycle.is_under_way:
            pause()
