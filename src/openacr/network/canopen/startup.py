"""Starting and resetting the network: from the request flag to operational nodes.

1. Check what the user has set (`verify`).
2. Put all nodes into the pre-operational state and ask each expected one what it has.
3. Check that everything was found and fits into the cycle.
4. Put the nodes into the operational state.

An attempt that fails ends with Network Start Failed and a bus state that says why; the
request flag clears itself in any case.
"""

from __future__ import annotations

from openacr.map.rows import canopen, canopen_nodes, network_master, network_slaves
from openacr.map.words import canf
from openacr.network.canopen import exchange, figures, image
from openacr.network.canopen.nodes import Pending
from openacr.network.canopen.rows import FAULTS, SLAVES, BusState, Master, Phase
from openacr.plant.bus import bus
from openacr.plant.bus.bus import Found

POWER_UP_MS = 100
RESET_MS = 200
LOOK_AGAIN_MS = 1.0  # for the answers of a node that is still being asked
HIGHEST_ID = 127
MOST_BYTES, MOST_ANALOG = 64, 32  # of all nodes together, in each direction
BIT_RATES = (10, 20, 50, 125, 250, 500, 800, 1000)

FOUND_ROWS = (
    canopen_nodes.number_of_digital_inputs_bytes,
    canopen_nodes.number_of_digital_outputs_bytes,
    canopen_nodes.number_of_analog_inputs,
    canopen_nodes.number_of_analog_outputs,
    canopen_nodes.health_type,
)
TOTAL_ROWS = (
    canopen.number_of_digital_input_bytes,
    canopen.number_of_digital_output_bytes,
    canopen.number_of_analog_inputs,
    canopen.number_of_analog_outputs,
)


def power_up(master: Master) -> None:
    """Begin after switching the card on: without a controller nothing ever happens."""
    if bus.is_fitted(master.memory):
        master.change_flags(set_=canf.CANOPEN_CONTROLLER_INSTALLED)
        master.enter(Phase.POWER_UP)
        master.set_time(network_master.phase_tk, POWER_UP_MS)


def become_ready(master: Master) -> None:
    """End power-up or reset: ready to start, or a state with the reason why not."""
    master.enter(Phase.IDLE)
    master.stop_times()
    master.change_flags(clear=canf.RESET_NETWORK)
    master.show(verify(master))


def verify(master: Master) -> BusState:
    """Check the master id and the node ids; P32770 is the number of ids in use."""
    if any(nodes.has_failed() for nodes in master.buses):
        return BusState.INTERNAL_ERROR
    own = master.setting(canopen.master_node_id)
    if not 1 <= own <= HIGHEST_ID:
        return BusState.INVALID_MASTER
    count = master.setting(canopen.number_of_slave_nodes)
    ids = [master.node_id(slave) for slave in range(min(max(count, 0), SLAVES))]
    is_valid = all(1 <= each <= HIGHEST_ID for each in ids)
    if 0 <= count <= SLAVES and is_valid and len({own, *ids}) == len(ids) + 1:
        return BusState.PRE_OPERATIONAL
    return BusState.INVALID_NODES


# the request flags


def reset(master: Master) -> None:
    """Reset all nodes; the request flag stays until they have begun anew."""
    master.change_flags(clear=FAULTS)
    if master.phase is Phase.ABSENT:
        master.change_flags(clear=canf.RESET_NETWORK)
        return
    for nodes in master.buses:
        nodes.reset()
    master.stop_times()
    for slave in range(SLAVES):
        master.show_slave(slave, canopen_nodes.node_state, 0)
    master.show(BusState.PRE_INITIALIZED)
    master.enter(Phase.RESETTING)
    master.set_time(network_master.phase_tk, RESET_MS)


def start(master: Master) -> None:
    """Begin to start the network."""
    master.change_flags(clear=FAULTS)
    if master.phase is Phase.ABSENT:
        master.change_flags(clear=canf.START_NETWORK, set_=canf.NETWORK_START_FAILED)
        return
    master.stop_times()
    state = verify(master)
    master.show(state)
    if state is not BusState.PRE_OPERATIONAL:
        _end(master, state)
        return
    master.put(network_master.bit_rate, master.setting(canopen.bit_rate))
    master.put(network_master.cycle_ms, master.setting(canopen.cyclic_period))
    master.put(network_master.slaves, master.setting(canopen.number_of_slave_nodes))
    mapping = master.setting(canopen.alternate_digital_i_o_mapping)
    master.put(network_master.mapping, image.mapping_of(mapping))
    for nodes in master.buses:
        nodes.stop()
    for slave in range(SLAVES):
        _forget(master, slave)
    master.enter(Phase.INTERROGATING)
    master.put(network_master.slave, -1)
    ask_next(master)


def _forget(master: Master, slave: int) -> None:
    for row in (*FOUND_ROWS, canopen_nodes.node_state):
        master.show_slave(slave, row, 0)
    master.forget_slave(slave)


# asking the nodes


def ask_next(master: Master) -> None:
    """Take down what the present node has answered and ask the next one."""
    slave = master.get(network_master.slave)
    if slave >= 0:
        found = master.nodes(slave).answer(slave)
        if isinstance(found, Pending):
            master.set_time(network_master.phase_tk, LOOK_AGAIN_MS)
            return
        _take_down(master, slave, found)
    slave += 1
    master.put(network_master.slave, slave)
    if slave >= master.get(network_master.slaves):
        _conclude(master)
    else:
        master.set_time(network_master.phase_tk, _look(master, slave))


def _look(master: Master, slave: int) -> float:
    """Ask the node of a slave, on the last bus if none knows it; time for its answer."""
    identity = master.node_id(slave)
    nodes = next((bus for bus in master.buses if bus.has(identity)), master.buses[-1])
    master.look_on(nodes, slave)
    return nodes.ask(slave)


def _take_down(master: Master, slave: int, found: Found | None) -> None:
    if found is None:
        return
    values = (
        found.digital_input_bytes,
        found.digital_output_bytes,
        found.analog_inputs,
        found.analog_outputs,
        found.health,
    )
    for row, value in zip(FOUND_ROWS, values, strict=True):
        master.show_slave(slave, row, value)
    master.put_slave(slave, network_slaves.live, 1)
    master.show_slave(slave, canopen_nodes.node_state, 1)


# all have been asked


def _conclude(master: Master) -> None:
    """Report the totals and go operational, unless something does not fit."""
    cycle_ms = master.get(network_master.cycle_ms)
    health_ms = min(max(figures.HEALTH_CYCLES * cycle_ms, 0), 2**31 - 1)
    _show_setting(master, canopen.health_period, health_ms)
    totals = [
        sum(master.shown_slave(slave, row) for slave in master.slaves()) for row in FOUND_ROWS[:4]
    ]
    for row, total in zip(TOTAL_ROWS, totals, strict=True):
        _show_setting(master, row, total)
    messages = figures.total_messages(_messages(master, slave) for slave in master.slaves())
    master.put(network_master.frames, messages)
    _end(master, _judge(master, totals, cycle_ms))


def _judge(master: Master, totals: list[int], cycle_ms: int) -> BusState:
    limits = (MOST_BYTES, MOST_BYTES, MOST_ANALOG, MOST_ANALOG)
    if len(master.live_slaves()) < len(master.slaves()):
        return BusState.CHARACTERIZATION_ERROR
    if master.get(network_master.bit_rate) not in BIT_RATES:
        return BusState.CHARACTERIZATION_ERROR
    if any(total > limit for total, limit in zip(totals, limits, strict=True)):
        return BusState.INVALID_NODES
    needed_ms = figures.cycle_ms(
        master.get(network_master.frames), master.get(network_master.bit_rate)
    )
    return BusState.TRANSMISSION_OVERFLOW if cycle_ms < needed_ms else BusState.STARTED


def _messages(master: Master, slave: int) -> int:
    return figures.node_messages(
        master.shown_slave(slave, canopen_nodes.number_of_analog_inputs),
        8 * master.shown_slave(slave, canopen_nodes.number_of_digital_outputs_bytes),
        master.shown_slave(slave, canopen_nodes.number_of_analog_outputs),
    )


def _show_setting(master: Master, row: int, value: int) -> None:
    master.memory.I[row] = value


def _end(master: Master, state: BusState) -> None:
    """End the attempt with a bus state."""
    master.stop_times()
    master.show(state)
    if state is BusState.STARTED:
        master.enter(Phase.RUNNING)
        exchange.begin(master)
    else:
        master.enter(Phase.IDLE)
        master.change_flags(set_=canf.NETWORK_START_FAILED)
    master.change_flags(clear=canf.START_NETWORK)
