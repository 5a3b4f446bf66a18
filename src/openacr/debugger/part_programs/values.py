"""What a part program sees at a block: modal state, offsets, parameters, expressions."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext

from openacr.client.program_variables import Value
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.geometry.coordinates import Coordinates, system_base
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import axes_of
from openacr.cnc.program.program import Program
from openacr.cnc.reading.expressions import ExpressionReader
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.state.cells import (
    COMMON,
    FIXTURES,
    FLOATING,
    LENGTH,
    LENGTH_WEAR,
    LOCAL,
    RADIUS,
    RADIUS_WEAR,
)
from openacr.cnc.state.hosts import Cells, Home, VirtualMachine
from openacr.cnc.state.parameters import FIRST_STORED, LAST_STORED
from openacr.controller.controller import Controller
from openacr.debugger.part_programs.blocks import Block, BlockLog, NotedCells
from openacr.errors import OpenacrError, UserError

FIXTURE_CELLS = 10  # of each fixture


class CellsThen:
    """The cells of a program as they were at a block; writing changes nothing."""

    def __init__(self, noted: NotedCells, written_cnt: int) -> None:
        self._noted, self._written_cnt = noted, written_cnt

    def home(self, n: int) -> Home:
        """Where a number lives."""
        return self._noted.home(n)

    def read(self, n: int) -> float:
        """The number that was in a cell."""
        return self._noted.read_at(n, self._written_cnt)

    def write(self, n: int, value: float) -> None:
        """Do nothing."""

    def read_text(self, n: int) -> str:
        """The text in a cell."""
        return self._noted.read_text(n)

    def transaction(self, *, is_durable: bool = True) -> AbstractContextManager[None]:
        """Nothing is written inside."""
        return nullcontext()


class CardThen(VirtualMachine):
    """The card at the present moment of its timeline, read without a trace."""

    def __init__(self, card: Controller) -> None:
        super().__init__()
        self._card = card

    def read_parameter(self, n: int) -> float:
        """A parameter of the card."""
        return float(self._card.p[n])

    def read_bit(self, n: int) -> bool:
        """A flag of the card."""
        return bool(self._card.bit[n])


def value_of(
    expression: str,
    block: Block,
    noted: NotedCells,
    card: Controller,
    program: Program,
    dialect: str,
) -> float:
    """The value of an expression of the program before a block acts; UserError if it has none."""
    cells: Cells = CellsThen(noted, block.written_cnt)
    run = Interpreter(program, cells, CardThen(card), dialect)
    run.modal.restore(block.modal.copy())
    run.path.program = block.position
    run.parameters.values[:] = array("d", block.locals)
    run.parameters.names = run.parameters.global_names = dict(block.names)
    reader = ExpressionReader(expression, DIALECTS[dialect].grammar)
    try:
        formula = reader.expression()
        reader.blanks()
        if reader.pos < len(reader.text):
            raise reader.fault("E108")
        return formula.value(run.parameters)
    except CodeError as error:
        finding = error.at("", 1, expression)
        raise UserError(f"{expression}: {finding.code} {finding.text}") from None
    except (ArithmeticError, ValueError, OpenacrError) as error:
        raise UserError(f"{expression}: {error}") from None


def modal_values(block: Block) -> Iterator[Value]:
    """The codes and words in force before a block acts; the feed in default units/min."""
    modal = block.modal
    yield Value("block", block.text)
    yield Value("codes", " ".join(modal.codes))
    yield Value("plane", f"G{modal.plane} {modal.plane_axes.name}")
    for name, number in (("F", modal.feed), ("S", modal.speed)):
        yield Value(name, f"{number:.9g}")
    for name, number in (
        ("T", modal.tool), ("tool in spindle", modal.tool_in_spindle),
        ("D", modal.radius_number), ("H", modal.length_number),
    ):  # fmt: skip
        yield Value(name, f"{number}")
    yield Value("spindle", modal.spin.name.lower().replace("_", " "))
    on = [name for name, is_on in (("mist", modal.mist), ("flood", modal.flood)) if is_on]
    yield Value("coolant", " and ".join(on) or "off")


def offset_values(block: Block, noted: NotedCells) -> Iterator[Value]:
    """What shifts the program before a block acts, by axis in default units, and its sum."""
    cells, modal = CellsThen(noted, block.written_cnt), block.modal
    letters = axes_of(cells)
    coordinates = Coordinates(cells, letters)
    coordinates.refresh(modal)
    yield _vector("all together", list(coordinates.shift), letters)
    parts = [(modal.work_code, system_base(modal.work))] if modal.work else []
    parts += [("common", COMMON), ("local (G52)", LOCAL), ("floating zero", FLOATING)]
    if modal.fixture:
        parts.append((f"fixture {modal.fixture}", FIXTURES + FIXTURE_CELLS * modal.fixture))
    for name, base in parts:
        yield _vector(
            name, [cells.read(base + axis) for axis in range(len(coordinates.shift))], letters
        )
    for name, cell, wear in (
        ("tool length", LENGTH, LENGTH_WEAR), ("tool radius", RADIUS, RADIUS_WEAR)
    ):  # fmt: skip
        yield Value(name, f"{cells.read(cell) + cells.read(wear):.9g}")


def _vector(name: str, values: list[float], letters: dict[str, int]) -> Value:
    elements = tuple(Value(letter, f"{values[axis]:.9g}") for letter, axis in letters.items())
    return Value(name, " ".join(f"{each.name}{each.text}" for each in elements), elements)


def position_values(block: Block, cells: Cells) -> Iterator[Value]:
    """Where the program is before a block acts, by axis in default units."""
    yield _vector("program position", list(block.position), axes_of(cells))


def parameter_values(block: Block, log: BlockLog) -> Iterator[Value]:
    """Locals, named parameters, and what the program has written or will have written."""
    if block.locals[0]:
        for number, value in enumerate(block.locals[1:], 1):
            yield Value(f"#{number}", f"{value:.9g}")
    for name, value in sorted(block.names.items()):
        yield Value(f"#<{name}>", f"{value:.9g}")
    for n in log.noted.written_since(log.begin_cnt):
        if FIRST_STORED <= n <= LAST_STORED:
            yield Value(f"P{n}", f"{log.noted.read_at(n, block.written_cnt):.9g}")
