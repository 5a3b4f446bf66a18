"""The running network: cycles, changed inputs, health and bus errors.

One cycle: the master sends all outputs, then the synchronisation. On that the nodes put the
outputs out and latch their analog inputs, whose values have arrived when the messages of
the cycle are through. Digital inputs travel by themselves, whenever one has changed.
"""

from __future__ import annotations

from openacr.map.rows import canopen_nodes, network_master
from openacr.map.words import canf
from openacr.network.canopen import figures, image
from openacr.network.canopen.rows import BusState, Master, Phase

# The error counter of a bus controller: 8 up for a message that was destroyed, 1 down for
# one that came through; a warning from 96 on, off the bus from 256 on.
DESTROYED, WARNING, OFF = 8, 96, 256


def begin(master: Master) -> None:
    """Make the nodes operational; they send their digital inputs at once."""
    image.clear_moved(master)
    master.memory.F[network_master.errors] = 0.0
    for slave in master.slaves():
        nodes = master.nodes(slave)
        nodes.run(slave)
        image.show_digital_inputs(master, slave, nodes.digital(slave) or [])
    master.set_time(
        network_master.health_tk, figures.HEALTH_CYCLES * master.get(network_master.cycle_ms)
    )
    cycle(master)


def cycle(master: Master) -> None:
    """One synchronisation."""
    bit_rate, messages = master.get(network_master.bit_rate), master.get(network_master.frames)
    answering = [slave for slave in master.live_slaves() if master.nodes(slave).answers(slave)]
    for bus in master.buses:
        own = [slave for slave in answering if master.nodes(slave) is bus]
        bus.exchange({slave: image.outputs(master, slave, *bus.outputs(slave)) for slave in own})
    master.set_time(network_master.sync_tk, master.get(network_master.cycle_ms))
    master.set_time(network_master.arrival_tk, figures.cycle_ms(messages, bit_rate))
    _count_errors(master, messages)


def receive(master: Master) -> None:
    """Show everything that nodes have sent."""
    for slave in master.live_slaves():
        nodes = master.nodes(slave)
        words, counts = nodes.digital(slave), nodes.analog(slave)
        if words is not None:
            image.show_digital_inputs(master, slave, words)
        if counts is not None:
            image.show_analog_inputs(master.memory, slave, counts)
    if master.is_due(network_master.arrival_tk):
        master.memory.F[network_master.arrival_tk] = 0.0


def note_changes(master: Master) -> None:
    """Let nodes send digital inputs that have changed."""
    for slave in master.live_slaves():
        master.nodes(slave).notice(slave)


# what goes wrong


def check_health(master: Master) -> None:
    """Count as dead who does not answer: a fault that lasts until the next start."""
    cycle_ms = master.get(network_master.cycle_ms)
    master.set_time(network_master.health_tk, figures.HEALTH_CYCLES * cycle_ms)
    for slave in master.live_slaves():
        if not master.nodes(slave).is_well(slave):
            master.forget_slave(slave)
            master.show_slave(slave, canopen_nodes.node_state, 0)
            master.change_flags(set_=canf.NODE_FAILURE)
            master.show(BusState.HEALTH_EVENT)


def _count_errors(master: Master, messages: int) -> None:
    """Follow the error counter: too many errors are a warning, still more end it all."""
    share = max(bus.destroyed() for bus in master.buses)
    row = network_master.errors
    before = master.memory.F[row]
    step = messages * (DESTROYED * share - (1.0 - share))
    least = max(bus.errors() for bus in master.buses)
    now = master.memory.F[row] = min(max(before + step, float(least)), float(OFF))
    if now >= OFF:
        master.stop_times()
        master.enter(Phase.IDLE)
        master.show(BusState.BUS_OFF)
    elif (now >= WARNING) != (before >= WARNING) and _all_live(master):
        master.show(BusState.EXCESS_ERRORS if now >= WARNING else BusState.STARTED)


def _all_live(master: Master) -> bool:
    return len(master.live_slaves()) == len(master.slaves())
