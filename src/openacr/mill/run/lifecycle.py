"""The life cycle of a run: its states, what may happen in each of them, and what follows.

`TRANSITIONS` is the whole of it: a pair of state and event that is not in the table is refused
and changes nothing. A row names the next state and the action that leads there. An action that
refuses leaves the state as it is; an ending is entered even where its action fails half done,
for what has failed once must not be taken for running. `docs/run-life-cycle.md` is drawn from
the table.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from openacr.errors import UserError


class State(Enum):
    """What a machine is doing; `cell` is the value of P244."""

    IDLE = "nothing runs"
    RUN = "a program runs"
    WAIT = "an action of the program waits for the machine"
    HOMING = "reference points are being found"
    PAUSED = "feed hold"
    HOLD = "the program has stopped itself: M0, M1, single block, hand retract"
    ALARM = "an alarm has ended what ran"

    @property
    def cell(self) -> int:
        """The value that P244 shows."""
        return CELLS[self]


CELLS = {
    State.IDLE: 0,
    State.RUN: 1,
    State.PAUSED: 2,
    State.WAIT: 3,
    State.HOMING: 3,
    State.HOLD: 4,
    State.ALARM: 5,
}


class Event(Enum):
    """What happens to a machine; commands of an operator read as in "cannot home: ..."."""

    LOAD = "start a program"
    HOME = "home"
    HOMED = "find the last reference point"
    ACTION = "wait for an action"
    ACTION_DONE = "end an action"
    PROGRAM_STOP = "stop a program"
    CYCLE_START = "go on"
    FEED_HOLD = "hold the feed"
    RESUME = "resume"
    TRACE = "trace the path"
    END = "end a program"
    ABORT = "abort"
    FAULT = "end a program by an alarm"
    KILL = "kill all motion"
    NO_REST = "cut the power of the drives"
    LINK_LOST = "lose the link"
    DISOWNED = "give the machine up"
    ACKNOWLEDGE = "acknowledge the alarms"


class Action(Enum):
    """What is done in a transition."""

    NOTHING = "nothing"
    BEGIN = "the program is read from its first block"
    SEEK = "the axes move to their reference points"
    HOLD = "feed hold: the moves ramp to rest on their path"
    REJOIN = "back to the path where it was left, and on"
    TRACE = "back along the path, or forward again"
    CONTINUE = "on from where the stop came to rest"
    FINISH = "spindle, coolant and beam off, unless blocks were typed"
    REST = "feed hold; spindle, coolant and beam off; moves dropped; until all axes are at rest"
    KILL = "all motion killed; drive enable, spindle, coolant and beam off"
    CUT_POWER = "the kill, then all drives off"
    ABANDON = "nothing more is sent to the card"
    TAKE_BACK = "the kill is taken back"


class Transition(NamedTuple):
    """The next state, and the action that leads there."""

    state: State
    action: Action


def _rows() -> Iterable[tuple[Event, tuple[State, ...], State, Action]]:
    active = (State.RUN, State.WAIT)
    begun = (*active, State.HOMING, State.PAUSED, State.HOLD)
    every = tuple(State)
    yield Event.LOAD, (State.IDLE,), State.RUN, Action.BEGIN
    yield Event.HOME, (State.IDLE,), State.HOMING, Action.SEEK
    yield Event.HOMED, (State.HOMING,), State.IDLE, Action.NOTHING
    yield Event.ACTION, (State.RUN,), State.WAIT, Action.NOTHING
    yield Event.ACTION_DONE, (State.WAIT,), State.RUN, Action.NOTHING
    yield Event.PROGRAM_STOP, active, State.HOLD, Action.NOTHING
    yield Event.CYCLE_START, (State.HOLD,), State.RUN, Action.CONTINUE
    yield Event.FEED_HOLD, active, State.PAUSED, Action.HOLD
    yield Event.RESUME, (State.PAUSED,), State.RUN, Action.REJOIN
    yield Event.TRACE, (State.PAUSED,), State.PAUSED, Action.TRACE
    yield Event.END, active, State.IDLE, Action.FINISH
    # What was ended may still come to rest, and axes may be moved by hand: in IDLE and ALARM, too.
    yield Event.ABORT, (State.IDLE, *begun), State.IDLE, Action.REST
    yield Event.ABORT, (State.ALARM,), State.ALARM, Action.REST
    yield Event.FAULT, every, State.ALARM, Action.REST
    yield Event.KILL, every, State.ALARM, Action.KILL
    yield Event.NO_REST, every, State.ALARM, Action.CUT_POWER
    yield Event.LINK_LOST, every, State.ALARM, Action.NOTHING
    yield Event.DISOWNED, every, State.ALARM, Action.ABANDON
    yield Event.ACKNOWLEDGE, (State.IDLE, State.ALARM), State.IDLE, Action.TAKE_BACK


TRANSITIONS: dict[tuple[State, Event], Transition] = {
    (state, event): Transition(following, action)
    for event, states, following, action in _rows()
    for state in states
}
# Entered even where their action fails.
ENDINGS = frozenset({Action.FINISH, Action.REST, Action.KILL, Action.CUT_POWER, Action.ABANDON})


@dataclass(frozen=True, slots=True)
class Options:
    """How a program is run."""

    is_dry: bool = False
    is_single: bool = False
    stops_optionally: bool = False
    is_repeated: bool = True  # where the store says Repeat Forever
    is_mdi: bool = False  # blocks typed one by one: what is on stays on after them


@dataclass(slots=True)
class Lifecycle:
    """What a machine is doing now, and how its program is run."""

    has_operator: bool = True  # an operator answers and starts again
    options: Options = field(default_factory=Options)
    state: State = field(default=State.IDLE, init=False)
    reason: str = field(default="", init=False)  # what a WAIT or HOLD is for
    holds_later: bool = field(default=False, init=False)  # a feed hold waits for a tap to be out
    _actions: Mapping[Action, Callable[[], None]] = field(default_factory=dict, init=False)

    def bind(self, actions: Mapping[Action, Callable[[], None]]) -> None:
        """Say what each action does; every action but NOTHING needs one."""
        missing = set(Action) - {Action.NOTHING} - set(actions)
        if missing:
            raise ValueError(f"actions without a function: {sorted(one.name for one in missing)}")
        self._actions = {**actions, Action.NOTHING: lambda: None}

    def fire(self, event: Event, reason: str = "") -> None:
        """Let an event happen: the action of its row, then the next state; UserError if refused.

        `reason` says what a WAIT or HOLD that is entered is for.
        """
        self.require(event)
        following, action = TRANSITIONS[self.state, event]
        if action not in ENDINGS:
            self._actions[action]()
            self._enter(following, reason)
            return
        try:
            self._actions[action]()
        finally:
            self._enter(following, reason)

    def require(self, event: Event) -> None:
        """Refuse an event that this state does not know."""
        if (self.state, event) not in TRANSITIONS:
            states = " or ".join(state.name for state, one in TRANSITIONS if one is event)
            raise UserError(f"cannot {event.value}: the state is {self.state.name}, not {states}")

    def _enter(self, state: State, reason: str) -> None:
        if state is not State.PAUSED:  # an action that waits goes on waiting after it
            self.reason = reason
        if state not in (State.RUN, State.WAIT):
            self.holds_later = False
        self.state = state

    @property
    def is_under_way(self) -> bool:
        """Whether a program or a homing goes on by itself."""
        return self.state in (State.RUN, State.WAIT, State.HOMING)

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to be ended."""
        return self.state in (State.IDLE, State.ALARM)
