"""How long the bus and its nodes need for one cycle.

All data travels in messages of 125 bits that carry up to 64 bits: four analog values, or 64
digital outputs. A node has one more message for its health, the master one for the
synchronisation. Digital inputs do not count, they are sent only when they change.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

MESSAGE_BITS = 125
ANALOG_PER_MESSAGE = 4
DIGITAL_PER_MESSAGE = 64
HEALTH_CYCLES = 10


@dataclass(frozen=True, slots=True)
class Speed:
    """What a coupler needs for a cycle: to answer at all, and for each of its points [us]."""

    base_us: int
    digital_us: int
    analog_us: int


PIO_337 = Speed(1000, 15, 40)
PIO_347 = Speed(5000, 100, 270)
COUPLERS = (PIO_337, PIO_347)  # by the number in the rows of a node


def node_messages(analog_inputs: int, digital_outputs: int, analog_outputs: int) -> int:
    """Messages of a node in each cycle."""
    return (
        _messages(analog_inputs, ANALOG_PER_MESSAGE)
        + _messages(digital_outputs, DIGITAL_PER_MESSAGE)
        + _messages(analog_outputs, ANALOG_PER_MESSAGE)
        + 1
    )


def total_messages(nodes: Iterable[int]) -> int:
    """Messages on the bus in each cycle, by those of the nodes."""
    return sum(nodes) + 1


def cycle_ms(messages: int, bit_rate: int) -> int:
    """The shortest cycle for this number of messages, at a bit rate in kbit/s."""
    return -(-messages * MESSAGE_BITS // bit_rate)


def node_ms(speed: Speed, digital: int, analog: int) -> int:
    """The shortest cycle a node keeps up with; its points are inputs and outputs together."""
    needed_us = speed.base_us + digital * speed.digital_us + analog * speed.analog_us
    return -(-needed_us // 1000)


def _messages(values: int, per_message: int) -> int:
    return (values + per_message - 1) // per_message
