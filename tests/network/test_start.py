"""Starting and resetting the network: flags, bus states, node information."""

import pytest
from tests.network.rig import (
    DO,
    FAILED,
    FITTED,
    NODE_FAILURE,
    NODE_ID,
    OPERATIONAL,
    PANEL,
    RESET,
    START,
    STATE,
    card,
    expect,
    fault,
    node,
    node_state,
    output,
    running,
    start,
)

PRE_OPERATIONAL, NODE_OPERATIONAL = 1, 2
FOUR = (
    node(10, digital_inputs=12, digital_outputs=4, analog_inputs=1, analog_outputs=2)
    + node(20, digital_inputs=8, digital_outputs=16, analog_inputs=4, analog_outputs=8)
    + node(30, digital_inputs=64, digital_outputs=1, analog_inputs=0, analog_outputs=0)
    + node(40, digital_inputs=0, digital_outputs=0, analog_inputs=8, analog_outputs=0, health="guarding")  # noqa: E501
)  # fmt: skip


@pytest.mark.req("ACR-CAN-19", "ACR-CAN-STATE-2", "ACR-CAN-21")
def test_the_start_flag_takes_the_nodes_through_their_states_and_clears_itself() -> None:
    made = running()
    assert [made.bit[flag] for flag in (FITTED, OPERATIONAL, FAILED)] == [True, True, False]
    made.bit[START] = True
    made.until(OPERATIONAL, is_=False)
    seen = {(node_state(made, 0), made.bit[START])}
    while made.bit[START]:
        made.advance(1)
        seen.add((node_state(made, 0), made.bit[START]))
    assert seen == {(PRE_OPERATIONAL, True), (NODE_OPERATIONAL, False)}
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (2, True)


@pytest.mark.req("ACR-CAN-20", "ACR-CAN-STATE-0", "ACR-CAN-STATE-1")
def test_a_reset_begins_all_nodes_anew_and_clears_its_flag() -> None:
    made = running()
    made.bit[DO[0]] = True
    made.advance(seconds=0.2)
    assert output(made, 0, 0)
    made.bit[RESET] = True
    assert made.until(OPERATIONAL, is_=False)
    assert (made.p[STATE], made.bit[RESET], output(made, 0, 0)) == (0, True, False)
    assert made.until(RESET, is_=False, timeout_s=1.0)
    assert (made.p[STATE], node_state(made, 0)) == (1, PRE_OPERATIONAL)
    assert start(made) == 2


@pytest.mark.req("ACR-CAN-STATE-5")
@pytest.mark.parametrize(
    ("world", "repaired"),
    [
        (PANEL.replace("id = 1", "id = 7"), False),
        (PANEL + "bit_rate = 250\n", False),
        (PANEL + fault("lost", node=1, until_s=1.0), True),
        (PANEL + fault("silent", node=1, until_s=1.0), True),
    ],
    ids=["other id", "other bit rate", "no power yet", "silent"],
)
def test_a_node_that_does_not_answer_is_missed_but_the_bus_can_be_started(
    world: str, repaired: bool
) -> None:
    made = card(world)
    assert start(made) == 5
    assert [made.bit[flag] for flag in (OPERATIONAL, FAILED)] == [False, True]
    assert (made.p[33029], made.p[33030]) == (0, 0)
    made.advance(seconds=1.0)
    assert start(made) == (2 if repaired else 5)
    assert made.bit[FAILED] is not repaired


@pytest.mark.req("ACR-CAN-NODE-6", "ACR-CAN-NODE-7")
def test_slaves_that_are_not_expected_are_not_present() -> None:
    made = card(FOUR)
    expect(made, 10, 20, 30, 40)
    start(made)
    expect(made, 20)
    assert start(made) == 2
    assert [made.p[first + 5] for first in NODE_ID] == [1, 0, 0, 0]
    assert [made.p[first + 6] for first in NODE_ID] == [1, 0, 0, 0]
    assert made.p[33028] == 8


def test_reset_goes_before_start_when_both_are_asked_for() -> None:
    made = card()
    made.bit[START], made.bit[RESET] = True, True
    assert made.until(RESET, is_=False, timeout_s=1.0)
    assert made.p[STATE] == 1
    assert made.until(START, is_=False, timeout_s=1.0)
    assert made.p[STATE] == 2


def test_nonsense_in_every_parameter_does_no_harm() -> None:
    made = running()
    for number in (*range(32768, 32774), *range(32775, 32780), *range(33024, 33031)):
        made.p[number] = -(2**31)
    made.advance(seconds=0.5)
    assert start(made) == 3
    for number in range(32768, 32774):
        made.p[number] = 2**31 - 1
    assert start(made) == 3
    made.p[32768] = 5
    assert start(made) == 4
    made.bit[NODE_FAILURE] = True
    expect(made, 1, bit_rate=0)
    assert start(made) == 5
