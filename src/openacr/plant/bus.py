"""The CANopen nodes of the world: what is at their terminals, and what they answer.

All of it is in rows of the map. The functions here are what the network master of the card
can reach over the bus; `now_s` is the age of the world, which no restart of the card changes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from openacr.map import numbers as at
from openacr.map.memory import Memory

FLAG_WORDS = 4096
WORD_BITS = 32
FULL_SCALE = 32767  # counts of a signed 16-bit converter
BOTTOM = -32768
NEVER_S = 1e300
STRANGE_BIT_RATE = 0.2  # share of messages a node at another bit rate destroys


class NodeState(IntEnum):
    """What a node is doing."""

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
    """What a node tells about itself when it is asked."""

    digital_input_bytes: int
    digital_output_bytes: int
    analog_inputs: int
    analog_outputs: int
    health: int


def ints(node: int) -> int:
    """Index (into I) of the rows of a node."""
    return at.BUSNI_BASE + node * at.BUSNI_STRIDE


def reals(node: int) -> int:
    """Index (into F) of the rows of a node."""
    return at.BUSNF_BASE + node * at.BUSNF_STRIDE


def now_s(memory: Memory) -> float:
    """The age of the world in seconds."""
    return memory.F[at.BUSF_BASE + at.BUSF_BEFORE_S] + memory.F[at.SYSF_BASE + at.SYSF_TIME_S]


def is_fitted(memory: Memory) -> bool:
    """Whether the card has a CANopen controller."""
    return bool(memory.I[at.BUSI_BASE + at.BUSI_FITTED])


# terminals


def terminal_row(node: int, terminal: int, rows: int) -> int:
    """Index (into I) of the word with the level of a digital input or output."""
    return ints(node) + rows + terminal // WORD_BITS


def _place(flag: int, first_word: int) -> tuple[int, int] | None:
    """Node and number of a terminal, by a flag of the block that begins with a word."""
    offset = flag - (first_word - FLAG_WORDS) * WORD_BITS
    node, terminal = divmod(offset, at.CANDI_WORD_STRIDE * WORD_BITS)
    is_terminal = terminal < at.BUSNI_LEVELS_SIZE * WORD_BITS
    return (node, terminal) if 0 <= node < at.BUSN_COUNT and is_terminal else None


def input_terminal(flag: int) -> tuple[int, int] | None:
    """Node and number of the digital input a flag belongs to."""
    return _place(flag, at.CANDI_WORD)


def output_terminal(flag: int) -> tuple[int, int] | None:
    """Node and number of the digital output a flag belongs to."""
    return _place(flag, at.CANDO_WORD)


def switch(memory: Memory, flag: int, on: bool) -> bool:
    """Switch a digital input of a node; False if no node has it."""
    place = input_terminal(flag)
    if place is None or place[1] >= memory.I[ints(place[0]) + at.BUSNI_DIGITAL_INPUTS]:
        return False
    row, bit = terminal_row(*place, at.BUSNI_LEVELS), flag % WORD_BITS
    mask = 1 << bit if bit < WORD_BITS - 1 else -(1 << bit)
    memory.I[row] = memory.I[row] | mask if on else memory.I[row] & ~mask
    return True


def analog_input(memory: Memory, parameter: int) -> int | None:
    """Index (into F) of what is at the analog input a parameter shows; None if there is none."""
    channel, offset = divmod(parameter - at.CANADC_BASE, at.CANADC_STRIDE)
    node, number = divmod(channel, at.BUSNF_MEASURED_SIZE)
    if offset != at.CANADC_ADC_INPUT_VALUE or not 0 <= node < at.BUSN_COUNT:
        return None
    if number >= memory.I[ints(node) + at.BUSNI_ANALOG_INPUTS]:
        return None
    return reals(node) + at.BUSNF_MEASURED + number


# faults


def faults(memory: Memory, kind: Trouble, node: int | None = None) -> Iterator[float]:
    """Yield the rates of the faults of a kind that are present."""
    now = now_s(memory)
    for fault in _known_faults(memory):
        rows = at.BUSXI_BASE + fault * at.BUSXI_STRIDE
        times = at.BUSXF_BASE + fault * at.BUSXF_STRIDE
        is_meant = memory.I[rows + at.BUSXI_KIND] == kind
        if is_meant and (node is None or memory.I[rows + at.BUSXI_NODE] == node):
            if memory.F[times + at.BUSXF_FROM_S] <= now < memory.F[times + at.BUSXF_UNTIL_S]:
                yield memory.F[times + at.BUSXF_RATE]


def _known_faults(memory: Memory) -> Iterator[int]:
    """The rows of faults; they are filled from the first on."""
    for fault in range(at.BUSX_COUNT):
        if not memory.I[at.BUSXI_BASE + fault * at.BUSXI_STRIDE + at.BUSXI_KIND]:
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
    """Let nodes lose their power, or begin anew when it is back."""
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
    """Find the node that answers to an id at a bit rate."""
    for node in nodes(memory):
        if memory.I[ints(node) + at.BUSNI_ID] == identity and answers(memory, node, bit_rate):
            return node
    return None


def answers(memory: Memory, node: int, bit_rate: int) -> bool:
    """Whether a node hears and answers messages at a bit rate."""
    rows = ints(node)
    return (
        memory.I[rows + at.BUSNI_STATE] != NodeState.OFF
        and memory.I[rows + at.BUSNI_BIT_RATE] == bit_rate
        and not has_fault(memory, Trouble.SILENT, node)
    )


def describe(memory: Memory, node: int) -> Found:
    """Return what a node has; digital terminals come in bytes."""
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


def convert_inputs(memory: Memory, node: int) -> list[int]:
    """Measure the analog inputs, in counts of a signed 16-bit converter."""
    first = reals(node)
    low, high = memory.F[first + at.BUSNF_INPUT_LOW], memory.F[first + at.BUSNF_INPUT_HIGH]
    count, bits = (memory.I[ints(node) + row] for row in (at.BUSNI_ANALOG_INPUTS, _BITS))
    measured = memory.F[first + at.BUSNF_MEASURED : first + at.BUSNF_MEASURED + count]
    return [_counts(min(max(value, low), high) / high, bits) for value in measured]


_BITS = at.BUSNI_ANALOG_BITS


def _counts(share: float, bits: int) -> int:
    """A share of full scale in counts; a converter with fewer bits leaves the low ones out."""
    step = 1 << 16 - bits
    counts = round(share * (FULL_SCALE if share > 0 else -BOTTOM))
    return counts if abs(counts) in (FULL_SCALE, -BOTTOM) else counts // step * step


def set_outputs(memory: Memory, node: int, words: list[int], counts: list[int]) -> None:
    """Put values out at all terminals of a node."""
    rows = ints(node)
    low, high = (memory.F[reals(node) + row] for row in (at.BUSNF_OUTPUT_LOW, at.BUSNF_OUTPUT_HIGH))
    for word, value in enumerate(words):
        memory.I[rows + at.BUSNI_OUTPUTS + word] = value
    bottom = BOTTOM if low < 0.0 < high else 0
    for channel, value in enumerate(counts):
        memory.I[rows + at.BUSNI_CONVERTED + channel] = max(value, bottom)


def output_value(memory: Memory, node: int, channel: int) -> float:
    """Return what an analog output puts out, in its unit."""
    counts = memory.I[ints(node) + at.BUSNI_CONVERTED + channel]
    high = memory.F[reals(node) + at.BUSNF_OUTPUT_HIGH]
    return counts / (FULL_SCALE if counts > 0 else -BOTTOM) * high
