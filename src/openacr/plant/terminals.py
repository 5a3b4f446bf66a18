"""The terminals of CANopen nodes: digital and analog, and what is wired to them.

The rows of a node hold the level at each of its terminals. Scenarios and wires name a terminal
by the flag or parameter at which the card shows the same place of its own node table.
"""

from __future__ import annotations

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import motors

WORD_BITS = 32
FULL_SCALE = 32767  # counts of a signed 16-bit converter
BOTTOM = -32768
_BITS = at.BUSNI_ANALOG_BITS


def ints(node: int) -> int:
    """Index (into I) of the rows of a node."""
    return at.BUSNI_BASE + node * at.BUSNI_STRIDE


def reals(node: int) -> int:
    """Index (into F) of the rows of a node."""
    return at.BUSNF_BASE + node * at.BUSNF_STRIDE


def terminal_row(node: int, terminal: int, rows: int) -> int:
    """Index (into I) of the word with the level of a digital input or output."""
    return ints(node) + rows + terminal // WORD_BITS


def _place(flag: int, first_word: int) -> tuple[int, int] | None:
    """Node and number of a terminal, by a flag of the block that begins with a word."""
    offset = flag - (first_word - at.FLAG_WORD_BASE) * WORD_BITS
    node, terminal = divmod(offset, at.CANDI_WORD_STRIDE * WORD_BITS)
    is_terminal = terminal < at.BUSNI_LEVELS_SIZE * WORD_BITS
    return (node, terminal) if 0 <= node < at.BUSN_COUNT and is_terminal else None


def input_terminal(flag: int) -> tuple[int, int] | None:
    """Node and number of the digital input a flag belongs to."""
    return _place(flag, at.CANDI_WORD)


def output_terminal(flag: int) -> tuple[int, int] | None:
    """Node and number of the digital output a flag belongs to."""
    return _place(flag, at.CANDO_WORD)


def analog_input(memory: Memory, parameter: int) -> int | None:
    """Index (into F) of the value at the analog input a parameter shows; None if not one."""
    channel, offset = divmod(parameter - at.CANADC_BASE, at.CANADC_STRIDE)
    node, number = divmod(channel, at.BUSNF_MEASURED_SIZE)
    if offset != at.CANADC_ADC_INPUT_VALUE or not 0 <= node < at.BUSN_COUNT:
        return None
    if number >= memory.I[ints(node) + at.BUSNI_ANALOG_INPUTS]:
        return None
    return reals(node) + at.BUSNF_MEASURED + number


def analog_output(memory: Memory, parameter: int) -> tuple[int, int] | None:
    """Node and number of the analog output a parameter commands; None if not one."""
    channel, offset = divmod(parameter - at.CANDAC_BASE, at.CANDAC_STRIDE)
    node, number = divmod(channel, at.BUSNI_CONVERTED_SIZE)
    if offset != at.CANDAC_DAC_OUTPUT_VALUE or not 0 <= node < at.BUSN_COUNT:
        return None
    is_there = number < memory.I[ints(node) + at.BUSNI_ANALOG_OUTPUTS]
    return (node, number) if is_there else None


def follow_signals(memory: Memory) -> None:
    """Update the analog inputs from the signals wired to them."""
    for signal in range(at.BUSS_COUNT):
        rows = at.BUSSI_BASE + signal * at.BUSSI_STRIDE
        place, axis = memory.I[rows + at.BUSSI_INPUT], memory.I[rows + at.BUSSI_AXIS]
        if not place:
            return  # they are filled from the first on
        if axis >= 0:
            source = memory.F[motors.position_cnt[axis]]
        else:
            node, channel = (memory.I[rows + row] for row in (at.BUSSI_NODE, at.BUSSI_CHANNEL))
            source = output_value(memory, node, channel)
        factors = at.BUSSF_BASE + signal * at.BUSSF_STRIDE
        scale, offset = (memory.F[factors + row] for row in (at.BUSSF_SCALE, at.BUSSF_OFFSET))
        memory.F[place] = source * scale + offset


def convert_inputs(memory: Memory, node: int) -> list[int]:
    """Measure the analog inputs, in counts of a signed 16-bit converter."""
    first = reals(node)
    low, high = memory.F[first + at.BUSNF_INPUT_LOW], memory.F[first + at.BUSNF_INPUT_HIGH]
    count, bits = (memory.I[ints(node) + row] for row in (at.BUSNI_ANALOG_INPUTS, _BITS))
    measured = memory.F[first + at.BUSNF_MEASURED : first + at.BUSNF_MEASURED + count]
    return [_counts(min(max(value, low), high) / high, bits) for value in measured]


def _counts(share: float, bits: int) -> int:
    """A share of full scale in counts; a converter with fewer bits leaves the low ones out."""
    step = 1 << 16 - bits
    counts = round(share * (FULL_SCALE if share > 0 else -BOTTOM))
    return counts if abs(counts) in (FULL_SCALE, -BOTTOM) else counts // step * step


def set_outputs(memory: Memory, node: int, words: list[int], counts: list[int]) -> None:
    """Set all output terminals of a node."""
    rows = ints(node)
    low, high = (memory.F[reals(node) + row] for row in (at.BUSNF_OUTPUT_LOW, at.BUSNF_OUTPUT_HIGH))
    for word, value in enumerate(words):
        memory.I[rows + at.BUSNI_OUTPUTS + word] = value
    bottom = BOTTOM if low < 0.0 < high else 0
    for channel, value in enumerate(counts):
        memory.I[rows + at.BUSNI_CONVERTED + channel] = max(value, bottom)


def output_value(memory: Memory, node: int, channel: int) -> float:
    """Return the value of an analog output, in its unit."""
    counts = memory.I[ints(node) + at.BUSNI_CONVERTED + channel]
    high = memory.F[reals(node) + at.BUSNF_OUTPUT_HIGH]
    return counts / (FULL_SCALE if counts > 0 else -BOTTOM) * high
