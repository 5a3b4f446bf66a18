"""Probing (G31): a move that ends where the probe trips, with the captured position.

The input is polled in every mode: a contact that the hardware does not capture stops the
move at once and raises alarm 36.

Every wait for the card has a limit. The two moves have none, because their feed may be overridden:
they end with their motion, and a move that the card does not start is alarm 18.
"""

from collections.abc import Callable

from openacr.cnc.canonical import Line, Pace, PathMode, Point, Probe
from openacr.map.rows import axes as axis_rows
from openacr.map.words import af1
from openacr.mill.card import alarms
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.driver import CLEAR_S, CardState, flag_of
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.capture import SOFTWARE_TRIGGER, Capture, capture_of
from openacr.mill.config.settings import S_PER_MIN
from openacr.mill.plan.moves.encoding import Job


class Probing:
    """Runs probing moves of one machine; `point` is where the last one tripped, None if nowhere."""

    def __init__(
        self,
        io: MachineIo,
        send: Callable[[list[Job]], None],
        position: Callable[[], Point],
        say: Callable[[str], None],
    ) -> None:
        self._io = io
        self._machine = io.machine
        self._send = send
        self._position = position  # where the axes have come to rest
        self._say = say
        self._reported = ""
        self.point: Point | None = None

    def steps(self, job: Job, job_to: Callable[[Line, Point], Job]) -> Steps:
        """Make the move and, if the probe trips, return to the trip point at feed."""
        wiring = self._io.settings.wiring
        self.point = None
        is_away = isinstance(job.entry, Probe) and job.entry.is_away
        is_contact = wiring.is_probe_trailing == is_away  # what trips: contact made, or lost
        if wiring.is_probe_checked and self._is_at(self._machine.poll(), is_contact):
            raise AlarmError(alarms.PROBE_IDLE if is_away else alarms.PROBE_ACTIVE)
        capture = self._armed(job, is_contact)
        has_tripped = False

        def is_done(sample: CardState) -> bool:
            nonlocal has_tripped  # a contact counts even if it is lost again
            is_at_end = is_over(sample, job)
            has_tripped = has_tripped or self._has_tripped(sample, capture, is_contact)
            return has_tripped or is_at_end

        self._send([job])
        yield Until("probing", is_done)
        if not has_tripped:
            return
        rest_s = self._io.settings.rest_s
        self._machine.stop()
        yield Until("probe stops", lambda sample: not sample.is_moving, rest_s, alarms.NO_REST)
        self._machine.clear_kill()
        yield Until(
            "kill is cleared", lambda sample: not sample.is_killed, CLEAR_S, alarms.MOVES_KILLED
        )
        if not self._is_captured(capture):
            raise AlarmError(alarms.PROBE_MISSED)
        self.point = self._captured(job, capture)
        back = Line(job.entry.source, self.point, _pace_back(job, wiring.probe_back_ups))
        returning = job_to(back, self._position())
        self._send([returning])
        yield Until("back to the probed point", lambda sample: is_over(sample, returning))

    def _is_at(self, sample: CardState, is_contact: bool) -> bool:
        """Whether the input has the level of a tripped probe."""
        return self._io.is_in(sample, self._io.settings.wiring.probe) == is_contact

    def _armed(self, job: Job, is_contact: bool) -> Capture:
        """Arm the capture; report once if it falls back from hardware to polling."""
        probe = self._io.settings.wiring.probe
        is_rising = is_contact != self._io.is_inverted(probe)
        travel_u = [end - begin for begin, end in zip(job.begin, job.finish, strict=True)]
        capture = capture_of(self._io.settings, travel_u, is_rising=is_rising)
        if capture.reason and capture.reason != self._reported:
            self._reported = capture.reason
            self._say(f"{capture.reason}: the probe is polled, which is less accurate")
        self._machine.type(f"INTCAP {axis.name} {capture.mode}" for axis in capture.axes)
        return capture

    def _captures(self, capture: Capture) -> list[bool]:
        flags = [flag_of(af1.word[a.index], af1.CAPTURE_COMPLETE) for a in capture.axes]
        return self._machine.card.read_bits(flags)

    def _is_captured(self, capture: Capture) -> bool:
        return all(self._captures(capture))

    def _has_tripped(self, sample: CardState, capture: Capture, is_contact: bool) -> bool:
        """Whether the input has changed or a position was captured."""
        is_changed = self._is_at(sample, is_contact)
        if is_changed and capture.is_polled and not self._is_captured(capture):
            self._machine.set_flag(SOFTWARE_TRIGGER, True)
        return is_changed or self._is_captured(capture)

    def _captured(self, job: Job, capture: Capture) -> Point:
        """The positions at the trip; an axis without capture is interpolated along the line."""
        pulses = dict(
            zip(
                self._machine.axes,
                self._machine.axis_values(axis_rows.hardware_capture),
                strict=True,
            )
        )
        travel_u = [end - begin for begin, end in zip(job.begin, job.finish, strict=True)]
        captured_u = {
            axis.index: pulses[axis.index] / axis.pulses_per_unit for axis in capture.axes
        }
        longest = max(captured_u, key=lambda axis: abs(travel_u[axis]))
        share = 0.0
        if travel_u[longest]:
            share = (captured_u[longest] - job.begin[longest]) / travel_u[longest]
        along = [
            begin + share * distance for begin, distance in zip(job.begin, travel_u, strict=True)
        ]
        return tuple(captured_u.get(axis, value) for axis, value in enumerate(along))


def is_over(sample: CardState, job: Job) -> bool:
    """Whether a move that was sent has started and ended."""
    return sample.counter >= job.count and not sample.is_moving


def _pace_back(job: Job, back_ups: float) -> Pace:
    """The feed of the return move: of the store if configured, else of the program."""
    feed_upm = back_ups * S_PER_MIN or job.feed_ups * S_PER_MIN
    return Pace(feed_upm, PathMode.EXACT)
