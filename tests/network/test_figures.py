"""Messages, transfer times and the speed of nodes, by the figures of the guide."""

import pytest
from tests.network.rig import NODE_FAILURE, STATE, card, expect, node, running, start

from openacr.network.canopen.figures import (
    PIO_337,
    PIO_347,
    Speed,
    cycle_ms,
    node_messages,
    node_ms,
    total_messages,
)

LARGE = {"digital_inputs": 100, "digital_outputs": 100, "analog_inputs": 10, "analog_outputs": 10}
SMALL = {"digital_inputs": 20, "digital_outputs": 20, "analog_inputs": 5, "analog_outputs": 5}


@pytest.mark.req("ACR-CAN-11")
@pytest.mark.parametrize(
    ("analog_inputs", "digital_outputs", "analog_outputs", "messages"),
    [(0, 0, 0, 1), (1, 0, 0, 2), (4, 0, 0, 2), (5, 0, 0, 3), (0, 1, 0, 2), (0, 64, 0, 2),
     (0, 65, 0, 3), (0, 0, 4, 2), (0, 0, 5, 3), (32, 512, 32, 25)],
)  # fmt: skip
def test_messages_of_a_node(
    analog_inputs: int, digital_outputs: int, analog_outputs: int, messages: int
) -> None:
    assert node_messages(analog_inputs, digital_outputs, analog_outputs) == messages
    assert total_messages([messages, messages]) == 2 * messages + 1


@pytest.mark.req("ACR-CAN-12")
def test_the_worked_example_has_sixteen_messages() -> None:
    first, second = node_messages(10, 100, 10), node_messages(5, 20, 5)
    assert (first, second, total_messages((first, second))) == (9, 6, 16)


@pytest.mark.req("ACR-CAN-13")
def test_the_cycle_time_is_rounded_up() -> None:
    assert (cycle_ms(16, 1000), cycle_ms(16, 125), cycle_ms(17, 1000)) == (2, 16, 3)


@pytest.mark.req("ACR-CAN-12", "ACR-CAN-13", "ACR-CAN-16")
@pytest.mark.parametrize(("bit_rate", "needed_ms"), [(1000, 2), (125, 16)])
def test_the_card_needs_the_cycle_of_the_worked_example(bit_rate: int, needed_ms: int) -> None:
    made = card(node(1, bit_rate=bit_rate, **LARGE) + node(2, bit_rate=bit_rate, **SMALL))
    expect(made, 1, 2, bit_rate=bit_rate, cycle_ms=needed_ms - 1)
    assert start(made) == 9
    expect(made, 1, 2, bit_rate=bit_rate, cycle_ms=needed_ms)
    assert start(made) == 2


@pytest.mark.req("ACR-CAN-14", "ACR-CAN-15")
@pytest.mark.parametrize(
    ("coupler", "digital", "analog", "needed_ms"),
    [(PIO_347, 0, 0, 5), (PIO_337, 0, 0, 1), (PIO_347, 200, 20, 31), (PIO_337, 200, 20, 5),
     (PIO_347, 40, 10, 12), (PIO_337, 40, 10, 2)],
)  # fmt: skip
def test_a_node_needs_time_for_each_point(
    coupler: Speed, digital: int, analog: int, needed_ms: int
) -> None:
    assert node_ms(coupler, digital, analog) == needed_ms


@pytest.mark.req("ACR-CAN-14", "ACR-CAN-15")
@pytest.mark.parametrize(
    ("coupler", "points", "needed_ms"),
    [("PIO-347", LARGE, 31), ("PIO-337", LARGE, 5), ("PIO-347", SMALL, 12), ("PIO-337", SMALL, 2)],
)
def test_a_cycle_that_is_too_fast_for_a_node_is_a_health_event(
    coupler: str, points: dict[str, object], needed_ms: int
) -> None:
    world = node(1, bit_rate=1000, coupler=coupler, **points)
    fast = running(world, bit_rate=1000, cycle_ms=needed_ms - 1)
    fast.advance(seconds=0.5)
    assert (fast.p[STATE], fast.bit[NODE_FAILURE]) == (7, True)
    right = running(world, bit_rate=1000, cycle_ms=needed_ms)
    right.advance(seconds=0.5)
    assert (right.p[STATE], right.bit[NODE_FAILURE]) == (2, False)
