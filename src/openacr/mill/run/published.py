"""What other programs read of a run: cells of the store and variables of the card."""

from collections.abc import Callable
from typing import NamedTuple

from openacr.mill.card.driver import MachineDriver
from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import CELLS

Write = Callable[[int, float], None]
EXECUTING_LINE, RUN_STATE, PARTS = CELLS.executing_line, CELLS.run_state, CELLS.parts_finished
LAST_ALARM, FEED_PERCENT, RUN_TIME = CELLS.last_alarm, CELLS.fov_percent, CELLS.run_time


class Facts(NamedTuple):
    """What there is to be read of a run."""

    line: float
    state: int
    last_alarm: int
    run_s: float


class Published:
    """Writes what has changed, and nothing else."""

    def __init__(self, store: Store, machine: MachineDriver) -> None:
        self._store = store
        self._machine = machine
        self._written: dict[tuple[bool, int], float] = {}

    def cell(self, n: int, value: float) -> None:
        """A cell of the store."""
        self._keep((False, n), value, self._store.write)

    def variable(self, n: int, value: float) -> None:
        """A variable of the card."""
        self._keep((True, n), value, self._machine.write)

    def _keep(self, place: tuple[bool, int], value: float, write: Write) -> None:
        if self._written.get(place) != value:
            write(place[1], value)
            self._written[place] = value  # one that failed is written again
