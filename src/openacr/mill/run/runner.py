"""Runner of part programs on a card: states, commands, and the step of each poll.

`step()` polls the card once and does what is due; the caller lets time pass in
between. Nothing here sleeps or knows the wall clock, so the same run takes an hour on a real
machine and seconds on a virtual one.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial

from openacr.cnc import canonical as c
from openacr.errors import StoreError, UserError
from openacr.map.words import pf
from openacr.mill.card import alarms, soft_limits
from openacr.mill.card.action_player import ActionPlayer
from openacr.mill.card.actions import Steps
from openacr.mill.card.alarms import Alarm, Alarms
from openacr.mill.card.ballscrew import Compensation
from openacr.mill.card.driver import LINK_ERRORS, CardState, MachineDriver, StepLostError
from openacr.mill.card.enabling import enable_drives
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.overrides import Override, Overrides
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

PLACE_S = 0.1  # between two looks at where the axes are


class Runner:
    """Runs programs on one machine."""

    def __init__(
        self,
        machine: MachineDriver,
        store: Store,
        depth: int,
        say: Callable[[str], None] = lambda _text: None,
        alarm_list: Alarms | None = None,
        *,
        has_operator: bool = True,  # an operator is present to answer and continue
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
        self._console = console = Console(io, stream, entry_actions.spindle, store)
        self._times = times = Times()
        self._passes = passes = Passes(io, stream, console, lifecycle, times)
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
        self._homing_axes: Sequence[int] = ()
        self.homing: dict[int, str] = {}  # by axis: what it waits for
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
                Action.CLEAR_KILL: self._supervision.clear_kill,
            }
        )

    # --- status -----------------------------------------------------

    @property
    def state(self) -> State:
        """The state of the machine."""
        return self._lifecycle.state

    @property
    def reason(self) -> str:
        """The reason of a WAIT or HOLD."""
        return self._lifecycle.reason

    @property
    def options(self) -> Options:
        """The options of the run."""
        return self._lifecycle.options

    @property
    def passes(self) -> int:
        """The count of completed passes."""
        return self._passes.count

    @property
    def asking(self) -> c.Ask | None:
        """The question for the operator; None if there is none."""
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
        """Whether a program runs, waits, is held or being ended, or an axis is moved by hand."""
        return self._supervision.is_busy

    @property
    def is_out_of_reach(self) -> bool:
        """Whether the card has not answered for so long that nothing more is sent to it."""
        return self._supervision.is_out_of_reach

    @property
    def source(self) -> c.Source | None:
        """The executing block."""
        return self.retrace.source or self.stream.tracker.source

    @property
    def run_s(self) -> float:
        """Card time of the present run, or of the last one, s; 0 before the first."""
        return self._times.run_s

    @property
    def pass_s(self) -> float:
        """The part of the predicted time of the program that has passed in this pass, s.

        Moves count as fast as their override lets them pass, dwells in full; waits of any other
        kind and holds do not count.
        """
        return self._times.pass_s

    @property
    def wait_left_s(self) -> float:
        """The time until the present wait times out, s; infinite without a limit."""
        return self._player.left_s

    def _facts(self) -> Facts:
        """The facts published to other programs."""
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

    def require_start(self) -> None:
        """Require what starting a program needs: no active alarm, and nothing runs."""
        self._require_idle(Event.LOAD)

    def home(self, axes: Sequence[int]) -> None:
        """Home axes in order of priority (HOME)."""
        self._make_ready(Event.HOME)
        self._homing_axes = axes
        self._lifecycle.fire(Event.HOME)
        self._times.restart()

    def _seek(self) -> None:
        self._player.begin(self._homed_steps())

    def _homed_steps(self) -> Steps:
        say = self._say
        return home(self.io, self._homing_axes, self._compensation, say, self.homing)

    def jog(self, move: Callable[[Jogging], object]) -> None:
        """Jog axes, in IDLE or while a program is held."""
        self._manual.jog(move)

    def turn(self, axes: Sequence[int]) -> None:
        """Select the axes the hand wheel moves; an empty selection ends it."""
        self._manual.turn(axes)

    def start(self) -> None:
        """Continue from a pause or hold (START, Cycle Start)."""
        if self.state is State.PAUSED:
            self.resume()
            return
        self._lifecycle.require(Event.CYCLE_START)
        self.alarms.require_none()
        self._require_rest()
        self._lifecycle.fire(Event.CYCLE_START)

    def stop(self) -> None:
        """Hold the feed; axes moved by hand ramp to rest (STOP)."""
        if self._manual.is_active:
            self._manual.stop()
            return
        if not self._lifecycle.is_under_way:
            raise UserError(f"nothing runs: the state is {self.state.name}")
        self._supervision.pause()

    def resume(self) -> None:
        """Continue the path where it was held, or the program after its stop (RESUME)."""
        if self.state is State.HOLD:
            self.start()
            return
        self._lifecycle.require(Event.RESUME)
        self.alarms.require_none()
        self._require_rest()
        self._lifecycle.fire(Event.RESUME)

    def trace(self, direction: int) -> None:
        """Trace the path in a pause: back (-1), forward (1), or stop (0)."""
        if direction == 0:
            self.retrace.stop()
            return
        self._lifecycle.require(Event.TRACE)
        self._require_rest()
        self._pausing.direction = direction
        self._lifecycle.fire(Event.TRACE)

    def abort(self) -> None:
        """End the program, drop its moves, switch spindle and coolant off (ABORT)."""
        if not self.is_busy:
            raise UserError("no program runs")
        self.was_aborted = True
        self._manual.stop()
        self._lifecycle.fire(Event.ABORT)

    def guard(self, rearm: Callable[[], None]) -> None:
        """Register the watchdog on the card; `rearm` restarts it on acknowledgement."""
        self._supervision.rearm = rearm

    def disown(self) -> None:
        """Give up the machine to another program: send nothing more, raise AlarmError."""
        self.machine.detach("another program drives the machine")
        self._supervision.leave()
        raise self.alarms.error(alarms.NOT_OWNER, self.machine.now_s)

    def cut_power(self) -> None:
        """Kill all motion and switch all drives off (alarm 15): the machine does not rest."""
        self._supervision.raise_alarm(alarms.NO_REST, "")

    def kill(self, detail: str) -> None:
        """Switch spindle, beam and all drives of the card off (alarm 9): an operator's order."""
        self._supervision.raise_alarm(alarms.SCREEN_STOP, detail)

    def fail(self, cause: str) -> None:
        """End what runs (alarm 19): its caller cannot poll the machine any more."""
        self._supervision.raise_alarm(alarms.CONTROL_FAILED, cause)

    def bring_to_rest(self) -> None:
        """Bring everything that moves to rest: the caller leaves the machine."""
        if self._manual.is_active:
            self._manual.stop()
        if not self._lifecycle.is_over:
            self.abort()

    def answer(self, value: float) -> None:
        """Answer the question that is asked."""
        if self.asking is None:
            raise UserError("nothing is asked")
        self.stream.host.answers[self.asking.parameter] = value

    def block(self, on: bool) -> None:
        """Switch single block on or off (BLOCK); it applies from the executing block."""
        self._lifecycle.options = replace(self.options, is_single=on)
        self.stream.set_single(on)
        is_free = self.state is State.RUN and not self._supervision.is_tapping
        if on and is_free and not self._player.is_active:
            self._player.begin(self.stream.retake())

    def stop_optionally(self, on: bool) -> None:
        """Switch the stop at M1 on or off; it applies from the executing block."""
        self._lifecycle.options = replace(self.options, stops_optionally=on)

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; returns those that stay."""
        return self._supervision.acknowledge()

    # --- interlocks of commands ----------------------------------------------------------

    def _make_ready(self, event: Event) -> None:
        """Enable the drives for a program or homing, if it may start."""
        self._require_idle(event)
        self._require_free_program()
        enable_drives(self.io)

    def _make_free(self, what: str) -> None:
        """Enable the drives for manual motion, if it is allowed."""
        self._require_free(what)
        self._require_free_program()
        enable_drives(self.io)

    def _require_free_program(self) -> None:
        """Require that the program of the master is not run by itself: its channel is needed."""
        number = self.machine.master
        if int(self.machine.read(pf.word[number])) & pf.PROGRAM_RUNNING:
            raise UserError(
                f"PROG{number} runs on the card, and the machine needs its axes: halt it first"
                f" (HALT PROG{number})"
            )

    def _require_idle(self, event: Event) -> None:
        """Require that no alarm is active and nothing runs."""
        self.alarms.require_none()
        self._lifecycle.require(event)
        self._require_ended(event.value)
        self._require_rest()

    def _require_free(self, what: str) -> None:
        """Require that nothing else moves the machine and no alarm is active."""
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
        soft_limits.update(self.io, sample)
        self.alarms.require_none()
        self.stream.excuse()

    def _require_ended(self, what: str) -> None:
        """Require that an aborted program has come to rest."""
        if self._lifecycle.is_over and self._player.is_active:
            raise UserError(f"cannot {what}: the last program is still being ended")

    def _require_rest(self) -> None:
        if self._manual.is_active:
            raise UserError("an axis is being jogged")
        if self.retrace.is_active:
            raise UserError("the path is being traced")

    # --- one step ---------------------------------------------------------------------

    def step(self) -> None:
        """Poll the card and do what is due."""
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
            self._supervision.raise_alarm(alarms.STORE_FAILED, error)

    def _do(self, sample: CardState) -> None:
        is_running = not self._lifecycle.is_over
        self._times.advance_to(self.machine.now_s, is_running=is_running, rate=self._rate())
        self.stream.tracker.update(sample.counter)
        with self.machine.repeating():
            soft_limits.update(self.io, sample)
        self._supervision.check(sample, self._times.step_s)
        self._switches.poll(sample, pause=self._supervision.pause, start=self.start)
        self._pausing.note_place(sample)
        for play in (self._manual.play, self.retrace.play):
            self._supervision.guard(partial(play, sample, self._times.step_s))
        if self.state is not State.PAUSED:
            self._supervision.play(sample, self._times.step_s)
        if self._is_reading:
            self._check_place()
        if self._is_reading:
            self._advance(sample)
        self.stream.poll(sample)
        is_cutting = not self.options.is_dry and not self.retrace.is_active
        with self.machine.repeating():
            self._burner.update(sample, is_cutting=is_cutting and self.stream.has_program)
            self._console.update(sample, self._times, self._facts)

    def _rate(self) -> float:
        """How much of the predicted time passes per second."""
        if self._is_reading:
            job = self.stream.tracker.current
            which = Override.RAPID if job is not None and job.is_rapid else Override.FEED
            return self.overrides.factor(which)
        return 1.0 if self.state is State.WAIT and self._player.is_dwelling else 0.0

    @property
    def _is_reading(self) -> bool:
        """Whether the program itself runs, not one of its actions."""
        return self.state is State.RUN and not self._player.is_active

    def _check_place(self) -> None:
        """Require that the machine is on the moves it was sent: others can move its axes, too."""
        if self._times.is_due("place", PLACE_S):
            with self.machine.repeating():
                strayed = self.stream.strayed()
            if strayed:
                self._supervision.raise_alarm(alarms.NOT_IN_PLACE, strayed)

    def _advance(self, sample: CardState) -> None:
        """Read, send, and start halts that are reached."""
        while self._is_reading:
            halt, passes = self.stream.advance(sample), self.passes
            if halt is None:
                return
            self._player.begin(self._program_stops.steps(halt))
            self._supervision.play(sample, self._times.step_s)
            if self.passes != passes:
                return  # the next pass counts from zero: this sample is of the old one
