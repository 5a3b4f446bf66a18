"""The CANopen nodes of the machine: their power, their answers and their faults.

All state is in rows of the map. The functions here are what the network master of the card
can access over the bus; `now_s` is the age of the machine, unaffected by restarts of the card.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import bus_faults
from openacr.plant.terminals import ints

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
    return memory.F[at.BUSF_BASE + at.BUSF_BEFORE_S] + memory.F[at.SYSF_BASE + at.SYSF_TIME_S]


def is_fitted(memory: Memory) -> bool:
    """Whether the card has a CANopen controller."""
    return bool(memory.I[at.BUSI_BASE + at.BUSI_FITTED])


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
    for fault in range(at.BUSX_COUNT):
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
        memory.F[at.BUSXF_BASE + fault * at.BUSXF_STRIDE + row]
        for fault in _known_faults(memory)
        for row in (at.BUSXF_FROM_S, at.BUSXF_UNTIL_S)
    )
    return min((time for time in times if now < time < NEVER_S), default=None)


def follow_power(memory: Memory) -> None:
    """Switch nodes off when they lose power, and restart them when it is back."""
    for node in range(at.BUSN_COUNT):
        row = ints(node) + at.BUSNI_STATE
        is_off = has_fault(memory, Trouble.LOST, node)
        if memory.I[ints(node) + at.BUSNI_ID] and is_off != (memory.I[row] == NodeState.OFF):
            begin(memory, node, NodeState.OFF if is_off else NodeState.PRE_OPERATIONAL)


def begin(memory: Memory, node: int, state: NodeState) -> None:
    """Bring a node to the state after power-up (or power-down): all outputs off."""
    first = ints(node)
    memory.I[first + at.BUSNI_STATE] = state
    for row in range(at.BUSNI_OUTPUTS, at.BUSNI_CONVERTED + at.BUSNI_CONVERTED_SIZE):
        memory.I[first + row] = 0


def run(memory: Memory, node: int) -> None:
    """Make a node operational: it exchanges data."""
    memory.I[ints(node) + at.BUSNI_STATE] = NodeState.OPERATIONAL


def stop(memory: Memory, node: int) -> None:
    """Make a node pre-operational; its outputs stay as they are."""
    memory.I[ints(node) + at.BUSNI_STATE] = NodeState.PRE_OPERATIONAL


def is_operational(memory: Memory, node: int) -> bool:
    """Whether a node exchanges data."""
    return memory.I[ints(node) + at.BUSNI_STATE] == NodeState.OPERATIONAL


# what the bus carries


def nodes(memory: Memory) -> Iterator[int]:
    """Yield the nodes of the world."""
    return (node for node in range(at.BUSN_COUNT) if memory.I[ints(node) + at.BUSNI_ID])


def find(memory: Memory, identity: int, bit_rate: int) -> int | None:
    """Find the node that answers for an id at a bit rate."""
    for node in nodes(memory):
        if memory.I[ints(node) + at.BUSNI_ID] == identity and answers(memory, node, bit_rate):
            return node
    return None


def answers(memory: Memory, node: int, bit_rate: int) -> bool:
    """Whether a node receives and answers messages at a bit rate."""
    rows = ints(node)
    return (
        memory.I[rows + at.BUSNI_STATE] != NodeState.OFF
        and memory.I[rows + at.BUSNI_BIT_RATE] == bit_rate
        and not has_fault(memory, Trouble.SILENT, node)
    )


def describe(memory: Memory, node: int) -> Found:
    """Return the equipment of a node; digital terminals are counted in bytes."""
    rows = ints(node)
    return Found(
        (memory.I[rows + at.BUSNI_DIGITAL_INPUTS] + 7) // 8,
        (memory.I[rows + at.BUSNI_DIGITAL_OUTPUTS] + 7) // 8,
        memory.I[rows + at.BUSNI_ANALOG_INPUTS],
        memory.I[rows + at.BUSNI_ANALOG_OUTPUTS],
        memory.I[rows + at.BUSNI_HEALTH],
    )


def destroyed(memory: Memory, bit_rate: int) -> float:
    """Return the share of messages that noise and nodes at another bit rate destroy."""
    rates = list(faults(memory, Trouble.NOISE))
    for node in nodes(memory):
        rows = ints(node)
        if memory.I[rows + at.BUSNI_STATE] and memory.I[rows + at.BUSNI_BIT_RATE] != bit_rate:
            rates.append(STRANGE_BIT_RATE)
    return min(1.0, sum(rates))
