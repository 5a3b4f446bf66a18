"""The ends of a program: the last block, ABORT or an alarm, and the kill of all motion.

However a program ends, spindle, coolant and beam are switched off first; nothing waits for
the machine to come to rest before that. Every wait of an ending has a limit, and a machine
that does not come to rest within it loses its drives (alarm 15).
"""

from contextlib import ExitStack

from openacr.mill import alarms
from openacr.mill.actions import Steps, Until
from openacr.mill.course import Course
from openacr.mill.doing import Doing
from openacr.mill.panel import Panel
from openacr.mill.pausing import Pausing
from openacr.mill.script import Script
from openacr.mill.states import State, Status


class Ending:
    """Ends what runs on one machine."""

    def __init__(
        self,
        panel: Panel,
        course: Course,
        doing: Doing,
        pausing: Pausing,
        script: Script,
        status: Status,
    ) -> None:
        self._panel = panel
        self._machine = panel.machine
        self._course = course
        self._doing = doing
        self._pausing = pausing
        self._script = script
        self._status = status

    def finish(self) -> None:
        """All is done and at rest; blocks typed one by one leave on what is on."""
        if not self._status.options.is_mdi:
            self._doing.off()
        self._leave(State.IDLE)

    def abort(self, state: State) -> None:
        """To rest, moves dropped, everything off.

        The hold is requested at once: who is told to end may never come to another look.
        """
        with ExitStack() as then:  # each of these even if the one before it fails; last one first
            then.callback(self._script.begin, self._to_rest())
            then.callback(self._leave, state)
            if not self._status.options.is_dry:
                then.callback(self._doing.off)
            then.callback(self._machine.hold)

    def kill(self) -> None:
        """All motion is killed, drives and spindle go off, the program is over."""
        with ExitStack() as then:  # each of these even if the one before it fails; last one first
            then.callback(self._script.close)
            then.callback(self._leave, State.ALARM)
            then.callback(self._doing.off)
            then.callback(self._panel.output, self._panel.settings.wiring.drive_enable, False)
            self._machine.kill()

    def cut_power(self) -> None:
        """The last resort, when nothing brings the machine to rest: kill, and all drives off."""
        with ExitStack() as then:
            then.callback(self._machine.disable)
            then.callback(self.kill)

    def _leave(self, state: State) -> None:
        self._pausing.close()
        self._course.end()
        self._doing.is_tapping = False
        self._status.end(state)

    def _to_rest(self) -> Steps:
        yield self._course.stops()
        yield from self._course.drop_moves()
        yield Until(
            "axes stop",
            lambda _look: not self._machine.is_jogging(),
            self._panel.settings.rest_s,
            alarms.NO_REST,
        )
        self._machine.fold_jogs()  # of a homing that was broken off
        self._machine.go_on()  # nothing is left to move: a hold must not outlast its program
