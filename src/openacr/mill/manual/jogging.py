"""Jogging of axes: while a control is held, or by one increment.

A jog is an offset on the card; when it has ended the offset becomes position, so that the
machine position is one number again. Where soft limits are active, a held jog stops at the
limit.

While a control is held, the target is at most `LEASH_S` of travel ahead at full speed plus the
braking distance; it advances only while the host polls. So an axis comes to rest by itself
when the host or the link is lost: no stop has to be sent in time.
"""

from collections.abc import Iterable
from contextlib import ExitStack
from dataclasses import dataclass

from openacr.client.errors import RefusedError
from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.map.words import af1
from openacr.messages import HARD_LIMIT
from openacr.mill.card import alarms
from openacr.mill.card.actions import Steps, Until
from openacr.mill.card.alarms import AlarmError
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import LONGEST_REST_S, REST_S
from openacr.mill.config.tabs import AxisSettings
from openacr.mill.manual.profile import Profile
from openacr.sysvar.tabs import JOG

INCREMENTS = len(JOG.increments)
JOG_ACTIVE = af1.JOG_ACTIVE
LEASH_S, RENEW_S = 0.5, 0.1


@dataclass(slots=True)
class _Held:
    """A jog in progress: while a control is held, or to the end of an increment."""

    direction: int
    reach_u: float  # distance of the target ahead of the axis
    renewed_s: float
    end_u: float | None = None  # of an increment: machine position


class Jogging:
    """Jogs the axes of one machine."""

    def __init__(self, io: MachineIo) -> None:
        self._io = io
        self._machine = io.machine
        self._moving: set[int] = set()
        self._has_jerk: set[int] = set()  # that of a profile
        self._rest_by_s: float | None = None  # when the axes have to be at rest
        self._held: dict[int, _Held] = {}

    @property
    def is_active(self) -> bool:
        """Whether an axis was moved and is not known to be at rest."""
        return bool(self._moving)

    def hold(self, axis: int, direction: int, *, fast: bool = False) -> None:
        """Jog an axis until `release`, at most to its soft limit."""
        row, speed_ups = self.ready(axis, fast=fast)
        direction = direction if not self._is_reversed(axis) else -direction
        if self._is_at_limit(row, direction):
            raise AlarmError(alarms.SOFT_LIMIT, row.name)
        self._lead(row, direction, speed_ups, None, _brake_u(row, speed_ups))

    def _lead(
        self,
        row: AxisSettings,
        direction: int,
        speed_ups: float,
        end_u: float | None,
        brake_u: float,
    ) -> None:
        reach_u = LEASH_S * speed_ups + brake_u
        self._held[row.index] = _Held(direction, reach_u, self._machine.now_s, end_u)
        self._aim(row, self._held[row.index])

    def release(self, axis: int) -> None:
        """Ramp an axis to rest: its control is released."""
        self._held.pop(axis, None)
        self._type(f"JOG OFF {self._io.settings.axis(axis).name}")

    def increment(self, axis: int, direction: int, preset: int, *, fast: bool = False) -> float:
        """Move by one of the five increments, in the sense of Jog Direction; returns its size."""
        if not 1 <= preset <= INCREMENTS:
            raise UserError(f"increment {preset}: allowed are 1..{INCREMENTS}")
        size = self._io.settings.real(JOG.increments[preset - 1][axis])
        forward = (direction > 0) is not self._is_reversed(axis)
        self.move(axis, size if forward else -size, fast=fast)
        return size

    def move(self, axis: int, distance_u: float, *, fast: bool = False) -> None:
        """Move by a distance; AlarmError if it ends beyond a soft limit."""
        row, speed_ups = self.ready(axis, fast=fast)
        end = self._end_of(row, distance_u)
        self._lead(row, 1 if distance_u > 0 else -1, speed_ups, end, _brake_u(row, speed_ups))

    def _end_of(self, row: AxisSettings, distance_u: float) -> float:
        """Where a move by a distance ends; AlarmError beyond a soft limit."""
        limit = self.limit(row, 1 if distance_u > 0 else -1)
        end = self.position(row) + distance_u
        if limit is not None:
            beyond_u = end - limit if distance_u > 0.0 else limit - end
            if beyond_u * abs(row.pulses_per_unit) >= 0.5:  # of a pulse: -0.2 - 0.1 is at -0.3
                raise AlarmError(alarms.SOFT_LIMIT, row.name)
        return end

    def index(self, profile: Profile) -> None:
        """Move by the distance of a profile with its speed and ramps; soft limits as in `move`."""
        row, _speed_ups = self.ready(self._io.settings.named(profile.axis).index, fast=False)
        end = self._end_of(row, profile.distance_u)
        name, speed_ups = row.name, min(profile.speed_ups, self._io.settings.speeds.max_ups)
        self._type(
            f"JOG ACC {name}{number_text(profile.acc_ups2)}",
            f"JOG DEC {name}{number_text(profile.stop_ups2)}",
            f"JOG VEL {name}{number_text(speed_ups)}",
            f"JOG JRK {name}{number_text(profile.jerk_ups3)}",
        )
        self._has_jerk.add(row.index)
        brake_u = 0.5 * speed_ups**2 / profile.stop_ups2
        self._lead(row, 1 if profile.distance_u > 0 else -1, speed_ups, end, brake_u)

    def settle(self) -> Steps:
        """Wait for rest, then convert jog offsets to positions."""
        yield Until("jog", lambda _sample: not self._is_still_moving())
        self._rest_by_s = None
        for axis in sorted(self._moving):
            self._type(f"JOG RES {self._io.settings.axis(axis).name}")
        for axis in sorted(self._has_jerk):
            self._type(f"JOG JRK {self._io.settings.axis(axis).name}0")
        self._has_jerk.clear()
        self._moving.clear()

    def stop_all(self) -> None:
        """Ramp every axis to rest on its stop ramp, for STOP or an alarm."""
        if self._moving and self._rest_by_s is None:
            self._rest_by_s = self._machine.now_s + self._rest_s()
        with ExitStack() as each:  # all of them, even if the card refuses to stop one
            for axis in self._moving:
                each.callback(self._stop, axis)

    def _rest_s(self) -> float:
        """Longest time for axes to come to rest: twice the longest ramp plus a margin."""
        rows = (self._io.settings.axis(axis) for axis in self._moving)
        ramps_s = (max(row.jog_ups, row.jog_rapid_ups) / _ramp(row) for row in rows if _ramp(row))
        return min(REST_S + 2.0 * max(ramps_s, default=0.0), LONGEST_REST_S)

    def _stop(self, axis: int) -> None:
        row = self._io.settings.axis(axis)
        try:
            self._type(f"JOG DEC {row.name}{number_text(_ramp(row))}")
        finally:
            self.release(axis)

    def drop_held(self) -> None:
        """Drop all held jogs: a kill has stopped the axes."""
        self._held.clear()

    # --- helpers -----------------------------------------------------------------------

    def _aim(self, row: AxisSettings, held: _Held) -> None:
        """Advance the target of a jog, at most to its end or the soft limit."""
        here = self.position(row)
        end = self.limit(row, held.direction) if held.end_u is None else held.end_u
        target = here + held.direction * held.reach_u
        if end is not None and (target - end) * held.direction >= 0.0:
            beyond = held.end_u is None and (here - end) * held.direction > 0.0
            target = here if beyond else end
            if held.end_u is not None:
                del self._held[row.index]  # the card has the end as its target now
        self.aim(row, target)
        held.renewed_s = self._machine.now_s

    def aim(self, row: AxisSettings, target_u: float) -> None:
        """Command the target of an axis, in machine position."""
        self._moving.add(row.index)
        self._start(row, f"JOG ABS {row.name}{number_text(target_u - self._current(row))}")

    def _start(self, row: AxisSettings, line: str) -> None:
        """Send a jog; AlarmError where the card refuses it for an active limit switch."""
        try:
            self._type(line)
        except RefusedError as refused:
            if refused.message != HARD_LIMIT:
                raise
            raise AlarmError(alarms.HARDWARE_LIMIT, row.name) from refused

    def _is_still_moving(self) -> bool:
        """Whether axes still move; advances the targets of held jogs."""
        for axis, held in list(self._held.items()):
            row = self._io.settings.axis(axis)
            if self._machine.now_s < held.renewed_s + RENEW_S:
                continue
            if held.end_u is None and self._is_at_limit(row, held.direction):
                del self._held[axis]
            else:
                self._aim(row, held)
        is_still_moving = bool(self._held) or self._is_moving()
        if (
            is_still_moving
            and self._rest_by_s is not None
            and self._machine.now_s > self._rest_by_s
        ):
            raise AlarmError(alarms.NO_REST)
        return is_still_moving

    def _is_at_limit(self, row: AxisSettings, direction: int) -> bool:
        limit = self.limit(row, direction)
        return limit is not None and (limit - self.position(row)) * direction <= 0.0

    def ready(self, axis: int, *, fast: bool) -> tuple[AxisSettings, float]:
        """Set jog speed and ramps of an axis that may move; returns its row and speed."""
        settings = self._io.settings
        row = settings.axis(axis)
        if row.is_home_required and not settings.is_homed(axis):
            raise AlarmError(alarms.NOT_HOMED, row.name)
        is_fast = fast and not self._is_key_turned()
        speed = min(row.jog_rapid_ups if is_fast else row.jog_ups, settings.speeds.max_ups)
        self._type(
            f"JOG ACC {row.name}{number_text(row.jog_acc_ups2)}",
            f"JOG DEC {row.name}{number_text(row.jog_dec_ups2)}",
            f"JOG VEL {row.name}{number_text(speed)}",
        )
        return row, speed

    def _is_key_turned(self) -> bool:
        """Whether the maintenance key is turned: no soft limits, no rapid jog."""
        return self._io.is_key_turned(self._machine.poll())

    def _is_reversed(self, axis: int) -> bool:
        """Whether Jog Direction reverses the controls of an axis."""
        return bool(self._io.settings.real(JOG.direction[axis]))

    def limit(self, row: AxisSettings, direction: int) -> float | None:
        """The limit of an axis when jogged, as machine position; None without limit."""
        if row.soft_limits is None or not self._io.settings.is_homed(row.index):
            return None
        if self._is_key_turned():
            return None
        high, low = row.soft_limits
        return high if direction > 0 else low

    def position(self, row: AxisSettings) -> float:
        """The commanded machine position including the jog offset."""
        offset = self._machine.read(axes.jog_offset[row.index])
        return self._current(row) + offset / row.pulses_per_unit

    def _current(self, row: AxisSettings) -> float:
        """The commanded position without the jog offset."""
        pulses = self._machine.read(axes.current_position[row.index])
        return pulses / row.pulses_per_unit

    def _is_moving(self) -> bool:
        words = self._machine.card.read_many([af1.word[axis] for axis in self._moving])
        return any(int(word) & JOG_ACTIVE for word in words)

    def _type(self, *lines: str) -> None:
        self._machine.type(lines)


def _brake_u(row: AxisSettings, speed_ups: float) -> float:
    """The distance in which a jog comes to rest."""
    return 0.5 * speed_ups**2 / row.jog_dec_ups2 if row.jog_dec_ups2 else 0.0


def _ramp(row: AxisSettings) -> float:
    """The stop ramp, never softer than the ramp used to plan the path to a soft limit."""
    return max(row.jog_stp_ups2, row.jog_dec_ups2)


def distances(texts: Iterable[str], names: Iterable[str]) -> list[tuple[str, float]]:
    """Parse distances such as `X0.5 Y-1`: axis name and distance of each."""
    known = set(names)
    found = []
    for text in texts:
        name, rest = text[:1].upper(), text[1:]
        try:
            distance = float(rest)
        except ValueError:
            raise UserError(f"{text}: write a distance as X0.5") from None
        if name not in known:
            raise UserError(
                f"axis {name} is not configured; configured are {' '.join(sorted(known))}"
            )
        found.append((name, distance))
    return found
