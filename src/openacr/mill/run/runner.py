"""Runs a part program on a card: states, commands, and one step after the other.

`step()` looks at the card once and does what is due; whoever drives it lets time pass in
between. Nothing here sleeps or knows the wall clock, so the same run takes an hour on a real
machine and seconds on a virtual one.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial

from openacr.cnc import canonical as c
from openacr.errors import StoreError, UserError
from openacr.mill.card import alarms, soft_limits
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.alarms import Alarm, Alarms
from openacr.mill.card.ballscrew import Compensation
from openacr.mill.card.driver import LINK_ERRORS, CardState, MachineDriver, StepLostError
from openacr.mill.card.enabling import enable_drives
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.overrides import Overrides
from openacr.mill.config.settings import Settings, Store
from openacr.mill.manual.controls import Controls
from openacr.mill.manual.homing import home
from openacr.mill.manual.jogging import Jogging
from openacr.mill.manual.manual_motion import ManualMotion
from openacr.mill.run.burning import Burner
from openacr.mill.run.console import Console
from openacr.mill.run.ending import Ending
from openacr.mill.run.entry_actions import EntryActions
from openacr.mill.run.lifecycle import Action, Event, Lifecycle, Options, State
from openacr.mill.run.passes import Passes
from openacr.mill.run.pausing import Pausing
from openacr.mill.run.program_stops import ProgramStops
from openacr.mill.run.program_stream import Entries, ProgramStream
from openacr.mill.run.published import Facts
from openacr.mill.run.retracing import Retrace
from openacr.mill.run.supervision import Supervision
from openacr.mill.run.switches import Switches
from openacr.mill.run.times import Times


class Runner:
    """One machine and the program that runs on it."""

    def __init__(
        self,
        machine: MachineDriver,
        store: Store,
        depth: int,
        say: Callable[[str], None] = lambda _text: None,
        alarm_list: Alarms | None = None,
        *,
        has_operator: bool = True,  # somebody answers and starts again
        compensated: Iterable[int] = (),  # axes with a ballscrew table on the card
    ) -> None:
        self.machine = machine
        self.settings = Settings(store)
        self._say = say
        self._compensation = Compensation(machine.card, self.settings, compensated)
        self.io = io = MachineIo(machine, self.settings)
        self.entry_actions = entry_actions = EntryActions(io, store, say)
        self.alarms = alarm_list or Alarms()
        self.stream = stream = ProgramStream(io, entry_actions, depth)
        self.retrace = retrace = Retrace(io, stream, depth)
        self._lifecycle = lifecycle = Lifecycle(has_operator=has_operator)
        self._player = player = ActionPlayer()
        self._manual = manual = ManualMotion(io, self._make_free)
        self._pausing = pausing = Pausing(io, stream, retrace, player, lifecycle)
        ending = Ending(io, stream, entry_actions, pausing, player, lifecycle)
        self._console = console = Console(io, entry_actions.spindle, store)
        self._passes = passes = Passes(io, stream, console, lifecycle)
        self._program_stops = ProgramStops(io, stream, entry_actions, passes, lifecycle)
        self._supervision = Supervision(
            io, self.alarms, stream, entry_actions, manual=manual, retrace=retrace,
            console=console, player=player, lifecycle=lifecycle,
            compensation=self._compensation, say=say,
        )  # fmt: skip
        self._burner = Burner(io, stream)
        self._switches = Switches(
            io, stream.host, manual=manual, retrace=retrace, lifecycle=lifecycle, say=say
        )
        self._times = Times()
        self._homing_axes: Sequence[int] = ()
        self.was_aborted = False
        lifecycle.bind(
            {
                Action.BEGIN: passes.begin,
                Action.SEEK: self._seek,
                Action.HOLD: pausing.begin,
                Action.REJOIN: pausing.resume,
                Action.TRACE: pausing.trace,
                Action.CONTINUE: self._program_stops.go_on,
                Action.FINISH: ending.finish,
                Action.REST: ending.abort,
                Action.KILL: ending.kill,
                Action.CUT_POWER: ending.cut_power,
                Action.ABANDON: self._supervision.abandon,
                Action.TAKE_BACK: self._supervision.take_back_kill,
            }
        )

    # --- what is known of the run -----------------------------------------------------

    @property
    def state(self) -> State:
        """What the machine is doing."""
        return self._lifecycle.state

    @property
    def reason(self) -> str:
        """What a WAIT or HOLD is for."""
        return self._lifecycle.reason

    @property
    def options(self) -> Options:
        """How the program is run."""
        return self._lifecycle.options

    @property
    def passes(self) -> int:
        """Ends of the program reached."""
        return self._passes.count

    @property
    def asking(self) -> c.Ask | None:
        """What the operator has to answer."""
        return self._program_stops.asking

    @property
    def jogging(self) -> Jogging:
        """The jogs of the axes."""
        return self._manual.jogging

    @property
    def controls(self) -> Controls:
        """The keys and the joystick."""
        return self._manual.controls

    @property
    def overrides(self) -> Overrides:
        """The three override switches."""
        return self._console.overrides

    @property
    def is_busy(self) -> bool:
        """A program runs, waits, is held or being ended, or an axis is moved by hand."""
        return self._supervision.is_busy

    @property
    def is_out_of_reach(self) -> bool:
        """Whether the card has not answered for so long that nothing more is sent to it."""
        return self._supervision.is_out_of_reach

    @property
    def source(self) -> c.Source | None:
        """The block that is executed."""
        return self.retrace.source or self.stream.tracker.source

    @property
    def run_s(self) -> float:
        """Card time since the start of the program."""
        return self._times.run_s

    @property
    def wait_left_s(self) -> float:
        """How long what is waited for takes at most, 0 or more; infinite without a limit."""
        return self._player.left_s

    def _facts(self) -> Facts:
        """What other programs may read of the run."""
        line = float(self.source.line) if self.source else 0.0
        return Facts(line, self.state.cell, self.alarms.last_code, self.run_s)

    # --- commands ---------------------------------------------------------------------

    def run(self, entries: Entries, options: Options | None = None) -> None:
        """Start a program from its beginning."""
        self._make_ready(Event.LOAD)
        self._lifecycle.options = options or Options()
        self.was_aborted = False
        self._passes.load(entries)
        self._lifecycle.fire(Event.LOAD)
        self._times.restart()

    def home(self, axes: Sequence[int]) -> None:
        """HOME: find the reference points of axes, priority after priority."""
        self._make_ready(Event.HOME)
        self._homing_axes = axes
        self._lifecycle.fire(Event.HOME)
        self._times.restart()

    def _seek(self) -> None:
        self._player.begin(home(self.io, self._homing_axes, self._compensation, self._say))

    def jog(self, move: Callable[[Jogging], object]) -> None:
        """Let somebody move axes by hand: in IDLE, or while a program is held."""
        self._manual.jog(move)

    def turn(self, axes: Sequence[int]) -> None:
        """Let the hand wheel move these axes, and no others; none ends it."""
        self._manual.turn(axes)

    def start(self) -> None:
        """START, Cycle Start: go on from a pause or hold."""
        if self.state is State.PAUSED:
            self.resume()
            return
        self._lifecycle.require(Event.CYCLE_START)
        self.alarms.require_none()
        self._require_rest()
        self._lifecycle.fire(Event.CYCLE_START)

    def stop(self) -> None:
        """STOP: feed hold; axes moved by hand ramp to rest."""
        if self._manual.is_active:
            self._manual.stop()
            return
        if not self._lifecycle.is_under_way:
            raise UserError(f"nothing runs: the state is {self.state.name}")
        self._supervision.pause()

    def resume(self) -> None:
        """RESUME: the way goes on where it was held."""
        self._lifecycle.require(Event.RESUME)
        self.alarms.require_none()
        self._require_rest()
        self._lifecycle.fire(Event.RESUME)

    def trace(self, direction: int) -> None:
        """In a pause: back along the path (-1), forward again (1), or to rest (0)."""
        if direction == 0:
            self.retrace.stop()
            return
        self._lifecycle.require(Event.TRACE)
        self._require_rest()
        self._pausing.direction = direction
        self._lifecycle.fire(Event.TRACE)

    def abort(self) -> None:
        """ABORT: the program ends, moves are dropped, spindle and coolant go off."""
        if not self.is_busy:
            raise UserError("no program runs")
        self.was_aborted = True
        self._manual.stop()
        self._lifecycle.fire(Event.ABORT)

    def guard(self, rearm: Callable[[], None]) -> None:
        """A watchdog runs on the card; `rearm` starts it again when an alarm is acknowledged."""
        self._supervision.rearm = rearm

    def disown(self) -> None:
        """Another program drives the machine: nothing is sent any more. AlarmError."""
        self.machine.let_go("another program drives the machine")
        self._supervision.leave()
        raise self.alarms.error(alarms.NOT_OWNER, self.machine.now_s)

    def cut_power(self) -> None:
        """The last resort where nothing brings rest: kill, all drives off, alarm 15."""
        self._supervision.give(alarms.NO_REST, "")

    def break_off(self) -> None:
        """Whoever drives the machine leaves: everything that moves comes to rest."""
        if self._manual.is_active:
            self._manual.stop()
        if not self._lifecycle.is_over:
            self.abort()

    def answer(self, value: float) -> None:
        """What the operator says to the question that is asked."""
        if self.asking is None:
            raise UserError("nothing is asked")
        self.stream.host.answers[self.asking.parameter] = value

    def block(self, on: bool) -> None:
        """BLOCK: stop behind every block, also behind the one that is being executed."""
        self._lifecycle.options = replace(self.options, is_single=on)
        self.stream.set_single(on)
        is_free = self.state is State.RUN and not self._supervision.is_tapping
        if on and is_free and not self._player.is_active:
            self._player.begin(self.stream.retake())

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; those that stay."""
        return self._supervision.acknowledge()

    # --- what bars a command ----------------------------------------------------------

    def _make_ready(self, event: Event) -> None:
        """Enable the drives for a program or a homing, if it may begin."""
        self._require_idle(event)
        enable_drives(self.io)

    def _make_free(self, what: str) -> None:
        """Enable the drives for axes moved by hand, if they may be."""
        self._require_free(what)
        enable_drives(self.io)

    def _require_idle(self, event: Event) -> None:
        """No alarm is up and nothing is under way."""
        self.alarms.require_none()
        self._lifecycle.require(event)
        self._require_ended(event.value)
        self._require_rest()

    def _require_free(self, what: str) -> None:
        """Nothing else may move the machine, and nothing may be wrong."""
        if self.state not in (State.IDLE, State.PAUSED, State.HOLD):
            raise UserError(f"cannot {what}: the state is {self.state.name}")
        if self.retrace.is_active:
            raise UserError(f"cannot {what}: the path is being traced")
        if self.state is State.PAUSED and not self._pausing.has_rested:
            raise UserError(f"cannot {what}: the machine has not come to rest yet")
        self._require_ended(what)
        sample = self.machine.poll()
        if self.io.is_in(sample, self.settings.wiring.feed_hold):
            raise UserError(f"cannot {what}: the feed hold input is active")
        soft_limits.keep(self.io, sample)
        self.alarms.require_none()
        self.stream.excuse()

    def _require_ended(self, what: str) -> None:
        """What was aborted has come to rest, and nothing of it is still to be done."""
        if self._lifecycle.is_over and self._player.is_active:
            raise UserError(f"cannot {what}: the last program is still being ended")

    def _require_rest(self) -> None:
        if self._manual.is_active:
            raise UserError("an axis is being jogged")
        if self.retrace.is_active:
            raise UserError("the path is being traced")

    # --- one step ---------------------------------------------------------------------

    def step(self) -> None:
        """Look at the card and do what is due."""
        try:
            sample = self.machine.poll()
        except LINK_ERRORS as failure:
            self._supervision.miss_poll(failure)
            return
        try:
            self._do(sample)
        except StepLostError as lost:
            self._supervision.miss_poll(lost)
        except LINK_ERRORS:
            self._supervision.lose_link()
        except StoreError as error:
            self._supervision.give(alarms.STORE_FAILED, error)

    def _do(self, sample: CardState) -> None:
        self._times.advance_to(self.machine.now_s)
        self.stream.tracker.update(sample.counter)
        with self.machine.repeating():
            soft_limits.keep(self.io, sample)
        self._supervision.keep(sample, self._times.step_s)
        self._switches.keep(sample, pause=self._supervision.pause, start=self.start)
        self._pausing.note_place(sample)
        for play in (self._manual.play, self.retrace.play):
            self._supervision.guard(partial(play, sample, self._times.step_s))
        if self.state is not State.PAUSED:
            self._supervision.play(sample, self._times.step_s)
        if self._is_reading:
            self._advance(sample)
        is_cutting = not self.options.is_dry and not self.retrace.is_active
        with self.machine.repeating():
            self._burner.keep(sample, is_cutting=is_cutting and self.stream.has_program)
            self._console.keep(sample, self._times, self._facts)

    @property
    def _is_reading(self) -> bool:
        """Whether the program itself goes on, and not an action of it."""
        return self.state is State.RUN and not self._player.is_active

    def _advance(self, sample: CardState) -> None:
        """Read, send, and take up what waits for rest."""
        while self._is_reading:
            halt, passes = self.stream.advance(sample), self.passes
            if halt is None:
                return
            self._player.begin(self._program_stops.steps(halt))
            self._supervision.play(sample, self._times.step_s)
            if self.passes != passes:
                return  # another pass counts from zero: this look is of the old one
