"""Turn the lines of a PLC into the code its scan works through."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from msgspec import Struct

from openacr.errors import CardError
from openacr.map.hidden.plc import INSTRUCTIONS
from openacr.messages import PLC_ERROR, PLC_TOO_LONG
from openacr.plc import scan_cy as scan
from openacr.plc.instructions import END, ENDP, Operand
from openacr.plc.reader import PlcLine, Step

DEEPEST = 16  # saved results


class PlcCompileError(CardError):
    """A PLC that cannot be scanned: `line` holds the instruction that is wrong."""

    def __init__(self, line: int, text: str) -> None:
        super().__init__(PLC_ERROR, f"{line}: {text}")
        self.line = line


class Preload(Struct, frozen=True):
    """A preload RUN writes to a timer or counter."""

    operand: Operand
    number: int
    value: int


@dataclass(slots=True)
class Compiled:
    """Code of one PLC: operation and operand of each instruction."""

    code: list[tuple[int, int]] = field(default_factory=list)
    preloads: list[Preload] = field(default_factory=list)

    @property
    def words(self) -> list[int]:
        """The instructions as the scan reads them."""
        return [operation | operand << scan.OPERAND_SHIFT for operation, operand in self.code]


def scanned(lines: Iterable[tuple[int, PlcLine]]) -> Iterator[tuple[int, Step, int]]:
    """The line number, text and operation of each instruction of a scan: all up to END."""
    for number, line in lines:
        for step in line.steps:
            if step.instruction in (END, ENDP):
                return
            if step.instruction.operation is not None:
                yield number, step, step.instruction.operation


def compile_plc(lines: Iterable[tuple[int, PlcLine]]) -> Compiled:
    """Check the lines (with their numbers) and compile them up to END."""
    compiler = _Compiler()
    for number, step, operation in scanned(lines):
        compiler.add(number, step, operation)
    return compiler.result


class _Compiler:
    """Follows the stack of saved results; rungs have no jumps, so its depth is known."""

    def __init__(self) -> None:
        self.result = Compiled()
        self.depth: int | None = None  # None: no rung has begun
        self.begins_rung = True

    def add(self, line: int, step: Step, operation: int) -> None:
        row = step.instruction
        if operation & ~scan.NEGATED == scan.OP_LOAD:
            operation = self._load(line, operation)
        else:
            self._use(line, row.takes)
        self.begins_rung = row.is_output
        self._emit(operation, step)

    def _load(self, line: int, operation: int) -> int:
        """LD saves the result before it, but not at the start of a rung."""
        if self.depth is None or self.begins_rung:
            self.depth = 0
            return operation + scan.OP_START - scan.OP_LOAD
        self.depth += 1
        if self.depth > DEEPEST:
            raise PlcCompileError(line, "Stack overflow")
        return operation

    def _use(self, line: int, takes: int) -> None:
        if self.depth is None:
            raise PlcCompileError(line, "LD expected")
        if self.depth < takes:
            raise PlcCompileError(line, "Stack underflow")
        self.depth -= takes

    def _emit(self, operation: int, step: Step) -> None:
        if len(self.result.code) >= INSTRUCTIONS:
            raise CardError(PLC_TOO_LONG)
        self.result.code.append((operation, step.number))
        if step.preload is not None:
            preload = Preload(step.instruction.operand, step.number, step.preload)
            self.result.preloads.append(preload)
