"""Console of a run: override switches, and the status published to other programs."""

from collections.abc import Callable

from openacr.cnc.occupied import CARD_LINE, CARD_SPEED, CARD_SPINDLE, CARD_STATE
from openacr.mill.card.actions import Spindle
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.overrides import Override, Overrides
from openacr.mill.config.settings import Store
from openacr.mill.run.program_stream import ProgramStream
from openacr.mill.run.published import (
    EXECUTING_LINE,
    FEED_PERCENT,
    LAST_ALARM,
    PARTS,
    RUN_STATE,
    RUN_TIME,
    Facts,
    Published,
)
from openacr.mill.run.times import Times

OVERRIDES_S, PUBLISH_S = 0.05, 0.5


class Console:
    """Reads the override switches and publishes the status of the run."""

    def __init__(
        self, io: MachineIo, stream: ProgramStream, spindle: Spindle, store: Store
    ) -> None:
        self.overrides = Overrides(io.settings)
        self._stream = stream
        self._io = io
        self._spindle = spindle
        self._published = Published(store, io.machine)
        self._factors = (1.0, 1.0)
        self._state: int | None = None  # last published

    def update(self, sample: CardState, times: Times, facts: Callable[[], Facts]) -> None:
        """Do what is due at this poll."""
        if times.is_due("overrides", OVERRIDES_S):
            self._send_overrides(sample)
        now = facts()
        if times.is_due("cells", PUBLISH_S) or now.state != self._state:
            self._state = now.state
            self._publish(now)

    def renew(self) -> None:
        """Send the overrides again: their packets may be lost."""
        self._io.machine.override(*self._factors)

    def count_part(self, passes: int) -> None:
        """Publish the count of completed passes."""
        self._published.cell(PARTS, passes)

    def _send_overrides(self, sample: CardState) -> None:
        self.overrides.read(lambda number: self._io.is_in(sample, number))
        factors = (self.overrides.factor(Override.FEED), self.overrides.factor(Override.RAPID))
        if factors != self._factors:
            self._io.machine.override(*factors)
            self._stream.override(*factors)
            self._factors = factors
        self._spindle.set_override(self.overrides.factor(Override.SPINDLE))

    def _publish(self, facts: Facts) -> None:
        cells = {
            EXECUTING_LINE: facts.line,
            RUN_STATE: float(facts.state),
            LAST_ALARM: float(facts.last_alarm),
            FEED_PERCENT: 100.0 * self._factors[0],
            RUN_TIME: facts.run_s,
        }
        variables = {
            CARD_SPEED: self._spindle.rpm,
            CARD_SPINDLE: float(self._spindle.state),
            CARD_LINE: facts.line,
            CARD_STATE: float(facts.state),
        }
        for number, value in cells.items():
            self._published.cell(number, value)
        for number, value in variables.items():
            self._published.variable(number, value)
