"""Manual motion: jogs, keys and joystick, hand wheel; one of them at a time."""

from collections.abc import Callable, Sequence

from openacr.errors import UserError
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.manual.controls import Controls
from openacr.mill.manual.handwheel import HandWheel
from openacr.mill.manual.jogging import Jogging


class ManualMotion:
    """Manual motion of the axes of one machine."""

    def __init__(self, io: MachineIo, make_free: Callable[[str], None]) -> None:
        self.jogging = Jogging(io)
        self.controls = Controls(io, self.jogging, self.jog)
        self._wheel = HandWheel(io, self.jogging)
        self._player = ActionPlayer()
        self._make_free = make_free  # checks that nothing else may move the machine

    @property
    def is_active(self) -> bool:
        """Whether an axis is moved by hand, or may be at any time."""
        return self._player.is_active

    def jog(self, move: Callable[[Jogging], object]) -> None:
        """Start a jog; UserError while the hand wheel is in use."""
        self._make_free("jog")
        if self._wheel.axes:
            raise UserError("cannot jog: the hand wheel is in use")
        move(self.jogging)
        if not self._player.is_active:
            self._player.begin(self.jogging.settle())

    def turn(self, axes: Sequence[int]) -> None:
        """Select the axes the hand wheel moves; an empty selection ends it."""
        if not axes:
            self._wheel.leave()
            return
        self._make_free("use the hand wheel")
        if self.jogging.is_active and not self._wheel.axes:
            raise UserError("cannot use the hand wheel: an axis is being jogged")
        self._wheel.select(axes)
        self._player.begin(self._wheel.follow())

    def stop(self) -> None:
        """Ramp axes moved by hand to rest."""
        self._wheel.leave()
        self.jogging.stop_all()

    def drop_held(self) -> None:
        """Drop held jogs and the wheel: all motion was killed."""
        self._wheel.leave()
        self.jogging.drop_held()

    def close(self) -> None:
        """Drop all manual motion without commands: a card out of reach stops its axes itself."""
        self._player.close()
        self.drop_held()

    def play(self, sample: CardState, step_s: float) -> None:
        """Poll the controls, and continue the motion in progress."""
        self.controls.poll(sample)
        self._player.play(sample, step_s)
