"""Run programs and typed lines: everything about a thread that the VM leaves to Python.

The scheduler comes back with a thread whose next step needs Python: a command with a
handler, an operand with strings, an error, the end. `attend` deals with it; after that the
scheduler is called again for the same tick.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from openacr.basic import commands as _commands  # noqa: F401 - registers the commands
from openacr.basic.execute.computing import WHOLE_LINE, Computing
from openacr.basic.execute.evaluate import Blocked
from openacr.basic.execute.threads import ENDS_WITH_PROGRAM, KINEMATICS
from openacr.basic.language import registry
from openacr.basic.language.nodes import Move, Statement
from openacr.basic.language.registry import Level
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm import scheduler_cy as scheduler
from openacr.basic.vm.code import Chunk
from openacr.basic.vm.compiler import compile_line, compile_program
from openacr.basic.vm.flow_cy import FLOW_GOSUB
from openacr.basic.vm.levels import CompileError
from openacr.basic.vm.run import Run, Wait, WaitKind
from openacr.compiled import pick
from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.messages import LINE_NOT_FOUND, PROGRAM_IS_RUNNING
from openacr.motion import kinematics
from openacr.motion.row_index import master_word

if TYPE_CHECKING:
    from openacr.basic.channels.session import Session
    from openacr.basic.execute.system import System

_HOLDS = at.PF_BLOCK_MODE | at.PF_PAUSE_MODE
_CLEARED_BY_RUN = (  # block mode stays until AUT
    ENDS_WITH_PROGRAM
    | at.PF_PROGRAM_MODIFIED
    | at.PF_PAUSE_MODE
    | at.PF_PAUSE_CONTROL
    | at.PF_PAUSE_EDGE_DETECT
)


class Executor(Computing):
    """Executes the programs of a card and the lines typed on its channels."""

    def __init__(self, system: System) -> None:
        super().__init__(system)
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
            chunk = _compiled(lines)
        except CompileError as error:
            row = at.PROG_BASE + program * at.PROG_STRIDE + at.PROG_LINE_NUMBER
            self.memory.I[row] = error.line
            self._fail(program, error.line, error)
            self.system.listeners.ended(program)
            return
        if line is not None and line not in chunk.starts:
            raise CardError(LINE_NOT_FOUND, line)
        self._start_program(program, chunk, line)
        self.sources[program] = lines

    def _start_program(self, program: int, chunk: Chunk, line: int | None) -> None:
        word = at.PF_WORD + program
        self.memory.I[word] = self.memory.I[word] & ~_CLEARED_BY_RUN | at.PF_PROGRAM_RUNNING
        start = chunk.starts[line] if line is not None else 0
        self._start(program, chunk, self._program_run(program), start)

    def _program_run(self, program: int) -> Run:
        write = partial(self.system.listeners.print, program)
        card = self.system.card
        return Run(card, program, program, Level.PROG, True, self, write, system=self.system)

    def halt_program(self, program: int) -> None:
        """End a program as HALT does; its motion is not this module's business."""
        if self.is_running(program):
            self._end(program, None)

    def is_running(self, program: int) -> bool:
        """Whether a program executes, waits or is held."""
        return self._row(program, at.THI_STATE) != scheduler.THREAD_IDLE

    # kinematics

    def load_kinematics(self, master: int, program: int) -> None:
        """Compile the text of a program as the kinematics of a master."""
        lines = tuple(self.system.programs.lines(program))
        chunk = _compiled(lines)
        thread = KINEMATICS + master
        self._start(thread, chunk, self._kinematics_run(master), 0)
        self.set_row(thread, at.THI_LOCALS, program)
        self.set_row(thread, at.THI_STATE, scheduler.THREAD_IDLE)
        self.sources[thread] = lines

    def forget_kinematics(self, master: int) -> None:
        """Forget the kinematics of a master."""
        self._forget(KINEMATICS + master)

    def _kinematics_run(self, master: int) -> Run:
        """In the context of the master: the axes are those of its program."""
        program = self.system.card.attachments.program(master)
        listeners, card = self.system.listeners, self.system.card
        write = partial(listeners.print, master if program is None else program)
        thread = KINEMATICS + master
        return Run(card, thread, program, Level.PROG, True, self, write, system=self.system)

    def _end(self, thread: int, error: CardError | None) -> None:
        """A thread is done or has failed; kinematics that fail kill the moves of their master."""
        if thread < KINEMATICS:
            super()._end(thread, error)
            return
        program, line = self._row(thread, at.THI_LOCALS), self._row(thread, at.THI_LINE)
        master = thread - KINEMATICS
        kinematics.switch_off(self.system.card, master)
        self.forget_kinematics(master)
        self.memory.I[master_word(master)] |= at.MF1_KILL_ALL_MOVES_REQUEST
        if error is not None:
            self.system.listeners.error(program, line, error.text)

    # typed lines

    def start(self, session: Session, line: StoredLine) -> None:
        """Execute a typed line now; what has to wait is finished by the scheduler."""
        try:
            chunk = compile_line(line.tree)
        except CardError as error:
            session.finished(error)
            return
        self._start(session.thread, chunk, self._session_run(session), 0)
        self.sources[session.thread] = (line,)
        self.set_row(session.thread, at.THI_BUDGET, WHOLE_LINE)
        while self._advance(*self._views(), session.thread, self.tick):
            self.attend(session.thread)

    def _session_run(self, session: Session) -> Run:
        return Run(
            self.system.card, session.thread, session.program, session.level,
            False, self, session.write, channel=session, system=self.system,
        )  # fmt: skip

    def cancel(self, session: Session) -> None:
        """Forget a line that is still being executed."""
        self._forget(session.thread)

    def is_waiting(self, thread: int) -> bool:
        """Whether a thread waits."""
        return self._row(thread, at.THI_STATE) == scheduler.THREAD_WAITING

    # time

    def step(self, tick: int) -> None:
        """Let all threads do what is due in this tick (for use without the engine loop)."""
        while called := self._step(*self._views(), tick):
            self.attend(called - 1)

    def attend(self, thread: int) -> None:
        """Deal with what has stopped a thread, as its row `event` says."""
        event = self._row(thread, at.THI_EVENT)
        try:
            if event == vm.VM_TRAP:
                self._trap(thread)
            elif event == vm.VM_CALL:
                self._push_operand(thread)
            elif event == vm.VM_FLAGS:
                self._hold(thread)
            elif event == vm.VM_ERROR:
                raise self._error(thread)
            else:
                self._end(thread, None)
        except Blocked as blocked:
            self._wait(thread, blocked.wait, at_trap=event == vm.VM_TRAP)
        except CardError as error:
            self._end(thread, error)

    def _trap(self, thread: int) -> None:
        statement = self.space.chunks[thread].statements[self._row(thread, at.THI_TRAP)]
        wait = self._perform(self.run_of(thread), statement)
        if wait is not None:
            self._wait(thread, wait, at_trap=wait.retry)

    def _hold(self, thread: int) -> None:
        """Stop before a line in pause or block mode; show its number in trace mode."""
        word = at.PF_WORD + thread
        flags = self.memory.I[word]
        if flags & at.PF_TRACE_MODE_ENABLE:
            line = self.space.chunks[thread].code[self._row(thread, at.THI_PC) + 1]
            self.system.listeners.trace(thread, line)
        if not flags & _HOLDS:
            self.set_row(thread, at.THI_PASSED, 1)
            return
        if flags & at.PF_PAUSE_MODE:
            flags |= at.PF_PAUSE_MODE_WAITING
        if flags & at.PF_BLOCK_MODE:
            flags |= at.PF_BLOCK_MODE_WAITING
        self.memory.I[word] = flags
        self.set_row(thread, at.THI_STATE, scheduler.THREAD_HELD)

    def _wait(self, thread: int, wait: Wait, *, at_trap: bool) -> None:
        """Let a thread wait; `at_trap`: the statement is executed again afterwards."""
        if at_trap:
            self.set_row(thread, at.THI_PC, self._row(thread, at.THI_PC) - 2)
        reals = at.THF_BASE + thread * at.THF_STRIDE
        self.set_row(thread, at.THI_WAIT_KIND, wait.kind)
        self.set_row(thread, at.THI_WAIT_OPERAND, wait.operand)
        self.set_row(thread, at.THI_WAIT_SHOW, wait.show)
        self.memory.F[reals + at.THF_WAIT_VALUE] = wait.value
        is_next = wait.kind is WaitKind.NEXT_SLICE
        self.memory.F[reals + at.THF_WAIT_DEADLINE_TK] = self.tick + 1.0 if is_next else 0.0
        self.set_row(thread, at.THI_STATE, scheduler.THREAD_WAITING)
        if thread < PROGRAMS:
            self.memory.I[at.PF_WORD + thread] |= wait.show

    # commands

    def execute(self, run: Run, statement: Statement) -> Wait | None:
        """Execute one command for a handler that contains it."""
        return self._perform(run, statement)

    def _perform(self, run: Run, statement: Statement | Move) -> Wait | None:
        if isinstance(statement, Statement):
            wait = self._handle(run, statement)
            return wait if isinstance(wait, Wait) else None
        targets = [target for part in statement.parts for target in self._handle(run, part) or ()]
        issued: Wait | None = registry.move_issuer()(run, tuple(targets))
        return issued

    def _handle(self, run: Run, statement: Statement) -> Any:
        """Evaluate the arguments of a command and call its handler."""
        row = statement.command
        outer, run.prefix = run.prefix, statement.prefix
        try:
            indices = [run.integer(index) for index in statement.indices]
            given = zip(row.forms, statement.arguments, strict=True)
            values = [form.evaluate(run, read) for form, read in given]
            return row.handler(run, *indices, *values)
        finally:
            run.prefix = outer

    # snapshot

    def restore(
        self, sources: Mapping[int, tuple[StoredLine, ...]], failures: Mapping[int, str]
    ) -> None:
        """Take over what threads execute; where they stand lies in the memory, restored before."""
        self.failures = dict(failures)
        self.sources = dict(sources)
        for thread in range(at.TH_COUNT):
            lines = self.sources.get(thread)
            if lines is None:
                self.space.chunks[thread], self._runs[thread] = Chunk(), None
            elif thread < PROGRAMS:
                self.space.chunks[thread] = _compiled(lines)
                self._runs[thread] = self._program_run(thread)
            elif thread >= KINEMATICS:
                self.space.chunks[thread] = _compiled(lines)
                self._runs[thread] = self._kinematics_run(thread - KINEMATICS)
            else:
                self.space.chunks[thread] = compile_line(lines[0].tree)
                self._runs[thread] = self._session_run(self._session(thread))
            self._check_thread(thread)
        self.space.rebuild()

    def _check_thread(self, thread: int) -> None:
        """LookupError unless a thread stands between two operations of what it executes."""
        state = self._row(thread, at.THI_STATE)
        is_marked = thread < KINEMATICS and self._is_marked(thread)
        if thread not in self.sources:
            if state != scheduler.THREAD_IDLE or is_marked:
                raise LookupError(f"thread {thread} executes nothing")
            return
        chunk = self.space.chunks[thread]
        code = set(chunk.begins) - set(range(chunk.lines_at, len(chunk.code)))
        stops = [
            self._row(thread, at.THI_FLOW_BACK + level)
            for level in range(self._row(thread, at.THI_DEPTH))
            if self._row(thread, at.THI_FLOW_KIND + level) == FLOW_GOSUB
        ]
        if thread < KINEMATICS or state != scheduler.THREAD_IDLE:
            stops.append(self._row(thread, at.THI_PC))
            if self._row(thread, at.THI_SP):
                raise LookupError(f"thread {thread} is in the middle of an expression")
        if not code.issuperset(stops):
            raise LookupError(f"thread {thread} is in the middle of an operation")
        self.space.show_lines(thread)

    def _session(self, thread: int) -> Session:
        found = [s for s in self.system.sessions.values() if s.thread == thread]
        if not found:
            raise LookupError(f"thread {thread} serves no channel")
        return found[0]


def _compiled(lines: tuple[StoredLine, ...]) -> Chunk:
    return compile_program([(line.number, line.tree) for line in lines])
