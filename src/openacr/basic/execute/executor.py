"""Run programs and typed lines: everything about a thread that the VM leaves to Python.

The scheduler comes back with a thread whose next step needs Python: a command with a
handler, an operand with strings, an error, the end. `attend` deals with it; after that the
scheduler is called again for the same tick.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from openacr.basic.execute.computing import WHOLE_LINE, Computing
from openacr.basic.execute.evaluate import Blocked
from openacr.basic.execute.performing import perform
from openacr.basic.execute.threads import ENDS_WITH_PROGRAM, KINEMATICS, Threads
from openacr.basic.language.registry import Level
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm import scheduler_cy as scheduler
from openacr.basic.vm.code import BEGINS_LINE, Chunk
from openacr.basic.vm.compiler import compile_line, compile_program
from openacr.basic.vm.levels import CompileError
from openacr.basic.vm.run import Run, Wait, WaitKind
from openacr.compiled import pick
from openacr.errors import CardError
from openacr.map.rows import programs, threads
from openacr.map.words import pf
from openacr.messages import LINE_NOT_FOUND, PROGRAM_IS_RUNNING

if TYPE_CHECKING:
    from openacr.basic.channels.session import Session
    from openacr.basic.execute.system import System

_HOLDS = pf.BLOCK_MODE | pf.PAUSE_MODE
_CLEARED_BY_RUN = (  # block mode stays until AUT
    ENDS_WITH_PROGRAM
    | pf.PROGRAM_MODIFIED
    | pf.PAUSE_MODE
    | pf.PAUSE_CONTROL
    | pf.PAUSE_EDGE_DETECT
)


class Executor:
    """Executes the programs of a card and the lines typed on its channels."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.memory = system.card.memory
        self.threads = Threads(system)
        self.computing = Computing(self.threads)
        self._advance = pick(scheduler.advance)
        self._step = pick(scheduler.scheduler_step)

    # programs

    def run_program(self, program: int, line: int | None = None) -> None:
        """RUN: compile the stored text and start it at its first line or at `line`.

        Structure errors are reported to the channels that listen to the program.
        """
        if self.is_running(program):
            raise CardError(PROGRAM_IS_RUNNING)
        lines = tuple(self.system.programs.lines(program))
        if not lines:
            return
        try:
            chunk = self._compiled(lines)
        except CompileError as error:
            row = programs.line_number[program]
            self.memory.I[row] = error.line
            self.threads.fail(program, error.line, error)
            self.system.listeners.ended(program)
            return
        if line is not None and line not in chunk.starts:
            raise CardError(LINE_NOT_FOUND, line)
        self._start_program(program, chunk, line)
        self.threads.sources[program] = lines

    def _start_program(self, program: int, chunk: Chunk, line: int | None) -> None:
        word = pf.word[program]
        self.memory.I[word] = self.memory.I[word] & ~_CLEARED_BY_RUN | pf.PROGRAM_RUNNING
        start = chunk.starts[line] if line is not None else 0
        self.threads.start(program, chunk, self._program_run(program), start)

    def _program_run(self, program: int) -> Run:
        write = partial(self.system.listeners.print, program)
        card = self.system.card
        return Run(
            card, program, program, Level.PROG, True, self.computing, write, system=self.system
        )

    def halt_program(self, program: int) -> None:
        """End a program as HALT does; its motion is not this module's business."""
        if self.is_running(program):
            self.threads.end(program, None)

    def is_running(self, program: int) -> bool:
        """Whether a program executes, waits or is held."""
        return self.threads.row(program, threads.state) != scheduler.THREAD_IDLE

    # kinematics

    def load_kinematics(self, master: int, program: int) -> None:
        """Compile the text of a program as the kinematics of a master."""
        lines = tuple(self.system.programs.lines(program))
        chunk = self._compiled(lines)
        thread = KINEMATICS + master
        self.threads.start(thread, chunk, self._kinematics_run(master), 0)
        self.threads.set_row(thread, threads.locals, program)
        self.threads.set_row(thread, threads.state, scheduler.THREAD_IDLE)
        self.threads.sources[thread] = lines

    def forget_kinematics(self, master: int) -> None:
        """Forget the kinematics of a master."""
        self.threads.forget(KINEMATICS + master)

    def _kinematics_run(self, master: int) -> Run:
        """In the context of the master: the axes are those of its program."""
        program = self.system.card.attachments.program(master)
        listeners, card = self.system.listeners, self.system.card
        write = partial(listeners.print, master if program is None else program)
        thread = KINEMATICS + master
        return Run(
            card, thread, program, Level.PROG, True, self.computing, write, system=self.system
        )

    # typed lines

    def start(self, session: Session, line: StoredLine) -> None:
        """Execute a typed line now; what has to wait is finished by the scheduler."""
        try:
            chunk = compile_line(line.tree)
        except CardError as error:
            session.finished(error)
            return
        self.threads.start(session.thread, chunk, self._session_run(session), 0)
        self.threads.sources[session.thread] = (line,)
        self.threads.set_row(session.thread, threads.budget, WHOLE_LINE)
        while self._advance(*self.threads.views(), session.thread, self.threads.clock.tick):
            self.attend(session.thread)

    def _session_run(self, session: Session) -> Run:
        return Run(
            self.system.card, session.thread, session.program, session.level,
            False, self.computing, session.write, channel=session, system=self.system,
        )  # fmt: skip

    def cancel(self, session: Session) -> None:
        """Forget a line that is still being executed."""
        self.threads.forget(session.thread)

    def is_waiting(self, thread: int) -> bool:
        """Whether a thread waits."""
        return self.threads.row(thread, threads.state) == scheduler.THREAD_WAITING

    # time

    def step(self, tick: int) -> None:
        """Let all threads do what is due in this tick (for use without the engine loop)."""
        while called := self._step(*self.threads.views(), tick):
            self.attend(called - 1)

    def attend(self, thread: int) -> None:
        """Deal with what has stopped a thread, as its row `event` says."""
        event = self.threads.row(thread, threads.event)
        try:
            if event == vm.VM_TRAP:
                self._trap(thread)
            elif event == vm.VM_CALL:
                self.computing.push_operand(thread)
            elif event == vm.VM_FLAGS:
                self._hold(thread)
            elif event == vm.VM_ERROR:
                raise self.threads.error(thread)
            else:
                self.threads.end(thread, None)
        except Blocked as blocked:
            self._wait(thread, blocked.wait, at_trap=event == vm.VM_TRAP)
        except CardError as error:
            self.threads.end(thread, error)

    def _trap(self, thread: int) -> None:
        chunk = self.threads.space.chunks[thread]
        statement = chunk.statements[self.threads.row(thread, threads.trap)]
        wait = perform(self.threads.run_of(thread), statement)
        if wait is not None:
            self._wait(thread, wait, at_trap=wait.retry)

    def _hold(self, thread: int) -> None:
        """Stop before a line in pause or block mode; show its number in trace mode.

        Within a line, where followers of a program want to hear of it, nothing stops.
        """
        word = pf.word[thread]
        flags = self.memory.I[word]
        marks = self.threads.next_marks(thread)
        if flags & pf.TRACE_MODE_ENABLE:
            self.system.listeners.trace(thread, self.threads.next_line(thread), marks)
        if not (flags & _HOLDS and marks & BEGINS_LINE):
            self.threads.set_row(thread, threads.passed, 1)
            return
        if flags & pf.PAUSE_MODE:
            flags |= pf.PAUSE_MODE_WAITING
        if flags & pf.BLOCK_MODE:
            flags |= pf.BLOCK_MODE_WAITING
        self.memory.I[word] = flags
        self.threads.set_row(thread, threads.state, scheduler.THREAD_HELD)

    def _wait(self, thread: int, wait: Wait, *, at_trap: bool) -> None:
        """Let a thread wait; `at_trap`: the statement is executed again afterwards."""
        if at_trap:
            self.threads.set_row(thread, threads.pc, self.threads.row(thread, threads.pc) - 2)
        self.threads.set_row(thread, threads.wait_kind, wait.kind)
        self.threads.set_row(thread, threads.wait_operand, wait.operand)
        self.threads.set_row(thread, threads.wait_show, wait.show)
        self.memory.F[threads.wait_value[thread]] = wait.value
        is_next = wait.kind is WaitKind.NEXT_SLICE
        self.memory.F[threads.wait_deadline_tk[thread]] = (
            self.threads.clock.tick + 1.0 if is_next else 0.0
        )
        self.threads.set_row(thread, threads.state, scheduler.THREAD_WAITING)
        if thread < PROGRAMS:
            self.memory.I[pf.word[thread]] |= wait.show

    # snapshot

    def restore(
        self, sources: Mapping[int, tuple[StoredLine, ...]], failures: Mapping[int, str]
    ) -> None:
        """Take over what threads execute; where they stand lies in the memory, restored before."""
        self.threads.failures = dict(failures)
        self.threads.sources = {}
        for thread in range(threads.COUNT):
            lines = sources.get(thread)
            if lines is None:
                self.threads.put_back(thread, (), Chunk(), None)
            elif thread < PROGRAMS:
                run = self._program_run(thread)
                self.threads.put_back(thread, lines, self._compiled(lines), run)
            elif thread >= KINEMATICS:
                run = self._kinematics_run(thread - KINEMATICS)
                self.threads.put_back(thread, lines, self._compiled(lines), run)
            else:
                run = self._session_run(self._session(thread))
                self.threads.put_back(thread, lines, compile_line(lines[0].tree), run)
            self.threads.check(thread)
        self.threads.space.rebuild()

    def _session(self, thread: int) -> Session:
        found = [s for s in self.system.sessions.values() if s.thread == thread]
        if not found:
            raise LookupError(f"thread {thread} serves no channel")
        return found[0]

    def _compiled(self, lines: tuple[StoredLine, ...]) -> Chunk:
        return compile_program(
            [(line.number, line.tree) for line in lines],
            is_followed=self.system.listeners.follower is not None,
        )
