"""Feed hold of a program: its rest position, tracing of the path, and resume."""

from openacr.cnc.canonical import Point
from openacr.errors import UserError
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.driver import CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.run.lifecycle import Lifecycle, State
from openacr.mill.run.program_stream import ProgramStream
from openacr.mill.run.rejoin import Place
from openacr.mill.run.retracing import Retrace


class Pausing:
    """The feed hold of one machine."""

    def __init__(
        self,
        io: MachineIo,
        stream: ProgramStream,
        retrace: Retrace,
        player: ActionPlayer,
        lifecycle: Lifecycle,
    ) -> None:
        self._io = io
        self._machine = io.machine
        self._stream = stream
        self._retrace = retrace
        self._player = player
        self._lifecycle = lifecycle
        self.direction = -1  # of a trace: back (-1) or forward (1)
        self._rest: Point | None = None  # where the hold came to rest
        self._left: Place | None = None  # its place on the path, None before the first move

    @property
    def has_rested(self) -> bool:
        """Whether the hold has come to rest, which jogging requires."""
        return self._rest is not None

    def begin(self) -> None:
        """Hold the feed: moves ramp to rest on their path."""
        self._stream.hold()

    def note_place(self, sample: CardState) -> None:
        """Record where a feed hold came to rest on the path."""
        if self._lifecycle.state is State.PAUSED and self._rest is None and sample.is_held:
            self._rest, self._left = self._stream.host.position(), self._stream.place()

    def trace(self) -> None:
        """Move back along the path or forward again, by `direction`."""
        if self._left is None or self._player.is_active:
            raise UserError("no move is held")
        self._retrace.begin(self.direction, self._left)

    def resume(self) -> None:
        """Continue the path where it was held; a refusal changes nothing."""
        if self._io.is_in(self._machine.poll(), self._io.settings.wiring.feed_hold):
            raise UserError("the feed hold input is active")
        left = self._retrace.left or self._left
        point = left.point if left else self._rest
        is_off = point is not None and self._stream.is_off(point)
        if is_off and self._player.is_active:
            raise UserError("the machine was moved while an action waits: move it back, or abort")
        if point is not None and is_off:
            self._stream.require_return_path(point)
        self._go_on(point if is_off else None, left)
        self._rest = self._left = None

    def _go_on(self, target: Point | None, left: Place | None) -> None:
        """Continue along the path: as held, after a trace, or first back to `target`."""
        is_traced = self._retrace.left is not None
        self._retrace.finish()
        if target is not None:
            self._player.begin(self._stream.rejoin(target, left))
        elif is_traced or self._stream.is_retaking:
            return  # the card holds no move to continue, or none that should
        elif self._must_reread and not self._player.is_active:
            self._player.begin(self._stream.retake())
        else:
            self._machine.go_on()

    @property
    def _must_reread(self) -> bool:
        """Whether moves are read again instead of continuing those on the card."""
        stream = self._stream
        return self._lifecycle.options.is_single or stream.may_lack_moves or stream.is_planned

    def close(self) -> None:
        """Forget the held position: the program has ended."""
        self._retrace.close()
        self._rest = self._left = None
