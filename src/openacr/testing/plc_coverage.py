"""Which contacts and outputs of PLCs were on and off.

A PLC is no sequence of lines: all instructions up to END are in each scan. So a line is scanned or
not, and its decisions are those of the ladder: each contact was on, or off; each output had power,
or none. The scans note that in the words of the code.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import islice

from openacr.basic.memory.program_memory import PROGRAMS
from openacr.controller import Controller
from openacr.errors import CardError
from openacr.map.rows import plcs
from openacr.plc import scan_cy as scan
from openacr.plc.compile import compile_plc, scanned
from openacr.plc.reader import PlcLine, Step
from openacr.testing.covered_lines import Contact, Line, Place

_BLOCKS = (scan.OP_AND_BLOCK, scan.OP_OR_BLOCK, scan.OP_NOT)  # neither contact nor output
_INPUTS = {scan.OP_COUNTER: ("clock", "reset"), scan.OP_LATCH: ("set", "reset")}
# Of the last input, or the contact itself, and of the one before it: it was on, it was off.
_MARKS = ((scan.SEEN_ON, scan.SEEN_OFF), (scan.FIRST_SEEN_ON, scan.FIRST_SEEN_OFF))
_Text = list[tuple[int, PlcLine]]


def plc_line(line: PlcLine) -> Line | None:
    """A line of a PLC to be covered; None for remarks, END, PBOOT and frames."""
    if all(step.instruction.operation is None for step in line.steps):
        return None
    return Line(contacts=tuple(Contact(name) for step in line.steps for name in _names(step)))


def _names(step: Step) -> list[str]:
    """The contact or output of an instruction; both inputs of a counter or latch."""
    operation = step.instruction.operation
    if operation is None or operation in _BLOCKS:
        return []
    if operation in _INPUTS:
        return [f"{step.spelled} ({name})" for name in _INPUTS[operation]]
    return [step.spelled]


class PlcNotes:
    """What the scans of the PLCs of a card note, added to the lines of their files."""

    def __init__(self, card: Controller, lines: Mapping[Place, Line]) -> None:
        self._card, self._lines = card, lines
        self._code: dict[int, list[tuple[Line, list[Contact]]]] = {}  # of each PLC, by instruction
        for plc in range(plcs.COUNT):
            card.plcs.note(plc, True)
            self._learn(plc, is_run_next=False)

    def code_changes(self, plc: int) -> None:
        """Take the notes before RUN compiles the text that a PLC has now."""
        self._collect(plc)
        self._card.plcs.note(plc, True)
        self._learn(plc, is_run_next=True)

    def end(self) -> None:
        """Take the notes of all PLCs; their scans note nothing from now on."""
        for plc in range(plcs.COUNT):
            self._collect(plc)
            self._card.plcs.note(plc, False)

    def _learn(self, plc: int, *, is_run_next: bool) -> None:
        """Find the lines of the instructions, if the text is that of the code."""
        stored = self._card.system.programs.lines(PROGRAMS + plc)
        text = [(line.number, line.tree) for line in stored]
        with suppress(CardError):  # what cannot be compiled does not replace the code
            words = compile_plc(text).words
            if is_run_next or words == self._card.plcs.code(plc):
                self._code[plc] = list(self._instructions(plc, text))

    def _instructions(self, plc: int, text: _Text) -> Iterator[tuple[Line, list[Contact]]]:
        """The line of each instruction, and its contact, or the inputs of its output."""
        lines = {number: self._line(plc, number) for number, _ in text}
        contacts = {number: iter(line.contacts) for number, line in lines.items()}
        for number, step, _ in scanned(text):
            yield lines[number], list(islice(contacts[number], len(_names(step))))

    def _line(self, plc: int, number: int) -> Line:
        """A line of a file, or one that was typed and is in no report."""
        place = self._card.origin(PROGRAMS + plc, number)
        known = self._lines.get(place) if place is not None else None
        return known or Line()

    def _collect(self, plc: int) -> None:
        """Add what the scans have noted since the notes were begun."""
        for (line, contacts), seen in zip(
            self._code.get(plc, ()), self._card.plcs.seen(plc), strict=False
        ):
            line.count |= seen > 0
            for contact, (on, off) in zip(reversed(contacts), _MARKS, strict=False):
                contact.on |= bool(seen & on)
                contact.off |= bool(seen & off)
