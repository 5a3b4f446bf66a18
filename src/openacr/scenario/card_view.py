"""Read what a run shows out of the memory of a card: programs, motion, flags."""

from openacr.map import numbers as at
from openacr.map.block import FLAG_WORD_BASE
from openacr.map.memory import Memory
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters as master_rows
from openacr.map.rows import programs, storage, threads
from openacr.map.words import af1, mf1, pf
from openacr.scenario.schema import State

PROGRAMS = range(programs.COUNT)
MASTERS = range(master_rows.COUNT)

# Looked at in this order: a paused program is also running.
_STATES = (
    (pf.PAUSE_MODE_WAITING, State.PAUSED),
    (pf.BLOCK_MODE_WAITING, State.BLOCKED),
    (pf.PROGRAM_DWELLING, State.DWELLING),
    (pf.PROGRAM_INHIBITED, State.INHIBITED),
    (pf.PROGRAM_RUNNING, State.RUNNING),
)


def has_failed(memory: Memory, program: int) -> bool:
    """Whether an error has ended a program since it was started."""
    return memory.I[threads.error[program]] > 0


def program_state(memory: Memory, program: int) -> State:
    """Say what a program is doing."""
    flags = memory.I[pf.word[program]]
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
    return [p for p in PROGRAMS if memory.I[pf.word[p]] & pf.PROGRAM_RUNNING]


def is_moving(memory: Memory) -> bool:
    """Whether a coordinated move or a jog is in progress."""
    return any(memory.I[word] & mf1.IN_MOTION for word in mf1.word) or any(
        memory.I[word] & af1.JOG_ACTIVE for word in af1.word
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
        first = master_rows.slave_axis[master]
        for axis in memory.I[first : first + master_rows.SLAVE_AXIS_SIZE]:
            if axis >= 0:
                found.setdefault(axis, master)
    return found


def pulses_per_unit(memory: Memory, axis: int) -> float:
    """Give the PPU of an axis; 1 where it is not set."""
    return memory.S[axis_rows.ppu[axis]] or 1.0


def actual_u(memory: Memory, axis: int) -> float:
    """Give the actual position of an axis in units."""
    row = axis_rows.actual_position[axis]
    return memory.I[row] / pulses_per_unit(memory, axis)


def commanded_u(memory: Memory, axis: int) -> float:
    """Give the commanded position of an axis, all its parts together, in units."""
    row = axis_rows.secondary_setpoint[axis]
    return memory.I[row] / pulses_per_unit(memory, axis)
