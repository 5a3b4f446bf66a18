"""Place the rungs of a PLC on a grid, as a screen draws them: contacts, wires, coils.

Everything is placed in columns and rows of the grid; an element takes one column. Wires and
elements belong to *nets*: what is connected without anything between. Net 0 is the left rail.
Power flows in the order of the elements from the net at their left to the net at their right,
so that a screen finds the nets that carry it in one pass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from msgspec import Struct

from openacr.plc import scan_cy as scan
from openacr.plc.instructions import Operand, output_flag
from openacr.plc.ladder import Element, Gate, Node, Parallel, Rung, Series, rungs
from openacr.plc.reader import PlcLine, Step

RAIL = 0  # the net of the left rail

KINDS = {
    scan.OP_NOT: "not",
    scan.OP_OUT: "coil",
    scan.OP_SET: "set",
    scan.OP_CLEAR: "clear",
    scan.OP_TIMER: "timer",
    scan.OP_COUNTER: "counter",
    scan.OP_LATCH: "latch",
}


class Symbol(Struct, frozen=True):
    """One element on the grid.

    `flag` is the flag it reads, writes or, of a timer, counter or latch, puts out; None for NOT.
    `number` is that of the timer, counter or latch. A counter and a latch reach from `row` to
    `reset_row`, where their second input is: what follows them has its power, as in the scan.
    """

    kind: str  # contact, or a value of KINDS
    text: str
    flag: int | None
    is_negated: bool
    number: int | None
    column: int
    row: int
    source: int
    sink: int
    reset: int | None = None
    reset_row: int | None = None


class Wire(Struct, frozen=True):
    """A straight wire between two points of the grid; columns count boundaries."""

    net: int
    column: int
    row: int
    to_column: int
    to_row: int


@dataclass(slots=True)
class Picture:
    """A rung on the grid."""

    line: int
    columns: int
    rows: int
    nets: int
    symbols: list[Symbol] = field(default_factory=list)
    wires: list[Wire] = field(default_factory=list)


def pictures(lines: Sequence[tuple[int, PlcLine]]) -> list[Picture]:
    """The rungs of a PLC, their outputs at the right rail; CardError where it cannot run."""
    found = list(rungs(lines))
    columns = max((_width(rung.present) for rung in found), default=0)
    return [_Placer(rung).placed(columns) for rung in found]


def _width(node: Node) -> int:
    if isinstance(node, Element):
        return 1
    if isinstance(node, Series):
        return sum(map(_width, node.parts))
    if isinstance(node, Parallel):
        return max(map(_width, node.branches))
    return 1 + max(_width(node.first), _width(node.reset))


def _height(node: Node) -> int:
    if isinstance(node, Element):
        return 1
    if isinstance(node, Series):
        return max(map(_height, node.parts))
    if isinstance(node, Parallel):
        return sum(map(_height, node.branches))
    return _height(node.first) + _height(node.reset)


class _Placer:
    """Places the elements of one rung."""

    def __init__(self, rung: Rung) -> None:
        self._rung = rung
        self._picture = Picture(rung.line, 0, _height(rung.present), 1)

    def placed(self, columns: int) -> Picture:
        """The rung between its rails, which are `columns` apart."""
        picture, node = self._picture, self._rung.present
        picture.columns = columns
        parts = list(node.parts) if isinstance(node, Series) else [node]
        outputs = _outputs_at_the_end(parts)
        at, net = 0, RAIL
        for part in parts[: len(parts) - outputs]:
            net = self._after(part, at, net)
            at += _width(part)
        self._wire(net, at, 0, columns - outputs, 0)
        for column, part in enumerate(parts[len(parts) - outputs :], columns - outputs):
            net = self._after(part, column, net)
        return picture

    def _net(self) -> int:
        self._picture.nets += 1
        return self._picture.nets - 1

    def _wire(self, net: int, column: int, row: int, to_column: int, to_row: int) -> None:
        if (column, row) != (to_column, to_row):
            self._picture.wires.append(Wire(net, column, row, to_column, to_row))

    def _after(self, node: Node, column: int, source: int) -> int:
        """Place a node in row 0; the net after it."""
        sink = self._net()
        self._place(node, column, 0, source, sink)
        return sink

    def _place(self, node: Node, column: int, row: int, source: int, sink: int) -> None:
        if isinstance(node, Element):
            self._picture.symbols.append(self._symbol(node.step, column, row, source, sink))
        elif isinstance(node, Series):
            for part in node.parts[:-1]:
                between = self._net()
                self._place(part, column, row, source, between)
                column, source = column + _width(part), between
            self._place(node.parts[-1], column, row, source, sink)
        elif isinstance(node, Parallel):
            self._branches(node, column, row, source, sink)
        else:
            self._gate(node, column, row, source, sink)

    def _branches(self, node: Parallel, column: int, row: int, source: int, sink: int) -> None:
        end = column + _width(node)
        last = row
        for branch in node.branches:
            last = row
            self._place(branch, column, row, source, sink)
            self._wire(sink, column + _width(branch), row, end, row)
            row += _height(branch)
        first = last - sum(map(_height, node.branches[:-1]))
        self._wire(source, column, first, column, last)
        self._wire(sink, end, first, end, last)

    def _gate(self, node: Gate, column: int, row: int, source: int, sink: int) -> None:
        end = column + _width(node) - 1
        reset_row = row + _height(node.first)
        first, reset = self._net(), self._net()
        for part, at, net in ((node.first, row, first), (node.reset, reset_row, reset)):
            self._place(part, column, at, source, net)
            self._wire(net, column + _width(part), at, end, at)
        self._wire(source, column, row, column, reset_row)
        self._picture.symbols.append(
            self._symbol(node.step, end, row, first, sink, reset=reset, reset_row=reset_row)
        )

    def _symbol(
        self,
        step: Step,
        column: int,
        row: int,
        source: int,
        sink: int,
        *,
        reset: int | None = None,
        reset_row: int | None = None,
    ) -> Symbol:
        row_of = step.instruction
        operation = (row_of.operation or 0) & ~scan.NEGATED
        is_object = row_of.operand not in (Operand.FLAG, Operand.NONE)
        flag = output_flag(row_of.operand, step.number) if is_object else step.number
        return Symbol(
            kind=KINDS.get(operation, "contact"),
            text=step.written,
            flag=None if row_of.operand is Operand.NONE else flag,
            is_negated=row_of.is_negated,
            number=step.number if is_object else None,
            column=column,
            row=row,
            source=source,
            sink=sink,
            reset=reset,
            reset_row=reset_row,
        )


def _outputs_at_the_end(parts: Sequence[Node]) -> int:
    """How many of the last parts are outputs of one column."""
    is_output = [isinstance(p, Element) and p.step.instruction.is_output for p in parts]
    return next((n for n, is_one in enumerate(reversed(is_output)) if not is_one), len(parts))
