"""The life cycle of a run: every pair of state and event, in the table and on a machine."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from tests.mill.shop import Shop

from openacr.errors import UserError
from openacr.mill.card import alarms
from openacr.mill.run.lifecycle import (
    ENDINGS,
    TRANSITIONS,
    Action,
    Event,
    Lifecycle,
    State,
)
from openacr.mill.run.lifecycle_page import page

PAGE = Path(__file__).parents[2] / "docs" / "run-life-cycle.md"
PAIRS = [(state, event) for state in State for event in Event]


def named(pair: object) -> str:
    return pair.name if isinstance(pair, State | Event | Action) else str(pair)


class Recorder:
    """Actions that note their name and the state in which they were done."""

    def __init__(self, state: State, fails: Action | None = None) -> None:
        self.lifecycle = Lifecycle(has_operator=True)
        self.lifecycle.state = state
        self.lifecycle.reason = "before"
        self.done: list[tuple[Action, State]] = []
        self._fails = fails
        self.lifecycle.bind(
            {action: self._act(action) for action in Action if action is not Action.NOTHING}
        )

    def _act(self, action: Action) -> Callable[[], None]:
        def act() -> None:
            self.done.append((action, self.lifecycle.state))
            if action is self._fails:
                raise UserError("refused")

        return act


@pytest.mark.parametrize(("state", "event"), PAIRS, ids=named)
def test_an_event_does_what_its_row_says_or_is_refused(state: State, event: Event) -> None:
    recorder = Recorder(state)
    row = TRANSITIONS.get((state, event))
    if row is None:
        allowed = " or ".join(one.name for one, what in TRANSITIONS if what is event)
        with pytest.raises(UserError) as refused:
            recorder.lifecycle.fire(event, "after")
        assert (
            str(refused.value) == f"cannot {event.value}: the state is {state.name}, not {allowed}"
        )
        assert (recorder.done, recorder.lifecycle.state) == ([], state)
        assert recorder.lifecycle.reason == "before"
        return
    recorder.lifecycle.fire(event, "after")
    expected = [] if row.action is Action.NOTHING else [(row.action, state)]
    assert (recorder.done, recorder.lifecycle.state) == (expected, row.state)
    kept = row.state is State.PAUSED
    assert recorder.lifecycle.reason == ("before" if kept else "after")


@pytest.mark.parametrize("pair", sorted(TRANSITIONS, key=str), ids=str)
def test_an_action_that_fails_keeps_the_state_unless_it_is_an_ending(
    pair: tuple[State, Event],
) -> None:
    following, action = TRANSITIONS[pair]
    if action is Action.NOTHING:
        return
    recorder = Recorder(pair[0], fails=action)
    with pytest.raises(UserError, match="refused"):
        recorder.lifecycle.fire(pair[1])
    assert recorder.lifecycle.state is (following if action in ENDINGS else pair[0])


def test_every_action_needs_a_function() -> None:
    with pytest.raises(ValueError, match=r"actions without a function: \['ABANDON'") as missing:
        Lifecycle(has_operator=True).bind({Action.BEGIN: lambda: None})
    assert "BEGIN" not in str(missing.value)
    assert "NOTHING" not in str(missing.value)


def test_the_cell_of_a_state_is_that_of_the_store() -> None:
    assert [(state.name, state.cell) for state in State] == [
        ("IDLE", 0), ("RUN", 1), ("WAIT", 3), ("HOMING", 3), ("PAUSED", 2), ("HOLD", 4),
        ("ALARM", 5),
    ]  # fmt: skip


def test_the_page_is_drawn_from_the_table() -> None:
    assert PAGE.read_text() == page()


# --- on a machine ------------------------------------------------------------------------

SPINDLE = {"P800_005": 40, "P800_007": 43, "P800_010": 41, "P800_002": 3, "P800_001": 0.01}
BEAM = {"P650_017": 44, "P250_014": 45}
OFF = ([False, False, True, False, False], 0.0)
DAC3 = 6448
CUT = "M3 S500\nM8\nG1 F600 X300\nM2\n"


def brought_to(state: State) -> Shop:
    """A machine in a state, with spindle and coolant on where a program has switched them on."""
    if state is State.HOMING:
        shop = Shop(P300_002=3, P300_003=60.0, **SPINDLE, **BEAM)
        shop.runner.home([0])
    else:
        shop = Shop(**SPINDLE, **BEAM)
    if state is State.IDLE:
        shop.runner.jog(lambda jogging: jogging.move(0, 20.0))
    elif state is State.WAIT:
        shop.load("M3 S500\nM8\nG4 F20\nM2\n")
    elif state is State.HOLD:
        shop.load("M3 S500\nM8\nM0\nM2\n")
    elif state is not State.HOMING:
        shop.load(CUT)
    shop.pass_time(0.5)
    if state is State.PAUSED:
        shop.runner.stop()
        shop.pass_time(0.5)
    if state is State.ALARM:
        shop.runner._supervision.raise_alarm(alarms.TARGET_BEYOND, "X")
        shop.pass_time(0.005)
    assert shop.runner.state is state
    return shop


def cause(shop: Shop, event: Event) -> None:
    """Let an ending happen as it does in a run."""
    supervision = shop.runner._supervision
    if event is Event.ABORT:
        shop.runner.abort()
    elif event is Event.FAULT:
        supervision.raise_alarm(alarms.NOT_MOVED, "")
    elif event is Event.KILL:
        supervision.raise_alarm(alarms.DRIVE_FAULT, "X")
    elif event is Event.CUT_POWER:
        shop.runner.cut_power()
    elif event is Event.LINK_LOST:
        supervision.lose_link()
    else:
        with suppress(alarms.AlarmError):
            shop.runner.disown()


def controlled(shop: Shop) -> tuple[list[bool], float]:
    return shop.outputs([40, 41, 43, 44, 45]), float(shop.controller.p[DAC3])


@pytest.mark.parametrize("state", State, ids=named)
@pytest.mark.parametrize(
    "event", [Event.ABORT, Event.FAULT, Event.KILL, Event.CUT_POWER, Event.LINK_LOST], ids=named
)
def test_every_ending_of_every_state_leaves_a_machine_at_rest_with_everything_off(
    state: State, event: Event
) -> None:
    shop = brought_to(state)
    cause(shop, event)
    shop.pass_time(1.5)
    rest = shop.pulses()
    assert shop.runner.state is TRANSITIONS[state, event].state
    assert not shop.runner.is_busy
    assert controlled(shop) == OFF
    shop.pass_time(0.3)
    assert shop.pulses() == rest


@pytest.mark.parametrize("state", State, ids=named)
def test_nothing_more_is_sent_to_a_card_that_another_program_has_taken(state: State) -> None:
    shop = brought_to(state)
    before = controlled(shop)
    cause(shop, Event.DISOWNED)
    shop.pass_time(0.3)
    assert shop.runner.state is State.ALARM
    assert controlled(shop) == before


@pytest.fixture
def fired(monkeypatch: pytest.MonkeyPatch) -> set[tuple[State, Event]]:
    """The pairs that happen in a test."""
    found: set[tuple[State, Event]] = set()
    plain = Lifecycle.fire

    def fire(self: Lifecycle, event: Event, reason: str = "") -> None:
        found.add((self.state, event))
        plain(self, event, reason)

    monkeypatch.setattr(Lifecycle, "fire", fire)
    return found


def test_a_program_passes_through_every_state_that_is_no_ending(
    fired: set[tuple[State, Event]],
) -> None:
    shop = Shop()
    shop.load("G1 F600 X1\nG4 F.2\nM0\nX2\nM2\n")
    shop.pass_time(0.1)
    shop.runner.stop()
    shop.pass_time(0.3)
    shop.runner.trace(-1)
    shop.pass_time(0.3)
    shop.runner.trace(0)
    shop.pass_time(0.3)
    shop.runner.resume()
    shop.until(State.WAIT)
    shop.runner.stop()
    shop.pass_time(0.1)
    shop.runner.resume()
    shop.until(State.HOLD)
    shop.runner.start()
    shop.until(State.IDLE)
    assert shop.pulses() == (20_000, 0, 0)
    assert fired == {
        (State.IDLE, Event.LOAD), (State.RUN, Event.FEED_HOLD), (State.PAUSED, Event.TRACE),
        (State.PAUSED, Event.RESUME), (State.RUN, Event.ACTION), (State.WAIT, Event.FEED_HOLD),
        (State.WAIT, Event.ACTION_DONE), (State.RUN, Event.PROGRAM_STOP),
        (State.HOLD, Event.CYCLE_START), (State.RUN, Event.END),
    }  # fmt: skip


def test_an_end_after_an_action_and_an_acknowledgement(fired: set[tuple[State, Event]]) -> None:
    shop = Shop()
    shop.load("G4 F.2\nM2\n")
    shop.pass_time(0.1)
    shop.runner.abort()
    shop.until(State.IDLE)
    shop.runner._supervision.raise_alarm(alarms.NOT_MOVED, "")
    shop.runner.acknowledge()
    assert (State.WAIT, Event.ABORT) in fired
    assert (State.IDLE, Event.ACKNOWLEDGE) in fired
    shop.runner.jog(lambda jogging: jogging.move(0, 20.0))
    shop.pass_time(0.1)
    shop.runner._supervision.raise_alarm(alarms.NOT_MOVED, "")
    shop.pass_time(0.5)
    assert shop.until(State.ALARM) is State.ALARM
    assert shop.runner.acknowledge() == []
    assert (State.ALARM, Event.ACKNOWLEDGE) in fired
    assert shop.until(State.IDLE) is State.IDLE


def test_a_homing_that_is_held_ends_with_an_alarm(
    fired: set[tuple[State, Event]],
) -> None:
    shop = brought_to(State.HOMING)
    shop.runner.stop()
    shop.pass_time(0.5)
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [34]
    assert (State.HOMING, Event.FAULT) in fired
    assert (State.HOMING, Event.FEED_HOLD) not in fired
    assert (State.IDLE, Event.HOME) in fired
