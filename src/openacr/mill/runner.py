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
from openacr.mill import alarms, barrier
from openacr.mill.alarms import Alarm, Alarms
from openacr.mill.ballscrew import Compensation
from openacr.mill.burning import Burner
from openacr.mill.console import Console
from openacr.mill.controls import Controls
from openacr.mill.course import Course, Entries
from openacr.mill.doing import Doing
from openacr.mill.enabling import enable_drives
from openacr.mill.ending import Ending
from openacr.mill.halting import Halting
from openacr.mill.hands import Hands
from openacr.mill.homing import home
from openacr.mill.jogging import Jogging
from openacr.mill.machine import LINK_ERRORS, Look, Machine, StepLostError
from openacr.mill.overrides import Overrides
from openacr.mill.panel import Panel
from openacr.mill.passes import Passes
from openacr.mill.pausing import Pausing
from openacr.mill.published import Facts
from openacr.mill.retracing import Retrace
from openacr.mill.script import Script
from openacr.mill.settings import Settings, Store
from openacr.mill.states import Options, State, Status
from openacr.mill.supervision import Supervision
from openacr.mill.switches import Switches
from openacr.mill.times import Times


class Runner:
    """One machine and the program that runs on it."""

    def __init__(
        self,
        machine: Machine,
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
        self.panel = panel = Panel(machine, self.settings)
        self.doing = doing = Doing(panel, store, say)
        self.alarms = alarm_list or Alarms()
        self.course = course = Course(panel, doing, depth)
        self.retrace = retrace = Retrace(panel, course, depth)
        self._status = status = Status(has_operator=has_operator)
        self._script = script = Script()
        self._hands = hands = Hands(panel, self._make_free)
        self._pausing = pausing = Pausing(panel, course, retrace, script, status)
        self._ending = ending = Ending(panel, course, doing, pausing, script, status)
        self._console = console = Console(panel, doing.spindle, store)
        self._passes = passes = Passes(panel, course, console, ending, status)
        self._halting = Halting(panel, course, doing, passes, status)
        self._supervision = Supervision(
            panel, self.alarms, course, doing, hands=hands, retrace=retrace, pausing=pausing,
            ending=ending, console=console, script=script, status=status,
            compensation=self._compensation, say=say,
        )  # fmt: skip
        self._burner = Burner(panel, course)
        self._switches = Switches(
            panel, course.host, hands=hands, retrace=retrace, status=status, say=say
        )
        self._times = Times()
        self.was_aborted = False

    # --- what is known of the run -----------------------------------------------------

    @property
    def state(self) -> State:
        """What the machine is doing."""
        return self._status.state

    @property
    def reason(self) -> str:
        """What a WAIT or HOLD is for."""
        return self._status.reason

    @property
    def options(self) -> Options:
        """How the program is run."""
        return self._status.options

    @property
    def passes(self) -> int:
        """Ends of the program reached."""
        return self._passes.count

    @property
    def asking(self) -> c.Ask | None:
        """What the operator has to answer."""
        return self._halting.asking

    @property
    def jogging(self) -> Jogging:
        """The jogs of the axes."""
        return self._hands.jogging

    @property
    def controls(self) -> Controls:
        """The keys and the joystick."""
        return self._hands.controls

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
        return self.retrace.source or self.course.tracker.source

    @property
    def run_s(self) -> float:
        """Card time since the start of the program."""
        return self._times.run_s

    @property
    def wait_left_s(self) -> float:
        """How long what is waited for takes at most, 0 or more; infinite without a limit."""
        return self._script.left_s

    def _facts(self) -> Facts:
        """What other programs may read of the run."""
        line = float(self.source.line) if self.source else 0.0
        return Facts(line, self.state, self.alarms.last_code, self.run_s)

    # --- commands ---------------------------------------------------------------------

    def run(self, entries: Entries, options: Options | None = None) -> None:
        """Start a program from its beginning."""
        self._make_ready("start a program")
        self._status.options = options or Options()
        self.was_aborted = False
        self._passes.load(entries)
        self._status.state = State.RUN
        self._times.restart()

    def home(self, axes: Sequence[int]) -> None:
        """HOME: find the reference points of axes, priority after priority."""
        self._make_ready("home")
        self._script.begin(home(self.panel, axes, self._compensation, self._say))
        self._status.state = State.WAIT
        self._status.is_homing = True
        self._times.restart()

    def jog(self, move: Callable[[Jogging], object]) -> None:
        """Let somebody move axes by hand: in IDLE, or while a program is held."""
        self._hands.jog(move)

    def turn(self, axes: Sequence[int]) -> None:
        """Let the hand wheel move these axes, and no others; none ends it."""
        self._hands.turn(axes)

    def start(self) -> None:
        """START, Cycle Start: go on from a pause or hold."""
        if self.state is State.PAUSED:
            self.resume()
            return
        self._status.require(State.HOLD, "go on")
        self.alarms.require_none()
        self._require_rest()
        self._halting.go_on()

    def stop(self) -> None:
        """STOP: feed hold; axes moved by hand ramp to rest."""
        if self._hands.is_active:
            self._hands.stop()
            return
        if not self._status.is_under_way:
            raise UserError(f"nothing runs: the state is {self.state.name}")
        self._supervision.pause()

    def resume(self) -> None:
        """RESUME: the way goes on where it was held."""
        self._status.require(State.PAUSED, "resume")
        self.alarms.require_none()
        self._require_rest()
        self._pausing.resume()

    def trace(self, direction: int) -> None:
        """In a pause: back along the path (-1), forward again (1), or to rest (0)."""
        if direction == 0:
            self.retrace.stop()
            return
        self._status.require(State.PAUSED, "trace the path")
        self._require_rest()
        self._pausing.trace(direction)

    def abort(self) -> None:
        """ABORT: the program ends, moves are dropped, spindle and coolant go off."""
        if not self.is_busy:
            raise UserError("no program runs")
        self.was_aborted = True
        self._hands.stop()
        self._ending.abort(State.IDLE)

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
        if self._hands.is_active:
            self._hands.stop()
        if not self._status.is_over:
            self.abort()

    def answer(self, value: float) -> None:
        """What the operator says to the question that is asked."""
        if self.asking is None:
            raise UserError("nothing is asked")
        self.course.host.answers[self.asking.parameter] = value

    def block(self, on: bool) -> None:
        """BLOCK: stop behind every block, also behind the one that is being executed."""
        self._status.options = replace(self.options, is_single=on)
        self.course.set_single(on)
        is_free = self.state is State.RUN and not self._supervision.is_tapping
        if on and is_free and not self._script.is_active:
            self._script.begin(self.course.retake())

    def acknowledge(self) -> list[Alarm]:
        """Clear the alarms whose cause is gone; those that stay."""
        return self._supervision.acknowledge()

    # --- what bars a command ----------------------------------------------------------

    def _make_ready(self, what: str) -> None:
        """Enable the drives for a program or a homing, if it may begin."""
        self._require_idle(what)
        enable_drives(self.panel)

    def _make_free(self, what: str) -> None:
        """Enable the drives for axes moved by hand, if they may be."""
        self._require_free(what)
        enable_drives(self.panel)

    def _require_idle(self, what: str) -> None:
        """No alarm is up and nothing is under way."""
        self.alarms.require_none()
        self._status.require(State.IDLE, what)
        self._require_ended(what)
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
        look = self.machine.look()
        if self.panel.is_in(look, self.settings.wiring.feed_hold):
            raise UserError(f"cannot {what}: the feed hold input is active")
        barrier.keep(self.panel, look)
        self.alarms.require_none()
        self.course.excuse()

    def _require_ended(self, what: str) -> None:
        """What was aborted has come to rest, and nothing of it is still to be done."""
        if self._status.is_over and self._script.is_active:
            raise UserError(f"cannot {what}: the last program is still being ended")

    def _require_rest(self) -> None:
        if self._hands.is_active:
            raise UserError("an axis is being jogged")
        if self.retrace.is_active:
            raise UserError("the path is being traced")

    # --- one step ---------------------------------------------------------------------

    def step(self) -> None:
        """Look at the card and do what is due."""
        try:
            look = self.machine.look()
        except LINK_ERRORS as failure:
            self._supervision.miss_look(failure)
            return
        try:
            self._do(look)
        except StepLostError as lost:
            self._supervision.miss_look(lost)
        except LINK_ERRORS:
            self._supervision.lose_link()
        except StoreError as error:
            self._supervision.give(alarms.STORE_FAILED, error)

    def _do(self, look: Look) -> None:
        self._times.look(self.machine.now_s)
        self.course.tracker.update(look.counter)
        with self.machine.repeating():
            barrier.keep(self.panel, look)
        self._supervision.keep(look, self._times.step_s)
        self._switches.keep(look, pause=self._supervision.pause, start=self.start)
        self._pausing.note_place(look)
        for play in (self._hands.play, self.retrace.play):
            self._supervision.guard(partial(play, look, self._times.step_s))
        if self.state is not State.PAUSED:
            self._supervision.play(look, self._times.step_s)
        if self._is_reading:
            self._advance(look)
        is_cutting = not self.options.is_dry and not self.retrace.is_active
        with self.machine.repeating():
            self._burner.keep(look, is_cutting=is_cutting and self.course.has_program)
            self._console.keep(look, self._times, self._facts)

    @property
    def _is_reading(self) -> bool:
        """Whether the program itself goes on, and not an action of it."""
        return self.state is State.RUN and not self._script.is_active

    def _advance(self, look: Look) -> None:
        """Read, send, and take up what waits for rest."""
        while self._is_reading:
            halt, passes = self.course.advance(look), self.passes
            if halt is None:
                return
            self._script.begin(self._halting.steps(halt))
            self._supervision.play(look, self._times.step_s)
            if self.passes != passes:
                return  # another pass counts from zero: this look is of the old one
