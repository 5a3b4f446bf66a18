"""The threads of a card: programs, command channels and kinematics, as rows of the memory.

Where a thread stands lies in its rows; what it executes, and for whom, lies here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.vm import scheduler_cy as scheduler
from openacr.basic.vm.code import Chunk, CodeSpace
from openacr.basic.vm.flow_cy import FLOW_GOSUB
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.map.rows import engine, threads
from openacr.map.rows import scheduler as scheduler_rows
from openacr.map.words import mf1, pf
from openacr.messages import LABEL_NOT_FOUND, MESSAGES
from openacr.motion.path import kinematics

if TYPE_CHECKING:
    from openacr.basic.execute.system import System

KINEMATICS = 32  # first thread of the kinematics of masters

ENDS_WITH_PROGRAM = (
    pf.PROGRAM_RUNNING
    | pf.PROGRAM_DWELLING
    | pf.PROGRAM_INHIBITED
    | pf.MOVE_PENDING
    | pf.BLOCK_MODE_WAITING
    | pf.PAUSE_MODE_WAITING
    | pf.STEP_REQUEST_FLAG
)
_CLEARED_BY_START = (
    threads.sp,
    threads.depth,
    threads.line,
    threads.passed,
    threads.spare_flags,
    threads.error,
)


class Threads:
    """Begins and ends what threads execute."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.memory, self.clock = system.card.memory, system.card.clock
        self.space = CodeSpace(self.memory)
        self._runs: list[Run | None] = [None] * threads.COUNT
        self.sources: dict[int, tuple[StoredLine, ...]] = {}  # what each thread executes
        self.lives = [0] * threads.COUNT  # how often each thread has begun or ended
        self.failures: dict[int, str] = {}  # of programs that an error has ended

    def views(self) -> tuple[Any, Any, Any, Any, Any]:
        """What the sources of the core get: the memory and the code."""
        memory, space = self.memory, self.space
        return memory.F, memory.I, memory.S, space.code, space.nums

    def row(self, thread: int, row: tuple[int, ...], place: int = 0) -> int:
        """One int32 row of a thread, or one place of an array row."""
        return self.memory.I[row[thread] + place]

    def set_row(self, thread: int, row: tuple[int, ...], value: int) -> None:
        """Write one int32 row of a thread."""
        self.memory.I[row[thread]] = value

    def next_line(self, thread: int) -> int:
        """Number of the line whose first statement a thread executes next."""
        line: int = self.space.chunks[thread].code[self.row(thread, threads.pc) + 1]
        return line

    def next_marks(self, thread: int) -> int:
        """What `basic.vm.code` says of the statement a thread executes next."""
        marks: int = self.space.chunks[thread].code[self.row(thread, threads.pc) + 2]
        return marks

    def run_of(self, thread: int) -> Run:
        """The context of what a thread executes."""
        run = self._runs[thread]
        if run is None:
            raise LookupError(f"thread {thread} executes nothing")
        return run

    def start(self, thread: int, chunk: Chunk, run: Run, start: int) -> None:
        """Let a thread begin at a place of its code; the scheduler goes on with it."""
        self.space.put(thread, chunk)
        self.lives[thread] += 1
        self._runs[thread] = run
        self.failures.pop(thread, None)
        for row in _CLEARED_BY_START:
            self.set_row(thread, row, 0)
        if self.memory.I[engine.line_announced] == thread + 1:
            self.memory.I[engine.line_announced] = 0  # of what it executed before
        self.set_row(thread, threads.pc, start)
        self.set_row(thread, threads.locals, -1 if run.program is None else run.program)
        self.set_row(thread, threads.state, scheduler.THREAD_READY)
        self._mark(thread, active=True)

    def _mark(self, thread: int, *, active: bool) -> None:
        if thread >= KINEMATICS:
            return  # started anew by the scheduler whenever a tool has moved
        row = scheduler_rows.programs if thread < PROGRAMS else scheduler_rows.channels
        bit = 1 << thread % PROGRAMS
        mask = self.memory.I[row]
        self.memory.I[row] = mask | bit if active else mask & ~bit

    def is_marked(self, thread: int) -> bool:
        """Whether the scheduler attends to a program or channel."""
        row = scheduler_rows.programs if thread < PROGRAMS else scheduler_rows.channels
        return bool(self.memory.I[row] >> thread % PROGRAMS & 1)

    def forget(self, thread: int) -> None:
        """Let a thread execute nothing more; no host gets a report."""
        self.set_row(thread, threads.state, scheduler.THREAD_IDLE)
        self.set_row(thread, threads.depth, 0)
        self._mark(thread, active=False)
        self.lives[thread] += 1
        self._runs[thread] = None
        self.sources.pop(thread, None)

    def end(self, thread: int, error: CardError | None) -> None:
        """A thread is done, or stopped by an error: report it to its channel or listeners."""
        if thread >= KINEMATICS:
            self._end_kinematics(thread, error)
            return
        session = self.run_of(thread).channel
        self.forget(thread)
        if session is not None:
            session.finished(error)
            return
        self.memory.I[pf.word[thread]] &= ~ENDS_WITH_PROGRAM
        if error is not None:
            self.fail(thread, self.row(thread, threads.line), error)
        self.system.listeners.ended(thread)

    def _end_kinematics(self, thread: int, error: CardError | None) -> None:
        """Kinematics that end or fail kill the moves of their master."""
        program, line = self.row(thread, threads.locals), self.row(thread, threads.line)
        master = thread - KINEMATICS
        kinematics.switch_off(self.system.card, master)
        self.forget(thread)
        self.memory.I[mf1.word[master]] |= mf1.KILL_ALL_MOVES_REQUEST
        if error is not None:
            self.system.listeners.error(program, line, error.text)

    def fail(self, program: int, line: int, error: CardError) -> None:
        """Note and report the error that has ended a program."""
        self.set_row(program, threads.error, error.message.number)
        self.failures[program] = error.text
        self.system.listeners.error(program, line, error.text)

    def error(self, thread: int) -> CardError:
        """The error the VM has stopped with."""
        message = MESSAGES[self.row(thread, threads.error)]
        detail = int(self.memory.F[threads.error_detail[thread]])
        if message is LABEL_NOT_FOUND:
            return CardError(message, self.space.chunks[thread].names[detail])
        return CardError(message, detail)

    # snapshot

    def put_back(
        self, thread: int, lines: tuple[StoredLine, ...], chunk: Chunk, run: Run | None
    ) -> None:
        """Take over what a thread executes; where it stands lies in the memory."""
        if run is not None:
            self.sources[thread] = lines
        self.space.chunks[thread], self._runs[thread] = chunk, run

    def check(self, thread: int) -> None:
        """LookupError unless a thread stands between two operations of what it executes."""
        state = self.row(thread, threads.state)
        is_marked = thread < KINEMATICS and self.is_marked(thread)
        if thread not in self.sources:
            if state != scheduler.THREAD_IDLE or is_marked:
                raise LookupError(f"thread {thread} executes nothing")
            return
        chunk = self.space.chunks[thread]
        code = set(chunk.begins) - set(range(chunk.lines_at, len(chunk.code)))
        stops = [
            self.row(thread, threads.flow_back, level)
            for level in range(self.row(thread, threads.depth))
            if self.row(thread, threads.flow_kind, level) == FLOW_GOSUB
        ]
        if thread < KINEMATICS or state != scheduler.THREAD_IDLE:
            stops.append(self.row(thread, threads.pc))
            if self.row(thread, threads.sp):
                raise LookupError(f"thread {thread} is in the middle of an expression")
        if not code.issuperset(stops):
            raise LookupError(f"thread {thread} is in the middle of an operation")
        self.space.show_lines(thread)

    def reset(self) -> None:
        """Forget what all threads execute (REBOOT)."""
        self.failures.clear()
        for thread in range(threads.COUNT):
            self.forget(thread)
