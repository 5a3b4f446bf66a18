"""Inputs by flag number: which exist, what drives them, and forcing their level.

A scenario or a test switches inputs with `switch`. An input that nothing in the machine drives
simply takes the level. One that a limit switch, a region, an output or `[inputs]` drives is
forced to it, as by a stuck contact or a cut wire, until `release`; the machine continues to
drive the signal underneath.
"""

from dataclasses import dataclass

from openacr.map import numbers as at
from openacr.map.memory import Memory, flag_place
from openacr.map.rows import bus_nodes, input_words, plant
from openacr.map.words import candi
from openacr.plant.bus import terminals

WORD_BITS = 32
# The onboard inputs and those of the four expansion boards, which wires may lead to.
WIRED_RANGES = ((0, 31), (256, 287), (320, 351), (384, 415), (448, 479))
OUTPUT_RANGES = ((32, 63), (288, 319), (352, 383), (416, 447), (480, 511))
MISCELLANEOUS = (64, 95)
NODE_RANGES = tuple(
    (first, first + bus_nodes.LEVELS_SIZE * WORD_BITS - 1)
    for node in range(bus_nodes.COUNT)
    for first in ((candi.word[node * bus_nodes.LEVELS_SIZE] - at.FLAG_WORD_BASE) * WORD_BITS,)
)
RANGES = tuple(sorted((*WIRED_RANGES, MISCELLANEOUS, *NODE_RANGES)))


def input_place(flag: int) -> tuple[int, int]:
    """Word and mask of the level of an input; for a node, of the level at its terminal."""
    terminal = terminals.input_terminal(flag)
    word, mask = flag_place(flag)
    return (terminals.terminal_row(*terminal, bus_nodes.levels) if terminal else word), mask


def output_place(flag: int) -> tuple[int, int]:
    """Word and mask of an output; for a node, of the level at its terminal."""
    terminal = terminals.output_terminal(flag)
    word, mask = flag_place(flag)
    return (terminals.terminal_row(*terminal, bus_nodes.outputs) if terminal else word), mask


def within(number: int, ranges: tuple[tuple[int, int], ...]) -> bool:
    """Whether a flag is in one of these ranges."""
    return any(first <= number <= last for first, last in ranges)


def exists(memory: Memory, flag: int) -> bool:
    """Whether the card, an expansion board or a node of the machine has this input."""
    terminal = terminals.input_terminal(flag)
    if terminal is None:
        return within(flag, RANGES)
    node, number = terminal
    return number < memory.I[bus_nodes.digital_inputs[node]]


def switch(memory: Memory, flag: int, on: bool) -> None:
    """Set the level of an input; one driven by the machine keeps it until released."""
    word, mask = input_place(flag)
    slot = _driven(memory, word, mask)
    if slot is not None:
        memory.I[input_words.stuck[slot]] |= mask
        _put(memory, input_words.stuck_level[slot], mask, on)
    _put(memory, word, mask, on)


def release(memory: Memory, flag: int) -> None:
    """Release an input: the machine drives it again; off if nothing drives it."""
    word, mask = input_place(flag)
    slot = _driven(memory, word, mask)
    if slot is None:
        _put(memory, word, mask, False)
        return
    for row in (input_words.stuck, input_words.stuck_level):
        memory.I[row[slot]] &= ~mask
    _put(memory, word, mask, memory.I[input_words.level[slot]] & mask != 0)


def drive(memory: Memory, flag: int, on: bool) -> None:
    """Set the level to which the machine drives an input; a forced one keeps its level."""
    word, mask = input_place(flag)
    slot = _driven(memory, word, mask)
    if slot is None:
        return
    _put(memory, input_words.level[slot], mask, on)
    if not memory.I[input_words.stuck[slot]] & mask:
        _put(memory, word, mask, on)


@dataclass(frozen=True, slots=True)
class InputState:
    """An input: its level, and whether it is forced to it."""

    flag: int
    is_on: bool
    is_forced: bool


def state(memory: Memory, flag: int) -> InputState:
    """The state of an input of the card, an expansion board or a node."""
    word, mask = input_place(flag)
    slot = _driven(memory, word, mask)
    is_forced = slot is not None and memory.I[input_words.stuck[slot]] & mask != 0
    return InputState(flag, memory.I[word] & mask != 0, is_forced)


def is_driven(memory: Memory, flag: int) -> bool:
    """Whether the machine drives an input."""
    return driven_slot(memory, flag) is not None


def driven_slot(memory: Memory, flag: int) -> int | None:
    """Where the machine keeps the level to which it drives an input; None if it does not."""
    return _driven(memory, *input_place(flag))


def _driven(memory: Memory, word: int, mask: int) -> int | None:
    """The slot of an input that the machine drives; None if not driven."""
    for slot in range(memory.I[plant.words]):
        is_word = memory.I[input_words.word[slot]] == word
        if is_word and memory.I[input_words.wired[slot]] & mask:
            return slot
    return None


def _put(memory: Memory, row: int, mask: int, on: bool) -> None:
    memory.I[row] = memory.I[row] | mask if on else memory.I[row] & ~mask
