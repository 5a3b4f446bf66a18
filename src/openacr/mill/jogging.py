"""Moving axes by hand: as long as a control is held, or by one increment.

A jog is an offset on the card; when it has ended the offset becomes position, so that the
machine position is one number again. Where soft limits hold, a held jog goes to the limit
and no further; nothing ever has to be stopped in time.
"""

from collections.abc import Iterable

from openacr.client.values import number_text
from openacr.errors import UserError
from openacr.map import numbers as n
from openacr.mill import alarms
from openacr.mill.actions import Steps, Until
from openacr.mill.alarms import AlarmError
from openacr.mill.panel import Panel
from openacr.mill.settings import JOG, AxisSettings

FIRST_INCREMENT, INCREMENTS = 6, 5
JOG_ACTIVE = n.AF1_JOG_ACTIVE


class Jogging:
    """Jogs of the axes of one machine."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel
        self._machine = panel.machine
        self._moving: set[int] = set()

    @property
    def is_active(self) -> bool:
        """Whether an axis was set moving and is not known to be at rest."""
        return bool(self._moving)

    def hold(self, axis: int, direction: int, *, fast: bool = False) -> None:
        """A control is held: the axis moves until `release`, at most to its soft limit."""
        row = self._ready(axis, fast=fast)
        direction = direction if not self._is_turned(axis) else -direction
        limit = self._limit(row, direction)
        if limit is None:
            self._type(f"JOG {'FWD' if direction > 0 else 'REV'} {row.name}")
        else:
            way = limit - self._position(row)
            if way * direction <= 0.0:
                raise AlarmError(alarms.SOFT_LIMIT, row.name)
            self._type(f"JOG INC {row.name}{number_text(way)}")
        self._moving.add(axis)

    def release(self, axis: int) -> None:
        """The control is let go: the axis ramps to rest."""
        row = self._panel.settings.axis(axis)
        self._type(f"JOG OFF {row.name}")

    def increment(self, axis: int, direction: int, preset: int, *, fast: bool = False) -> float:
        """Exactly one of the five increments; how far that is."""
        if not 1 <= preset <= INCREMENTS:
            raise UserError(f"increment {preset}: 1..{INCREMENTS} are there")
        size = self._panel.settings.real(JOG, FIRST_INCREMENT + preset - 1, axis)
        self.move(axis, size if direction > 0 else -size, fast=fast)
        return size

    def move(self, axis: int, way_u: float, *, fast: bool = False) -> None:
        """By a distance, refused where it leads beyond a soft limit."""
        row = self._ready(axis, fast=fast)
        limit = self._limit(row, 1 if way_u > 0 else -1)
        end = self._position(row) + way_u
        if limit is not None and (end - limit) * way_u > 0.0:
            raise AlarmError(alarms.SOFT_LIMIT, row.name)
        self._type(f"JOG INC {row.name}{number_text(way_u)}")
        self._moving.add(axis)

    def settle(self) -> Steps:
        """Wait for rest, then make positions of the offsets."""
        yield Until("jog", lambda _look: not self._is_moving())
        for axis in sorted(self._moving):
            self._type(f"JOG RES {self._panel.settings.axis(axis).name}")
        self._moving.clear()

    def stop_all(self) -> None:
        """Every axis ramps to rest: a held control is lost, or an alarm is up."""
        for axis in self._moving:
            self.release(axis)

    # --- pieces -----------------------------------------------------------------------

    def _ready(self, axis: int, *, fast: bool) -> AxisSettings:
        """The speed and ramps of jogs for an axis that may move."""
        settings = self._panel.settings
        row = settings.axis(axis)
        if row.is_home_required and not settings.is_homed(axis):
            raise AlarmError(alarms.NOT_HOMED, row.name)
        speed = min(row.jog_rapid_ups if fast else row.jog_ups, settings.speeds.max_ups)
        self._type(
            f"JOG ACC {row.name}{number_text(row.jog_acc_ups2)}",
            f"JOG DEC {row.name}{number_text(row.jog_dec_ups2)}",
            f"JOG VEL {row.name}{number_text(speed)}",
        )
        return row

    def _is_turned(self, axis: int) -> bool:
        """Whether Jog Direction turns the controls of an axis around."""
        return bool(self._panel.settings.real(JOG, 5, axis))

    def _limit(self, row: AxisSettings, direction: int) -> float | None:
        if row.soft_limits is None or not self._panel.settings.is_homed(row.index):
            return None
        high, low = row.soft_limits
        return high if direction > 0 else low

    def _position(self, row: AxisSettings) -> float:
        """Where the axis is commanded to stand, with the jog that is not position yet."""
        rows = (n.AX_CURRENT_POSITION, n.AX_JOG_OFFSET)
        base = n.AX_BASE + row.index * n.AX_STRIDE
        pulses = self._machine.card.read_many([base + each for each in rows])
        return sum(map(float, pulses)) / row.pulses_per_unit

    def _is_moving(self) -> bool:
        words = self._machine.card.read_many([n.AF1_WORD + axis for axis in self._moving])
        return any(int(word) & JOG_ACTIVE for word in words)

    def _type(self, *lines: str) -> None:
        self._machine.type(lines)


def ways(texts: Iterable[str], names: Iterable[str]) -> list[tuple[str, float]]:
    """Distances as `X0.5 Y-1`: axis and way of each."""
    known = set(names)
    found = []
    for text in texts:
        name, rest = text[:1].upper(), text[1:]
        try:
            way = float(rest)
        except ValueError:
            raise UserError(f"{text}: write a way as X0.5") from None
        if name not in known:
            raise UserError(f"axis {name} is not configured: {' '.join(sorted(known))} are")
        found.append((name, way))
    return found
