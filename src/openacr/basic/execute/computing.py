"""Values of expressions for handlers: the VM computes them in the middle of a statement."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from openacr.basic.execute.evaluate import Operands
from openacr.basic.execute.performing import perform
from openacr.basic.execute.threads import Threads
from openacr.basic.language.nodes import Expr, Statement, is_text, resolved
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.compiler import Emitter
from openacr.basic.vm.run import Run, Wait
from openacr.basic.vm.vm_cy import vm_run
from openacr.compiled import pick
from openacr.map.rows import threads as thread_rows

WHOLE_LINE = 255  # no line holds more statements


class Computing:
    """Computes and stores with the variables of a thread, for handlers of commands."""

    def __init__(self, threads: Threads) -> None:
        self.threads = threads
        self.operands = Operands(threads, self.value)
        self._vm_run = pick(vm_run)

    def value(self, thread: int, node: Expr) -> float:
        """The number of an expression, computed by the VM with the variables of the thread."""
        chunk = self.threads.space.chunks[thread]
        known = chunk.computed.get(id(node))
        if known is None:
            known = node, self._append(thread, lambda e: e.expression(node))
            chunk.computed[id(node)] = known
        return self._compute(thread, known[1])

    def text(self, thread: int, node: Expr) -> str:
        """The string of an expression."""
        return self.operands.text(thread, node)

    def execute(self, run: Run, statement: Statement) -> Wait | None:
        """Execute one command for a handler that contains it."""
        return perform(run, statement)

    def assign(self, thread: int, target: Expr, value: float | str) -> None:
        """Store into a variable, parameter, flag or array element."""
        if isinstance(value, str) or is_text(target):
            self.operands.assign_text(thread, resolved(target), str(value))
            return

        def store(e: Emitter) -> None:
            e.store(target, lambda: e.push(value))
            e.push(0)

        chunk = self.threads.space.chunks[thread]
        code, nums = len(chunk.code), len(chunk.nums)
        start = self._append(thread, store)
        try:
            self._compute(thread, start)
        finally:
            del chunk.code[code:], chunk.nums[nums:]
            while chunk.begins and chunk.begins[-1] >= code:
                chunk.begins.pop()

    def _append(self, thread: int, build: Callable[[Emitter], None]) -> int:
        """Compile something more into the chunk of a thread; where it begins."""
        chunk = self.threads.space.chunks[thread]
        code, nums = len(chunk.code), len(chunk.nums)
        emitter = Emitter(chunk)
        build(emitter)
        emitter.op(vm.DO_RESULT)
        self.threads.space.refresh(thread, code, nums)
        return code

    def _compute(self, thread: int, start: int) -> float:
        with self._aside(thread):
            self.threads.set_row(thread, thread_rows.pc, start)
            event, clock = vm.VM_CALL, self.threads.clock
            while event == vm.VM_CALL:
                event = self._vm_run(*self.threads.views(), thread, WHOLE_LINE, clock.tick)
                if event == vm.VM_CALL:
                    self.push_operand(thread)
            if event == vm.VM_ERROR:
                raise self.threads.error(thread)
        return self.threads.memory.F[thread_rows.result[thread]]

    @contextmanager
    def _aside(self, thread: int) -> Iterator[None]:
        """Let the VM compute something in the middle of a statement."""
        rows = thread_rows.pc, thread_rows.sp, thread_rows.budget, thread_rows.trap
        kept = [self.threads.row(thread, row) for row in rows]
        try:
            yield
        finally:
            for row, value in zip(rows, kept, strict=True):
                self.threads.set_row(thread, row, value)

    def push_operand(self, thread: int) -> None:
        """Compute the operand the VM has stopped at, and go on after it."""
        node = self.threads.space.chunks[thread].operands[
            self.threads.row(thread, thread_rows.trap)
        ]
        value = self.operands.number(thread, node)
        depth = self.threads.row(thread, thread_rows.sp)
        self.threads.memory.F[thread_rows.stack[thread] + depth] = value
        self.threads.set_row(thread, thread_rows.sp, depth + 1)
        self.threads.set_row(thread, thread_rows.pc, self.threads.row(thread, thread_rows.pc) + 2)
