"""Read what a run shows out of the memory of a card: programs, motion, flags."""

from collections.abc import Iterator

from openacr.map import numbers as at
from openacr.map.block import FLAG_WORD_BASE
from openacr.map.memory import Memory
from openacr.map.rows import programs, storage, threads
from openacr.scenario.schema import State

PROGRAMS = range(at.PROG_COUNT)
AXES = range(at.AX_COUNT)
MASTERS = range(at.MA_COUNT)

# Looked at in this order: a paused program is also running.
_STATES = (
    (at.PF_PAUSE_MODE_WAITING, State.PAUSED),
    (at.PF_BLOCK_MODE_WAITING, State.BLOCKED),
    (at.PF_PROGRAM_DWELLING, State.DWELLING),
    (at.PF_PROGRAM_INHIBITED, State.INHIBITED),
    (at.PF_PROGRAM_RUNNING, State.RUNNING),
)


def has_failed(memory: Memory, program: int) -> bool:
    """Whether an error has ended a program since it was started."""
    return memory.I[threads.error[program]] > 0


def program_state(memory: Memory, program: int) -> State:
    """Say what a program is doing."""
    flags = memory.I[at.PF_WORD + program]
    for mask, state in _STATES:
        if flags & mask:
            return state
    return State.ERROR if has_failed(memory, program) else State.IDLE


def program_line(memory: Memory, program: int) -> int:
    """Give the number of the line a program is at, or was at last."""
    return memory.I[programs.line_number[program]]


def has_program(memory: Memory, program: int) -> bool:
    """Whether program text is stored."""
    return memory.I[storage.code_bytes[program]] > 0


def running_programs(memory: Memory) -> list[int]:
    """List the programs whose Running flag is set."""
    return [p for p in PROGRAMS if memory.I[at.PF_WORD + p] & at.PF_PROGRAM_RUNNING]


def is_moving(memory: Memory) -> bool:
    """Whether a coordinated move or a jog is in progress."""
    masters = _words(at.MF1_WORD, at.MF1_WORD_HIGH, at.MA_COUNT)
    axes = _words(at.AF1_WORD, at.AF1_WORD_HIGH, at.AX_COUNT)
    return any(memory.I[word] & at.MF1_IN_MOTION for word in masters) or any(
        memory.I[word] & at.AF1_JOG_ACTIVE for word in axes
    )


def is_idle(memory: Memory) -> bool:
    """Whether no program runs and nothing moves."""
    return not running_programs(memory) and not is_moving(memory)


def set_flags(memory: Memory) -> list[int]:
    """List the numbers of all flags that are set."""
    return [
        (word - FLAG_WORD_BASE) * 32 + bit
        for word in range(FLAG_WORD_BASE, FLAG_WORD_BASE + (at.FLAG_LAST + 1) // 32)
        if memory.I[word]
        for bit in range(32)
        if memory.I[word] >> bit & 1
    ]


def masters_of_axes(memory: Memory) -> dict[int, int]:
    """Map every attached axis to the master it follows."""
    found: dict[int, int] = {}
    for master in MASTERS:
        first = at.MSI_BASE + master * at.MSI_STRIDE + at.MSI_SLAVE_AXIS
        for axis in memory.I[first : first + at.MSI_SLAVE_AXIS_SIZE]:
            if axis >= 0:
                found.setdefault(axis, master)
    return found


def pulses_per_unit(memory: Memory, axis: int) -> float:
    """Give the PPU of an axis; 1 where it is not set."""
    return memory.S[at.AX_BASE + axis * at.AX_STRIDE + at.AX_PPU] or 1.0


def actual_u(memory: Memory, axis: int) -> float:
    """Give the actual position of an axis in units."""
    row = at.AX_BASE + axis * at.AX_STRIDE + at.AX_ACTUAL_POSITION
    return memory.I[row] / pulses_per_unit(memory, axis)


def commanded_u(memory: Memory, axis: int) -> float:
    """Give the commanded position of an axis, all its parts together, in units."""
    row = at.AX_BASE + axis * at.AX_STRIDE + at.AX_SECONDARY_SETPOINT
    return memory.I[row] / pulses_per_unit(memory, axis)


def _words(low: int, high: int, count: int) -> Iterator[int]:
    """List the flag words of a family whose second half may lie elsewhere."""
    return (low + n if n < count // 2 else high + n for n in range(count))
