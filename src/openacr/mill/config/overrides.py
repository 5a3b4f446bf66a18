"""Feed, rapid and spindle override: switch positions (clicks) and their percentages."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from openacr.errors import UserError
from openacr.mill.config.settings import NONE, Settings
from openacr.sysvar.tabs import FOV, ROV, SOV
from openacr.sysvar.tabs.wiring import CLICKS

SWITCH_INPUTS = 4


class Override(Enum):
    """Which override; the value is its tab of the store."""

    FEED = FOV
    RAPID = ROV
    SPINDLE = SOV


@dataclass(slots=True)
class _Switch:
    table: tuple[float, ...]  # percent per click
    first_input: int
    click: int


class Overrides:
    """The three switches. `factor` is 1 at 100 percent."""

    def __init__(self, settings: Settings) -> None:
        self._switches = {
            which: _Switch(
                settings.table(which.value),
                settings.switch(which.value),
                settings.click(which.value),
            )
            for which in Override
        }

    def factor(self, which: Override) -> float:
        """The factor of the present click; 1 is 100 percent."""
        switch = self._switches[which]
        return switch.table[switch.click] / 100.0

    def click(self, which: Override) -> int:
        """The present click, 0 to 15."""
        return self._switches[which].click

    def choose(self, which: Override, click: int) -> None:
        """Set the click on the screen; refused where a panel switch sets it."""
        switch = self._switches[which]
        if switch.first_input != NONE:
            raise UserError(f"{which.name} override is set by its switch on the panel")
        if not 0 <= click < CLICKS:
            raise UserError(f"click {click}: allowed are 0..{CLICKS - 1}")
        switch.click = click

    def read(self, is_on: Callable[[int], bool]) -> None:
        """Read the click of each switch from its four inputs, lowest bit first."""
        for switch in self._switches.values():
            if switch.first_input != NONE:
                bits = (is_on(switch.first_input + bit) << bit for bit in range(SWITCH_INPUTS))
                switch.click = sum(bits)
