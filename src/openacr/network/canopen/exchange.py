"""The running network: cycles, changed inputs, health and bus errors.

One cycle: the master sends all outputs, then the synchronisation. On that the nodes put the
outputs out and latch their analog inputs, whose values have arrived when the messages of
the cycle are through. Digital inputs travel by themselves, whenever one has changed.
"""

from __future__ import annotations

from openacr.map.rows import bus_nodes, canopen_nodes, network_master, network_slaves
from openacr.map.words import canf
from openacr.network.canopen import figures, image
from openacr.network.canopen.rows import BusState, Master, Phase
from openacr.plant.bus import bus, terminals

# The error counter of a bus controller: 8 up for a message that was destroyed, 1 down for
# one that came through; a warning from 96 on, off the bus from 256 on.
DESTROYED, WARNING, OFF = 8, 96, 256


def begin(master: Master) -> None:
    """Make the nodes operational; they send their digital inputs at once."""
    image.clear_moved(master)
    master.memory.F[network_master.errors] = 0.0
    for slave in master.slaves():
        bus.run(master.memory, _node(master, slave))
        _send_inputs(master, slave)
        _show_inputs(master, slave)
    master.set_time(
        network_master.health_tk, figures.HEALTH_CYCLES * master.get(network_master.cycle_ms)
    )
    cycle(master)


def cycle(master: Master) -> None:
    """One synchronisation."""
    bit_rate, messages = master.get(network_master.bit_rate), master.get(network_master.frames)
    terminals.follow_signals(master.memory)
    for slave in _answering(master):
        _exchange_outputs(master, slave)
        latched = terminals.convert_inputs(master.memory, _node(master, slave))
        for number, counts in enumerate(latched):
            master.put_slave(slave, network_slaves.latched, counts, number)
    master.set_time(network_master.sync_tk, master.get(network_master.cycle_ms))
    master.set_time(network_master.arrival_tk, figures.cycle_ms(messages, bit_rate))
    _count_errors(master, messages, bus.destroyed(master.memory, bit_rate))


def arrive(master: Master) -> None:
    """Everything the nodes have answered to the last synchronisation is there."""
    master.memory.F[network_master.arrival_tk] = 0.0
    if _receives(master):
        for slave in _answering(master):
            count = master.shown_slave(slave, canopen_nodes.number_of_analog_inputs)
            counts = [
                master.slave(slave, network_slaves.latched, n) for n in range(_at_most(count))
            ]
            image.show_analog_inputs(master.memory, slave, counts)


def _at_most(count: int) -> int:
    """A count the user may have overwritten."""
    return min(max(count, 0), network_slaves.LATCHED_SIZE)


def _node(master: Master, slave: int) -> int:
    return master.slave(slave, network_slaves.node)


def _answering(master: Master) -> list[int]:
    """Slaves that take part in the exchange."""
    bit_rate = master.get(network_master.bit_rate)
    return [
        slave
        for slave in master.live_slaves()
        if bus.answers(master.memory, _node(master, slave), bit_rate)
        and bus.is_operational(master.memory, _node(master, slave))
    ]


def _exchange_outputs(master: Master, slave: int) -> None:
    node = _node(master, slave)
    digital = master.memory.I[bus_nodes.digital_outputs[node]]
    analog = master.memory.I[bus_nodes.analog_outputs[node]]
    words = image.read_outputs(master, slave, digital)
    terminals.set_outputs(
        master.memory, node, words, image.dac_counts(master.memory, slave, analog)
    )


def _receives(master: Master) -> bool:
    """Whether the card can take what arrives; an overflow is shown and loses it."""
    kinds = (
        (bus.Trouble.SOFTWARE_OVERFLOW, canf.SW_RX_OVERFLOW),
        (bus.Trouble.HARDWARE_OVERFLOW, canf.HW_RX_OVERFLOW),
    )
    lost = [flag for kind, flag in kinds if bus.has_fault(master.memory, kind)]
    for flag in lost:
        master.change_flags(set_=flag)
    return not lost


# digital inputs


def note_changes(master: Master) -> None:
    """Let nodes send digital inputs that have changed; they arrive one message later."""
    answering = _answering(master)
    for slave in master.live_slaves():
        time = network_slaves.change_tk[slave]
        if not master.memory.F[time] and _send_inputs(master, slave) and slave in answering:
            after_ms = figures.MESSAGE_BITS / master.get(network_master.bit_rate)
            master.memory.F[time] = master.later_tk(after_ms)


def receive_changes(master: Master) -> None:
    """Show digital inputs whose messages have arrived."""
    for slave in master.live_slaves():
        time = network_slaves.change_tk[slave]
        if 0.0 < master.memory.F[time] <= master.tick:
            master.memory.F[time] = 0.0
            if _receives(master):
                _show_inputs(master, slave)


def _send_inputs(master: Master, slave: int) -> bool:
    """What a node sends is what is at its terminals now; whether it is something new."""
    levels = bus_nodes.levels[_node(master, slave)]
    is_new = False
    for word in range(master.slave(slave, network_slaves.words)):
        level = master.memory.I[levels + word]
        is_new = is_new or level != master.slave(slave, network_slaves.sent, word)
        master.put_slave(slave, network_slaves.sent, level, word)
    return is_new


def _show_inputs(master: Master, slave: int) -> None:
    for word in range(master.slave(slave, network_slaves.words)):
        sent = master.slave(slave, network_slaves.sent, word)
        master.memory.I[image.input_word(master, slave, word)] = sent


# what goes wrong


def check_health(master: Master) -> None:
    """Count as dead who does not answer: a fault that lasts until the next start."""
    cycle_ms = master.get(network_master.cycle_ms)
    master.set_time(network_master.health_tk, figures.HEALTH_CYCLES * cycle_ms)
    answering = _answering(master)
    for slave in master.live_slaves():
        if slave not in answering or _is_overrun(master, slave, cycle_ms):
            master.put_slave(slave, network_slaves.live, 0)
            master.show_slave(slave, canopen_nodes.node_state, 0)
            master.change_flags(set_=canf.NODE_FAILURE)
            master.show(BusState.HEALTH_EVENT)


def _is_overrun(master: Master, slave: int, cycle_ms: int) -> bool:
    """Whether the cycle is too fast for a node; it is then too busy to say that it is alive."""
    memory, node = master.memory, _node(master, slave)
    digital, analog = (
        sum(memory.I[row[node]] for row in pair)
        for pair in (
            (bus_nodes.digital_inputs, bus_nodes.digital_outputs),
            (bus_nodes.analog_inputs, bus_nodes.analog_outputs),
        )
    )
    speed = figures.COUPLERS[memory.I[bus_nodes.coupler[node]]]
    return cycle_ms < figures.node_ms(speed, digital, analog)


def _count_errors(master: Master, messages: int, share: float) -> None:
    """Follow the error counter: too many errors are a warning, still more end it all."""
    row = network_master.errors
    before = master.memory.F[row]
    step = messages * (DESTROYED * share - (1.0 - share))
    now = master.memory.F[row] = min(max(before + step, 0.0), float(OFF))
    if now >= OFF:
        master.stop_times()
        master.enter(Phase.IDLE)
        master.show(BusState.BUS_OFF)
    elif (now >= WARNING) != (before >= WARNING) and _all_live(master):
        master.show(BusState.EXCESS_ERRORS if now >= WARNING else BusState.STARTED)


def _all_live(master: Master) -> bool:
    return len(master.live_slaves()) == len(master.slaves())
