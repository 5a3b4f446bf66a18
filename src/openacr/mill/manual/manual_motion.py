"""Axes moved by hand: jogs, keys and joystick, the hand wheel; one of them at a time."""

from collections.abc import Callable, Sequence

from openacr.errors import UserError
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.manual.controls import Controls
from openacr.mill.manual.handwheel import HandWheel
from openacr.mill.manual.jogging import Jogging


class ManualMotion:
    """Everything that moves the axes of one machine by hand."""

    def __init__(self, io: MachineIo, make_free: Callable[[str], None]) -> None:
        self.jogging = Jogging(io)
        self.controls = Controls(io, self.jogging, self.jog)
        self._wheel = HandWheel(io, self.jogging)
        self._player = ActionPlayer()
        self._make_free = make_free  # nothing else may move the machine

    @property
    def is_active(self) -> bool:
        """Whether an axis is moved, or may be at any time."""
        return self._player.is_active

    def jog(self, move: Callable[[Jogging], object]) -> None:
        """Let somebody move axes."""
        self._make_free("jog")
        if self._wheel.axes:
            raise UserError("cannot jog: the hand wheel moves the machine")
        move(self.jogging)
        if not self._player.is_active:
            self._player.begin(self.jogging.settle())

    def turn(self, axes: Sequence[int]) -> None:
        """Let the hand wheel move these axes, and no others; none ends it."""
        if not axes:
            self._wheel.leave()
            return
        self._make_free("use the hand wheel")
        if self.jogging.is_active and not self._wheel.axes:
            raise UserError("cannot use the hand wheel: an axis is being jogged")
        self._wheel.select(axes)
        self._player.begin(self._wheel.follow())

    def stop(self) -> None:
        """Axes moved by hand ramp to rest."""
        self._wheel.leave()
        self.jogging.stop_all()

    def let_go(self) -> None:
        """All motion was killed: what has come to rest becomes position."""
        self._wheel.leave()
        self.jogging.let_go()

    def close(self) -> None:
        """The card is out of reach: axes stop by themselves, nothing more is known of them."""
        self._player.close()
        self.let_go()

    def play(self, sample: CardState, step_s: float) -> None:
        """Let go what nobody holds, and go on with what is moved."""
        self.controls.keep(sample)
        self._player.play(sample, step_s)
