"""Status of a run for other programs: cells of the store and variables of the card."""

from collections.abc import Callable
from typing import NamedTuple

from openacr.mill.card.driver import MachineDriver
from openacr.mill.config.settings import Store
from openacr.sysvar.tabs import CELLS

Write = Callable[[int, float], None]
EXECUTING_LINE, RUN_STATE, PARTS = CELLS.executing_line, CELLS.run_state, CELLS.parts_finished
LAST_ALARM, FEED_PERCENT, RUN_TIME = CELLS.last_alarm, CELLS.fov_percent, CELLS.run_time


class Facts(NamedTuple):
    """Published facts of a run."""

    line: float
    state: int
    last_alarm: int
    run_s: float


class Published:
    """Writes published values when they change."""

    def __init__(self, store: Store, machine: MachineDriver) -> None:
        self._store = store
        self._machine = machine
        self._written: dict[tuple[bool, int], float] = {}

    def cell(self, n: int, value: float) -> None:
        """Publish a cell of the store."""
        self._write_changed((False, n), value, self._store.write)

    def variable(self, n: int, value: float) -> None:
        """Publish a variable of the card."""
        self._write_changed((True, n), value, self._machine.write)

    def _write_changed(self, place: tuple[bool, int], value: float, write: Write) -> None:
        if self._written.get(place) != value:
            write(place[1], value)
            self._written[place] = value  # a failed write is repeated
