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

from openacr.controller import Controller

PRE_OPERATIONAL, NODE_OPERATIONAL = 1, 2
FOUR = (
    node(10, digital_inputs=12, digital_outputs=4, analog_inputs=1, analog_outputs=2)
    + node(20, digital_inputs=8, digital_outputs=16, analog_inputs=4, analog_outputs=8)
    + node(30, digital_inputs=64, digital_outputs=1, analog_inputs=0, analog_outputs=0)
    + node(40, digital_inputs=0, digital_outputs=0, analog_inputs=8, analog_outputs=0, health="guarding")  # noqa: E501
)  # fmt: skip


@pytest.mark.req("ACR-CAN-08")
def test_the_card_has_defaults() -> None:
    made = card()
    settings = [made.p[number] for number in (32768, 32769, 32770, 32771, 32772, *NODE_ID)]
    assert settings == [5, 125, 1, 0, 50, 1, 0, 0, 0]


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


@pytest.mark.req("ACR-CAN-STATE-0", "ACR-CAN-21")
def test_a_card_without_the_controller_cannot_start_a_network() -> None:
    made = Controller()
    made.advance(seconds=0.2)
    assert (made.p[STATE], made.bit[FITTED]) == (0, False)
    made.bit[START] = True
    assert made.until(START, is_=False, timeout_s=0.1)
    assert [made.bit[flag] for flag in (FITTED, OPERATIONAL, FAILED)] == [False, False, True]
    assert made.p[STATE] == 0
    made.bit[RESET] = True
    assert made.until(RESET, is_=False, timeout_s=0.1)


@pytest.mark.req("ACR-CAN-STATE-0", "ACR-CAN-STATE-1")
def test_after_power_up_the_bus_is_ready_to_start() -> None:
    made = card(powered_up=False)
    assert (made.p[STATE], made.bit[FITTED]) == (0, True)
    made.advance(seconds=0.2)
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (1, False)


@pytest.mark.req("ACR-CAN-10", "ACR-CAN-STATE-3")
@pytest.mark.parametrize("own", [0, 128, -1])
def test_a_wrong_master_id_is_refused(own: int) -> None:
    made = card()
    made.p[32768] = own
    assert start(made) == 3
    assert (made.bit[FAILED], made.bit[OPERATIONAL]) == (True, False)
    made.p[32768] = 127
    assert start(made) == 2
    assert not made.bit[FAILED]


@pytest.mark.req("ACR-CAN-10", "ACR-CAN-STATE-4", "ACR-CAN-01")
@pytest.mark.parametrize(
    "ids", [(0,), (128,), (1, 1), (5,), (1, 0), (1, 2, 5), (1, 2, 3, 4, 6), (1, 2, 3, 1)]
)
def test_wrong_node_ids_are_refused(ids: tuple[int, ...]) -> None:
    made = card()
    expect(made, *ids)
    assert start(made) == 4
    assert made.bit[FAILED]
    expect(made, 1)
    assert start(made) == 2


def test_ids_of_slaves_that_do_not_count_may_be_anything() -> None:
    made = card()
    expect(made, 1)
    made.p[33040], made.p[33056] = 5, 200
    assert start(made) == 2


@pytest.mark.req("ACR-CAN-01")
@pytest.mark.parametrize("what", ["digital_inputs", "digital_outputs"])
def test_five_hundred_and_twelve_digital_points_are_the_most(what: str) -> None:
    made = card(node(1, **{what: 256}) + node(2, **{what: 256}) + node(3, **{what: 8}))
    expect(made, 1, 2)
    assert start(made) == 2
    expect(made, 1, 2, 3)
    assert start(made) == 4
    assert made.bit[FAILED]


@pytest.mark.req("ACR-CAN-01")
@pytest.mark.parametrize("what", ["analog_inputs", "analog_outputs"])
def test_thirty_two_analog_channels_are_the_most(what: str) -> None:
    made = card(node(1, **{what: 30}) + node(2, **{what: 2}) + node(3, **{what: 1}))
    expect(made, 1, 2)
    assert start(made) == 2
    expect(made, 1, 2, 3)
    assert start(made) == 4


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


@pytest.mark.req("ACR-CAN-STATE-8")
def test_a_broken_controller_is_an_internal_error() -> None:
    made = card(PANEL + fault("controller", at_s=0.5))
    assert made.p[STATE] == 1
    made.advance(seconds=0.5)
    assert start(made) == 8
    assert made.bit[FAILED]
    broken = card(PANEL + fault("controller"))
    assert broken.p[STATE] == 8


@pytest.mark.req("ACR-CAN-16", "ACR-CAN-STATE-9")
def test_a_cycle_that_is_too_short_is_an_overflow() -> None:
    made = card()
    expect(made, 1, cycle_ms=4)  # 2 * 2 analog, 12 outputs: 5 messages at 125 kbit/s
    assert start(made) == 9
    assert made.bit[FAILED]
    expect(made, 1, cycle_ms=5)
    assert start(made) == 2
    for extreme in (0, -1, -(2**31)):
        expect(made, 1, cycle_ms=extreme)
        assert start(made) == 9
    expect(made, 1, cycle_ms=2**31 - 1)
    assert start(made) == 2
    assert made.p[32773] == 2**31 - 1


@pytest.mark.req(
    "ACR-CAN-NODE-1", "ACR-CAN-NODE-2", "ACR-CAN-NODE-3", "ACR-CAN-NODE-4", "ACR-CAN-NODE-5",
    "ACR-CAN-NODE-6", "ACR-CAN-NODE-7", "ACR-CAN-22",
)  # fmt: skip
def test_the_card_fills_in_what_it_has_found() -> None:
    made = card(FOUR)
    expect(made, 10, 20, 30, 40, cycle_ms=60)
    assert start(made) == 2
    table = [[made.p[first + row] for first in NODE_ID] for row in range(7)]
    assert table == [
        [10, 20, 30, 40],  # id
        [2, 1, 8, 0],  # bytes of digital inputs
        [1, 2, 1, 0],  # bytes of digital outputs
        [1, 4, 0, 8],  # analog inputs
        [2, 8, 0, 0],  # analog outputs
        [1, 1, 1, 2],  # health: heartbeat or guarding
        [1, 1, 1, 1],  # alive
    ]
    assert [made.p[number] for number in (32773, *range(32775, 32780))] == [600, 11, 4, 13, 10, 2]


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


def test_a_network_without_slaves_starts() -> None:
    made = card("")
    expect(made)
    assert start(made) == 2


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
