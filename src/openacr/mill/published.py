"""What other programs read of a run: cells of the store and variables of the card."""

from typing import NamedTuple

from openacr.mill.machine import Machine
from openacr.mill.settings import Store

EXECUTING_LINE, RUN_STATE, PARTS, LAST_ALARM, FEED_PERCENT, RUN_TIME = range(243, 249)


class Facts(NamedTuple):
    """What there is to be read of a run."""

    line: float
    state: int
    last_alarm: int
    run_s: float


class Published:
    """Writes what has changed, and nothing else."""

    def __init__(self, store: Store, machine: Machine) -> None:
        self._store = store
        self._machine = machine
        self._written: dict[tuple[bool, int], float] = {}

    def cell(self, n: int, value: float) -> None:
        """A cell of the store."""
        if self._is_new(False, n, value):
            self._store.write(n, value)

    def variable(self, n: int, value: float) -> None:
        """A variable of the card."""
        if self._is_new(True, n, value):
            self._machine.write(n, value)

    def _is_new(self, on_card: bool, n: int, value: float) -> bool:
        is_new = self._written.get((on_card, n)) != value
        self._written[(on_card, n)] = value
        return is_new
