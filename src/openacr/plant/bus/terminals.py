"""The terminals of CANopen nodes: digital and analog, and what is wired to them.

The rows of a node hold the level at each of its terminals. Scenarios and wires name a terminal
by the flag or parameter at which the card shows the same place of its own node table.
"""

from __future__ import annotations

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import bus_nodes, bus_signals, canopen_adcs, canopen_dacs, motors
from openacr.map.words import candi, cando

WORD_BITS = 32
FULL_SCALE = 32767  # counts of a signed 16-bit converter
BOTTOM = -32768


def terminal_row(node: int, terminal: int, row: tuple[int, ...]) -> int:
    """Index (into I) of the word with the level of a digital input or output."""
    return row[node] + terminal // WORD_BITS


def _place(flag: int, words: tuple[int, ...]) -> tuple[int, int] | None:
    """Node and number of a terminal, by a flag of the words of a side of all nodes."""
    offset, bit = divmod(flag, WORD_BITS)
    if at.FLAG_WORD_BASE + offset not in words:
        return None
    node, word = divmod(words.index(at.FLAG_WORD_BASE + offset), bus_nodes.LEVELS_SIZE)
    return node, word * WORD_BITS + bit


def input_terminal(flag: int) -> tuple[int, int] | None:
    """Node and number of the digital input a flag belongs to."""
    return _place(flag, candi.word)


def output_terminal(flag: int) -> tuple[int, int] | None:
    """Node and number of the digital output a flag belongs to."""
    return _place(flag, cando.word)


def analog_input(memory: Memory, parameter: int) -> int | None:
    """Index (into F) of the value at the analog input a parameter shows; None if not one."""
    if parameter not in canopen_adcs.adc_input_value:
        return None
    channel = canopen_adcs.adc_input_value.index(parameter)
    node, number = divmod(channel, bus_nodes.MEASURED_SIZE)
    if number >= memory.I[bus_nodes.analog_inputs[node]]:
        return None
    return bus_nodes.measured[node] + number


def analog_output(memory: Memory, parameter: int) -> tuple[int, int] | None:
    """Node and number of the analog output a parameter commands; None if not one."""
    if parameter not in canopen_dacs.dac_output_value:
        return None
    channel = canopen_dacs.dac_output_value.index(parameter)
    node, number = divmod(channel, bus_nodes.CONVERTED_SIZE)
    is_there = number < memory.I[bus_nodes.analog_outputs[node]]
    return (node, number) if is_there else None


def follow_signals(memory: Memory) -> None:
    """Update the analog inputs from the signals wired to them."""
    for signal in range(bus_signals.COUNT):
        place, axis = memory.I[bus_signals.input[signal]], memory.I[bus_signals.axis[signal]]
        if not place:
            return  # they are filled from the first on
        if axis >= 0:
            source = memory.F[motors.position_cnt[axis]]
        else:
            node, channel = (
                memory.I[bus_signals.node[signal]],
                memory.I[bus_signals.channel[signal]],
            )
            source = output_value(memory, node, channel)
        scale, offset = memory.F[bus_signals.scale[signal]], memory.F[bus_signals.offset[signal]]
        memory.F[place] = source * scale + offset


def convert_inputs(memory: Memory, node: int) -> list[int]:
    """Measure the analog inputs, in counts of a signed 16-bit converter."""
    low, high = memory.F[bus_nodes.input_low[node]], memory.F[bus_nodes.input_high[node]]
    count, bits = memory.I[bus_nodes.analog_inputs[node]], memory.I[bus_nodes.analog_bits[node]]
    measured = memory.F[bus_nodes.measured[node] : bus_nodes.measured[node] + count]
    return [_counts(min(max(value, low), high) / high, bits) for value in measured]


def _counts(share: float, bits: int) -> int:
    """A share of full scale in counts; a converter with fewer bits leaves the low ones out."""
    step = 1 << 16 - bits
    counts = round(share * (FULL_SCALE if share > 0 else -BOTTOM))
    return counts if abs(counts) in (FULL_SCALE, -BOTTOM) else counts // step * step


def set_outputs(memory: Memory, node: int, words: list[int], counts: list[int]) -> None:
    """Set all output terminals of a node."""
    low, high = memory.F[bus_nodes.output_low[node]], memory.F[bus_nodes.output_high[node]]
    for word, value in enumerate(words):
        memory.I[bus_nodes.outputs[node] + word] = value
    bottom = BOTTOM if low < 0.0 < high else 0
    for channel, value in enumerate(counts):
        memory.I[bus_nodes.converted[node] + channel] = max(value, bottom)


def output_value(memory: Memory, node: int, channel: int) -> float:
    """Return the value of an analog output, in its unit."""
    counts = memory.I[bus_nodes.converted[node] + channel]
    high = memory.F[bus_nodes.output_high[node]]
    return counts / (FULL_SCALE if counts > 0 else -BOTTOM) * high
