"""User memory: what DIM gives, CLEAR takes back and MEM counts, for the whole card.

Sizes and counts are hidden rows of the map; only strings live in Python, in plain lists.
"""

from collections.abc import Iterator

from openacr.basic.memory.heap import Heap
from openacr.basic.memory.memory_cost import (
    ALIAS,
    AUTOMATIC_SHARE_BYTES,
    FLOW_LEVEL,
    GLOBAL_VARIABLE,
    STREAM_BYTES,
    SYSTEM_BYTES,
)
from openacr.basic.memory.program_memory import PROGRAMS, Locals
from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import plcs, storage, system, system_storage, threads
from openacr.messages import (
    INVALID_ARGUMENT,
    INVALID_DEVICE,
    OUT_OF_MEMORY,
    PROGRAM_IN_MEMORY,
    REDIMENSIONED_BLOCK,
)

PLCS = plcs.COUNT
AUTOMATIC_SHARES = 8
STREAMS = ("FIFO", "COM1", "COM2", "DPCB", "STREAM1", "STREAM2", "STREAM3", "STREAM4", "STREAM5")
_REDIMENSIONED_FLAG = {"FIFO": 1805, "COM1": 1869, "COM2": 1901, "DPCB": 5805}

_P_COUNT = system.p_count
_DEF_COUNT = system_storage.def_count
_STREAM_BYTES = system_storage.stream_bytes


class Storage:
    """Dimensions and free memory of all programs, PLCs, globals, aliases and streams."""

    def __init__(
        self,
        memory: Memory,
        *,
        streams: tuple[str, ...] = STREAMS,
    ) -> None:
        self.memory = memory
        self.heap = Heap(memory)
        self.streams = streams
        self.locals = Locals(self.heap, self._take)
        self.restore_factory()

    def restore_factory(self) -> None:
        """The allocation of a new card: equal automatic shares for PROG0 to PROG7."""
        self.locals.forget()
        for owner in range(storage.COUNT):
            for place in range(storage.INTS_SIZE):
                self.memory.I[storage.ints[owner] + place] = 0
        for program in range(AUTOMATIC_SHARES):
            self.heap.set_row(program, storage.size_bytes, AUTOMATIC_SHARE_BYTES)
            self.heap.set_row(program, storage.is_share, 1)
        self._set_system(_P_COUNT, 0)
        self._set_system(_DEF_COUNT, 0)

    @property
    def global_count(self) -> int:
        """P0 up to below this number exist."""
        return self._system(_P_COUNT)

    @property
    def define_count(self) -> int:
        """Aliases there is space for."""
        return self._system(_DEF_COUNT)

    @staticmethod
    def factory_lines() -> list[str]:
        """DIM at SYS of a new card."""
        return [f"DIM PROG{n}({AUTOMATIC_SHARE_BYTES})" for n in range(AUTOMATIC_SHARES)]

    def free_system(self) -> int:
        """Unallocated system memory in bytes."""
        owners = range(storage.COUNT)
        used = sum(self.heap.row(owner, storage.size_bytes) for owner in owners)
        used += GLOBAL_VARIABLE.bytes(self.global_count) + ALIAS.bytes(self.define_count)
        used += sum(self._stream_row(name) for name in STREAMS)
        return SYSTEM_BYTES - used

    def dimension_program(self, program: int, size: int) -> None:
        """DIM PROGn: replaces an automatic share while the program is empty."""
        self._dimension_owner(_number(program, PROGRAMS), size)

    def dimension_plc(self, plc: int, size: int) -> None:
        """DIM PLCn."""
        self._dimension_owner(PROGRAMS + _number(plc, PLCS), size)

    def dimension_globals(self, count: int) -> None:
        """DIM P: P0 to P(count - 1), all 0."""
        if not 0 < count <= at.USER_COUNT:
            raise CardError(INVALID_ARGUMENT)
        self._dimension_system(_P_COUNT, count, GLOBAL_VARIABLE.bytes(count))
        for index in range(count):
            self.memory.F[at.USER_BASE + index] = 0.0

    def dimension_defines(self, count: int) -> None:
        """DIM DEF: space for `count` aliases."""
        self._dimension_system(_DEF_COUNT, count, ALIAS.bytes(count))

    def dimension_stream(self, name: str, size: int) -> None:
        """DIM COM1 and others: another size for the buffer of a stream."""
        row = self._stream_offset(name)
        self._dimension_system(row, size, size)
        self._mark_stream(name, True)

    def stream_size(self, name: str) -> int:
        """Bytes of the buffer of a stream."""
        return self._stream_row(name) or STREAM_BYTES

    def dimensioned(self, name: str) -> int:
        """Bytes given to a stream with DIM, 0 for none."""
        return self._stream_row(name)

    def clear_stream(self, name: str) -> None:
        """CLEAR COM1 and others: back to 256 bytes."""
        self._set_system(self._stream_offset(name), 0)
        self._mark_stream(name, False)

    def clear_system(self) -> None:
        """CLEAR at SYS; refused while a program or PLC is stored."""
        if any(self.heap.row(owner, storage.code_bytes) for owner in range(storage.COUNT)):
            raise CardError(PROGRAM_IN_MEMORY)
        self.restore_factory()

    def system_lines(self) -> Iterator[str]:
        """DIM at SYS: what is allocated, as typed; of the factory allocation programs alone."""
        for owner in range(storage.COUNT):
            size = self.heap.row(owner, storage.size_bytes)
            if size:
                is_plc = owner >= PROGRAMS
                name = f"PLC{owner - PROGRAMS}" if is_plc else f"PROG{owner}"
                yield f"DIM {name}({size})"
        if self.global_count:
            yield f"DIM P({self.global_count})"
        if self.define_count:
            yield f"DIM DEF({self.define_count})"
        for name in self.streams:
            if self._stream_row(name):
                yield f"DIM {name}({self._stream_row(name)})"

    def size(self, owner: int) -> int:
        """Memory of a program (0-15) or PLC (16-23) in bytes."""
        return self.heap.row(owner, storage.size_bytes)

    def free_program(self, owner: int) -> int:
        """Bytes of a program or PLC not taken by its text, locals and open flow levels."""
        used = self.heap.row(owner, storage.code_bytes)
        if owner < PROGRAMS:
            levels = self.memory.I[threads.depth[owner]]
            used += FLOW_LEVEL.bytes(levels) + self.locals.bytes(owner)
        return self.size(owner) - used

    def set_code_bytes(self, owner: int, size: int) -> None:
        """Account for the stored text of a program or PLC; refused where there is no room."""
        growth = size - self.heap.row(owner, storage.code_bytes)
        if growth > 0 and growth > self.free_program(owner):
            raise CardError(OUT_OF_MEMORY)
        self.heap.set_row(owner, storage.code_bytes, size)

    def _take(self, program: int, size: int) -> None:
        if size > self.free_program(program):
            raise CardError(OUT_OF_MEMORY)

    def _dimension_owner(self, owner: int, size: int) -> None:
        is_share = self.heap.row(owner, storage.is_share)
        present = self.size(owner)
        if present and not is_share:
            raise CardError(REDIMENSIONED_BLOCK)
        if self.heap.row(owner, storage.code_bytes):
            raise CardError(PROGRAM_IN_MEMORY)
        _check_count(size)
        locals_bytes = present - self.free_program(owner)
        if size > self.free_system() + present or size < locals_bytes:
            raise CardError(OUT_OF_MEMORY)
        self.heap.set_row(owner, storage.size_bytes, size)
        self.heap.set_row(owner, storage.is_share, 0)

    def _dimension_system(self, row: int, count: int, size: int) -> None:
        if self._system(row):
            raise CardError(REDIMENSIONED_BLOCK)
        _check_count(count)
        if size > self.free_system():
            raise CardError(OUT_OF_MEMORY)
        self._set_system(row, count)

    def _stream_offset(self, name: str) -> int:
        if name not in self.streams:
            raise CardError(INVALID_DEVICE)
        return _STREAM_BYTES + STREAMS.index(name)

    def _stream_row(self, name: str) -> int:
        return self._system(_STREAM_BYTES + STREAMS.index(name))

    def _mark_stream(self, name: str, on: bool) -> None:
        if name in _REDIMENSIONED_FLAG:
            self.memory.set_bit(_REDIMENSIONED_FLAG[name], on)

    def _system(self, row: int) -> int:
        return self.memory.I[row]

    def _set_system(self, row: int, value: int) -> None:
        self.memory.I[row] = value


def _number(number: int, count: int) -> int:
    if not 0 <= number < count:
        raise CardError(INVALID_ARGUMENT)
    return number


def _check_count(count: int) -> None:
    if count < 1:
        raise CardError(INVALID_ARGUMENT)
