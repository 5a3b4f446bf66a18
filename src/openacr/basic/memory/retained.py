"""What battery-backed memory keeps when the card restarts."""

from openacr.map import numbers as at
from openacr.map.memory import Memory

LONG_VARIABLES = (at.USRI_BASE, at.USRS_BASE + at.USRS_COUNT)  # LONG, then FP32
_WORD_BYTES = 4

# Ranges of the I view: user variables, their count, dimensions, and the heap with
# everything programs have dimensioned.
_RANGES = (
    LONG_VARIABLES,
    (2 * at.USER_BASE, 2 * (at.USER_BASE + at.USER_COUNT)),
    (at.SYSI_BASE + at.SYSI_P_COUNT, at.SYSI_BASE + at.SYSI_P_COUNT + 1),
    (at.STI_BASE, at.STI_BASE + at.ST_COUNT * at.STI_STRIDE),
    (at.SMI_BASE, at.SMI_BASE + at.SM_COUNT * at.SMI_STRIDE),
    (at.HEAP_BYTE_BASE // _WORD_BYTES, (at.HEAP_BYTE_BASE + at.HEAP_BYTES) // _WORD_BYTES),
)


def take(memory: Memory) -> list[memoryview]:
    """A copy of what is kept."""
    return [memoryview(memory.I[a:b].tobytes()).cast("i") for a, b in _RANGES]


def put_back(memory: Memory, kept: list[memoryview]) -> None:
    """Write it into the memory of the restarted card."""
    for (a, b), content in zip(_RANGES, kept, strict=True):
        memory.I[a:b] = content
