"""Plans of blocks as numbers for `blocks_cy`, made once for each shape of lines."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from openacr.cnc.canonical import AXIS_LETTERS
from openacr.cnc.codes.fast import Does, Sets
from openacr.cnc.interpreter import blocks_cy as core
from openacr.cnc.interpreter.formula_code import FormulaWriter, NoCodeError
from openacr.cnc.interpreter.values_cy import MOST_VALUES
from openacr.cnc.reading.blocks import Assignment, Block, Goto, If, OWord, Statement
from openacr.cnc.reading.formulas import Call, Node, Number, Parameter
from openacr.cnc.reading.functions import EQUAL
from openacr.cnc.reading.statement_reader import INPUTS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from openacr.cnc.codes.block_plan import Plan
    from openacr.cnc.codes.table import Code

FIELDS = ("motion", "plane", "distance", "centres", "unit", "return_level", "path")
ARC_WORDS = "IJKR"
STRAIGHT = 1
_KNOWN_WORDS = frozenset(AXIS_LETTERS + ARC_WORDS + "F")
_LOOPS = core.JUMP_COUNTS
# O-words that may jump, as far as the line alone says where to.
_BRANCHES = {"ENDWHILE": _LOOPS, "WHILE": 0, "IF": 0, "ELSE": 0}


@dataclass(slots=True)
class _Steps:
    """Steps of a plan, and the code of formulas after them."""

    steps: list[tuple[int, int, int | list[int]]] = field(default_factory=list)

    def add(self, step: int, first: int = 0, second: int | list[int] = 0) -> None:
        """Add a step; `second` is a number, or the code of a formula."""
        self.steps.append((step, first, second))

    def numbers(self) -> list[int]:
        """The steps, then the code: a formula is named by its place in the plan."""
        written: list[int] = []
        code: list[int] = []
        begin = core.P_FIRST + 3 * len(self.steps)
        for step, first, second in self.steps:
            if isinstance(second, list):
                written += (step, first, begin + len(code))
                code += second
            else:
                written += (step, first, second)
        return written + code


def fast_plan(plan: Plan, acts: Iterable[Code]) -> list[int] | None:
    """The numbers of a plan of words with numbers; None where a code or a word has no fast form."""
    return _planned(plan, acts, _Steps(), has_values=False)


def rich_plan(
    plan: Plan,
    acts: Iterable[Code],
    writer: FormulaWriter,
    branches: Callable[[OWord], bool],
    *,
    assigns_last: bool,
) -> list[int] | None:
    """The numbers of a plan with formulas, assignments or a jump; None where one has no fast form.

    `branches` says whether an O-word only jumps to where the line alone decides.
    """
    block, body = plan.block, _Steps()
    if block.messages or block.is_skippable or block.is_percent or block.title:
        return None
    try:
        if not assigns_last:
            _each(block, writer, body)
        for letter, word in plan.words.items():
            if word.parameter is not None:
                return None
            body.add(core.STEP_WORD, ord(letter) - ord("A"), writer.code(word.value))
        if assigns_last:
            _together(block, writer, body)
        if block.statement is not None:
            _jump(block.statement, writer, body, branches)
    except NoCodeError:
        return None
    return _planned(plan, acts, body, has_values=True)


def _planned(
    plan: Plan, acts: Iterable[Code], body: _Steps, *, has_values: bool
) -> list[int] | None:
    if plan.is_computed or not _KNOWN_WORDS.issuperset(plan.words):
        return None
    is_plain, is_alone = not any(letter in plan.words for letter in ARC_WORDS), False
    for code in acts:
        form = code.fast
        match form:
            case Does.NOTHING:
                is_plain = is_plain and code.letter == "MACRO"
            case Does.TAKES_FEED:
                body.add(core.STEP_FEED)
            case Does.MOVES:
                body.add(core.STEP_MOVE)
            case Sets(name, value, alone) if name in FIELDS:
                number = int(code.number) if value is None else value
                kind = core.STEP_UNIT if name == "unit" else core.STEP_SET
                body.add(kind, FIELDS.index(name), number)
                is_plain = is_plain and (name, number) == ("motion", STRAIGHT)
                is_alone = is_alone or alone
            case _:
                return None
    axes = sum(1 << axis for axis, _ in plan.axes)
    words = sum(1 << k for k, letter in enumerate(ARC_WORDS) if letter in plan.words)
    head = [axes, words, is_plain and not has_values, is_alone, len(body.steps)]
    return head + body.numbers()


def _value(one: Assignment, slot: int, writer: FormulaWriter, body: _Steps) -> None:
    if isinstance(one.index, str) or slot + 1 >= MOST_VALUES:
        raise NoCodeError
    body.add(core.STEP_VALUE, slot, writer.target(one.index))
    body.add(core.STEP_VALUE, slot + 1, writer.code(one.value))


def _each(block: Block, writer: FormulaWriter, body: _Steps) -> None:
    """Assignments one after another; with computed numbers of parameters they wait for rest."""
    for one in block.assignments:
        _value(one, 0, writer, body)
        body.add(core.STEP_STORE, writer.store(one.kind), 0)
    if len(block.assignments) > MOST_VALUES or writer.is_computed:
        raise NoCodeError


def _together(block: Block, writer: FormulaWriter, body: _Steps) -> None:
    """Assignments with the values from before the block."""
    for k, one in enumerate(block.assignments):
        _value(one, 2 * k, writer, body)
    for k, one in enumerate(block.assignments):
        body.add(core.STEP_STORE, writer.store(one.kind), 2 * k)


def _may_test_input(condition: Node, writer: FormulaWriter) -> bool:
    """Whether a condition is `#n = number`, which may ask for input n: its numbers decide that."""
    match condition:
        case Call(function, (Parameter(Number() as index, True), Number())):
            is_input = index.number < INPUTS or not writer.is_of_the_shape(index)
            return function == EQUAL and is_input
        case _:
            return False


def _jump(
    statement: Statement, writer: FormulaWriter, body: _Steps, branches: Callable[[OWord], bool]
) -> None:
    """A jump to a place that is always the same, with its condition."""
    match statement:
        case Goto(Number()):
            body.add(core.STEP_JUMP, core.JUMP_COUNTS)
        case If(condition, Goto(Number())) if not _may_test_input(condition, writer):
            how = core.JUMP_COUNTS | core.JUMP_IF_TRUE
            body.add(core.STEP_JUMP, how, writer.code(condition))
        case OWord(_, "ENDIF") if branches(statement):
            pass
        case OWord(_, kind, values) if kind in _BRANCHES and branches(statement):
            code: int | list[int] = writer.code(values[0]) if values else 0
            body.add(core.STEP_JUMP, _BRANCHES[kind], code)
        case _:
            raise NoCodeError
