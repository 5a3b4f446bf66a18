"""Draw a PLC as a ladder of text.

        10 |--+--[0]--[/1]--+--(32)
           |  +--[2]--[3]---+

`[n]` is a contact, `[/n]` an inverted one, `(n)` an output, `(S n)` and `(R n)` set and clear
a flag. Outputs are drawn in series: the result continues after them, as in the text.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from msgspec import Struct

from openacr.plc import scan_cy as scan
from openacr.plc.compile import compile_plc
from openacr.plc.instructions import END, ENDP
from openacr.plc.reader import PlcLine, Step

LABEL_WIDTH = 6

_COILS = {scan.OP_OUT: "({})", scan.OP_SET: "(S {})", scan.OP_CLEAR: "(R {})"}
_GATE_INPUT = {scan.OP_COUNTER: "C", scan.OP_LATCH: "S"}


class Element(Struct, frozen=True):
    """One contact, output or box, and the instruction it was drawn from."""

    text: str
    step: Step


class Series(Struct, frozen=True):
    """Elements in series."""

    parts: tuple[Node, ...]


class Parallel(Struct, frozen=True):
    """Elements in parallel."""

    branches: tuple[Node, ...]


class Gate(Struct, frozen=True):
    """A box with two inputs: a counter or a latch."""

    text: str
    step: Step
    letter: str
    first: Node
    reset: Node


Node: TypeAlias = Element | Series | Parallel | Gate


@dataclass(slots=True)
class Rung:
    """One rung, from its left rail on; `saved` are blocks not yet connected."""

    line: int
    present: Node
    saved: list[Node]

    def add(self, step: Step) -> None:
        """Connect the element of an instruction to the rung."""
        operation = (step.instruction.operation or 0) & ~scan.NEGATED
        if operation == scan.OP_LOAD:
            self.saved.append(self.present)
            self.present = _contact(step)
        elif operation == scan.OP_OR:
            self.present = _parallel(self.present, _contact(step))
        elif operation == scan.OP_AND_BLOCK:
            self.present = _series(self.saved.pop(), self.present)
        elif operation == scan.OP_OR_BLOCK:
            self.present = _parallel(self.saved.pop(), self.present)
        elif operation in _GATE_INPUT:
            letter = _GATE_INPUT[operation]
            self.present = Gate(step.spelled, step, letter, self.saved.pop(), self.present)
        else:
            self.present = _series(self.present, _element(step))


def draw(lines: Sequence[tuple[int, PlcLine]]) -> Iterator[str]:
    """The rungs of a PLC; each begins with the number of its first line."""
    for rung in rungs(lines):
        label = f"{rung.line:>{LABEL_WIDTH}}"
        for row in _picture(rung.present):
            yield f"{label} |{row}".rstrip()
            label = " " * LABEL_WIDTH
        yield f"{label} |"


def rungs(lines: Sequence[tuple[int, PlcLine]]) -> Iterator[Rung]:
    """The rungs of a PLC as trees; PlcCompileError, or CardError where it is too long."""
    compile_plc(lines)
    rung: Rung | None = None
    has_output = False
    for number, step in _steps(lines):
        operation = (step.instruction.operation or 0) & ~scan.NEGATED
        if rung is not None and not (has_output and operation == scan.OP_LOAD):
            rung.add(step)
        else:
            if rung is not None:
                yield rung
            rung = Rung(number, _contact(step), [])
        has_output = step.instruction.is_output
    if rung is not None:
        yield rung


def _steps(lines: Iterable[tuple[int, PlcLine]]) -> Iterator[tuple[int, Step]]:
    """Everything that is scanned."""
    for number, line in lines:
        for step in line.steps:
            if step.instruction in (END, ENDP):
                return
            if step.instruction.operation is not None:
                yield number, step


def _contact(step: Step) -> Element:
    return Element(f"[{'/' * step.instruction.is_negated}{step.written}]", step)


def _element(step: Step) -> Element:
    operation = (step.instruction.operation or 0) & ~scan.NEGATED
    if operation == scan.OP_AND:
        return _contact(step)
    if operation in _COILS:
        slash = "/" * step.instruction.is_negated
        return Element(_COILS[operation].format(f"{slash}{step.written}"), step)
    return Element(f"[{step.spelled}]", step)


def _series(*nodes: Node) -> Series:
    parts: list[Node] = []
    for node in nodes:
        parts.extend(node.parts if isinstance(node, Series) else [node])
    return Series(tuple(parts))


def _parallel(*nodes: Node) -> Parallel:
    branches: list[Node] = []
    for node in nodes:
        branches.extend(node.branches if isinstance(node, Parallel) else [node])
    return Parallel(tuple(branches))


def _picture(node: Node) -> list[str]:
    """Rows of equal width; the current runs through the first one."""
    if isinstance(node, Element):
        return [f"--{node.text}"]
    if isinstance(node, Series):
        return _beside([_picture(part) for part in node.parts])
    if isinstance(node, Parallel):
        return _below([_picture(branch) for branch in node.branches])
    return _gate(node)


def _beside(pictures: list[list[str]]) -> list[str]:
    height = max(map(len, pictures))
    filled = [picture + [" " * len(picture[0])] * (height - len(picture)) for picture in pictures]
    return ["".join(rows) for rows in zip(*filled, strict=True)]


def _below(pictures: list[list[str]]) -> list[str]:
    width = max(len(picture[0]) for picture in pictures)
    rows: list[str] = []
    for place, picture in enumerate(pictures):
        side = "|" if place < len(pictures) - 1 else " "
        wire = "--" if not rows else "  "
        rows.append(f"{wire}+{picture[0].ljust(width, '-')}--+")
        rows += [f"  {side}{row.ljust(width)}  {side}" for row in picture[1:]]
    return rows


def _gate(node: Gate) -> list[str]:
    first, reset = _picture(node.first), _picture(node.reset)
    width = max(len(first[0]), len(reset[0]))
    blank = " " * (len(node.text) + 3)
    return [
        f"{first[0].ljust(width, '-')}--{node.letter}[{node.text}]",
        *(f"{row.ljust(width)}  {blank}" for row in first[1:]),
        f"{reset[0].ljust(width, '-')}--R[{' ' * len(node.text)}]",
        *(f"{row.ljust(width)}  {blank}" for row in reset[1:]),
    ]
