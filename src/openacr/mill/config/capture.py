"""Selection of the axes that capture their position at a probe edge (INTCAP).

The external capture inputs of axis n (0 to 7) are the inputs 24, 16, 8 and 0 plus n: an input
serves one axis, unless the probe is wired to those of all axes. The positions of the
other axes are interpolated along the line, so the capturing axis has to make the longest travel
of the move; otherwise its error of one count is magnified. If no axis of a move can capture in
hardware, the host polls the probe input and triggers the capture of all axes by software: their
error is the feed times the poll period.
"""

from collections.abc import Sequence

from msgspec import Struct

from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings

BANK = 8  # consecutive capture inputs, one for each of the axes 0 to 7
RISING_MODES = {24: 2, 16: 3, 8: 8, 0: 9}  # INTCAP mode of each bank, by its first input
FALLING_EDGE = 4
SOFTWARE_MODE, SOFTWARE_TRIGGER = 11, 113


class Capture(Struct, frozen=True):
    """Capture set-up of a probing move; `reason` is why the input is polled, empty if it is not."""

    axes: tuple[AxisSettings, ...]
    mode: int
    is_polled: bool
    reason: str = ""


def capture_of(settings: Settings, travel_u: Sequence[float], *, is_rising: bool) -> Capture:
    """Choose how positions are captured in a move by `travel_u`, at an edge of the probe input."""
    wiring = settings.wiring
    if wiring.is_probe_software:
        return Capture(settings.axes, SOFTWARE_MODE, is_polled=True)
    bank = wiring.probe // BANK * BANK
    longest = max(settings.axes, key=lambda axis: abs(travel_u[axis.index]))
    capturing = [
        axis
        for axis in settings.axes
        if wiring.is_probe_on_each or axis.index == wiring.probe - bank
    ]
    if bank in RISING_MODES and any(
        abs(travel_u[axis.index]) == abs(travel_u[longest.index]) for axis in capturing
    ):
        mode = RISING_MODES[bank] + (0 if is_rising else FALLING_EDGE)
        return Capture(tuple(capturing), mode, is_polled=False)
    reason = f"input {wiring.probe} captures no axis"
    if bank in RISING_MODES and capturing:
        taken = capturing[0]
        free = ", ".join(str(first + longest.index) for first in RISING_MODES)
        reason = f"input {wiring.probe} captures {taken.name}, and {longest.name} one of {free}"
    return Capture(settings.axes, SOFTWARE_MODE, is_polled=True, reason=reason)
