"""G31: a move that ends where the probe trips, and what was captured there."""

from collections.abc import Callable

from openacr.cnc.canonical import Line, Pace, PathMode, Point
from openacr.map import numbers as n
from openacr.mill import alarms
from openacr.mill.actions import Steps, Until
from openacr.mill.alarms import AlarmError
from openacr.mill.encoding import Job
from openacr.mill.machine import Look, flag_of
from openacr.mill.panel import Panel
from openacr.mill.settings import S_PER_MIN

HARDWARE_LEADING, HARDWARE_TRAILING, SOFTWARE_LEADING, SOFTWARE_TRAILING = 2, 6, 11, 15
SOFTWARE_TRIGGER = 113


class Probing:
    """Probing moves of one machine; `point` is where the last one tripped, None if nowhere."""

    def __init__(
        self, panel: Panel, send: Callable[[list[Job]], None], position: Callable[[], Point]
    ) -> None:
        self._panel = panel
        self._machine = panel.machine
        self._send = send
        self._position = position  # where the axes have come to rest
        self.point: Point | None = None

    def steps(self, job: Job, job_to: Callable[[Line, Point], Job]) -> Steps:
        """The move, and if the probe trips, back to the point of the trip at feed."""
        wiring = self._panel.settings.wiring
        self.point = None
        if wiring.is_probe_checked and self._is_active():
            raise AlarmError(alarms.PROBE_ACTIVE)
        self._arm()
        self._send([job])
        yield Until("probing", lambda look: self._has_tripped(look) or is_over(look, job))
        if not self._is_captured():
            if self._is_active():
                raise AlarmError(alarms.PROBE_MISSED)
            return
        self._machine.stop()
        yield Until("probe stops", lambda look: not look.is_moving)
        self._machine.clear_kill()
        yield Until("kill is cleared", lambda look: not look.is_killed)
        self.point = self._captured(job)
        back = Line(job.entry.source, self.point, _pace_back(job, wiring.probe_back_ups))
        returning = job_to(back, self._position())
        self._send([returning])
        yield Until("back to the probed point", lambda look: is_over(look, returning))

    def _is_active(self) -> bool:
        wiring = self._panel.settings.wiring
        is_on = self._panel.is_in(self._machine.look(), wiring.probe)
        return is_on != wiring.is_probe_trailing

    def _arm(self) -> None:
        wiring = self._panel.settings.wiring
        if wiring.is_probe_software:
            mode = SOFTWARE_TRAILING if wiring.is_probe_trailing else SOFTWARE_LEADING
        else:
            mode = HARDWARE_TRAILING if wiring.is_probe_trailing else HARDWARE_LEADING
        names = (axis.name for axis in self._panel.settings.axes)
        self._machine.type(f"INTCAP {name} {mode}" for name in names)

    def _flag(self, axis: int) -> int:
        return flag_of(n.AF1_WORD + axis, n.AF1_CAPTURE_COMPLETE)

    def _captures(self) -> list[bool]:
        return self._machine.card.read_bits([self._flag(axis) for axis in self._machine.axes])

    def _is_captured(self) -> bool:
        return any(self._captures())

    def _has_tripped(self, look: Look) -> bool:
        """Whether a position was captured; software capture is triggered from here."""
        wiring = self._panel.settings.wiring
        if wiring.is_probe_software:
            is_on = self._panel.is_in(look, wiring.probe)
            if is_on != wiring.is_probe_trailing:
                self._machine.set_flag(SOFTWARE_TRIGGER, True)
        return self._is_captured()

    def _captured(self, job: Job) -> Point:
        """The positions at the trip; an axis without capture gets its share of the line."""
        captured = self._machine.axis_values(n.AX_HARDWARE_CAPTURE)
        pulses = dict(zip(self._machine.axes, captured, strict=True))
        done = dict(zip(self._machine.axes, self._captures(), strict=True))
        point = list(job.begin)
        for axis in self._panel.settings.axes:
            if done[axis.index]:
                point[axis.index] = pulses[axis.index] / axis.pulses_per_unit
        way = [end - start for start, end in zip(job.begin, job.finish, strict=True)]
        longest = max((a for a in done if done[a]), key=lambda a: abs(way[a]))
        share = 0.0
        if way[longest]:
            share = (point[longest] - job.begin[longest]) / way[longest]
        for axis_number, is_done in done.items():
            if not is_done:
                point[axis_number] = job.begin[axis_number] + share * way[axis_number]
        return tuple(point)


def is_over(look: Look, job: Job) -> bool:
    """A move that was sent has started and ended."""
    return look.counter >= job.count and not look.is_moving


def _pace_back(job: Job, back_ups: float) -> Pace:
    """The feed of the way back: that of the program unless the store has its own."""
    feed_upm = back_ups * S_PER_MIN or job.feed_ups * S_PER_MIN
    return Pace(feed_upm, PathMode.EXACT)
