"""Who holds which axis: keys of screens, a joystick, anything that jogs while it is held.

A control moves its axis until it is released, or until the one who holds it is not heard
of any more: whoever is at the other end of a link says so several times a second.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from openacr.errors import UserError
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import NONE
from openacr.mill.manual.jogging import Jogging

SILENCE_S = 0.5  # longest time without a word from somebody who holds a control
JOYSTICK = "joystick"
STICK = ((0, 1), (0, -1), (1, 1), (1, -1))  # axis of the machine and direction of each input

Jog = Callable[[Callable[[Jogging], object]], None]


@dataclass(slots=True)
class _Grip:
    """One control in somebody's hand."""

    direction: int
    until_s: float


class Controls:
    """The controls of one machine that are held now."""

    def __init__(self, io: MachineIo, jogging: Jogging, jog: Jog) -> None:
        self._io = io
        self._jogging = jogging
        self._jog = jog
        self._grips: dict[tuple[str, int], _Grip] = {}  # by who holds it, and axis
        self._stick: list[bool] | None = None  # the inputs at the last look

    def press(self, who: str, axis: int, direction: int, *, fast: bool = False) -> None:
        """`who` holds the plus or minus control of an axis; to be repeated or renewed."""
        grip = self._grips.get((who, axis))
        if grip is None or grip.direction != direction:
            self._jog(lambda jogging: jogging.hold(axis, direction, fast=fast))
        self._grips[who, axis] = _Grip(direction, self._io.machine.now_s + SILENCE_S)

    def renew(self, who: str) -> None:
        """`who` is still there."""
        for (one, _), grip in self._grips.items():
            if one == who:
                grip.until_s = self._io.machine.now_s + SILENCE_S

    def release(self, who: str, axis: int) -> None:
        """`who` lets a control go; one that is not held is none."""
        if self._grips.pop((who, axis), None) is not None:
            self._jogging.release(axis)

    def drop(self, who: str) -> None:
        """`who` is gone, and with him every control he held."""
        for one, axis in list(self._grips):
            if one == who:
                self.release(one, axis)

    def keep(self, sample: CardState) -> None:
        """Read the joystick, and let go what nobody is heard of."""
        self._read_stick(sample)
        now_s = self._io.machine.now_s
        for (who, axis), grip in list(self._grips.items()):
            if now_s > grip.until_s:
                self.release(who, axis)

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
                self._let_go(axis, direction)

    def _push(self, axis: int, direction: int) -> None:
        try:
            self.press(JOYSTICK, axis, direction)
        except UserError:
            return  # it may not move now: the stick has no effect
        self._grips[JOYSTICK, axis].until_s = inf

    def _let_go(self, axis: int, direction: int) -> None:
        grip = self._grips.get((JOYSTICK, axis))
        if grip is not None and grip.direction == direction:
            self.release(JOYSTICK, axis)
