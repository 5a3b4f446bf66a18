"""Byte code of one thread, and the buffers in which the code of all threads lies."""

from array import array
from dataclasses import dataclass, field

from openacr.basic.language.nodes import Expr, Move, Statement
from openacr.map.memory import Memory
from openacr.map.rows import thread_code, threads
from openacr.views import F64, I32

# What DO_STATEMENT says of its statement, for followers and for stops before lines. Above these
# bits is the count of conditions that stand before it on its line.
BEGINS_LINE = 1
IS_CONDITION = 2  # an IF with THEN, of programs that are followed
IS_AFTER_THEN = 4  # the first statement after a THEN, of programs that are followed
CONDITIONS_SHIFT = 3

SMALLEST_CODE = 512
SMALLEST_NUMS = 128


@dataclass(slots=True)
class Chunk:
    """What a program or a line was compiled to.

    `code` and `nums` are for the VM; `statements` and `operands` are what it leaves to
    Python, `names` the details of messages. `computed` remembers where expressions lie
    that were compiled later for command handlers.
    """

    code: list[int] = field(default_factory=list)
    nums: list[float] = field(default_factory=list)
    statements: list[Statement | Move] = field(default_factory=list)
    operands: list[Expr] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    lines_at: int = 0
    lines_count: int = 0
    starts: dict[int, int] = field(default_factory=dict)  # line number: place
    begins: list[int] = field(default_factory=list)  # where operations begin
    computed: dict[int, tuple[Expr, int]] = field(default_factory=dict)  # by id: node and place


class CodeSpace:
    """The code of all threads in two buffers, each thread with room to grow.

    `code` and `nums` are replaced when a program outgrows its room: take them anew for
    every call of the compiled core.
    """

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._code_room = [SMALLEST_CODE] * threads.COUNT
        self._nums_room = [SMALLEST_NUMS] * threads.COUNT
        self.chunks = [Chunk() for _ in range(threads.COUNT)]
        self.code: I32
        self.nums: F64
        self.rebuild()

    def put(self, thread: int, chunk: Chunk) -> None:
        """Make `chunk` the code of a thread."""
        self.chunks[thread] = chunk
        self.show_lines(thread)
        self.refresh(thread)

    def show_lines(self, thread: int) -> None:
        """Tell the VM where the table of line numbers is."""
        chunk = self.chunks[thread]
        self._memory.I[threads.lines_at[thread]] = chunk.lines_at
        self._memory.I[threads.lines_count[thread]] = chunk.lines_count

    def refresh(self, thread: int, code_from: int = 0, nums_from: int = 0) -> None:
        """Copy what has been added to the chunk of a thread."""
        chunk = self.chunks[thread]
        if len(chunk.code) > self._code_room[thread] or len(chunk.nums) > self._nums_room[thread]:
            self._code_room[thread] = _room(len(chunk.code), SMALLEST_CODE)
            self._nums_room[thread] = _room(len(chunk.nums), SMALLEST_NUMS)
            self.rebuild()
        else:
            self._copy(thread, code_from, nums_from)

    def rebuild(self) -> None:
        """Lay all code out anew, and tell every thread where its own begins."""
        self.code = memoryview(array("i", bytes(4 * sum(self._code_room))))
        self.nums = memoryview(array("d", bytes(8 * sum(self._nums_room))))
        code_base = num_base = 0
        for thread in range(threads.COUNT):
            self._memory.I[thread_code.code_base[thread]] = code_base
            self._memory.I[thread_code.num_base[thread]] = num_base
            self._copy(thread, 0, 0)
            code_base += self._code_room[thread]
            num_base += self._nums_room[thread]

    def _copy(self, thread: int, code_from: int, nums_from: int) -> None:
        chunk = self.chunks[thread]
        code_base = self._memory.I[thread_code.code_base[thread]]
        num_base = self._memory.I[thread_code.num_base[thread]]
        code, nums = array("i", chunk.code[code_from:]), array("d", chunk.nums[nums_from:])
        code_at, nums_at = code_base + code_from, num_base + nums_from
        self.code[code_at : code_at + len(code)] = code
        self.nums[nums_at : nums_at + len(nums)] = nums


def _room(needed: int, smallest: int) -> int:
    room = smallest
    while room < needed * 2:
        room *= 2
    return room
