"""Where the card shows the inputs and outputs of its nodes, and how analog values are scaled.

Each bit has one place. P32771 moves the first words of some nodes to the flags of the expansion
boards (P4104 to P4111, an input and an output word in turn), which PLCs can reach; what
was moved is no longer at its standard place.
"""

from __future__ import annotations

from collections.abc import Sequence

from openacr.map.memory import Memory
from openacr.map.rows import canopen_adcs, canopen_dacs, network_master, network_slaves
from openacr.map.words import candi, cando
from openacr.network.canopen.rows import Master

EXPANSION = 4104
WORDS = network_slaves.SENT_SIZE
FULL_SCALE, BOTTOM = 32767, -32768

# Node and word of each pair of expansion words, by P32771.
MAPPINGS: tuple[tuple[tuple[int, int], ...], ...] = (
    (),
    ((0, 0), (0, 1), (0, 2), (0, 3)),
    ((0, 0), (0, 1), (1, 0), (1, 1)),
    ((0, 0), (1, 0), (2, 0), (3, 0)),
)


def mapping_of(value: int) -> int:
    """Which mapping a value of P32771 means."""
    return min(max(value, 0), len(MAPPINGS) - 1)


def input_word(master: Master, slave: int, word: int) -> int:
    """The parameter that shows 32 inputs of a slave."""
    return _place(master, slave, word, candi.word, 0)


def output_word(master: Master, slave: int, word: int) -> int:
    """The parameter that commands 32 outputs of a slave."""
    return _place(master, slave, word, cando.word, 1)


def _place(master: Master, slave: int, word: int, standard: tuple[int, ...], side: int) -> int:
    pairs = MAPPINGS[master.get(network_master.mapping)]
    if (slave, word) in pairs:
        return EXPANSION + 2 * pairs.index((slave, word)) + side
    return standard[slave * WORDS + word]


def clear_moved(master: Master) -> None:
    """Empty the standard places of everything that has been moved."""
    for slave, word in MAPPINGS[master.get(network_master.mapping)]:
        for standard in (candi.word, cando.word):
            master.memory.I[standard[slave * WORDS + word]] = 0


def outputs(master: Master, slave: int, digital: int, analog: int) -> tuple[list[int], list[int]]:
    """The commanded outputs of a slave: digital ones in words, analog ones in counts."""
    words = range(-(-digital // 32))
    return (
        [master.memory.I[output_word(master, slave, word)] for word in words],
        [_dac_counts(master.memory, _channel(slave, number)) for number in range(analog)],
    )


def _dac_counts(memory: Memory, channel: int) -> int:
    """A value of the user in counts: (value + offset) * gain."""
    value = memory.S[canopen_dacs.dac_output_value[channel]]
    offset, gain = canopen_dacs.dac_offset[channel], canopen_dacs.dac_gain[channel]
    counts = (value + memory.S[offset]) * memory.S[gain]
    return round(min(max(counts, BOTTOM), FULL_SCALE)) if counts == counts else 0


def show_digital_inputs(master: Master, slave: int, words: Sequence[int]) -> None:
    """Show digital inputs, in words."""
    for word, value in enumerate(words):
        master.memory.I[input_word(master, slave, word)] = value


def show_analog_inputs(memory: Memory, slave: int, counts: Sequence[int]) -> None:
    """Show analog inputs: share of full scale * gain + offset."""
    for number, value in enumerate(counts):
        channel = _channel(slave, number)
        share = value / (FULL_SCALE if value > 0 else -BOTTOM)
        gain = memory.S[canopen_adcs.adc_gain[channel]]
        offset = memory.S[canopen_adcs.adc_offset[channel]]
        memory.S[canopen_adcs.adc_input_value[channel]] = share * gain + offset


def _channel(slave: int, number: int) -> int:
    return slave * network_slaves.LATCHED_SIZE + number
