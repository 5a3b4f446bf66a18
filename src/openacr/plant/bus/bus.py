"""The CANopen nodes of the machine: their power, their answers and their faults.

All state is in rows of the map. The functions here are what the network master of the card
can access over the bus; `now_s` is the age of the machine, unaffected by restarts of the card.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from openacr.map.memory import Memory
from openacr.map.rows import bus, bus_faults, bus_nodes, system

NEVER_S = 1e300
STRANGE_BIT_RATE = 0.2  # share of messages a node at another bit rate destroys


class NodeState(IntEnum):
    """The state of a node."""

    OFF = 0
    PRE_OPERATIONAL = 1
    OPERATIONAL = 2


class Trouble(IntEnum):
    """Kinds of faults, as their rows hold them."""

    SILENT = 1
    LOST = 2
    NOISE = 3
    CONTROLLER = 4
    SOFTWARE_OVERFLOW = 5
    HARDWARE_OVERFLOW = 6


@dataclass(frozen=True, slots=True)
class Found:
    """The equipment a node reports when queried."""

    digital_input_bytes: int
    digital_output_bytes: int
    analog_inputs: int
    analog_outputs: int
    health: int


def now_s(memory: Memory) -> float:
    """The age of the machine in seconds."""
    return memory.F[bus.before_s] + memory.F[system.time_s]


def is_fitted(memory: Memory) -> bool:
    """Whether the card has a CANopen controller."""
    return bool(memory.I[bus.fitted])


# faults


def faults(memory: Memory, kind: Trouble, node: int | None = None) -> Iterator[float]:
    """Yield the rates of the faults of a kind that are present."""
    now = now_s(memory)
    for fault in _known_faults(memory):
        is_meant = memory.I[bus_faults.kind[fault]] == kind
        if is_meant and (node is None or memory.I[bus_faults.node[fault]] == node):
            if memory.F[bus_faults.from_s[fault]] <= now < memory.F[bus_faults.until_s[fault]]:
                yield memory.F[bus_faults.rate[fault]]


def _known_faults(memory: Memory) -> Iterator[int]:
    """The rows of faults; they are filled from the first on."""
    for fault in range(bus_faults.COUNT):
        if not memory.I[bus_faults.kind[fault]]:
            return
        yield fault


def has_fault(memory: Memory, kind: Trouble, node: int | None = None) -> bool:
    """Whether a fault of this kind is present."""
    return next(faults(memory, kind, node), None) is not None


def next_change_s(memory: Memory) -> float | None:
    """When the next fault begins or ends."""
    now = now_s(memory)
    times = (
        memory.F[row[fault]]
        for fault in _known_faults(memory)
        for row in (bus_faults.from_s, bus_faults.until_s)
    )
    return min((time for time in times if now < time < NEVER_S), default=None)


def follow_power(memory: Memory) -> None:
    """Switch nodes off when they lose power, and restart them when it is back."""
    for node in range(bus_nodes.COUNT):
        row = bus_nodes.state[node]
        is_off = has_fault(memory, Trouble.LOST, node)
        if memory.I[bus_nodes.id[node]] and is_off != (memory.I[row] == NodeState.OFF):
            begin(memory, node, NodeState.OFF if is_off else NodeState.PRE_OPERATIONAL)


def begin(memory: Memory, node: int, state: NodeState) -> None:
    """Bring a node to the state after power-up (or power-down): all outputs off."""
    memory.I[bus_nodes.state[node]] = state
    end = bus_nodes.converted[node] + bus_nodes.CONVERTED_SIZE
    for place in range(bus_nodes.outputs[node], end):
        memory.I[place] = 0


def run(memory: Memory, node: int) -> None:
    """Make a node operational: it exchanges data."""
    memory.I[bus_nodes.state[node]] = NodeState.OPERATIONAL


def stop(memory: Memory, node: int) -> None:
    """Make a node pre-operational; its outputs stay as they are."""
    memory.I[bus_nodes.state[node]] = NodeState.PRE_OPERATIONAL


def is_operational(memory: Memory, node: int) -> bool:
    """Whether a node exchanges data."""
    return memory.I[bus_nodes.state[node]] == NodeState.OPERATIONAL


# what the bus carries


def nodes(memory: Memory) -> Iterator[int]:
    """Yield the nodes of the world."""
    return (node for node in range(bus_nodes.COUNT) if memory.I[bus_nodes.id[node]])


def find(memory: Memory, identity: int, bit_rate: int) -> int | None:
    """Find the node that answers for an id at a bit rate."""
    for node in nodes(memory):
        if memory.I[bus_nodes.id[node]] == identity and answers(memory, node, bit_rate):
            return node
    return None


def answers(memory: Memory, node: int, bit_rate: int) -> bool:
    """Whether a node receives and answers messages at a bit rate."""
    return (
        memory.I[bus_nodes.state[node]] != NodeState.OFF
        and memory.I[bus_nodes.bit_rate[node]] == bit_rate
        and not has_fault(memory, Trouble.SILENT, node)
    )


def describe(memory: Memory, node: int) -> Found:
    """Return the equipment of a node; digital terminals are counted in bytes."""
    return Found(
        (memory.I[bus_nodes.digital_inputs[node]] + 7) // 8,
        (memory.I[bus_nodes.digital_outputs[node]] + 7) // 8,
        memory.I[bus_nodes.analog_inputs[node]],
        memory.I[bus_nodes.analog_outputs[node]],
        memory.I[bus_nodes.health[node]],
    )


def destroyed(memory: Memory, bit_rate: int) -> float:
    """Return the share of messages that noise and nodes at another bit rate destroy."""
    rates = list(faults(memory, Trouble.NOISE))
    for node in nodes(memory):
        is_on = memory.I[bus_nodes.state[node]] != NodeState.OFF
        if is_on and memory.I[bus_nodes.bit_rate[node]] != bit_rate:
            rates.append(STRANGE_BIT_RATE)
    return min(1.0, sum(rates))
