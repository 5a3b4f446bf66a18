"""Turn trees into byte code of the VM.

A program is compiled as a whole when it is started: labels, line numbers and the levels
of IF, FOR and WHILE are tied together then, and what does not fit together is reported
with its line. A line typed at a prompt is compiled in the same way.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from openacr.basic.language.nodes import (
    Block,
    Expr,
    LineTree,
    Move,
    Statement,
)
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.assembly import CodePlace
from openacr.basic.vm.code import (
    BEGINS_LINE,
    CONDITIONS_SHIFT,
    IS_AFTER_THEN,
    IS_CONDITION,
    Chunk,
)
from openacr.basic.vm.expression_code import ExpressionEmitter
from openacr.basic.vm.levels import Level, Levels, unclosed
from openacr.messages import (
    DUPLICATE_LABEL,
    LABEL_NOT_FOUND,
    LINE_NOT_FOUND,
    Message,
)


@dataclass(slots=True, eq=False)
class CodeLevel(Level):
    """A level with the places of its code."""

    start: CodePlace = field(default_factory=CodePlace)
    stop: CodePlace = field(default_factory=CodePlace)
    next_branch: CodePlace | None = None
    data: Expr | None = None  # the variable of a FOR


def compile_program(lines: Iterable[tuple[int, LineTree]], *, is_followed: bool = False) -> Chunk:
    """The code of a whole program; CompileError if its structure is wrong.

    Followed or not, every operation is at the same place: one can go on where the other was.
    """
    emitter = Emitter(is_followed=is_followed)
    for number, line in lines:
        emitter.line(number, line)
    return emitter.finish()


def compile_line(line: LineTree) -> Chunk:
    """The code of a line typed at a prompt."""
    emitter = Emitter()
    emitter.blocks(line.blocks)
    return emitter.finish()


class Emitter(ExpressionEmitter):
    """Writes byte code; commands with `emit=` in their row use it."""

    def __init__(self, chunk: Chunk | None = None, *, is_followed: bool = False) -> None:
        super().__init__(chunk)
        self._is_followed = is_followed
        self.levels = Levels[CodeLevel]()
        self._labels: dict[str, CodePlace] = {}
        self._lines: dict[int, CodePlace] = {}
        self._marks = BEGINS_LINE  # of the next statement

    # lines and statements

    def line(self, number: int, line: LineTree) -> None:
        """One stored line."""
        self.line_number = number
        self._marks = BEGINS_LINE
        self.put(self._lines.setdefault(number, CodePlace()))
        self.chunk.starts[number] = len(self.chunk.code)
        if line.label is not None:
            place = self._labels.setdefault(line.label, CodePlace())
            if place.at >= 0:
                raise self.error(DUPLICATE_LABEL, line.label)
            self.put(place)
        self.blocks(line.blocks)

    def blocks(self, blocks: Iterable[Block]) -> None:
        """Blocks one after the other."""
        for block in blocks:
            for statement in block:
                self.statement(statement)

    def statement(self, statement: Statement | Move) -> None:
        """One statement: its own code, or a trap to the handler of its command."""
        self.begin_statement()
        if isinstance(statement, Move) or statement.command.emit is None:
            self.trap(statement)
        else:
            statement.command.emit(self, statement)

    def begin_statement(self) -> None:
        """Mark the beginning of a statement: slices, pauses and steps stop there."""
        self.op(vm.DO_STATEMENT, self.line_number, self._marks)
        self._marks &= -1 << CONDITIONS_SHIFT

    def mark_condition(self) -> None:
        """The statement that has just begun is an IF with THEN: mark it and what follows."""
        if self._is_followed:
            self.chunk.code[-1] |= IS_CONDITION
            self._marks += 1 << CONDITIONS_SHIFT
            self._marks |= IS_AFTER_THEN

    def trap(self, statement: Statement | Move) -> None:
        """Leave a statement to Python."""
        self.op(vm.DO_TRAP, len(self.chunk.statements))
        self.chunk.statements.append(statement)

    def finish(self) -> Chunk:
        """Tie up all loose ends; CompileError if a level is still open."""
        if self.levels.innermost is not None:
            raise unclosed(self.levels.innermost)
        self.op(vm.DO_END)
        for label, place in self._labels.items():
            if place.at < 0:
                self._fail_at(place, LABEL_NOT_FOUND, len(self.chunk.names))
                self.chunk.names.append(label)
        for number, place in self._lines.items():
            if place.at < 0:
                self._fail_at(place, LINE_NOT_FOUND, number)
        self._write_line_table()
        return self.chunk

    def _fail_at(self, place: CodePlace, message: Message, detail: int) -> None:
        self.put(place)
        self.op(vm.DO_FAIL, message.number, detail)

    def _write_line_table(self) -> None:
        self.chunk.lines_at = len(self.chunk.code)
        self.chunk.lines_count = len(self.chunk.starts)
        for number in sorted(self.chunk.starts):
            self.op(number, self.chunk.starts[number])

    # code

    def open(self, kind: int) -> CodeLevel:
        """Begin a level of IF, FOR or WHILE."""
        level = CodeLevel(kind, self.line_number)
        self.levels.enter(level)
        return level

    def label(self, name: str) -> CodePlace:
        """The place of a label."""
        return self._labels.setdefault(name, CodePlace())

    def numbered(self, line: int) -> CodePlace:
        """The place of a line."""
        return self._lines.setdefault(line, CodePlace())
