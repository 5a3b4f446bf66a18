"""A program in a feed hold: where it came to rest, the way back along its path, and on again."""

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
        self._left: Place | None = None  # where the hold has come to rest

    def begin(self) -> None:
        """Feed hold: the moves ramp to rest on their path."""
        self._machine.hold()
        self._status.state = State.PAUSED

    def note_place(self, look: Look) -> None:
        """Where a feed hold has come to rest on the path."""
        if self._status.state is State.PAUSED and self._left is None and look.is_held:
            self._left = self._course.place()

    def trace(self, direction: int) -> None:
        """Back along the path (-1), or forward again (1)."""
        if self._left is None or self._script.is_active:
            raise UserError("no move is held")
        self._retrace.begin(direction, self._left)

    def resume(self) -> None:
        """The way goes on where it was held."""
        if self._panel.is_in(self._machine.look(), self._panel.settings.wiring.feed_hold):
            raise UserError("the feed hold input is active")
        left, self._left = self._left, None
        is_taken_back = self._retrace.has_left
        if is_taken_back:
            left = self._retrace.finish()
        if left is None or not self._course.is_off(left):
            if not is_taken_back:
                self._machine.go_on()
        elif self._script.is_active:
            raise UserError("the machine was moved while an action waits: abort")
        else:
            self._script.begin(self._course.rejoin(left))
        self._status.state = State.RUN

    def close(self) -> None:
        """The program is over: there is nothing to come back to."""
        self._retrace.close()
        self._left = None
