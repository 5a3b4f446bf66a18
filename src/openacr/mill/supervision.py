"""Alarms while a machine is driven: each is given once, and does to the machine what it must."""

from collections.abc import Callable
from contextlib import suppress
from functools import partial

from openacr.client import ConnectionLostError
from openacr.errors import UserError
from openacr.mill import alarms, homed
from openacr.mill.alarms import Alarm, AlarmError, Alarms, Effect, Kind
from openacr.mill.ballscrew import Compensation
from openacr.mill.console import Console
from openacr.mill.course import Course
from openacr.mill.doing import Doing
from openacr.mill.ending import Ending
from openacr.mill.hands import Hands
from openacr.mill.machine import LINK_ERRORS, Look
from openacr.mill.panel import Panel
from openacr.mill.pausing import Pausing
from openacr.mill.reach import Reach
from openacr.mill.retracing import Retrace
from openacr.mill.script import Script
from openacr.mill.states import State, Status
from openacr.mill.tracking import Stall
from openacr.mill.watching import Watch


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
        console: Console,
        script: Script,
        status: Status,
        compensation: Compensation,
        say: Callable[[str], None],
    ) -> None:
        self._panel = panel
        self._alarms = alarm_list
        self._course = course
        self._doing = doing
        self._spindle = doing.spindle
        self._hands = hands
        self._retrace = retrace
        self._pausing = pausing
        self._ending = ending
        self._console = console
        self._script = script
        self._status = status
        self._compensation = compensation
        self._say = say
        self._watch = Watch(panel)
        self._stall = Stall()
        self._reach = Reach(panel.machine.card, panel.settings.link_timeout_s)
        self.rearm: Callable[[], None] = lambda: None  # the watchdog, where there is one
        self._owes_rest = False  # the link was lost before the machine could be brought to rest

    @property
    def is_busy(self) -> bool:
        """A program runs, waits, is held or being ended, or an axis is moved by hand."""
        is_moved = self._script.is_active or self._hands.is_active
        return not self._status.is_over or is_moved or self._owes_rest

    @property
    def is_out_of_reach(self) -> bool:
        """Whether the card has not answered for so long that nothing more is sent to it."""
        return self._reach.is_given_up

    def keep(self, look: Look, step_s: float) -> None:
        """Alarms for what is wrong, each once until it is acknowledged."""
        self._reach.answer()
        self._panel.machine.forget_losses()
        if self._owes_rest:
            self._owes_rest = False
            self._bring_to_rest()
        elif look.may_have_lost:
            with self._panel.machine.repeating():
                self._renew()
        if step_s > self._panel.settings.link_timeout_s and self.is_busy:
            self.give(alarms.HOST_AWAY, f"{step_s:.1f}")
        if self._does_not_begin(look):
            self.give(alarms.NOT_MOVED, "")
        for kind, detail in self._watch.causes(look, spins=self._spindle.is_on):
            self.give(kind, detail)

    def _does_not_begin(self, look: Look) -> bool:
        """Whether moves of the program, or of a trace in a pause, were sent and are not made."""
        tracker = self._retrace.tracker if self._retrace.is_active else self._course.tracker
        is_stalled = self._stall.has_come(tracker, look, self._panel.machine.now_s)
        return is_stalled and not self._status.is_over

    def play(self, look: Look, step_s: float) -> None:
        """Go on with what is being done as far as the card lets it."""
        status, script = self._status, self._script
        self.guard(partial(script.play, look, step_s))
        if status.holds_later and not self.is_tapping:
            status.holds_later = False
            self._pausing.begin()
        if script.is_active and status.state is State.RUN:
            status.state = State.WAIT
        if status.state is State.WAIT:
            status.reason = script.reason
            if not script.is_active:
                status.is_homing = False
                status.state = State.RUN if self._course.has_program else State.IDLE

    def guard(self, do: Callable[[], None]) -> None:
        """Do something; an alarm it ends with takes effect."""
        try:
            do()
        except AlarmError as error:
            self.give(error.kind, error.detail)

    def give(self, kind: Kind, about: object) -> None:
        """An alarm comes up, and takes effect unless it was up before."""
        detail = str(about)
        is_new = not self._alarms.is_up(kind, detail)
        self._alarms.give(kind, detail, self._panel.machine.now_s)
        if not is_new or kind.effect is Effect.NONE:
            return
        if kind is alarms.CARD_RESET:
            homed.forget(self._panel)
        if kind is alarms.EXCESS_ERROR:
            homed.lose(self._panel, detail)
        if kind.effect is Effect.KILL:
            end = self._ending.cut_power if kind is alarms.NO_REST else self._ending.kill
            end()
            self._hands.let_go()
            self._watch.killed.note(kind)
            return
        self._take_effect(kind.effect)
        self._hands.stop()
        self._retrace.stop()

    def _take_effect(self, effect: Effect) -> None:
        if effect is Effect.ABORT and self.is_busy:
            self._ending.abort(State.ALARM)
        elif effect is Effect.HOLD and self._status.is_under_way:
            self.pause()

    def miss_look(self, failure: Exception) -> None:
        """The card has not answered a look: nothing is sent before it does.

        A connection that is broken and comes back within the link timeout goes on.
        """
        if isinstance(failure, ConnectionLostError) and not self._reach.is_overdue:
            return
        self.lose_link()

    def lose_link(self) -> None:
        """The card does not answer: alarm 3, and the program is over.

        Nothing is sent before the card has answered a look again, for every attempt would
        cost a time-out; then it is brought to rest. One that stays away is given up: its own
        watch stops it.
        """
        if self._reach.lose():
            self._owes_rest = self.is_busy
            self._alarms.give(alarms.LINK_LOST, "", self._panel.machine.now_s)
            self._status.end(State.ALARM)
            self._say("alarm 3: Link lost; trying to reach the card")
        if self.is_out_of_reach:
            self._panel.machine.let_go("it does not answer")
            self.leave()

    def leave(self) -> None:
        """End what runs here without a word to the card."""
        self._owes_rest = False
        self._status.end(State.ALARM)
        self._course.end()
        for close in (self._script.close, self._hands.close, self._retrace.close):
            with suppress(*LINK_ERRORS):
                close()

    def _renew(self) -> None:
        """Packets sent before a new connection may be lost: send again what the card has to know.

        Moves are taken back and sent once more from where the machine comes to rest; an
        action or a trace that has begun cannot be repeated, so it ends the program.
        """
        self._panel.renew()
        self._console.renew()
        is_acting = self.is_tapping or (self._script.is_active and not self._course.is_retaking)
        if self._retrace.is_active or (is_acting and self._status.is_under_way):
            self.lose_link()
        elif self._status.state is State.PAUSED:
            self._panel.machine.hold()
            self._course.may_lack_moves = True
        elif self._status.is_under_way:
            self._script.begin(self._course.retake())

    def _bring_to_rest(self) -> None:
        """Everything off, moves and jogs to rest: the card answers again."""
        self._ending.abort(State.ALARM)
        self._hands.stop()
        self._retrace.stop()

    def pause(self) -> None:
        """Feed hold; a homing fails by it, for it cannot be resumed.

        A tap comes out of its hole first: its feed never rests while the spindle turns.
        """
        if self._status.is_homing:
            self.give(alarms.HOMING_FAILED, "stopped")
        elif not self.is_tapping:
            self._pausing.begin()
        elif not self._status.holds_later:
            self._status.holds_later = True
            self._say("feed hold: the tap comes out of its hole first")

    @property
    def is_tapping(self) -> bool:
        """Whether a turning tap may be in its hole."""
        return self._doing.is_tapping and not self._status.options.is_dry

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; those that stay.

        With the last of them a kill is taken back, also one that nobody here asked for.
        """
        machine, is_over = self._panel.machine, self._status.is_over
        if is_over and (self._script.is_active or machine.is_jogging()):
            raise UserError("the machine has not come to rest yet")
        if is_over:
            machine.clear_limits()
            self.rearm()
        look = machine.look()
        is_gone = self._watch.is_gone(look, spins=self._spindle.is_on)
        left = self._alarms.acknowledge(
            lambda alarm: is_gone(alarm) or (is_over and alarm.kind is alarms.MOVES_KILLED)
        )
        if is_over and not self._alarms.bars_start:
            machine.release()
            self._watch.killed.forget()
            self._compensation.renew()
            self._status.state = State.IDLE
        return left
