"""The touch probes of an emulated drive: where the motor was when its switch or marker came.

The input of both probes is the home switch of the axis, or a level set by `touch`; the other
source is the marker of the encoder. A switch that changes gives the count at which it is.
"""

import math

from openacr.fieldbus.ethercat.emulated.drive_objects import DriveObjects
from openacr.fieldbus.ethercat.emulated.motor import Motor
from openacr.plant.describe.counts import count_of

PROBE_BITS = 8  # of the second probe's, beside those of the first
_ENABLE, _CONTINUOUS, _MARKER, _RISE, _FALL = 0x01, 0x02, 0x04, 0x10, 0x20
_IS_ON, _HAS_RISE, _HAS_FALL = 0x01, 0x02, 0x04


class Probe:
    """Both probes."""

    def __init__(self, objects: DriveObjects, motor: Motor) -> None:
        self._objects = objects
        self._motor = motor
        axis = motor.axis
        self._borders = (
            sorted(count_of(axis, end) for end in axis.home.between) if axis.home else []
        )
        self._pitch = axis.counts if axis.marker is not None else 0
        self._phase = math.floor(count_of(axis, axis.marker)) if axis.marker is not None else 0
        self._touched = False
        self._was_on = self.level
        self._before = motor.position_cnt

    @property
    def level(self) -> bool:
        """The level of the input."""
        return self._touched or self._motor.is_active("home")

    def touch(self, on: bool) -> None:
        """Set the input of the probes beside the home switch."""
        self._touched = on

    def watch(self, home_cnt: int) -> None:
        """A period is over: look for edges in it; `home_cnt` is added to positions."""
        function = self._objects.probe_function.number
        here, is_on = self._motor.position_cnt, self.level
        if function or self._objects.probe_status.number:
            edges = self._switch_edge(here, is_on), self._marker(here)
            status = self._objects.probe_status.number
            shown = 0
            for number in (0, 1):
                bits = function >> PROBE_BITS * number & 0xFF
                old = status >> PROBE_BITS * number & 0xFF
                edge = _as_wanted(edges[1], bits) if bits & _MARKER else edges[0]
                shown |= self._latch(number, bits, old, edge, home_cnt) << PROBE_BITS * number
            self._objects.probe_status.value = shown
        self._before, self._was_on = here, is_on

    def _latch(
        self, number: int, bits: int, old: int, edge: tuple[bool, int] | None, home_cnt: int
    ) -> int:
        if not bits & _ENABLE:
            return 0
        if not old & _IS_ON:
            return _IS_ON
        if edge is None:
            return old
        is_rise, place = edge
        wanted, has = (_RISE, _HAS_RISE) if is_rise else (_FALL, _HAS_FALL)
        if bits & wanted and (bits & _CONTINUOUS or not old & has):
            position = place + home_cnt
            entry = self._objects.probed[2 * number + (not is_rise)]
            entry.value = (position + 2**31) % 2**32 - 2**31
            return old | has
        return old

    def _switch_edge(self, here: float, is_on: bool) -> tuple[bool, int] | None:
        if is_on == self._was_on:
            return None
        low, high = sorted((self._before, here))
        for border in self._borders:
            if low <= math.floor(border) + 0.5 <= high:
                return is_on, math.floor(border)
        return is_on, math.floor(here)

    def _marker(self, here: float) -> tuple[bool, int] | None:
        if not self._pitch:
            return None
        low, high = sorted((math.floor(self._before), math.floor(here)))
        place = self._phase + math.ceil((low - self._phase) / self._pitch) * self._pitch
        if low < place <= high if here >= self._before else low <= place < high:
            return True, place
        return None


def _as_wanted(edge: tuple[bool, int] | None, bits: int) -> tuple[bool, int] | None:
    """A marker is one count wide: both its edges come in one period, the wanted one is latched."""
    return edge if edge is None or bits & _RISE else (False, edge[1])
