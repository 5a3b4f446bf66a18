"""Check rows of the machine that refer to other rows, as read from a snapshot."""

from openacr.errors import StoreError
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import bus_nodes, bus_signals, input_words, plant

_PARAMETERS = range(at.FLAG_WORD_BASE, at.PUBLIC_COUNT)
_OF_NODES = range(bus_nodes.ints[0], bus_nodes.ints[-1] + bus_nodes.INTS_SIZE)
_MEASURED = range(bus_nodes.reals[0], bus_nodes.reals[-1] + bus_nodes.REALS_SIZE)


def check_places(memory: Memory) -> None:
    """StoreError unless wires end at inputs and signals at analog inputs."""
    for slot in range(memory.I[plant.words]):
        word = memory.I[input_words.word[slot]]
        if word not in _PARAMETERS and word not in _OF_NODES:
            raise StoreError(
                f"the snapshot is damaged: a wire ends at row {word}, which no input is"
            )
    for signal in range(bus_signals.COUNT):
        place = memory.I[bus_signals.input[signal]]
        if place and place not in _MEASURED:
            raise StoreError(f"the snapshot is damaged: a signal ends at row {place}")
