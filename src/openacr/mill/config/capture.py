"""Which axis catches its position at the edge of the probe input (INTCAP).

The external capture inputs of axis n (0 to 7) are the inputs 24, 16, 8 and 0 plus n: an input
serves one axis, unless the probe is wired to those of all axes. The other axes get their
share of the line, so one that captures has to make the longest travel of the move; the count
it is caught with is magnified otherwise. A probe that no axis of a move captures so is watched
by the host, which triggers the capture of all axes by software: their error is the feed times
the time of one poll.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings

BANK = 8  # capture inputs side by side, one for each of the axes 0 to 7
RISING_MODES = {24: 2, 16: 3, 8: 8, 0: 9}  # INTCAP mode of each bank, by its first input
FALLING_EDGE = 4
SOFTWARE_MODE, SOFTWARE_TRIGGER = 11, 113


@dataclass(frozen=True, slots=True)
class Capture:
    """What is armed for a probing move; `reason` says why the input is polled, if it is."""

    axes: tuple[AxisSettings, ...]
    mode: int
    is_polled: bool
    reason: str = ""


def capture_of(settings: Settings, travel_u: Sequence[float], *, is_rising: bool) -> Capture:
    """How positions are caught in a move by `travel_u`, at an edge of the probe input."""
    wiring = settings.wiring
    if wiring.is_probe_software:
        return Capture(settings.axes, SOFTWARE_MODE, is_polled=True)
    bank = wiring.probe // BANK * BANK
    longest = max(settings.axes, key=lambda axis: abs(travel_u[axis.index]))
    caught = [
        axis
        for axis in settings.axes
        if wiring.is_probe_on_each or axis.index == wiring.probe - bank
    ]
    if bank in RISING_MODES and any(
        abs(travel_u[axis.index]) == abs(travel_u[longest.index]) for axis in caught
    ):
        mode = RISING_MODES[bank] + (0 if is_rising else FALLING_EDGE)
        return Capture(tuple(caught), mode, is_polled=False)
    reason = f"input {wiring.probe} captures no axis"
    if bank in RISING_MODES and caught:
        free = ", ".join(str(first + longest.index) for first in RISING_MODES)
        reason = f"input {wiring.probe} captures {caught[0].name}, and {longest.name} one of {free}"
    return Capture(settings.axes, SOFTWARE_MODE, is_polled=True, reason=reason)
