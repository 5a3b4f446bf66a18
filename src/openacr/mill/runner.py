"""Runs a part program on a card: states, commands, and one step after the other.

`step()` looks at the card once and does what is due; whoever drives it lets time pass in
between. Nothing here sleeps or knows the wall clock, so the same run takes an hour on a real
machine and seconds on a virtual one.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

from openacr.client import ConnectionLostError
from openacr.cnc import canonical as c
from openacr.errors import UserError
from openacr.mill import alarms, homed
from openacr.mill.actions import Steps, Until
from openacr.mill.alarms import Alarm, AlarmError, Alarms, Effect, Kind
from openacr.mill.burning import Burner
from openacr.mill.console import Console
from openacr.mill.controls import Controls
from openacr.mill.course import Course, Entries
from openacr.mill.doing import Doing
from openacr.mill.feeding import Halt
from openacr.mill.handwheel import HandWheel
from openacr.mill.homing import home
from openacr.mill.jogging import Jogging
from openacr.mill.machine import Look, Machine
from openacr.mill.overrides import Overrides
from openacr.mill.panel import Panel
from openacr.mill.published import Facts
from openacr.mill.rejoin import Place
from openacr.mill.retracing import Retrace
from openacr.mill.script import Script
from openacr.mill.settings import Settings, Store
from openacr.mill.states import Options, State
from openacr.mill.times import Times
from openacr.mill.watching import Edges, Watch


class Runner:
    """One machine and the program that runs on it."""

    def __init__(
        self,
        machine: Machine,
        store: Store,
        depth: int,
        say: Callable[[str], None] = lambda _text: None,
        alarm_list: Alarms | None = None,
    ) -> None:
        self.machine = machine
        self.settings = Settings(store)
        self.panel = Panel(machine, self.settings)
        self.doing = Doing(self.panel, store, say)
        self.alarms = alarm_list or Alarms()
        self._console = Console(self.panel, self.doing.spindle, store)
        self.state = State.IDLE
        self.reason = ""  # what a WAIT or HOLD is for
        self.options = Options()
        self.has_operator = True  # somebody answers and starts again
        self.asking: c.Ask | None = None
        self.jogging = Jogging(self.panel)
        self.controls = Controls(self.panel, self.jogging, self.jog)
        self.wheel = HandWheel(self.panel, self.jogging)
        self._by_hand = Script()
        self._is_homing = False
        self.passes = 0  # ends of the program reached
        self.course = Course(self.panel, self.doing, depth)
        self.retrace = Retrace(self.panel, self.course, depth)
        self._burner = Burner(self.panel, self.course)
        self._watch = Watch(self.panel)
        self._edges = Edges(self.panel)
        self._entries: Entries | None = None
        self._script = Script()
        self._left: Place | None = None  # where a feed hold has come to rest
        self._rest: c.Point | None = None  # where a stop of the program came to rest
        self._times = Times()

    @property
    def overrides(self) -> Overrides:
        """The three override switches."""
        return self._console.overrides

    # --- commands ---------------------------------------------------------------------

    def run(self, entries: Entries, options: Options | None = None) -> None:
        """Start a program from its beginning."""
        if self.alarms.bars_start:
            raise AlarmError(self.alarms.active[0].kind, self.alarms.active[0].detail)
        self._require(State.IDLE, "start a program")
        self._require_rest()
        self.options = options or Options()
        self._entries = entries
        self._begin_pass()
        self.state = State.RUN
        self._times.restart()

    def _begin_pass(self) -> None:
        """The program from its first block on."""
        if self._entries is None:
            raise UserError("no program is loaded")
        options = self.options
        self.course.begin(self._entries, is_dry=options.is_dry, is_single=options.is_single)

    def home(self, axes: Sequence[int]) -> None:
        """HOME: find the reference points of axes, priority after priority."""
        if self.alarms.bars_start:
            raise AlarmError(self.alarms.active[0].kind, self.alarms.active[0].detail)
        self._require(State.IDLE, "home")
        self._require_rest()
        self._script.begin(home(self.panel, axes))
        self.state = State.WAIT
        self._is_homing = True
        self._times.restart()

    def jog(self, move: Callable[[Jogging], object]) -> None:
        """Let somebody move axes by hand: in IDLE, or while a program is held."""
        self._require_free("jog")
        if self.wheel.axes:
            raise UserError("cannot jog: the hand wheel moves the machine")
        move(self.jogging)
        if not self._by_hand.is_active:
            self._by_hand.begin(self.jogging.settle())

    def turn(self, axes: Sequence[int]) -> None:
        """Let the hand wheel move these axes, and no others; none ends it."""
        if not axes:
            self.wheel.leave()
            return
        self._require_free("use the hand wheel")
        if self.jogging.is_active and not self.wheel.axes:
            raise UserError("cannot use the hand wheel: an axis is being jogged")
        self.wheel.select(axes)
        self._by_hand.begin(self.wheel.follow())

    def _require_free(self, what: str) -> None:
        """Nothing else may move the machine, and nothing may be wrong."""
        if self.state not in (State.IDLE, State.PAUSED, State.HOLD):
            raise UserError(f"cannot {what}: the state is {self.state.name}")
        if self.retrace.is_active:
            raise UserError(f"cannot {what}: the path is being traced")
        if self.alarms.bars_start:
            raise AlarmError(self.alarms.active[0].kind, self.alarms.active[0].detail)

    def start(self) -> None:
        """START, Cycle Start: go on from a pause or hold."""
        if self.state is State.PAUSED:
            self.resume()
        elif self.state is State.HOLD:
            self._require_rest()
            self.state, self.reason = State.RUN, ""
            self.course.go_on()
            if self._rest is not None:
                self.course.come_back(self._rest)
        else:
            self._require(State.HOLD, "go on")

    def stop(self) -> None:
        """STOP: feed hold; axes moved by hand ramp to rest."""
        if self._by_hand.is_active:
            self._stop_hands()
            return
        if self.state not in (State.RUN, State.WAIT):
            raise UserError(f"nothing runs: the state is {self.state.name}")
        self._pause()

    def _pause(self) -> None:
        if self._is_homing:  # cannot be resumed: the axes count as not homed
            self._raise(alarms.HOMING_FAILED, "stopped")
            return
        self.machine.hold()
        self.state = State.PAUSED

    def resume(self) -> None:
        """RESUME: the way goes on where it was held."""
        self._require(State.PAUSED, "resume")
        self._require_rest()
        if self.panel.is_in(self.machine.look(), self.settings.wiring.feed_hold):
            raise UserError("the feed hold input is active")
        left, self._left = self._left, None
        is_taken_back = self.retrace.has_left
        if is_taken_back:
            left = self.retrace.finish()
        if left is None or not self.course.is_off(left):
            if not is_taken_back:
                self.machine.go_on()
        elif self._script.is_active:
            raise UserError("the machine was moved while an action waits: abort")
        else:
            self._script.begin(self.course.rejoin(left))
        self.state = State.RUN

    def trace(self, direction: int) -> None:
        """In a pause: back along the path (-1), forward again (1), or to rest (0)."""
        if direction == 0:
            self.retrace.stop()
            return
        self._require(State.PAUSED, "trace the path")
        self._require_rest()
        if self._left is None or self._script.is_active:
            raise UserError("no move is held")
        self.retrace.begin(direction, self._left)

    def abort(self) -> None:
        """ABORT: the program ends, moves are dropped, spindle and coolant go off."""
        if self.state in (State.IDLE, State.ALARM):
            raise UserError("no program runs")
        self._stop_hands()
        self._end_program(State.IDLE)

    def break_off(self) -> None:
        """Whoever drives the machine leaves: everything that moves comes to rest."""
        if self._by_hand.is_active:
            self._stop_hands()
        if self.state not in (State.IDLE, State.ALARM):
            self.abort()

    def block(self, on: bool) -> None:
        """BLOCK: stop behind every block, also behind the one that is being executed."""
        self.options = replace(self.options, is_single=on)
        self.course.set_single(on)
        if on and self.state is State.RUN and not self._script.is_active:
            self._script.begin(self.course.retake())

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; those that stay."""
        look = self.machine.look()
        left = self.alarms.acknowledge(self._watch.is_gone(look, spins=self._spins))
        if self.state is State.ALARM and not self.alarms.bars_start:
            self.machine.release()
            self.state = State.IDLE
        return left

    def _require_rest(self) -> None:
        if self._by_hand.is_active:
            raise UserError("an axis is being jogged")
        if self.retrace.is_active:
            raise UserError("the path is being traced")

    def _require(self, state: State, what: str) -> None:
        if self.state is not state:
            raise UserError(f"cannot {what}: the state is {self.state.name}, not {state.name}")

    # --- one step ---------------------------------------------------------------------

    def step(self) -> None:
        """Look at the card and do what is due."""
        try:
            look = self.machine.look()
        except ConnectionLostError:
            self._raise(alarms.LINK_LOST, "")
            return
        self._times.look(self.machine.now_s)
        self.course.tracker.update(look.counter)
        self._supervise(look)
        self._switches(look)
        self._note_place(look)
        self.controls.keep(look)
        self._by_hand.play(look, self._times.step_s)
        self.retrace.play(look, self._times.step_s)
        if self.state is not State.PAUSED:
            self._play(look)
        if self.state is State.RUN and not self._script.is_active:
            self._advance(look)
        is_cutting = not self.options.is_dry and not self.retrace.is_active
        self._burner.keep(look, is_cutting=is_cutting and self.course.has_program)
        self._console.keep(look, self._times, self._facts)

    def _note_place(self, look: Look) -> None:
        """Where a feed hold has come to rest on the path."""
        if self.state is State.PAUSED and self._left is None and look.is_held:
            self._left = self.course.place()

    @property
    def is_busy(self) -> bool:
        """A program runs, waits, is held or being ended, or an axis is jogged."""
        if self.state not in (State.IDLE, State.ALARM):
            return True
        return self._script.is_active or self._by_hand.is_active

    @property
    def source(self) -> c.Source | None:
        """The block that is executed."""
        return self.retrace.source or self.course.tracker.source

    @property
    def run_s(self) -> float:
        """Card time since the start of the program."""
        return self._times.run_s

    def _advance(self, look: Look) -> None:
        """Read, send, and take up what waits for rest."""
        while self.state is State.RUN and not self._script.is_active:
            halt, passes = self.course.advance(look), self.passes
            if halt is None:
                return
            self._script.begin(self._halt_steps(halt))
            self._play(look)
            if self.passes != passes:
                return  # another pass counts from zero: this look is of the old one

    # --- what waits for rest ----------------------------------------------------------

    def _halt_steps(self, halt: Halt) -> Steps:
        if isinstance(halt, c.Probe):
            yield from self.course.probe(halt)
        elif isinstance(halt, c.Ask):
            yield from self._asked(halt)
        elif isinstance(halt, c.Stop | c.BlockEnd):
            if not self._passes_by(halt):
                self._hold(halt)
                return
        elif isinstance(halt, c.End):
            if self.options.is_dry and self.settings.returns_to_start:
                yield from self.course.return_to_begin()
            self._end_of_text()
            return
        else:
            yield from self.doing.steps(halt)
        self.course.go_on()

    def _asked(self, ask: c.Ask) -> Steps:
        """INPUT: until the operator has answered; alarm 61 where nobody can."""
        answers = self.course.host.answers
        if ask.parameter not in answers and not self.has_operator:
            raise AlarmError(alarms.ANSWER_MISSING, f"P{ask.parameter} {ask.text}")
        self.asking = ask
        try:
            yield Until(ask.text, lambda _look: ask.parameter in answers)
        finally:
            self.asking = None

    def _passes_by(self, halt: c.Stop | c.BlockEnd) -> bool:
        """Whether a stop has no effect: M1 without the switch, single block switched off."""
        if isinstance(halt, c.BlockEnd):
            return not self.options.is_single
        if halt.pause is c.Pause.OPTIONAL:
            return not self._stops_optionally
        return False

    @property
    def _stops_optionally(self) -> bool:
        wired = self.panel.is_in(self.machine.look(), self.settings.wiring.optional_stop)
        return self.options.stops_optionally or wired

    def _hold(self, halt: c.Stop | c.BlockEnd) -> None:
        text = halt.text if isinstance(halt, c.Stop) else ""
        self.state = State.HOLD
        is_by_hand = isinstance(halt, c.Stop) and halt.pause is c.Pause.HAND_RETRACT
        self._rest = None if is_by_hand else self.course.host.position()
        self.reason = text or (halt.pause.value if isinstance(halt, c.Stop) else "block")

    def _end_of_text(self) -> None:
        """M2 or the end: over, or once more where the store says so."""
        if not self.options.is_mdi:
            self.passes += 1
            self._console.count_part(self.passes)
        if self.settings.repeats and self.options.is_repeated:
            self._begin_pass()
            return
        if not self.options.is_mdi:
            self.doing.off()
        self._end_course()
        self.state, self.reason = State.IDLE, ""

    # --- scripts ----------------------------------------------------------------------

    def _play(self, look: Look) -> None:
        """Go on with what is being done as far as the card lets it."""
        try:
            self._script.play(look, self._times.step_s)
        except AlarmError as error:
            self._raise(error.kind, error.detail)
        if self._script.is_active and self.state is State.RUN:
            self.state = State.WAIT
        if self.state is State.WAIT:
            self.reason = self._script.reason
            if not self._script.is_active:
                self._is_homing = False
                self.state = State.RUN if self.course.has_program else State.IDLE

    # --- ends -------------------------------------------------------------------------

    def _end_program(self, state: State) -> None:
        """The program is over: to rest, moves dropped, everything off."""
        self._end_course()
        self._left, self._is_homing = None, False
        self.state, self.reason = state, ""
        self._script.begin(self._ending())

    def _end_course(self) -> None:
        self.retrace.close()
        self.course.end()

    def _ending(self) -> Steps:
        self.machine.hold()
        yield Until("stops", lambda look: look.is_held or not look.is_moving)
        yield from self.course.drop_moves()
        if not self.options.is_dry:
            self.doing.off()

    # --- supervision ------------------------------------------------------------------

    @property
    def _spins(self) -> bool:
        return self.doing.spindle.is_on

    def _supervise(self, look: Look) -> None:
        """Alarms for what is wrong, each once until it is acknowledged."""
        for kind, detail in self._watch.causes(look, spins=self._spins):
            self._raise(kind, detail)

    def _raise(self, kind: Kind, detail: str) -> None:
        is_new = not self.alarms.is_up(kind, detail)
        self.alarms.give(kind, detail, self.machine.now_s)
        if not is_new or kind.effect is Effect.NONE:
            return
        if kind is alarms.EXCESS_ERROR:
            homed.lose(self.panel, detail)
        if kind is not alarms.LINK_LOST:
            self._stop_hands()
            self.retrace.stop()
        if kind.effect is Effect.KILL:
            self._kill()
        elif not self.is_busy:
            return
        elif kind.effect is Effect.ABORT:
            self._end_program(State.ALARM)
        elif kind.effect is Effect.HOLD and self.state in (State.RUN, State.WAIT):
            self._pause()

    def _stop_hands(self) -> None:
        """Axes moved by hand ramp to rest."""
        self.wheel.leave()
        self.jogging.stop_all()

    def _kill(self) -> None:
        """All motion is killed, drives go off, the program is over."""
        self.machine.kill()
        self.panel.output(self.settings.wiring.drive_enable, False)
        self._script.close()
        self._end_course()
        self._left, self._is_homing = None, False
        self.doing.off()
        self.state, self.reason = State.ALARM, ""

    def _switches(self, look: Look) -> None:
        """The switches and buttons of the panel."""
        wiring = self.settings.wiring
        self.course.host.is_skipping = self.panel.is_in(look, wiring.block_skip)
        if self.panel.is_in(look, wiring.feed_hold):
            self.retrace.stop()
            if self.state in (State.RUN, State.WAIT):
                self._pause()
        elif self._edges.rose(look, wiring.cycle_start) and self.state in (
            State.PAUSED,
            State.HOLD,
        ):
            self.start()

    def _facts(self) -> Facts:
        """What other programs may read of the run."""
        line = float(self.source.line) if self.source else 0.0
        return Facts(line, self.state, self.alarms.last_code, self.run_s)
