"""Hold, step and watch the programs of a card that runs whatever happens here.

A program is held by PAUSE and steps by BLK and STEP; each program alone.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from msgspec.structs import replace

from openacr.client import Level
from openacr.client.program_states import PROGRAMS, ProgramState
from openacr.debugger.breakpoints import DataBreakpoint, Fault, LineBreakpoint
from openacr.debugger.real_cards.followers import Followers
from openacr.debugger.real_cards.holding import WAITS, is_held, release, step
from openacr.debugger.real_cards.link import CardLink
from openacr.debugger.stops import Reason, Stop
from openacr.errors import UserError
from openacr.map.words import pf
from openacr.timeline import Moment, Timeline

POLL_S = 0.05
NO_PAST = "a card over a link has no past: time runs back on a virtual card only"


def not_watched(name: str) -> UserError:
    """Changes of values are watched on virtual cards alone."""
    return UserError(f"{name}: no value of a card over a link can be watched to the tick")


class RealCardCourse:
    """The programs of a card over a link, and what is known of them here."""

    def __init__(
        self, link: CardLink, followers: Followers, run: Sequence[int], *, is_held_at_start: bool
    ) -> None:
        """Start nothing yet: `entry` starts the programs of `run`. ClientError, UserError."""
        self.link, self.followers = link, followers
        self.states = link.states()
        self.faults: dict[int, str] = {}  # errors that have ended programs
        self.started: set[int] = set()  # here, and not ended since
        self.commanded: set[int] = set()  # their moves may be of what was started or typed here
        self.paused_here: set[int] = set()
        self._run, self._is_held_at_start = list(run), is_held_at_start
        self.on_new_text: Callable[[int], None] = lambda owner: None  # of a program, perhaps
        self._show: Callable[[str], None] = lambda text: None
        self._held: set[int] = set()  # as reported
        self._steps: set[int] = set()
        self._filters = frozenset((Fault.PROGRAM,))
        self._stops: deque[Stop] = deque()
        self._is_loss_reported = False

    @property
    def is_live(self) -> bool:
        """Whether it runs on by itself: until it is lost."""
        return not self._is_loss_reported

    @property
    def period_s(self) -> float:
        """The time between two polls [s]."""
        return POLL_S

    @property
    def timeline(self) -> Timeline:
        """Refuse: it has none."""
        raise UserError(NO_PAST)

    def listen(self, show: Callable[[str], None]) -> None:
        """Show what the programs print that are followed."""
        self._show = show

    def set_lines(self, breakpoints: list[LineBreakpoint]) -> None:
        """Ignore them: `RealCardTarget.why_no_stop` gives the reason."""

    def set_data(self, breakpoints: list[DataBreakpoint]) -> None:
        """Refuse all but none."""
        for each in breakpoints:
            raise not_watched(each.name)

    def set_faults(self, faults: frozenset[Fault]) -> None:
        """Stop at errors of programs that are followed, or not."""
        self._filters = faults

    def entry(self) -> Stop:
        """Start programs; those that are to be held at their beginning are reported by `run`."""
        for program in self._run:
            level = Level.program(program)
            if self.states[program].is_running:
                raise UserError(f"{level} runs already: it is not started again")
            if self._is_held_at_start:
                self.paused_here.add(program)
                self.link.order(f"BLK {level}")
            self.started.add(program)
            self.link.order(f"RUN {level}")
            begun = self.states[program]  # so that its end is noticed, however soon
            self.states[program] = replace(begun, flags=begun.flags | pf.PROGRAM_RUNNING)
        return Stop(Reason.ENTRY)

    def paused(self, owner: int) -> Stop | None:
        """PAUSE; `run` reports when the program is held."""
        state = self._running(owner)
        if is_held(state):
            return Stop(Reason.PAUSE, owner)
        self.paused_here.add(owner)
        self.link.order(f"PAUSE {state.level}")
        return None

    def resume(self, owner: int) -> None:
        """Let a held program go on."""
        self._let(owner, is_step=False)

    def begin_step(self, owner: int, *, into: bool = False, out: bool = False) -> None:
        """Let a held program execute one line, also one of a routine that it calls."""
        if out:
            raise UserError("a card over a link steps line by line, not out of routines")
        self._let(owner, is_step=True)

    def _let(self, owner: int, *, is_step: bool) -> None:
        state = self._running(owner)
        if not is_held(state):
            raise UserError(f"{state.level} is not held: pause it first")
        act = step if is_step else release
        if is_step:
            self.paused_here.add(owner)
            self._steps.add(owner)
        self.link.do(lambda card: act(card, state))
        self._held.discard(owner)
        if not is_step:
            self.paused_here.discard(owner)

    def _running(self, owner: int) -> ProgramState:
        """A program that runs, as it is now; UserError for a PLC or one that has ended."""
        if owner not in PROGRAMS:
            raise UserError("a PLC cannot be held: HALT in the console ends it")
        self.states = self.link.states()
        state = self.states[owner]
        if not state.is_running:
            raise UserError(f"{state.level} does not run")
        return state

    def run(self, ticks: int) -> Stop | None:
        """Look once at what the card does; why a program has stopped, one at a time."""
        if not self._stops:
            self._poll()
        return self._stops.popleft() if self._stops else None

    # what it cannot do

    def tick(self) -> Stop:
        """Refuse: time does not stop."""
        raise UserError("the time of a card over a link does not stop: step line by line")

    def tick_back(self) -> Stop:
        """Refuse."""
        raise UserError(NO_PAST)

    def step_back(self, owner: int) -> Stop:
        """Refuse."""
        raise UserError(NO_PAST)

    def run_back(self) -> Stop:
        """Refuse."""
        raise UserError(NO_PAST)

    def seek(self, moment: Moment) -> Stop:
        """Refuse."""
        raise UserError(NO_PAST)

    # what the card does

    def _poll(self) -> None:
        states = self.link.poll()
        self._hear()
        if self.link.lost and not self._is_loss_reported:
            self._is_loss_reported = True
            self._stops.append(Stop(Reason.EXCEPTION, None, self.link.lost))
        if states is None:
            return
        before, self.states = self.states, states
        for program in PROGRAMS:
            self._compare(program, before[program], states[program])

    def _hear(self) -> None:
        for heard in self.followers.heard():
            self._show(heard.text)
            if heard.error:
                self.faults[heard.program] = heard.error
                if Fault.PROGRAM in self._filters:
                    self._stops.append(Stop(Reason.EXCEPTION, heard.program, heard.error))

    def _compare(self, program: int, before: ProgramState, state: ProgramState) -> None:
        if state.is_running and not before.is_running:
            self.faults.pop(program, None)
            self.on_new_text(program)
        if before.is_running and not state.is_running:
            self._steps.discard(program)
            if program in self.started:
                self.started.discard(program)
                self.commanded.add(program)  # its last moves may go on
            self._show(f"{state.level} has ended\n")
        if not is_held(state):
            self._held.discard(program)
        elif program not in self._held:
            self._held.add(program)
            self._stops.append(self._stop_of(program, state))

    def _stop_of(self, program: int, state: ProgramState) -> Stop:
        if program in self._steps:
            self._steps.discard(program)
            return Stop(Reason.STEP, program)
        if program in self.started and not state.line:
            return Stop(Reason.ENTRY, program)
        is_between = state.flags & WAITS
        return Stop(Reason.PAUSE, program, "" if is_between else "within a line that waits")
