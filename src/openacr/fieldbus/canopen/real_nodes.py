"""Real I/O nodes of a CAN bus, for the network master of the card.

| seen | what follows |
|---|---|
| a node does not answer, is no I/O node, or not the one of `machine.toml` | the start fails (5) |
| two nodes answer for one id, process data cannot be set up | the start fails (5) |
| no health report in a health period, or the node is not operational | the node is dead (7) |
| frames that the bus does not take | errors are counted: a warning (6), then bus off (10) |
| the controller reports a warning, or that it is off; the interface is gone | 6, or 10 |
| the interface cannot be opened again at a start | the start fails (8) |
| the program takes frames too late, the controller loses frames | an overflow flag |

Outputs are sent only after `allow`.
"""

import logging
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from openacr.fieldbus.canopen.frames import (
    OF_A_NODE,
    OFF,
    STATE,
    Cob,
    Frame,
    Link,
    Nmt,
    NodeState,
    nmt,
)
from openacr.fieldbus.canopen.io_node import (
    GUARDING,
    IoNode,
    Kind,
    Part,
    Wishes,
    read_inputs,
    set_up,
)
from openacr.fieldbus.canopen.sdo import Talk
from openacr.map.rows import canopen, network_master, network_slaves
from openacr.map.words import canf
from openacr.network.canopen.figures import HEALTH_CYCLES
from openacr.network.canopen.nodes import PENDING, Outputs, Pending
from openacr.network.canopen.rows import Master, Phase
from openacr.plant.bus.bus import Found
from openacr.plant.describe.network_schema import Node

log = logging.getLogger(__name__)

LOOK_MS = 1.0  # how often frames are taken
LONGEST_S = 10.0  # all answers of one node
STATE_TEXTS: dict[int, str] = {
    NodeState.BOOT: "it has begun anew",
    NodeState.STOPPED: "it is stopped",
    NodeState.PRE_OPERATIONAL: "it is pre-operational",
}


@dataclass(slots=True)
class _Node:
    """What is known of the node of a slave."""

    id: int
    asking: Talk[IoNode] | None = None
    since_s: float = 0.0
    first: Talk[bytes] | None = None  # inputs after the start
    io: IoNode | None = None
    is_running: bool = False
    digital: bytearray = field(default_factory=lambda: bytearray(64))
    analog: list[int] = field(default_factory=lambda: [0] * 32)
    sent: set[int] = field(default_factory=set)  # digital inputs, in bytes
    has_digital: bool = False  # something new
    has_analog: bool = False
    state: int | None = None  # as it has reported it last
    heard_s: float = 0.0
    emergency: int = 0


class RealNodes:
    """The nodes of one bus; all that is on it and is not modelled."""

    def __init__(self, master: Master, tables: Iterable[Node], link: Link) -> None:
        self._master, self._link = master, link
        self._tables = {node.id: node for node in tables}
        self._nodes: dict[int, _Node] = {}
        self._may_send = False
        self._beat_s = -1e9
        self._sent = self._refused = 0
        self._trouble = link.trouble()
        self._said = ""
        self._free: Iterator[int] = iter(())

    def allow(self) -> None:
        """Let outputs be sent; before it nodes are only read."""
        self._may_send = True

    def close(self) -> None:
        """Let all nodes that were started begin anew, with their outputs off."""
        for node in self._nodes.values():
            if node.is_running:
                self._send(nmt(Nmt.RESET, node.id))

    # what the master wants

    def attend(self) -> None:
        """Take all frames that have arrived; report health, ask for that of others."""
        now_s = self._link.now_s()
        by_id = {node.id: node for node in self._nodes.values()}
        for frame in self._link.take():
            self._hear(frame, by_id, now_s)
        for node in self._nodes.values():
            for talk in (node.asking, node.first):
                if talk is not None:
                    talk.look(now_s)
        self._look_at_link()
        if self._master.phase in (Phase.INTERROGATING, Phase.RUNNING):
            self._report(now_s)

    def next_tk(self) -> float:
        """Frames are taken every millisecond."""
        return self._master.later_tk(LOOK_MS)

    def has(self, identity: int) -> bool:
        """Whether the machine file says that this node is here; others are looked for, too."""
        return identity in self._tables

    def has_failed(self) -> bool:
        """Whether the interface is gone and cannot be opened again."""
        self._look_at_link()
        if self._trouble.failure or self._trouble.errors >= OFF:
            failure = self._link.reopen()
            if failure:
                log.error("CAN %s: %s", self._link.name, failure)
                return True
            self._trouble = self._link.trouble()
            self._said = ""
        return False

    def reset(self) -> None:
        """Reset all nodes of the bus."""
        self._forget()
        self._send(nmt(Nmt.RESET))

    def stop(self) -> None:
        """Make all nodes of the bus pre-operational."""
        self._forget()
        self._free = iter(range(Cob.FREE, Cob.FREE_LAST + 1))
        self._sent = self._refused = 0
        if not self._is_at_rate():
            log.error(
                "CAN %s has %d kbit/s, P32769 is %d: no node is asked",
                self._link.name, self._link.bit_rate, self._master.get(network_master.bit_rate),
            )  # fmt: skip
            return
        self._send(nmt(Nmt.PRE_OPERATIONAL))

    def _forget(self) -> None:
        self._nodes.clear()
        self._link.listen(None)

    def _is_at_rate(self) -> bool:
        return self._master.get(network_master.bit_rate) == self._link.bit_rate

    def ask(self, slave: int) -> float:
        """Begin to set up a node."""
        self._master.put_slave(slave, network_slaves.words, 0)  # its inputs are not in rows
        number, now_s = self._master.node_id(slave), self._link.now_s()
        self._nodes[slave] = node = _Node(number, since_s=now_s)
        if self._is_at_rate():
            wishes = Wishes(
                number,
                self._master.setting(canopen.master_node_id),
                self._health_ms,
                self._tables.get(number),
                self._free,
            )
            node.asking = Talk(number, set_up(wishes), self._send, now_s)
        return LOOK_MS

    @property
    def _health_ms(self) -> int:
        return max(2, HEALTH_CYCLES * self._master.get(network_master.cycle_ms))

    def answer(self, slave: int) -> Found | Pending | None:
        """What a node has, once it has been set up."""
        node = self._nodes[slave]
        talk = node.asking
        if talk is None:
            return None
        if not talk.is_over:
            if self._link.now_s() - node.since_s < LONGEST_S:
                return PENDING
            self._say(node, f"it has not answered everything in {LONGEST_S:g} s")
        elif talk.failure is not None:
            self._say(node, str(talk.failure))
        node.asking, node.io = None, talk.result
        return None if node.io is None else node.io.found

    def run(self, slave: int) -> None:
        """Make a node operational, and read its inputs once."""
        node = self._nodes[slave]
        node.is_running, node.heard_s = True, self._link.now_s()
        self._link.listen(set(self._identifiers()))
        self._send(nmt(Nmt.START, node.id))
        if node.io is not None and node.io.found.digital_input_bytes:
            script = read_inputs(node.io.found.digital_input_bytes)
            node.first = Talk(node.id, script, self._send, self._link.now_s())

    def _identifiers(self) -> Iterator[int]:
        """Those of frames that nodes send to the card."""
        for node in self._nodes.values():
            for base in (Cob.EMERGENCY, Cob.SDO_ANSWER, Cob.HEALTH):
                yield base + node.id
            if node.io is not None:
                yield from node.io.inputs

    def answers(self, slave: int) -> bool:
        """A node is served until it is found dead."""
        return self._nodes[slave].is_running

    def is_well(self, slave: int) -> bool:
        """Whether a node has reported in this period that it is operational."""
        node = self._nodes[slave]
        is_late = self._link.now_s() - node.heard_s > self._health_ms / 1000
        if node.state is None or is_late:
            why = "it reports no health"
        elif node.state != NodeState.OPERATIONAL:
            why = STATE_TEXTS.get(node.state, f"it is in state {node.state}")
        else:
            return True
        self._say(node, f"{why}: it is dead until the next start")
        node.is_running = False
        return False

    def outputs(self, slave: int) -> tuple[int, int]:
        """How many outputs a node has."""
        io = self._nodes[slave].io
        return (
            (0, 0) if io is None else (8 * io.found.digital_output_bytes, io.found.analog_outputs)
        )

    def exchange(self, outputs: Mapping[int, Outputs]) -> None:
        """Send the outputs, then the synchronisation."""
        for slave, (words, counts) in outputs.items():
            io = self._nodes[slave].io
            if io is not None and self._may_send:
                self._send_outputs(io, words, counts)
        self._send(Frame(Cob.SYNC))

    def _send_outputs(self, io: IoNode, words: Iterable[int], counts: list[int]) -> None:
        digital = b"".join((word & 0xFFFFFFFF).to_bytes(4, "little") for word in words)
        for identifier, part in io.outputs.items():
            end = part.first + part.count
            if part.kind is Kind.DIGITAL_OUTPUTS:
                data = digital[part.first : end]
            else:
                values = counts[part.first : end]
                data = b"".join(count.to_bytes(2, "little", signed=True) for count in values)
            self._send(Frame(identifier, data))

    def digital(self, slave: int) -> list[int] | None:
        """The digital inputs, if the node has sent some."""
        node = self._nodes[slave]
        if not node.has_digital or node.io is None:
            return None
        node.has_digital = False
        words = range(-(-node.io.found.digital_input_bytes // 4))
        return [
            int.from_bytes(node.digital[4 * word : 4 * word + 4], "little", signed=True)
            for word in words
        ]

    def analog(self, slave: int) -> list[int] | None:
        """The analog inputs, if the node has sent some."""
        node = self._nodes[slave]
        if not node.has_analog or node.io is None:
            return None
        node.has_analog = False
        return node.analog[: node.io.found.analog_inputs]

    def notice(self, slave: int) -> None:
        """A real node sends its inputs by itself."""

    def destroyed(self) -> float:
        """The share of frames that the bus has not taken in this cycle."""
        sent, refused = self._sent, self._refused
        self._sent = self._refused = 0
        return refused / sent if sent else 0.0

    def errors(self) -> int:
        """What the controller reports."""
        return OFF if self._trouble.failure else self._trouble.errors

    # frames

    def _send(self, frame: Frame) -> None:
        self._sent += 1
        self._refused += not self._link.send(frame)

    def _hear(self, frame: Frame, nodes: Mapping[int, _Node], now_s: float) -> None:
        """One frame of the bus; those of others are left out."""
        if frame.is_remote:
            return
        node = nodes.get(frame.id & OF_A_NODE)
        if node is not None and self._hear_node(frame, node, now_s):
            return
        for each in nodes.values():
            if each.io is not None and frame.id in each.io.inputs:
                _take_inputs(each, each.io.inputs[frame.id], frame.data)

    def _hear_node(self, frame: Frame, node: _Node, now_s: float) -> bool:
        """Whether it is no process data."""
        match frame.id & ~OF_A_NODE:
            case Cob.SDO_ANSWER:
                self._hear_answer(node, frame.data, now_s)
            case Cob.HEALTH if frame.data:
                node.state, node.heard_s = frame.data[0] & STATE, now_s
            case Cob.EMERGENCY if len(frame.data) >= 2:
                code = int.from_bytes(frame.data[:2], "little")
                if code not in (0, node.emergency):
                    self._say(node, f"it reports emergency 0x{code:04X}")
                node.emergency = code
            case _:
                return False
        return True

    def _hear_answer(self, node: _Node, data: bytes, now_s: float) -> None:
        if node.asking is not None:
            node.asking.hear(data, now_s)
        elif node.first is not None:
            node.first.hear(data, now_s)
            if node.first.is_over:
                for place, value in enumerate(node.first.result or b""):
                    if place not in node.sent:  # what it has sent is newer
                        node.digital[place] = value
                        node.has_digital = True
                node.first = None

    def _report(self, now_s: float) -> None:
        """Twice in a health period: the master is well, and nodes without a heartbeat are asked."""
        if now_s - self._beat_s < self._health_ms / 2000:
            return
        self._beat_s = now_s
        own = self._master.setting(canopen.master_node_id)
        self._send(Frame(Cob.HEALTH + own, bytes((NodeState.OPERATIONAL,))))
        for node in self._nodes.values():
            if node.is_running and node.io is not None and node.io.found.health == GUARDING:
                self._send(Frame(Cob.HEALTH + node.id, is_remote=True))

    def _look_at_link(self) -> None:
        trouble = self._link.trouble()
        flags = canf.SW_RX_OVERFLOW * bool(trouble.lost) | canf.HW_RX_OVERFLOW * trouble.is_overrun
        if flags:
            self._master.change_flags(set_=flags)
        text = trouble.failure or ("the controller is off the bus" * (trouble.errors >= OFF))
        if text and text != self._said:
            log.error("CAN %s: %s", self._link.name, text)
        self._said = text
        self._trouble = trouble

    def _say(self, node: _Node, text: str) -> None:
        log.warning("CAN %s: node %d: %s", self._link.name, node.id, text)


def _take_inputs(node: _Node, part: Part, data: bytes) -> None:
    """Values of one frame; one that is too short brings those that it has."""
    if part.kind is Kind.DIGITAL_INPUTS:
        fresh = data[: part.count]
        node.digital[part.first : part.first + len(fresh)] = fresh
        node.sent.update(range(part.first, part.first + len(fresh)))
        node.has_digital = True
    else:
        for place in range(min(part.count, len(data) // 2)):
            value = int.from_bytes(data[2 * place : 2 * place + 2], "little", signed=True)
            node.analog[part.first + place] = value
        node.has_analog = True
