"""What waits for rest: actions, questions, stops and ends of a program."""

from openacr.cnc import canonical as c
from openacr.mill import alarms
from openacr.mill.actions import Steps, Until
from openacr.mill.alarms import AlarmError
from openacr.mill.course import Course
from openacr.mill.doing import Doing
from openacr.mill.feeding import Halt
from openacr.mill.panel import Panel
from openacr.mill.passes import Passes
from openacr.mill.states import State, Status


class Halting:
    """Takes up what a program of one machine halts for."""

    def __init__(
        self, panel: Panel, course: Course, doing: Doing, passes: Passes, status: Status
    ) -> None:
        self.asking: c.Ask | None = None
        self._panel = panel
        self._course = course
        self._doing = doing
        self._status = status
        self._passes = passes
        self._rest: c.Point | None = None  # where a stop of the program came to rest

    def steps(self, halt: Halt) -> Steps:
        """What to do for a halt; the program goes on behind it unless it holds or ends."""
        if isinstance(halt, c.Probe):
            yield from self._course.probe(halt)
        elif isinstance(halt, c.Ask):
            yield from self._asked(halt)
        elif isinstance(halt, c.Stop | c.BlockEnd):
            if not self._passes_by(halt):
                self._hold(halt)
                return
        elif isinstance(halt, c.End):
            if self._status.options.is_dry and self._panel.settings.returns_to_start:
                yield from self._course.return_to_begin()
            self._passes.finish()
            return
        else:
            yield from self._doing.steps(halt)
        self._course.go_on()

    def go_on(self) -> None:
        """Cycle Start after a stop: from where it came to rest; a refusal changes nothing."""
        if self._rest is not None:
            self._course.require_way_back(self._rest)
        self._status.state, self._status.reason = State.RUN, ""
        self._course.go_on()
        if self._rest is not None:
            self._course.come_back(self._rest)

    def _asked(self, ask: c.Ask) -> Steps:
        """INPUT: until the operator has answered; alarm 61 where nobody can."""
        answers = self._course.host.answers
        if ask.parameter not in answers and not self._status.has_operator:
            raise AlarmError(alarms.ANSWER_MISSING, f"P{ask.parameter} {ask.text}")
        self.asking = ask
        try:
            yield Until(ask.text, lambda _look: ask.parameter in answers)
        finally:
            self.asking = None

    def _passes_by(self, halt: c.Stop | c.BlockEnd) -> bool:
        """Whether a stop has no effect: M1 without the switch, single block switched off."""
        if isinstance(halt, c.BlockEnd):
            return not self._status.options.is_single
        if halt.pause is c.Pause.OPTIONAL:
            return not self._stops_optionally
        return False

    @property
    def _stops_optionally(self) -> bool:
        switch = self._panel.settings.wiring.optional_stop
        wired = self._panel.is_in(self._panel.machine.look(), switch)
        return self._status.options.stops_optionally or wired

    def _hold(self, halt: c.Stop | c.BlockEnd) -> None:
        text = halt.text if isinstance(halt, c.Stop) else ""
        is_by_hand = isinstance(halt, c.Stop) and halt.pause is c.Pause.HAND_RETRACT
        self._rest = None if is_by_hand else self._course.host.position()
        self._status.state = State.HOLD
        self._status.reason = text or (halt.pause.value if isinstance(halt, c.Stop) else "block")
