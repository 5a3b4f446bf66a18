"""Checks at every poll: causes of alarms, and edges of panel switches."""

from collections.abc import Callable, Iterator

from openacr.map.words import af1, af4, af5
from openacr.mill.card import alarms
from openacr.mill.card.alarms import Alarm, Kind
from openacr.mill.card.driver import CardState
from openacr.mill.card.kill_cause import Killed
from openacr.mill.card.machine_io import MachineIo

HARDWARE_LIMIT = af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED | af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED
SOFT_LIMIT = af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED | af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
Cause = tuple[Kind, str]


class Watch:
    """Detects causes of alarms in the sampled state of the card."""

    def __init__(self, io: MachineIo) -> None:
        self._io = io
        self.killed = Killed(io.machine)
        self._has_error_band = any(axis.excess_error_u > 0.0 for axis in io.settings.axes)

    def causes(self, sample: CardState) -> Iterator[Cause]:
        """Yield every present cause of an alarm."""
        killed_by = self.killed.kind(sample)
        yield from self._present(sample)
        if self._is_killed(sample):
            yield killed_by, ""

    def _is_killed(self, sample: CardState) -> bool:
        """Whether moves were killed by another host or the card, not by a crossed soft limit."""
        is_crossed = any(word & SOFT_LIMIT for word in sample.limits)
        return sample.is_killed and not is_crossed and not self._io.machine.is_dropping

    def _present(self, sample: CardState) -> Iterator[Cause]:
        """Yield the present causes other than a kill."""
        wiring, spindle = self._io.settings.wiring, self._io.settings.spindle
        if self._io.is_in(sample, wiring.emergency_stop):
            yield alarms.EMERGENCY_STOP, ""
        if sample.was_reset:
            yield alarms.CARD_RESET, ""
        if sample.has_tripped:
            yield alarms.HOST_LOST, ""
        if not sample.is_guarded and not sample.cut:  # else ended with all programs
            yield alarms.WATCHDOG_HALTED, ""
        yield from self._of_axes(sample)
        if self._has_error_band and not sample.is_within_error:
            for name in self._in_error(sample):
                yield alarms.EXCESS_ERROR, name
        if self._io.is_in(sample, spindle.exception):
            yield alarms.SPINDLE_EXCEPTION, ""
        if self._io.is_in(sample, wiring.lubrication):
            yield alarms.LUBRICATION, ""

    def _of_axes(self, sample: CardState) -> Iterator[Cause]:
        for axis, drive, limit in zip(
            self._io.settings.axes, sample.drives, sample.limits, strict=True
        ):
            name = axis.name
            if drive & af4.EXCESS_ERROR_FAULT and not sample.is_cut(axis.index):
                yield alarms.EXCESS_ERROR, name
            if drive & af4.DRIVE_FAULT:
                yield alarms.DRIVE_FAULT, name
            if limit & HARDWARE_LIMIT:
                yield alarms.HARDWARE_LIMIT, name
            if limit & SOFT_LIMIT:
                yield alarms.LIMIT_CROSSED, name

    def _in_error(self, sample: CardState) -> Iterator[str]:
        """The driven axes outside their error band, read only when the master reports one."""
        words = self._io.machine.axis_flags(af1.word)
        for axis, word in zip(self._io.settings.axes, words, strict=True):
            is_beyond = axis.excess_error_u > 0.0 and not word & af1.NOT_EXCESS_ERROR
            if is_beyond and not sample.is_cut(axis.index):
                yield axis.name

    def is_gone(self, sample: CardState) -> Callable[[Alarm], bool]:
        """A test whether the cause of an alarm is gone; a kill is present as long as it lasts."""
        present = {(kind.code, detail) for kind, detail in self._present(sample)}
        if self._is_killed(sample):
            present.add((alarms.MOVES_KILLED.code, ""))
        return lambda alarm: (alarm.kind.code, alarm.detail) not in present


class Edges:
    """Detects rising edges of inputs."""

    def __init__(self, io: MachineIo) -> None:
        self._io = io
        self._before: dict[int, bool] = {}

    def rose(self, sample: CardState, number: int) -> bool:
        """Whether an input came on since the last poll; False at the first poll."""
        now = self._io.is_in(sample, number)
        before, self._before[number] = self._before.get(number, True), now
        return now and not before
