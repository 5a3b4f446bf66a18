"""Check rows of the machine that refer to other rows, as read from a snapshot."""

from openacr.errors import StoreError
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import bus_signals, input_words

_PARAMETERS = range(at.FLAG_WORD_BASE, at.PUBLIC_COUNT)
_OF_NODES = range(at.BUSNI_BASE, at.BUSNI_BASE + at.BUSN_COUNT * at.BUSNI_STRIDE)
_MEASURED = range(at.BUSNF_BASE, at.BUSNF_BASE + at.BUSN_COUNT * at.BUSNF_STRIDE)


def check_places(memory: Memory) -> None:
    """StoreError unless wires end at inputs and signals at analog inputs."""
    for slot in range(memory.I[at.PLGI_BASE + at.PLGI_WORDS]):
        word = memory.I[input_words.word[slot]]
        if word not in _PARAMETERS and word not in _OF_NODES:
            raise StoreError(
                f"the snapshot is damaged: a wire ends at row {word}, which no input is"
            )
    for signal in range(at.BUSS_COUNT):
        place = memory.I[bus_signals.input[signal]]
        if place and place not in _MEASURED:
            raise StoreError(f"the snapshot is damaged: a signal ends at row {place}")
