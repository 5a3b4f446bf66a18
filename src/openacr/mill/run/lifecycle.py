"""Life cycle of a run: states, events, and the transitions between them.

`TRANSITIONS` is complete: an event that the table does not list for a state is refused and
changes nothing. A row names the next state and the action of the transition. If an action
refuses, the state stays; an ending is entered even if its action fails halfway, because a
failed run must not count as running. `docs/run-life-cycle.md` is generated from the table.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from openacr.errors import UserError


class State(Enum):
    """State of a machine; `cell` is its value in P244."""

    IDLE = "no program runs"
    RUN = "a program runs"
    WAIT = "an action of the program waits for the machine"
    HOMING = "axes are being homed"
    PAUSED = "feed hold"
    HOLD = "the program has stopped itself: M0, M1, single block, hand retract"
    ALARM = "an alarm has ended what ran"

    @property
    def cell(self) -> int:
        """The value that P244 shows."""
        return CELLS[self]

    @property
    def shown(self) -> str:
        """What a status line shows: the guide's text for a pause, the name for the others."""
        return PAUSE if self is State.PAUSED else self.name


PAUSE = "----PAUSE----"
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
    """Event of a machine; the values of operator commands read as in "cannot home: ..."."""

    LOAD = "start a program"
    HOME = "home"
    HOMED = "finish homing"
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
    CUT_POWER = "cut the power of the drives"
    LINK_LOST = "lose the link"
    DISOWNED = "give the machine up"
    ACKNOWLEDGE = "acknowledge the alarms"


class Action(Enum):
    """Action of a transition."""

    NOTHING = "nothing"
    BEGIN = "start reading the program at its first block"
    SEEK = "home the axes"
    HOLD = "feed hold: moves ramp to rest on their path"
    REJOIN = "return to the path where it was left, and continue"
    TRACE = "move back along the path, or forward again"
    CONTINUE = "continue from where the stop came to rest"
    FINISH = "switch spindle, coolant and beam off, except after MDI"
    REST = "feed hold; spindle, coolant and beam off; drop moves; wait until all axes rest"
    KILL = "kill all motion; switch drive enable, spindle, coolant and beam off"
    CUT_POWER = (
        "kill all motion; switch spindle, coolant and beam off, then the drives of all axes of"
        " the card; end its programs"
    )
    ABANDON = "send nothing more to the card"
    CLEAR_KILL = "clear the kill"


class Transition(NamedTuple):
    """The next state and the action of a transition."""

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
    # IDLE and ALARM have rows as well: an ended run may still ramp down, an axis may be jogged.
    yield Event.ABORT, (State.IDLE, *begun), State.IDLE, Action.REST
    yield Event.ABORT, (State.ALARM,), State.ALARM, Action.REST
    yield Event.FAULT, every, State.ALARM, Action.REST
    yield Event.KILL, every, State.ALARM, Action.KILL
    yield Event.CUT_POWER, every, State.ALARM, Action.CUT_POWER
    yield Event.LINK_LOST, every, State.ALARM, Action.NOTHING
    yield Event.DISOWNED, every, State.ALARM, Action.ABANDON
    yield Event.ACKNOWLEDGE, (State.IDLE, State.ALARM), State.IDLE, Action.CLEAR_KILL


TRANSITIONS: dict[tuple[State, Event], Transition] = {
    (state, event): Transition(following, action)
    for event, states, following, action in _rows()
    for state in states
}
# Entered even where their action fails.
ENDINGS = frozenset({Action.FINISH, Action.REST, Action.KILL, Action.CUT_POWER, Action.ABANDON})


@dataclass(frozen=True, slots=True)
class Options:
    """Options of a run."""

    is_dry: bool = False
    is_single: bool = False
    stops_optionally: bool = False
    is_repeated: bool = True  # if Repeat Forever is set in the store
    is_mdi: bool = False  # blocks typed one by one: outputs stay on after them


@dataclass(slots=True)
class Lifecycle:
    """State of a machine, and the options of its program."""

    has_operator: bool  # an operator is present to answer and continue
    options: Options = field(default_factory=Options)
    state: State = field(default=State.IDLE, init=False)
    reason: str = field(default="", init=False)  # what a WAIT or HOLD is for
    holds_later: bool = field(default=False, init=False)  # feed hold pending during a tap
    _actions: Mapping[Action, Callable[[], None]] = field(default_factory=dict, init=False)

    def bind(self, actions: Mapping[Action, Callable[[], None]]) -> None:
        """Bind actions to functions; every action but NOTHING needs one."""
        missing = set(Action) - {Action.NOTHING} - set(actions)
        if missing:
            raise ValueError(f"actions without a function: {sorted(one.name for one in missing)}")
        self._actions = {**actions, Action.NOTHING: lambda: None}

    def fire(self, event: Event, reason: str = "") -> None:
        """Fire an event: run the action of its row, enter the next state; UserError if refused.

        `reason` is shown for a WAIT or HOLD that is entered.
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
        """Raise UserError if the present state does not allow an event."""
        if (self.state, event) not in TRANSITIONS:
            states = " or ".join(state.name for state, one in TRANSITIONS if one is event)
            raise UserError(f"cannot {event.value}: the state is {self.state.name}, not {states}")

    def _enter(self, state: State, reason: str) -> None:
        if state is not State.PAUSED:  # a waiting action continues to wait afterwards
            self.reason = reason
        if state not in (State.RUN, State.WAIT):
            self.holds_later = False
        self.state = state

    @property
    def is_under_way(self) -> bool:
        """Whether a program or homing is running."""
        return self.state in (State.RUN, State.WAIT, State.HOMING)

    @property
    def is_over(self) -> bool:
        """Whether no run is left to be ended."""
        return self.state in (State.IDLE, State.ALARM)
