"""The texts of canned cycles as plans, for holes that are drilled many at a time (`cycles_cy`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.gcodes.cycles import TURNS, label_of
from openacr.cnc.interpreter.by_block.ready import acting
from openacr.cnc.interpreter.by_line.fast_plans import FIELDS, Notes, Steps, rich_plan
from openacr.cnc.interpreter.by_line.formula_code import FormulaWriter, NoCodeError
from openacr.cnc.reading import rich_cy as rich
from openacr.cnc.reading.blocks import Goto, If, Return, Statement
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import Number
from openacr.cnc.reading.line_shapes import LineShapes
from openacr.cnc.reading.parser import parse
from openacr.cnc.rows import plans, scans

if TYPE_CHECKING:
    from collections.abc import Callable

    from openacr.cnc.interpreter.by_block.inside import Inside
    from openacr.cnc.program.program import Node
    from openacr.cnc.reading.blocks import Block

MOST_LINES = 64
LETTERS = "XYZ"
_CYCLE_FIELDS = (FIELDS.index("motion"), FIELDS.index("cycle"))
_STEPS = (
    plans.STEP_SET,
    plans.STEP_FEED,
    plans.STEP_MOVE,
    plans.STEP_WORD,
    plans.STEP_VALUE,
    plans.STEP_STORE,
    plans.STEP_NOTE,
    plans.STEP_LIMIT,
    plans.STEP_GO,
    plans.STEP_RETURN,
)


class Strokes:
    """The cycles of one run; their numbers are kept after those of a line.

    `keep` takes the numbers of a plan and returns its place, 0 without room.
    """

    def __init__(self, run: Inside, notes: Notes, keep: Callable[[list[int]], int]) -> None:
        self._run = run
        self._numbers_end = scans.MOST_NUMBERS
        self._notes = notes
        self._keep = keep
        self._known: dict[int, int] = {}
        self.nodes: dict[int, Node] = {}  # of the lines, by where they begin

    def place(self, code: int) -> int:
        """The place of the text of a cycle among the plans; 0 where it has none."""
        if code not in self._known:
            try:
                self._known[code] = 0 if code in TURNS else self._written(code)
            except (CodeError, NoCodeError):
                self._known[code] = 0
        return self._known[code]

    def _written(self, code: int) -> int:
        run = self._run
        if not (run.program.has_cycles or run.dialect.has_own_cycles):
            return 0
        lines = self._lines(run.flow.find(label_of(run, code), run.program.cycles))
        places = {node.offset: k for k, (node, _) in enumerate(lines)}
        numbers = [len(lines)]
        for node, block in lines:
            plan = self._keep(self._plan(node, block, places))
            if not plan:
                return 0
            numbers += [plan, node.line, node.offset, node.after]
            self.nodes[node.offset] = node
        return self._keep(numbers)

    def _lines(self, start: Node) -> list[tuple[Node, Block]]:
        """The lines of a text up to its last return, without those that are empty."""
        grammar = self._run.language(start.part)[0].grammar
        found: list[tuple[Node, Block]] = []
        node: Node | None = start
        last = start.offset  # of the lines that are jumped to
        while node is not None and node.part is start.part and len(found) < MOST_LINES:
            block = parse(node.raw, grammar)
            if not block.is_empty:
                found.append((node, block))
            target = self._target(block.statement, node)
            last = max(last, target.offset if target else 0)
            if isinstance(block.statement, Return) and node.offset >= last:
                return found
            node = self._run.flow.next_after(node)
        raise NoCodeError

    def _target(self, statement: Statement | None, node: Node) -> Node | None:
        """Where a jump leads to."""
        if isinstance(statement, If):
            statement = statement.then
        match statement:
            case Goto(Number(number)):
                return self._run.flow.find(int(number), node.part)
            case _:
                return None

    def _plan(self, node: Node, block: Block, places: dict[int, int]) -> list[int]:
        run = self._run
        planner = run.language(node.part)[1]
        plan = planner.plan(block)
        jump = self._jump_of(node, places)
        writer = _CycleWriter(run.parameters, self._numbers_of(node))
        acts, notes = acting(plan, run), self._notes
        body = rich_plan(plan, acts, writer, notes, jump, assigns_last=False)
        if body is None or not _is_of_a_cycle(body):
            raise NoCodeError
        if plan.is_motion:
            if any(letter not in (*LETTERS, "F") for letter in plan.words):
                raise NoCodeError
            body[plans.AXES] = sum(1 << LETTERS.index(a) for _, a in plan.axes)
        return body

    def _numbers_of(self, node: Node) -> dict[int, tuple[int, float]]:
        """The numbers of a line by their place in it, kept with those of the cycles."""
        shapes = LineShapes({}, "(")
        text = bytearray(node.raw.encode("ascii", "replace") + b"\n")
        data = memoryview(text)
        if rich.scan_rich(data, 0, len(data), shapes.F, shapes.I) < 0:
            raise NoCodeError
        found = {}
        for at, (_, value) in shapes.numbers().items():
            if self._numbers_end == len(scans.number):
                raise NoCodeError
            self._run.memory.F[scans.number[self._numbers_end]] = value
            found[at] = self._numbers_end, value
            self._numbers_end += 1
        return found

    def _jump_of(
        self, node: Node, places: dict[int, int]
    ) -> Callable[[Statement, FormulaWriter, Steps], None]:
        """How the statements of a line become steps."""

        def jump(statement: Statement, writer: FormulaWriter, body: Steps) -> None:
            code: int | list[int] = 0
            if isinstance(statement, If):
                if statement.test is not None:
                    raise NoCodeError
                code, statement = writer.code(statement.condition), statement.then
            target = self._target(statement, node)
            if target is not None and target.offset in places:
                body.add(plans.STEP_GO, places[target.offset], code)
            elif isinstance(statement, Return):
                body.add(plans.STEP_RETURN, 0, code)
            else:
                raise NoCodeError

        return jump


class _CycleWriter(FormulaWriter):
    """Formulas of cycles: they have cells alone, no locals."""

    def store(self, kind: str) -> int:
        """How a parameter is assigned."""
        if kind != "P":
            raise NoCodeError
        return super().store(kind)

    def _parameter(self, n: int, *, is_hash: bool) -> tuple[int, int]:
        if is_hash:
            raise NoCodeError
        return super()._parameter(n, is_hash=is_hash)

    def _any(self, *, is_hash: bool) -> int:
        if is_hash:
            raise NoCodeError
        return super()._any(is_hash=is_hash)


def _is_of_a_cycle(body: list[int]) -> bool:
    """Whether the steps of a plan are those that the core executes at a hole."""
    last = plans.STEPS + 3 * body[plans.STEP_CNT]
    for at in range(plans.STEPS, last, 3):
        step, row = body[at : at + 2]
        if step not in _STEPS or (step == plans.STEP_SET and row not in _CYCLE_FIELDS):
            return False
    return True
