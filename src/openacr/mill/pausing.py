"""A program in a feed hold: where it came to rest, the way back along its path, and on again."""

from openacr.cnc.canonical import Point
from openacr.errors import UserError
from openacr.mill.course import Course
from openacr.mill.machine import Look
from openacr.mill.panel import Panel
from openacr.mill.rejoin import Place
from openacr.mill.retracing import Retrace
from openacr.mill.script import Script
from openacr.mill.states import State, Status


class Pausing:
    """The feed hold of one machine."""

    def __init__(
        self, panel: Panel, course: Course, retrace: Retrace, script: Script, status: Status
    ) -> None:
        self._panel = panel
        self._machine = panel.machine
        self._course = course
        self._retrace = retrace
        self._script = script
        self._status = status
        self._rest: Point | None = None  # where the hold has come to rest
        self._left: Place | None = None  # that place on the path, once a move was made

    @property
    def has_rested(self) -> bool:
        """Whether the hold has come to rest: axes may be moved by hand only then."""
        return self._rest is not None

    def begin(self) -> None:
        """Feed hold: the moves ramp to rest on their path."""
        self._machine.hold()
        self._status.state = State.PAUSED

    def note_place(self, look: Look) -> None:
        """Where a feed hold has come to rest on the path."""
        if self._status.state is State.PAUSED and self._rest is None and look.is_held:
            self._rest, self._left = self._course.host.position(), self._course.place()

    def trace(self, direction: int) -> None:
        """Back along the path (-1), or forward again (1)."""
        if self._left is None or self._script.is_active:
            raise UserError("no move is held")
        self._retrace.begin(direction, self._left)

    def resume(self) -> None:
        """The way goes on where it was held; a refusal changes nothing."""
        if self._panel.is_in(self._machine.look(), self._panel.settings.wiring.feed_hold):
            raise UserError("the feed hold input is active")
        left = self._retrace.left or self._left
        point = left.point if left else self._rest
        is_off = point is not None and self._course.is_off(point)
        if is_off and self._script.is_active:
            raise UserError("the machine was moved while an action waits: move it back, or abort")
        if point is not None and is_off:
            self._course.require_way_back(point)
        self._go_on(point if is_off else None, left)
        self._rest = self._left = None
        self._status.state = State.RUN

    def _go_on(self, target: Point | None, left: Place | None) -> None:
        """On along the path: as it is held, back from a trace, or first back to `target`."""
        is_taken_back = self._retrace.left is not None
        self._retrace.finish()
        if target is not None:
            self._script.begin(self._course.rejoin(target, left))
        elif is_taken_back or self._course.is_retaking:
            return  # the card holds no move that goes on, or none that shall
        elif self._reads_again and not self._script.is_active:
            self._script.begin(self._course.retake())
        else:
            self._machine.go_on()

    @property
    def _reads_again(self) -> bool:
        """Whether the moves of the card are not simply gone on with."""
        return self._status.options.is_single or self._course.may_lack_moves

    def close(self) -> None:
        """The program is over: there is nothing to come back to."""
        self._retrace.close()
        self._rest = self._left = None
