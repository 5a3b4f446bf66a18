"""Jog controls held by operators: screen keys, a joystick, any control that jogs while held.

A control moves its axis until it is released, or until its holder is silent: a holder at the
other end of a link renews its hold several times a second.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from openacr.errors import UserError
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import NONE
from openacr.mill.manual.jogging import Jogging

SILENCE_S = 0.5  # longest time between renewals of a held control
JOYSTICK = "joystick"
STICK = ((0, 1), (0, -1), (1, 1), (1, -1))  # axis of the machine and direction of each input

Jog = Callable[[Callable[[Jogging], object]], None]


@dataclass(slots=True)
class _Grip:
    """A held control."""

    direction: int
    until_s: float


class Controls:
    """The held controls of one machine."""

    def __init__(self, io: MachineIo, jogging: Jogging, jog: Jog) -> None:
        self._io = io
        self._jogging = jogging
        self._jog = jog
        self._grips: dict[tuple[str, int], _Grip] = {}  # by holder and axis
        self._stick: list[bool] | None = None  # the inputs at the last poll

    def press(self, holder: str, axis: int, direction: int, *, fast: bool = False) -> None:
        """Hold the plus or minus control of an axis; to be repeated or renewed."""
        grip = self._grips.get((holder, axis))
        if grip is None or grip.direction != direction:
            self._jog(lambda jogging: jogging.hold(axis, direction, fast=fast))
        self._grips[holder, axis] = _Grip(direction, self._io.machine.now_s + SILENCE_S)

    def renew(self, holder: str) -> None:
        """Renew all holds of one holder."""
        for (one, _), grip in self._grips.items():
            if one == holder:
                grip.until_s = self._io.machine.now_s + SILENCE_S

    def release(self, holder: str, axis: int) -> None:
        """Release a control; one that is not held is ignored."""
        if self._grips.pop((holder, axis), None) is not None:
            self._jogging.release(axis)

    def drop(self, holder: str) -> None:
        """Release every control of a holder that has gone."""
        for one, axis in list(self._grips):
            if one == holder:
                self.release(one, axis)

    def poll(self, sample: CardState) -> None:
        """Read the joystick, and release controls whose holder is silent."""
        self._read_stick(sample)
        now_s = self._io.machine.now_s
        for (holder, axis), grip in list(self._grips.items()):
            if now_s > grip.until_s:
                self.release(holder, axis)

    # --- joystick ---------------------------------------------------------------------

    def _read_stick(self, sample: CardState) -> None:
        """Each of the four inputs holds one control while it is active."""
        first = self._io.settings.wiring.joystick
        if first == NONE:
            return
        axes = self._io.settings.axes
        now = [self._io.is_in(sample, first + n) for n in range(len(STICK))]
        before, self._stick = self._stick or now, now
        for (place, direction), was, is_on in zip(STICK, before, now, strict=True):
            if place >= len(axes) or was == is_on:
                continue
            axis = axes[place].index
            if is_on:
                self._push(axis, direction)
            else:
                self._release_stick(axis, direction)

    def _push(self, axis: int, direction: int) -> None:
        try:
            self.press(JOYSTICK, axis, direction)
        except UserError:
            return  # the axis may not move now: the stick has no effect
        self._grips[JOYSTICK, axis].until_s = inf

    def _release_stick(self, axis: int, direction: int) -> None:
        grip = self._grips.get((JOYSTICK, axis))
        if grip is not None and grip.direction == direction:
            self.release(JOYSTICK, axis)
