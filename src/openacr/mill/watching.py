"""What the runner looks for at every look: causes of alarms, and the switches of the panel."""

from collections.abc import Callable, Iterator

from openacr.map import numbers as n
from openacr.mill import alarms
from openacr.mill.alarms import Alarm, Kind
from openacr.mill.killed import Killed
from openacr.mill.machine import Look
from openacr.mill.panel import Panel

HARDWARE_LIMIT = (
    n.AF5_POSITIVE_HARDWARE_LIMIT_ENCOUNTERED | n.AF5_NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED
)
SOFT_LIMIT = n.AF5_POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED | n.AF5_NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
Cause = tuple[Kind, str]


class Watch:
    """The causes of alarms that the card and its inputs show."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel
        self._names = [axis.name for axis in panel.settings.axes]
        self.killed = Killed(panel.machine)
        self._has_error_band = any(axis.excess_error_u > 0.0 for axis in panel.settings.axes)

    def causes(self, look: Look, *, spins: bool) -> Iterator[Cause]:
        """Everything that is wrong now; `spins` says that the spindle is on."""
        killed_by = self.killed.kind(look)
        yield from self._present(look, spins=spins)
        if self._is_killed(look):
            yield killed_by, ""

    def _is_killed(self, look: Look) -> bool:
        """Whether moves were killed by another; a soft limit that was crossed kills them, too."""
        is_crossed = any(word & SOFT_LIMIT for word in look.limits)
        return look.is_killed and not is_crossed and not self._panel.machine.is_dropping

    def _present(self, look: Look, *, spins: bool) -> Iterator[Cause]:
        """What is wrong now, besides a kill."""
        wiring, spindle = self._panel.settings.wiring, self._panel.settings.spindle
        if self._panel.is_in(look, wiring.emergency_stop):
            yield alarms.EMERGENCY_STOP, ""
        if look.was_reset:
            yield alarms.CARD_RESET, ""
        if look.has_tripped:
            yield alarms.HOST_LOST, ""
        if not look.is_guarded:
            yield alarms.WATCHDOG_HALTED, ""
        yield from self._of_axes(look)
        if self._has_error_band and not look.is_within_error:
            for name in self._in_error():
                yield alarms.EXCESS_ERROR, name
        if spins and self._panel.is_in(look, spindle.exception):
            yield alarms.SPINDLE_EXCEPTION, ""
        if self._panel.is_in(look, wiring.lubrication):
            yield alarms.LUBRICATION, ""

    def _of_axes(self, look: Look) -> Iterator[Cause]:
        for name, drive, limit in zip(self._names, look.drives, look.limits, strict=True):
            if drive & n.AF4_EXCESS_ERROR_FAULT:
                yield alarms.EXCESS_ERROR, name
            if drive & n.AF4_DRIVE_FAULT:
                yield alarms.DRIVE_FAULT, name
            if limit & HARDWARE_LIMIT:
                yield alarms.HARDWARE_LIMIT, name
            if limit & SOFT_LIMIT:
                yield alarms.LIMIT_CROSSED, name

    def _in_error(self) -> Iterator[str]:
        """The axes outside their band, asked for only when the master says there are some."""
        words = self._panel.machine.axis_flags(n.AF1_WORD)
        for axis, word in zip(self._panel.settings.axes, words, strict=True):
            if axis.excess_error_u > 0.0 and not word & n.AF1_NOT_EXCESS_ERROR:
                yield axis.name

    def is_gone(self, look: Look, *, spins: bool) -> Callable[[Alarm], bool]:
        """Whether the cause of an alarm is no longer there; a kill is one as long as it lasts."""
        present = {(kind.code, detail) for kind, detail in self._present(look, spins=spins)}
        if self._is_killed(look):
            present.add((alarms.MOVES_KILLED.code, ""))
        return lambda alarm: (alarm.kind.code, alarm.detail) not in present


class Edges:
    """Inputs that act when they come on."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel
        self._before: dict[int, bool] = {}

    def rose(self, look: Look, number: int) -> bool:
        """Whether an input came on since the last look; at the first one it did not."""
        now = self._panel.is_in(look, number)
        before, self._before[number] = self._before.get(number, True), now
        return now and not before
