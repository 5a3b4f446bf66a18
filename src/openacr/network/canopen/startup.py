"""Starting and resetting the network: from the request flag to operational nodes.

1. Check what the user has set (`verify`).
2. Put all nodes into the pre-operational state and ask each expected one what it has.
3. Check that everything was found and fits into the cycle.
4. Put the nodes into the operational state.

An attempt that fails ends with Network Start Failed and a bus state that says why; the
request flag clears itself in any case.
"""

from __future__ import annotations

from openacr.map import numbers as at
from openacr.network.canopen import exchange, figures, image
from openacr.network.canopen.rows import FAULTS, SLAVES, BusState, Master, Phase
from openacr.plant import bus

POWER_UP_MS = 100
RESET_MS = 200
NO_ANSWER_MS = 100
QUESTIONS = 20  # messages to ask one node, and as many answers
HIGHEST_ID = 127
MOST_BYTES, MOST_ANALOG = 64, 32  # of all nodes together, in each direction
BIT_RATES = (10, 20, 50, 125, 250, 500, 800, 1000)

FOUND_ROWS = (
    at.CANN_NUMBER_OF_DIGITAL_INPUTS_BYTES,
    at.CANN_NUMBER_OF_DIGITAL_OUTPUTS_BYTES,
    at.CANN_NUMBER_OF_ANALOG_INPUTS,
    at.CANN_NUMBER_OF_ANALOG_OUTPUTS,
    at.CANN_HEALTH_TYPE,
)
TOTAL_ROWS = (
    at.CAN_NUMBER_OF_DIGITAL_INPUT_BYTES,
    at.CAN_NUMBER_OF_DIGITAL_OUTPUT_BYTES,
    at.CAN_NUMBER_OF_ANALOG_INPUTS,
    at.CAN_NUMBER_OF_ANALOG_OUTPUTS,
)


def power_up(master: Master) -> None:
    """Begin after switching the card on: without a controller nothing ever happens."""
    if bus.is_fitted(master.memory):
        master.change_flags(set_=at.CANF_CANOPEN_CONTROLLER_INSTALLED)
        master.enter(Phase.POWER_UP)
        master.set_time(at.NETMF_PHASE_TK, POWER_UP_MS)


def become_ready(master: Master) -> None:
    """End power-up or reset: ready to start, or a state with the reason why not."""
    master.enter(Phase.IDLE)
    master.stop_times()
    master.change_flags(clear=at.CANF_RESET_NETWORK)
    master.show(verify(master))


def verify(master: Master) -> BusState:
    """Check the master id and the node ids; P32770 is the number of ids in use."""
    if bus.has_fault(master.memory, bus.Trouble.CONTROLLER):
        return BusState.INTERNAL_ERROR
    own = master.setting(at.CAN_MASTER_NODE_ID)
    if not 1 <= own <= HIGHEST_ID:
        return BusState.INVALID_MASTER
    count = master.setting(at.CAN_NUMBER_OF_SLAVE_NODES)
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
        master.change_flags(clear=at.CANF_RESET_NETWORK)
        return
    for node in bus.nodes(master.memory):
        if bus.answers(master.memory, node, master.setting(at.CAN_BIT_RATE)):
            bus.begin(master.memory, node, bus.NodeState.PRE_OPERATIONAL)
    master.stop_times()
    for slave in range(SLAVES):
        master.show_slave(slave, at.CANN_NODE_STATE, 0)
    master.show(BusState.PRE_INITIALIZED)
    master.enter(Phase.RESETTING)
    master.set_time(at.NETMF_PHASE_TK, RESET_MS)


def start(master: Master) -> None:
    """Begin to start the network."""
    master.change_flags(clear=FAULTS)
    if master.phase is Phase.ABSENT:
        master.change_flags(clear=at.CANF_START_NETWORK, set_=at.CANF_NETWORK_START_FAILED)
        return
    master.stop_times()
    state = verify(master)
    master.show(state)
    if state is not BusState.PRE_OPERATIONAL:
        _end(master, state)
        return
    bit_rate = master.setting(at.CAN_BIT_RATE)
    master.put(at.NETMI_BIT_RATE, bit_rate)
    master.put(at.NETMI_CYCLE_MS, master.setting(at.CAN_CYCLIC_PERIOD))
    master.put(at.NETMI_SLAVES, master.setting(at.CAN_NUMBER_OF_SLAVE_NODES))
    mapping = master.setting(at.CAN_ALTERNATE_DIGITAL_I_O_MAPPING)
    master.put(at.NETMI_MAPPING, image.mapping_of(mapping))
    for node in bus.nodes(master.memory):
        if bus.answers(master.memory, node, bit_rate):
            bus.stop(master.memory, node)
    for slave in range(SLAVES):
        _forget(master, slave)
    master.enter(Phase.INTERROGATING)
    master.put(at.NETMI_SLAVE, -1)
    ask_next(master)


def _forget(master: Master, slave: int) -> None:
    for row in (*FOUND_ROWS, at.CANN_NODE_STATE):
        master.show_slave(slave, row, 0)
    master.put_slave(slave, at.NETSI_LIVE, 0)


# asking the nodes


def ask_next(master: Master) -> None:
    """Take down what the present node has answered and ask the next one."""
    slave = master.get(at.NETMI_SLAVE)
    if slave >= 0:
        _take_down(master, slave)
    slave += 1
    master.put(at.NETMI_SLAVE, slave)
    if slave >= master.get(at.NETMI_SLAVES):
        _conclude(master)
    else:
        master.set_time(at.NETMF_PHASE_TK, _answer_ms(master, slave))


def _find(master: Master, slave: int) -> int | None:
    return bus.find(master.memory, master.node_id(slave), master.get(at.NETMI_BIT_RATE))


def _answer_ms(master: Master, slave: int) -> float:
    """Time until a node has answered everything; one that is not there is given up."""
    if _find(master, slave) is None:
        return NO_ANSWER_MS
    return 2 * QUESTIONS * figures.MESSAGE_BITS / master.get(at.NETMI_BIT_RATE)


def _take_down(master: Master, slave: int) -> None:
    node = _find(master, slave)
    if node is None:
        return
    found = bus.describe(master.memory, node)
    values = (
        found.digital_input_bytes,
        found.digital_output_bytes,
        found.analog_inputs,
        found.analog_outputs,
        found.health,
    )
    for row, value in zip(FOUND_ROWS, values, strict=True):
        master.show_slave(slave, row, value)
    master.put_slave(slave, at.NETSI_NODE, node)
    master.put_slave(slave, at.NETSI_WORDS, -(-found.digital_input_bytes // 4))
    master.put_slave(slave, at.NETSI_LIVE, 1)
    master.show_slave(slave, at.CANN_NODE_STATE, 1)


# all have been asked


def _conclude(master: Master) -> None:
    """Report the totals and go operational, unless something does not fit."""
    cycle_ms = master.get(at.NETMI_CYCLE_MS)
    health_ms = min(max(figures.HEALTH_CYCLES * cycle_ms, 0), 2**31 - 1)
    _show_setting(master, at.CAN_HEALTH_PERIOD, health_ms)
    totals = [
        sum(master.shown_slave(slave, row) for slave in master.slaves()) for row in FOUND_ROWS[:4]
    ]
    for row, total in zip(TOTAL_ROWS, totals, strict=True):
        _show_setting(master, row, total)
    messages = figures.total_messages(_messages(master, slave) for slave in master.slaves())
    master.put(at.NETMI_FRAMES, messages)
    _end(master, _judge(master, totals, cycle_ms))


def _judge(master: Master, totals: list[int], cycle_ms: int) -> BusState:
    limits = (MOST_BYTES, MOST_BYTES, MOST_ANALOG, MOST_ANALOG)
    if len(master.live_slaves()) < len(master.slaves()):
        return BusState.CHARACTERIZATION_ERROR
    if master.get(at.NETMI_BIT_RATE) not in BIT_RATES:
        return BusState.CHARACTERIZATION_ERROR
    if any(total > limit for total, limit in zip(totals, limits, strict=True)):
        return BusState.INVALID_NODES
    needed_ms = figures.cycle_ms(master.get(at.NETMI_FRAMES), master.get(at.NETMI_BIT_RATE))
    return BusState.TRANSMISSION_OVERFLOW if cycle_ms < needed_ms else BusState.STARTED


def _messages(master: Master, slave: int) -> int:
    return figures.node_messages(
        master.shown_slave(slave, at.CANN_NUMBER_OF_ANALOG_INPUTS),
        8 * master.shown_slave(slave, at.CANN_NUMBER_OF_DIGITAL_OUTPUTS_BYTES),
        master.shown_slave(slave, at.CANN_NUMBER_OF_ANALOG_OUTPUTS),
    )


def _show_setting(master: Master, row: int, value: int) -> None:
    master.memory.I[at.CAN_BASE + row] = value


def _end(master: Master, state: BusState) -> None:
    """End the attempt with a bus state."""
    master.stop_times()
    master.show(state)
    if state is BusState.STARTED:
        master.enter(Phase.RUNNING)
        exchange.begin(master)
    else:
        master.enter(Phase.IDLE)
        master.change_flags(set_=at.CANF_NETWORK_START_FAILED)
    master.change_flags(clear=at.CANF_START_NETWORK)
