"""Machine access for the interpreter, always after a Sync, with the machine at rest."""

from collections.abc import Callable

from openacr.cnc.canonical import AXES, Point
from openacr.cnc.state.hosts import Switched
from openacr.map.rows import axes as axis_rows
from openacr.mill.card.driver import MachineDriver
from openacr.mill.config.settings import Settings


class RunHost:
    """`cnc.hosts.MachineDriver` for a card. `answers` of the operator are kept by parameter."""

    def __init__(
        self,
        machine: MachineDriver,
        settings: Settings,
        tripped: Callable[[], Point | None],
        switched: Callable[[], Switched],
    ) -> None:
        self._machine = machine
        self._settings = settings
        self._tripped = tripped
        self._switched = switched
        self.answers: dict[int, float] = {}
        self.is_skipping = False  # the switch
        self.skips_always = False  # the button on the screen

    def read_parameter(self, n: int) -> float:
        """A parameter of the card."""
        return self._machine.read(n)

    def write_parameter(self, n: int, value: float) -> None:
        """Set a parameter of the card."""
        self._machine.write(n, value)

    def read_bit(self, n: int) -> bool:
        """A flag of the card."""
        return self._machine.card.read_bit(n)

    def position(self) -> Point:
        """The commanded machine position."""
        counts = self._machine.axis_values(axis_rows.current_position)
        point = [0.0] * AXES
        for axis, count in zip(self._settings.axes, counts, strict=True):
            point[axis.index] = count / axis.pulses_per_unit
        return tuple(point)

    def tripped(self) -> Point | None:
        """Where the probe tripped in the last probing move."""
        return self._tripped()

    def answer(self, parameter: int) -> float | None:
        """The operator's answer, removed when read; None if absent."""
        return self.answers.pop(parameter, None)

    def is_homed(self, axis: int) -> bool:
        """Whether an axis is homed."""
        return self._settings.is_homed(axis)

    def has_probe(self) -> bool:
        """Whether a probe input is configured."""
        return self._settings.wiring.probe >= 0

    def switched(self) -> Switched:
        """Spindle and coolant as they are now."""
        return self._switched()

    def is_block_skip_on(self) -> bool:
        """Whether block skip is on, by the switch or the screen button."""
        return self.is_skipping or self.skips_always
