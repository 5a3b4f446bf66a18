"""What goes wrong while the network runs: lost nodes, noise, a bus that is off."""

import pytest
from tests.network.rig import (
    DI,
    DO,
    NODE_FAILURE,
    OPERATIONAL,
    PANEL,
    STATE,
    fault,
    node,
    output,
    running,
    start,
)

from openacr.map.rows import network_master
from openacr.network.canopen.rows import Phase

TWO = PANEL + node(2, digital_inputs=8, digital_outputs=8)


@pytest.mark.req("ACR-CAN-STATE-7", "ACR-CAN-18", "ACR-CAN-21")
@pytest.mark.parametrize("kind", ["silent", "lost"])
@pytest.mark.parametrize("health", ["heartbeat", "guarding"])
def test_a_node_that_says_nothing_more_is_dead_within_a_health_period(
    kind: str, health: str
) -> None:
    world = TWO.replace("id = 1", f'id = 1\nhealth = "{health}"') + fault(kind, node=1, at_s=2.0)
    made = running(world, 1, 2)
    assert made.p[33029] == {"heartbeat": 1, "guarding": 2}[health]
    made.advance(seconds=2.0 - made.time_s)
    assert (made.p[STATE], made.bit[NODE_FAILURE], made.p[33030]) == (2, False, 1)
    assert made.until(NODE_FAILURE, timeout_s=made.p[32773] / 1000)
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (7, False)
    assert (made.p[33030], made.p[33046]) == (0, 1)


@pytest.mark.req("ACR-CAN-18")
@pytest.mark.parametrize("cycle_ms", [20, 50, 100])
def test_the_health_period_is_ten_cycles(cycle_ms: int) -> None:
    made = running(PANEL + fault("silent", node=1, at_s=2.0), cycle_ms=cycle_ms)
    assert made.p[32773] == 10 * cycle_ms
    made.advance(seconds=1.9 - made.time_s)
    assert made.until(NODE_FAILURE, timeout_s=3.0)
    assert 0.0 < made.time_s - 2.0 <= 0.01 * cycle_ms + 0.001


@pytest.mark.req("ACR-CAN-STATE-7")
def test_the_other_nodes_go_on_and_a_new_start_brings_the_lost_one_back() -> None:
    made = running(TWO + fault("lost", node=1, at_s=1.0, until_s=3.0), 1, 2)
    made.bit[DO[0]], made.bit[DO[1]] = True, True
    made.advance(seconds=0.9 - made.time_s)
    assert output(made, 0, 0) and output(made, 1, 0)
    made.advance(seconds=0.2)
    assert not output(made, 0, 0), "without power its outputs drop"
    made.advance(seconds=1.0)
    made.set_input(DI[0], True)
    made.set_input(DI[1], True)
    made.advance(seconds=0.1)
    assert (made.bit[DI[0]], made.bit[DI[1]]) == (False, True)
    made.advance(seconds=1.5)
    assert made.p[STATE] == 7, "a node that has begun anew waits to be started"
    assert start(made) == 2
    made.advance(seconds=0.1)
    assert made.bit[DI[0]] and output(made, 0, 0) and not made.bit[NODE_FAILURE]


def test_outputs_of_a_silent_node_stay_as_they_are() -> None:
    made = running(PANEL + fault("silent", node=1, at_s=1.0))
    made.bit[DO[0]] = True
    made.advance(seconds=1.0)
    made.bit[DO[0]] = False
    made.advance(seconds=1.0)
    assert output(made, 0, 0)


def test_a_short_silence_is_not_noticed() -> None:
    made = running(PANEL + fault("silent", node=1, at_s=1.0, until_s=1.1))
    made.advance(seconds=2.0)
    assert made.p[STATE] == 2
    made.set_input(DI[0], True)
    made.advance(seconds=0.01)
    assert made.bit[DI[0]]


@pytest.mark.req("ACR-CAN-STATE-6")
def test_noise_brings_the_error_counter_to_its_warning_and_its_end_takes_it_back() -> None:
    made = running(PANEL + fault("noise", rate=0.2, at_s=1.0, until_s=3.5))
    made.advance(seconds=1.0 - made.time_s)
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (2, True)
    made.advance(seconds=2.4)
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (6, False)
    made.set_input(DI[0], True)
    made.advance(seconds=0.01)
    assert made.bit[DI[0]], "messages are repeated, so the data still comes through"
    made.advance(seconds=4.0)
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (2, True)


@pytest.mark.req("ACR-CAN-STATE-6")
def test_a_module_at_another_bit_rate_disturbs_the_bus() -> None:
    made = running(PANEL + node(9, bit_rate=500), 1)
    made.advance(seconds=3.0)
    assert made.p[STATE] == 6


@pytest.mark.req("ACR-CAN-STATE-10")
def test_too_many_errors_switch_the_controller_off_until_the_next_start() -> None:
    made = running(PANEL + fault("noise", rate=1.0, at_s=1.0, until_s=3.0))
    made.advance(seconds=1.0 - made.time_s)
    while made.p[STATE] == 2:
        made.advance(1)
    assert made.p[STATE] == 6
    made.advance(seconds=1.0)
    assert (made.p[STATE], made.bit[OPERATIONAL]) == (10, False)
    made.advance(seconds=2.0)
    assert made.p[STATE] == 10, "only a start helps"
    made.set_input(DI[0], True)
    made.advance(seconds=0.5)
    assert not made.bit[DI[0]], "nothing is exchanged without one"
    due = (
        network_master.phase_tk,
        network_master.sync_tk,
        network_master.arrival_tk,
        network_master.health_tk,
    )
    assert [made.memory.F[row] for row in due] == [0.0] * 4
    assert made.memory.I[network_master.phase] == Phase.IDLE
    assert start(made) == 2
    made.advance(seconds=1.0)
    assert made.p[STATE] == 2
