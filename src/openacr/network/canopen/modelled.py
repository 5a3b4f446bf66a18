"""The nodes of the modelled machine, in rows of the map; see `plant.bus`."""

from __future__ import annotations

from collections.abc import Mapping

from openacr.map.rows import bus_nodes, canopen, canopen_nodes, network_master, network_slaves
from openacr.map.words import canf
from openacr.network.canopen import figures
from openacr.network.canopen.nodes import Outputs
from openacr.network.canopen.rows import SLAVES, Master
from openacr.plant.bus import bus, terminals
from openacr.plant.bus.bus import Found

NO_ANSWER_MS = 100
QUESTIONS = 20  # messages to ask one node, and as many answers
OVERFLOWS = (
    (bus.Trouble.SOFTWARE_OVERFLOW, canf.SW_RX_OVERFLOW),
    (bus.Trouble.HARDWARE_OVERFLOW, canf.HW_RX_OVERFLOW),
)


class ModelledNodes:
    """The nodes of the machine file; all state is in rows."""

    def __init__(self, master: Master) -> None:
        self._master = master
        self._memory = master.memory

    def attend(self) -> None:
        """Follow the power of the nodes."""
        bus.follow_power(self._memory)

    def next_tk(self) -> float:
        """The tick at which a fault begins or ends, or changed inputs arrive."""
        times = [self._memory.F[network_slaves.change_tk[slave]] for slave in range(SLAVES)]
        change_s = bus.next_change_s(self._memory)
        if change_s is not None:
            times.append(self._master.later_tk((change_s - bus.now_s(self._memory)) * 1000))
        return min((time for time in times if time), default=0.0)

    def has(self, identity: int) -> bool:
        """Whether there is a modelled node with this id."""
        return any(self._memory.I[bus_nodes.id[n]] == identity for n in bus.nodes(self._memory))

    def has_failed(self) -> bool:
        """Whether the controller of the card is broken."""
        return bus.has_fault(self._memory, bus.Trouble.CONTROLLER)

    def reset(self) -> None:
        """Let all nodes that hear it begin anew."""
        for node in bus.nodes(self._memory):
            if bus.answers(self._memory, node, self._master.setting(canopen.bit_rate)):
                bus.begin(self._memory, node, bus.NodeState.PRE_OPERATIONAL)

    def stop(self) -> None:
        """Make all nodes that hear it pre-operational."""
        for node in bus.nodes(self._memory):
            if bus.answers(self._memory, node, self._bit_rate):
                bus.stop(self._memory, node)

    @property
    def _bit_rate(self) -> int:
        return self._master.get(network_master.bit_rate)

    def _node(self, slave: int) -> int:
        return self._master.slave(slave, network_slaves.node)

    # a node is asked what it has

    def ask(self, slave: int) -> float:
        """Time until a node has answered everything; one that is not there is given up."""
        if self._find(slave) is None:
            return NO_ANSWER_MS
        return 2 * QUESTIONS * figures.MESSAGE_BITS / self._bit_rate

    def answer(self, slave: int) -> Found | None:
        """What the node has."""
        node = self._find(slave)
        if node is None:
            return None
        found = bus.describe(self._memory, node)
        self._master.put_slave(slave, network_slaves.node, node)
        self._master.put_slave(slave, network_slaves.words, -(-found.digital_input_bytes // 4))
        return found

    def _find(self, slave: int) -> int | None:
        return bus.find(self._memory, self._master.node_id(slave), self._bit_rate)

    # exchange

    def run(self, slave: int) -> None:
        """Make a node operational; it sends its digital inputs at once."""
        bus.run(self._memory, self._node(slave))
        self._send_inputs(slave)
        self._memory.F[network_slaves.change_tk[slave]] = self._master.tick

    def answers(self, slave: int) -> bool:
        """Whether a node is operational and receives messages."""
        node = self._node(slave)
        hears = bus.answers(self._memory, node, self._bit_rate)
        return hears and bus.is_operational(self._memory, node)

    def is_well(self, slave: int) -> bool:
        """Whether a node answers; one for which the cycle is too fast is too busy to."""
        return self.answers(slave) and not self._is_overrun(slave)

    def _is_overrun(self, slave: int) -> bool:
        memory, node = self._memory, self._node(slave)
        digital, analog = (
            sum(memory.I[row[node]] for row in pair)
            for pair in (
                (bus_nodes.digital_inputs, bus_nodes.digital_outputs),
                (bus_nodes.analog_inputs, bus_nodes.analog_outputs),
            )
        )
        speed = figures.COUPLERS[memory.I[bus_nodes.coupler[node]]]
        cycle_ms = self._master.get(network_master.cycle_ms)
        return cycle_ms < figures.node_ms(speed, digital, analog)

    def outputs(self, slave: int) -> tuple[int, int]:
        """How many digital and analog outputs a node has."""
        node, rows = self._node(slave), self._memory.I
        return rows[bus_nodes.digital_outputs[node]], rows[bus_nodes.analog_outputs[node]]

    def exchange(self, outputs: Mapping[int, Outputs]) -> None:
        """Put the outputs out and latch the analog inputs; these have arrived later."""
        terminals.follow_signals(self._memory)
        for slave, (words, counts) in outputs.items():
            node = self._node(slave)
            terminals.set_outputs(self._memory, node, words, counts)
            for number, latched in enumerate(terminals.convert_inputs(self._memory, node)):
                self._master.put_slave(slave, network_slaves.latched, latched, number)

    def digital(self, slave: int) -> list[int] | None:
        """Inputs whose message has arrived."""
        time = network_slaves.change_tk[slave]
        if not 0.0 < self._memory.F[time] <= self._master.tick:
            return None
        self._memory.F[time] = 0.0
        if self._overflows():
            return None
        words = range(self._master.slave(slave, network_slaves.words))
        return [self._master.slave(slave, network_slaves.sent, word) for word in words]

    def analog(self, slave: int) -> list[int] | None:
        """What was latched at the last synchronisation, once all messages are through."""
        if not self._master.is_due(network_master.arrival_tk) or self._overflows():
            return None
        if not self.answers(slave):
            return None
        count = self._master.shown_slave(slave, canopen_nodes.number_of_analog_inputs)
        places = range(min(max(count, 0), network_slaves.LATCHED_SIZE))  # the user may write it
        return [self._master.slave(slave, network_slaves.latched, n) for n in places]

    def _overflows(self) -> bool:
        """Whether the card loses what arrives, which it shows."""
        lost = [flag for kind, flag in OVERFLOWS if bus.has_fault(self._memory, kind)]
        for flag in lost:
            self._master.change_flags(set_=flag)
        return bool(lost)

    def notice(self, slave: int) -> None:
        """Let a node send digital inputs that have changed; they arrive one message later."""
        time = network_slaves.change_tk[slave]
        if not self._memory.F[time] and self._send_inputs(slave) and self.answers(slave):
            after_ms = figures.MESSAGE_BITS / self._bit_rate
            self._memory.F[time] = self._master.later_tk(after_ms)

    def _send_inputs(self, slave: int) -> bool:
        """What a node sends is what is at its terminals now; whether it is something new."""
        levels = bus_nodes.levels[self._node(slave)]
        is_new = False
        for word in range(self._master.slave(slave, network_slaves.words)):
            level = self._memory.I[levels + word]
            is_new = is_new or level != self._master.slave(slave, network_slaves.sent, word)
            self._master.put_slave(slave, network_slaves.sent, level, word)
        return is_new

    # what goes wrong

    def destroyed(self) -> float:
        """The share of messages that noise and nodes at another bit rate destroy."""
        return bus.destroyed(self._memory, self._bit_rate)

    def errors(self) -> int:
        """The counter follows what was destroyed alone."""
        return 0
