"""MDI: single blocks typed by the operator, with a modal state that stays."""

from __future__ import annotations

from collections.abc import Iterator

from openacr.cnc.canonical import Entry
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.supplied import add_labels, supplied_cycles
from openacr.cnc.program.labels import Part
from openacr.cnc.program.program import Node
from openacr.cnc.reading.blocks import Goto, If, Include
from openacr.cnc.reading.findings import BlockError, CodeError
from openacr.cnc.reading.parser import parse

FILE = "MDI"
_REFUSED = Goto | If | Include


class Mdi:
    """Runs lines on an interpreter whose program gives the labels of macros and subs."""

    def __init__(self, run: Interpreter) -> None:
        self._run = run
        self.text: list[str] = []  # the MDI text: accepted lines, while the buffer is on
        self.is_buffer_on = True
        self._add_cycles()

    def _add_cycles(self) -> None:
        """The supplied cycles are there without $I."""
        program = self._run.program
        if program.has_cycles:
            return
        part = Part(supplied_cycles(), program.main.labels, is_cycles=True)
        add_labels(part)
        program.parts.append(part)
        program.has_cycles = True

    def execute(self, line: str) -> Iterator[Entry]:
        """The entries of one block; an invalid one raises BlockError and changes nothing."""
        self.check(line)
        return self._executed(line)

    def _executed(self, line: str) -> Iterator[Entry]:
        yield from self._run.single(Node(self._part(), 1, line, 0))
        if self.is_buffer_on:
            self.text.append(line)

    def _part(self) -> Part:
        part = self._run.program.main
        return Part(type(part.text).of("", FILE), part.labels)

    def check(self, line: str, number: int = 1) -> None:
        """Refuse a line that cannot be read (BlockError); `number` is its place in the text."""
        try:
            block = parse(line, self._run.dialect.grammar)
            if isinstance(block.statement, _REFUSED):
                raise CodeError("E108", block.statement.column, hint="not in MDI")
            self._run.planner.plan(block)
        except CodeError as error:
            raise BlockError(error.at(FILE, number, line)) from None
