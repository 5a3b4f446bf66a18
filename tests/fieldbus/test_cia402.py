"""The states of CiA 402, and how a drive is led through them."""

import pytest

from openacr.fieldbus.cia402.drive import Drive, Order
from openacr.fieldbus.cia402.states import State, state_of

SHOWN = {
    State.NOT_READY: 0x0000,
    State.DISABLED: 0x0040,
    State.READY: 0x0021,
    State.SWITCHED_ON: 0x0023,
    State.OPERATING: 0x0027,
    State.QUICK_STOP: 0x0007,
    State.REACTING: 0x000F,
    State.FAULT: 0x0008,
}


@pytest.mark.parametrize("state", State)
@pytest.mark.parametrize("other_bits", [0x0000, 0x0010, 0x0080, 0xFF90])
def test_the_status_word_shows_the_state_whatever_its_other_bits_are(
    state: State, other_bits: int
) -> None:
    assert state_of(SHOWN[state] | other_bits) is state


@pytest.mark.parametrize(
    "state",
    [s for s in State if s in (State.NOT_READY, State.DISABLED, State.FAULT, State.REACTING)],
)
def test_the_bit_of_the_quick_stop_plays_no_part_in_states_without_power(state: State) -> None:
    assert state_of(SHOWN[state] | 0x20) is state


@pytest.mark.parametrize("word", [0x0001, 0x0003, 0x0022, 0x0041, 0x004F])
def test_a_pattern_that_the_profile_does_not_have_is_no_state(word: int) -> None:
    assert state_of(word) is None


def led(drive: Drive, *states: State) -> list[int]:
    return [drive.next_word(SHOWN[state]) for state in states]


def test_a_drive_is_off_until_it_is_asked_for_more() -> None:
    assert led(Drive(), State.DISABLED, State.READY, State.SWITCHED_ON, State.OPERATING) == [0] * 4


def test_a_drive_goes_up_step_by_step_as_its_states_follow() -> None:
    drive = Drive()
    drive.ask(Order.ON)
    words = led(drive, State.DISABLED, State.DISABLED, State.READY, State.SWITCHED_ON)
    assert words == [0x06, 0x06, 0x07, 0x0F]
    assert not drive.is_operating
    assert led(drive, State.OPERATING) == [0x0F]
    assert drive.is_operating


@pytest.mark.parametrize("state", [State.NOT_READY, State.QUICK_STOP, State.REACTING, State.FAULT])
def test_a_drive_that_cannot_be_switched_on_stays_off_for_good(state: State) -> None:
    drive = Drive()
    drive.ask(Order.ON)
    assert led(drive, state) == [0]
    assert drive.order is Order.OFF
    assert led(drive, State.DISABLED) == [0]


def test_a_status_word_without_a_state_switches_off() -> None:
    drive = Drive()
    drive.ask(Order.ON)
    assert drive.next_word(0x0041) == 0
    assert drive.order is Order.OFF


@pytest.mark.parametrize("state", [s for s in State if s is not State.OPERATING])
def test_a_drive_that_has_left_operation_is_not_enabled_by_itself(state: State) -> None:
    drive = Drive()
    drive.ask(Order.ON)
    led(drive, State.DISABLED, State.READY, State.SWITCHED_ON, State.OPERATING)
    assert led(drive, state, State.DISABLED, State.READY) == [0, 0, 0]
    drive.ask(Order.ON)
    assert led(drive, State.DISABLED) == [0x06]


def test_a_quick_stop_is_asked_of_a_drive_in_operation_until_it_is_off() -> None:
    drive = Drive()
    drive.ask(Order.ON)
    led(drive, State.SWITCHED_ON, State.OPERATING)
    drive.ask(Order.QUICK_STOP)
    assert led(drive, State.OPERATING, State.QUICK_STOP, State.DISABLED) == [0x02, 0x02, 0]


@pytest.mark.parametrize("state", [State.DISABLED, State.READY, State.SWITCHED_ON, State.FAULT])
def test_a_quick_stop_of_a_drive_without_torque_switches_it_off(state: State) -> None:
    drive = Drive()
    drive.ask(Order.QUICK_STOP)
    assert led(drive, state) == [0]


def test_a_reset_is_one_edge_and_leaves_the_drive_off() -> None:
    drive = Drive()
    drive.ask(Order.ON)
    led(drive, State.FAULT)
    drive.reset()
    assert led(drive, *[State.FAULT] * 21) == [0] * 10 + [0x80] * 10 + [0]
    assert drive.order is Order.OFF


def test_a_reset_without_a_fault_sends_no_edge() -> None:
    drive = Drive()
    drive.reset()
    assert led(drive, *[State.DISABLED] * 20) == [0] * 20


@pytest.mark.parametrize("state", State)
def test_a_fault_is_seen_in_both_of_its_states_only(state: State) -> None:
    drive = Drive()
    led(drive, state)
    assert drive.has_fault is (state in (State.FAULT, State.REACTING))
