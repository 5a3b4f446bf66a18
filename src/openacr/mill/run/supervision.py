"""Supervision of a machine: raises each alarm once and applies its effect."""

from collections.abc import Callable
from contextlib import suppress
from functools import partial

from openacr.client import ConnectionLostError
from openacr.cnc.occupied import RAN_SHORT
from openacr.errors import UserError
from openacr.mill.card import alarms, homed
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.alarms import Alarm, AlarmError, Alarms, Effect, Kind
from openacr.mill.card.ballscrew import Compensation
from openacr.mill.card.driver import LINK_ERRORS, CardState
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.card.reach import Reach
from openacr.mill.manual.manual_motion import ManualMotion
from openacr.mill.run.alarm_causes import Watch
from openacr.mill.run.console import Console
from openacr.mill.run.entry_actions import EntryActions
from openacr.mill.run.lifecycle import Event, Lifecycle, State
from openacr.mill.run.program_stream import ProgramStream
from openacr.mill.run.retracing import Retrace
from openacr.mill.run.tracking import Stall

KILLS = {Effect.KILL: Event.KILL, Effect.CUT_POWER: Event.CUT_POWER}


class Supervision:
    """Checks one machine for alarms and applies their effects."""

    def __init__(
        self,
        io: MachineIo,
        alarm_list: Alarms,
        stream: ProgramStream,
        entry_actions: EntryActions,
        *,
        manual: ManualMotion,
        retrace: Retrace,
        console: Console,
        player: ActionPlayer,
        lifecycle: Lifecycle,
        compensation: Compensation,
        say: Callable[[str], None],
    ) -> None:
        self._io = io
        self._alarms = alarm_list
        self._stream = stream
        self._entry_actions = entry_actions
        self._manual = manual
        self._retrace = retrace
        self._console = console
        self._player = player
        self._lifecycle = lifecycle
        self._compensation = compensation
        self._say = say
        self._watch = Watch(io)
        self._stall = Stall()
        self._reach = Reach(io.machine.card, io.settings.link_timeout_s)
        self.rearm: Callable[[], None] = lambda: None  # the watchdog, where there is one
        self._owes_rest = False  # the link was lost before the machine could be brought to rest

    @property
    def is_busy(self) -> bool:
        """Whether a program runs, waits, is held or being ended, or an axis is moved by hand."""
        is_moved = self._player.is_active or self._manual.is_active
        return not self._lifecycle.is_over or is_moved or self._owes_rest

    @property
    def is_out_of_reach(self) -> bool:
        """Whether the card has not answered for so long that nothing more is sent to it."""
        return self._reach.is_given_up

    def check(self, sample: CardState, step_s: float) -> None:
        """Raise alarms for present causes, each once until it is acknowledged."""
        self._reach.answer()
        self._io.machine.forget_losses()
        if self._owes_rest:
            self._owes_rest = False
            self._bring_to_rest()
        elif sample.may_have_lost:
            with self._io.machine.repeating():
                self._renew()
        if sample.has_run_short:
            self._go_on_after_rest()
        if step_s > self._io.settings.link_timeout_s and self.is_busy:
            self.raise_alarm(alarms.HOST_AWAY, f"{step_s:.1f}")
        if self._does_not_begin(sample):
            self.raise_alarm(alarms.NOT_MOVED, "")
        for kind, detail in self._watch.causes(sample):
            self.raise_alarm(kind, detail)

    def _go_on_after_rest(self) -> None:
        """The watchdog has held a planned path of which too little had arrived: plan it again."""
        self._stream.hold()  # takes back the move at which the watchdog holds
        self._io.machine.set_flag(RAN_SHORT, False)
        self._say("the card had too little of the path and rests on it; it goes on from there")
        if self._lifecycle.state is State.RUN and not self._player.is_active:
            self._player.begin(self._stream.retake())

    def _does_not_begin(self, sample: CardState) -> bool:
        """Whether moves of the program or of a trace were sent and are not executed."""
        tracker = self._retrace.tracker if self._retrace.is_active else self._stream.tracker
        is_stalled = self._stall.has_come(tracker, sample, self._io.machine.now_s)
        return is_stalled and not self._lifecycle.is_over

    def play(self, sample: CardState, step_s: float) -> None:
        """Continue the present action until it has to wait."""
        lifecycle, player = self._lifecycle, self._player
        self.guard(partial(player.play, sample, step_s))
        if lifecycle.holds_later and not self.is_tapping:
            lifecycle.fire(Event.FEED_HOLD)
        if player.is_active and lifecycle.state is State.RUN:
            lifecycle.fire(Event.ACTION)
        if lifecycle.state not in (State.WAIT, State.HOMING):
            return
        lifecycle.reason = player.reason
        if not player.is_active:
            is_homing = lifecycle.state is State.HOMING
            lifecycle.fire(Event.HOMED if is_homing else Event.ACTION_DONE)

    def guard(self, do: Callable[[], None]) -> None:
        """Call a function; an AlarmError from it raises that alarm."""
        try:
            do()
        except AlarmError as error:
            self.raise_alarm(error.kind, error.detail)

    def raise_alarm(self, kind: Kind, about: object) -> None:
        """Raise an alarm; it takes effect unless it was active before."""
        detail = str(about)
        is_new = not self._alarms.is_active(kind, detail)
        self._alarms.raise_alarm(kind, detail, self._io.machine.now_s)
        is_order = kind is alarms.SCREEN_STOP  # each time, also while its alarm is active
        if not (is_new or is_order) or kind.effect is Effect.NONE:
            return
        if kind is alarms.CARD_RESET:
            homed.forget(self._io)
        if kind is alarms.EXCESS_ERROR:
            homed.lose(self._io, detail)
        if kind.effect in KILLS:
            self._lifecycle.fire(KILLS[kind.effect])
            self._manual.drop_held()
            self._watch.killed.note(kind)
            return
        self._take_effect(kind.effect)
        self._manual.stop()
        self._retrace.stop()

    def _take_effect(self, effect: Effect) -> None:
        if effect is Effect.ABORT and self.is_busy:
            self._lifecycle.fire(Event.FAULT)
        elif effect is Effect.HOLD and self._lifecycle.is_under_way:
            self.pause()

    def miss_poll(self, failure: Exception) -> None:
        """Handle a failed poll: nothing is sent before the card answers.

        A connection that returns within the link timeout is tolerated.
        """
        if isinstance(failure, ConnectionLostError) and not self._reach.is_overdue:
            return
        self.lose_link()

    def lose_link(self) -> None:
        """Handle the loss of the link: raise alarm 3 and end the program.

        Nothing is sent before the card answers a poll again, because every attempt would cost
        a time-out; then it is brought to rest. A card that stays silent is given up: its own
        watchdog stops it.
        """
        if self._reach.lose():
            self._owes_rest = self.is_busy
            self._alarms.raise_alarm(alarms.LINK_LOST, "", self._io.machine.now_s)
            self._lifecycle.fire(Event.LINK_LOST)
            self._say("alarm 3: Link lost; trying to reach the card")
        if self.is_out_of_reach:
            self._io.machine.detach("it does not answer")
            self.leave()

    def leave(self) -> None:
        """End the run without sending anything to the card."""
        self._lifecycle.fire(Event.DISOWNED)

    def abandon(self) -> None:
        """Drop the run without sending anything to the card."""
        self._owes_rest = False
        self._stream.end()
        for close in (self._player.close, self._manual.close, self._retrace.close):
            with suppress(*LINK_ERRORS):
                close()

    def _renew(self) -> None:
        """Send outputs, overrides and moves again: packets before a new connection may be lost.

        Moves are withdrawn and sent again from where the machine comes to rest; an action or
        a trace in progress cannot be repeated, so the program ends.
        """
        self._io.renew()
        self._console.renew()
        is_acting = self.is_tapping or (self._player.is_active and not self._stream.is_retaking)
        if self._retrace.is_active or (is_acting and self._lifecycle.is_under_way):
            self.lose_link()
        elif self._lifecycle.state is State.PAUSED:
            self._io.machine.hold()
            self._stream.may_lack_moves = True
        elif self._lifecycle.is_under_way:
            self._player.begin(self._stream.retake())

    def _bring_to_rest(self) -> None:
        """Switch everything off and bring moves and jogs to rest: the card answers again."""
        self._lifecycle.fire(Event.FAULT)
        self._manual.stop()
        self._retrace.stop()

    def pause(self) -> None:
        """Hold the feed; homing fails, because it cannot be resumed.

        A tap is first withdrawn from its hole: its feed never stops while the spindle turns.
        """
        if self._lifecycle.state is State.HOMING:
            self.raise_alarm(alarms.HOMING_FAILED, "stopped")
        elif not self.is_tapping:
            self._lifecycle.fire(Event.FEED_HOLD)
        elif not self._lifecycle.holds_later:
            self._lifecycle.holds_later = True
            self._say("feed hold after the tap is out of its hole")

    @property
    def is_tapping(self) -> bool:
        """Whether a turning tap may be in a hole."""
        return self._entry_actions.is_tapping and not self._lifecycle.options.is_dry

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; returns those that stay.

        With the last of them the kill is cleared, even one set by another host.
        """
        machine, is_over = self._io.machine, self._lifecycle.is_over
        if is_over and (self._player.is_active or machine.is_jogging()):
            raise UserError("the machine has not come to rest yet")
        if is_over:
            machine.clear_limits()
            self.rearm()
        sample = machine.poll()
        is_gone = self._watch.is_gone(sample)
        left = self._alarms.acknowledge(
            lambda alarm: is_gone(alarm) or (is_over and alarm.kind is alarms.MOVES_KILLED)
        )
        if is_over and not self._alarms.bars_start:
            self._lifecycle.fire(Event.ACKNOWLEDGE)
        return left

    def clear_kill(self) -> None:
        """Clear the kill: no active alarm bars a start."""
        self._io.machine.release()
        self._watch.killed.forget()
        self._compensation.renew()
