"""What battery-backed memory keeps when the card restarts."""

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import every, storage, system, system_storage, user_floats, user_integers

LONG_VARIABLES = slice(
    user_integers.parameters[0], user_floats.parameters[-1] + 1
)  # LONG, then FP32
_WORD_BYTES = 4

# Ranges of the I view: user variables, their count, dimensions, and the heap with
# everything programs have dimensioned.
_RANGES = (
    LONG_VARIABLES,
    slice(2 * at.USER_BASE, 2 * (at.USER_BASE + at.USER_COUNT)),
    slice(system.p_count, system.p_count + 1),
    every(storage.ints, storage.INTS_SIZE),
    every(system_storage.ints, system_storage.INTS_SIZE),
    slice(at.HEAP_BYTE_BASE // _WORD_BYTES, (at.HEAP_BYTE_BASE + at.HEAP_BYTES) // _WORD_BYTES),
)


def take(memory: Memory) -> list[memoryview]:
    """A copy of what is kept."""
    return [memoryview(memory.I[places].tobytes()).cast("i") for places in _RANGES]


def put_back(memory: Memory, kept: list[memoryview]) -> None:
    """Write it into the memory of the restarted card."""
    for places, content in zip(_RANGES, kept, strict=True):
        memory.I[places] = content
