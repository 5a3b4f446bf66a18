"""Alarms while a machine is driven: each is given once, and does to the machine what it must."""

from contextlib import suppress

from openacr.errors import UserError
from openacr.mill import alarms, homed
from openacr.mill.alarms import Alarm, AlarmError, Alarms, Effect, Kind
from openacr.mill.ballscrew import Compensation
from openacr.mill.course import Course
from openacr.mill.doing import Doing
from openacr.mill.ending import Ending
from openacr.mill.hands import Hands
from openacr.mill.machine import LINK_ERRORS, Look
from openacr.mill.panel import Panel
from openacr.mill.pausing import Pausing
from openacr.mill.retracing import Retrace
from openacr.mill.script import Script
from openacr.mill.states import State, Status
from openacr.mill.watching import Watch

LOOKS_LOST = 3  # in a row, each with its time-out: the card is out of reach


class Supervision:
    """Watches one machine and takes the effects of its alarms."""

    def __init__(
        self,
        panel: Panel,
        alarm_list: Alarms,
        course: Course,
        doing: Doing,
        *,
        hands: Hands,
        retrace: Retrace,
        pausing: Pausing,
        ending: Ending,
        script: Script,
        status: Status,
        compensation: Compensation,
    ) -> None:
        self._panel = panel
        self._alarms = alarm_list
        self._course = course
        self._spindle = doing.spindle
        self._hands = hands
        self._retrace = retrace
        self._pausing = pausing
        self._ending = ending
        self._script = script
        self._status = status
        self._compensation = compensation
        self._watch = Watch(panel)
        self._lost_looks = 0

    @property
    def is_busy(self) -> bool:
        """A program runs, waits, is held or being ended, or an axis is moved by hand."""
        return not self._status.is_over or self._script.is_active or self._hands.is_active

    def keep(self, look: Look) -> None:
        """Alarms for what is wrong, each once until it is acknowledged."""
        self._lost_looks = 0
        for kind, detail in self._watch.causes(look, spins=self._spindle.is_on):
            self.give(kind, detail)

    def play(self, look: Look, step_s: float) -> None:
        """Go on with what is being done as far as the card lets it."""
        status, script = self._status, self._script
        try:
            script.play(look, step_s)
        except AlarmError as error:
            self.give(error.kind, error.detail)
        if script.is_active and status.state is State.RUN:
            status.state = State.WAIT
        if status.state is State.WAIT:
            status.reason = script.reason
            if not script.is_active:
                status.is_homing = False
                status.state = State.RUN if self._course.has_program else State.IDLE

    def give(self, kind: Kind, about: object) -> None:
        """An alarm comes up, and takes effect unless it was up before."""
        detail = str(about)
        is_new = not self._alarms.is_up(kind, detail)
        self._alarms.give(kind, detail, self._panel.machine.now_s)
        if not is_new or kind.effect is Effect.NONE:
            return
        if kind is alarms.EXCESS_ERROR:
            homed.lose(self._panel, detail)
        if kind.effect is Effect.KILL:
            self._ending.kill()
            self._hands.let_go()
            return
        self._take_effect(kind.effect)
        if kind is not alarms.LINK_LOST:
            self._hands.stop()
            self._retrace.stop()

    def _take_effect(self, effect: Effect) -> None:
        if effect is Effect.ABORT and self.is_busy:
            self._ending.abort(State.ALARM)
        elif effect is Effect.HOLD and self._status.is_under_way:
            self.pause()

    def lose_link(self) -> None:
        """The card does not answer: the program is over; a card that is back is brought to rest.

        One that stays away ends the moves it has, and is not waited for.
        """
        self._lost_looks += 1
        with suppress(*LINK_ERRORS):
            self.give(alarms.LINK_LOST, "")
        if self._lost_looks >= LOOKS_LOST:
            with suppress(*LINK_ERRORS):
                self._script.close()
            self._hands.close()

    def pause(self) -> None:
        """Feed hold; a homing fails by it, for it cannot be resumed."""
        if self._status.is_homing:
            self.give(alarms.HOMING_FAILED, "stopped")
        else:
            self._pausing.begin()

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; those that stay.

        With the last of them a kill is taken back, also one that nobody here asked for.
        """
        machine, is_over = self._panel.machine, self._status.is_over
        if is_over and (self._script.is_active or machine.is_jogging()):
            raise UserError("the machine has not come to rest yet")
        if is_over:
            machine.clear_limits()
        look = machine.look()
        is_gone = self._watch.is_gone(look, spins=self._spindle.is_on)
        left = self._alarms.acknowledge(
            lambda alarm: is_gone(alarm) or (is_over and alarm.kind is alarms.MOVES_KILLED)
        )
        if is_over and not self._alarms.bars_start:
            machine.release()
            self._compensation.renew()
            self._status.state = State.IDLE
        return left
