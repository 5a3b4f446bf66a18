"""Plans of blocks as numbers for `blocks_cy`, made once for each shape of lines."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from msgspec import Struct, field

from openacr.cnc.canonical import AXES
from openacr.cnc.codes.fast import Does, Fast, Sets
from openacr.cnc.interpreter.by_line.formula_code import FormulaWriter, NoCodeError
from openacr.cnc.reading.blocks import Assignment, Block, Goto, If, OWord, Statement
from openacr.cnc.reading.formulas import Call, Node, Number, Parameter
from openacr.cnc.reading.functions import EQUAL
from openacr.cnc.reading.statements import INPUTS
from openacr.cnc.rows import plans, values

if TYPE_CHECKING:
    from collections.abc import Iterable

    from openacr.cnc.codes.block_plan import Plan
    from openacr.cnc.codes.table import Code, Limit

FIELDS = "motion plane distance centres unit return_level path cycle compensation".split()
MOTION_WORDS = "IJKRQPL"  # of arcs and cycles
STRAIGHT = 1
_SET_STEPS = {
    "unit": plans.STEP_UNIT,
    "path": plans.STEP_ALONE,
    "compensation": plans.STEP_KEEP,
}
_NOTE_STEPS = {
    Does.RESTS: plans.STEP_NOTE,
    Does.SHOWS: plans.STEP_SHOW,
    Does.TURNS: plans.STEP_TURN,
}
_LOOPS = plans.JUMP_COUNTS
# O-words that may jump, as far as the line alone says where to.
_BRANCHES = {"ENDWHILE": _LOOPS, "WHILE": 0, "IF": 0, "ELSE": 0}


class Notes:
    """Codes whose handlers are called between moves, and limits of words, of all plans of a run."""

    def __init__(self, limits: Callable[[int, Limit], None]) -> None:
        self.codes: list[tuple[Plan, Code]] = []
        self._limits: list[Limit] = []
        self._write = limits

    def add(self, plan: Plan, code: Code) -> int:
        """The number of a code of a plan."""
        self.codes.append((plan, code))
        return len(self.codes) - 1

    def limit(self, limit: Limit) -> int:
        """The number of a limit; NoCodeError without room."""
        if limit not in self._limits:
            if len(self._limits) == plans.MOST_LIMITS:
                raise NoCodeError
            self._limits.append(limit)
            self._write(len(self._limits) - 1, limit)
        return self._limits.index(limit)


class Steps(Struct):
    """Steps of a plan, and the code of formulas after them."""

    steps: list[tuple[int, int, int | list[int]]] = field(default_factory=list)

    def add(self, step: int, first: int = 0, second: int | list[int] = 0) -> None:
        """Add a step; `second` is a number, or the code of a formula."""
        self.steps.append((step, first, second))

    def numbers(self) -> list[int]:
        """The steps, then the code: a formula is named by its place in the plan."""
        written: list[int] = []
        code: list[int] = []
        begin = plans.STEPS + 3 * len(self.steps)
        for step, first, second in self.steps:
            if isinstance(second, list):
                written += (step, first, begin + len(code))
                code += second
            else:
                written += (step, first, second)
        return written + code


Jumping = Callable[["Statement", FormulaWriter, Steps], None]


def fast_plan(plan: Plan, acts: Iterable[Code], notes: Notes) -> list[int] | None:
    """The numbers of a plan of words with numbers; None where a code or a word has no fast form."""
    try:
        return _planned(plan, acts, Steps(), notes, has_values=False)
    except NoCodeError:
        return None


def rich_plan(
    plan: Plan,
    acts: Iterable[Code],
    writer: FormulaWriter,
    notes: Notes,
    jump: Jumping,
    *,
    assigns_last: bool,
) -> list[int] | None:
    """The numbers of a plan with formulas, assignments or a jump; None where one has no fast form.

    `jump` adds the steps of a statement.
    """
    block, body = plan.block, Steps()
    if block.messages or block.is_skippable or block.is_percent or block.title:
        return None
    try:
        if not assigns_last:
            _each(block, writer, body)
        for letter, word in plan.words.items():
            body.add(plans.STEP_WORD, _letter(letter), writer.code(word.value))
        if assigns_last:
            _together(block, writer, body)
        if block.statement is not None:
            jump(block.statement, writer, body)
        return _planned(plan, acts, body, notes, has_values=True)
    except NoCodeError:
        return None


def _letter(letter: str) -> int:
    return ord(letter) - ord("A")


def _planned(
    plan: Plan, acts: Iterable[Code], body: Steps, notes: Notes, *, has_values: bool
) -> list[int]:
    """The numbers of a plan; NoCodeError where a code has no fast form."""
    if plan.is_computed or plan.is_polar or any(word.parameter for word in plan.words.values()):
        raise NoCodeError
    acts = tuple(acts)
    for code in acts:
        for limit in code.limits:
            if limit.letter in plan.words:
                body.add(plans.STEP_LIMIT, _letter(limit.letter), notes.limit(limit))
    has_feed = False
    for code in acts:
        for form in code.fast or (None,):
            if isinstance(form, Sets) and form.field == "unit" and has_feed:
                # Only the handler warns where the unit changes after F of its block was read.
                value = int(code.number) if form.value is None else form.value
                body.add(plans.STEP_KEEP, FIELDS.index("unit"), value)
            elif form is Does.SHIFTS and has_values:
                raise NoCodeError  # it may read what the block assigns
            else:
                _act(form, code, plan, body, notes)
            has_feed |= form is Does.TAKES_FEED
    if len(body.steps) > plans.MOST_STEPS:
        raise NoCodeError
    axes = sum(1 << axis for axis, _ in plan.axes)
    taken = {each for code in acts if code.fast != (Does.DRILLS,) for each in code.takes}
    free = [letter for letter in plan.words if letter not in taken]
    words = sum(1 << k for k, letter in enumerate(MOTION_WORDS) if letter in free)
    is_plain = not (has_values or words) and _is_plain(acts)
    return [axes, words, is_plain, len(body.steps), *body.numbers()]


def _is_plain(acts: tuple[Code, ...]) -> bool:
    """Whether codes are straight feed moves and what belongs to them."""
    return all(
        code.letter in ("F", "MOTION", "MACRO") or (code.letter, code.number) == ("G", STRAIGHT)
        for code in acts
    )


def _act(form: Fast | None, code: Code, plan: Plan, body: Steps, notes: Notes) -> None:
    """The steps of a fast form of a code."""
    match form:
        case Does.NOTHING:
            pass
        case Does.TAKES_FEED:
            body.add(plans.STEP_FEED)
        case Does.MOVES:
            body.add(plans.STEP_MOVE)
        case Does.DRILLS:
            body.add(plans.STEP_DRILL, int(code.number))
        case Does.ENDS_CYCLE:
            body.add(plans.STEP_END_CYCLE)
        case Does.RESTS | Does.SHOWS | Does.TURNS if len(plan.words) <= AXES:
            letters = [_letter(letter) for letter in plan.words]
            body.add(_NOTE_STEPS[form], notes.add(plan, code), [len(letters), *letters])
        case Does.SHIFTS if all(letter in plan.words for letter in code.takes):
            body.add(plans.STEP_CALL, notes.add(plan, code))
        case Sets(name, value) if name in FIELDS:
            kind = plans.STEP_BAR if form.is_barred else _SET_STEPS.get(name, plans.STEP_SET)
            body.add(kind, FIELDS.index(name), int(code.number) if value is None else value)
        case _:
            raise NoCodeError


def _value(one: Assignment, slot: int, writer: FormulaWriter, body: Steps) -> None:
    if isinstance(one.index, str) or slot + 1 >= values.MOST_VALUES:
        raise NoCodeError
    body.add(plans.STEP_VALUE, slot, writer.target(one.index))
    body.add(plans.STEP_VALUE, slot + 1, writer.code(one.value))


def _each(block: Block, writer: FormulaWriter, body: Steps) -> None:
    """Assignments one after another; with computed numbers of parameters they wait for rest."""
    for one in block.assignments:
        _value(one, 0, writer, body)
        body.add(plans.STEP_STORE, writer.store(one.kind), 0)
    if len(block.assignments) > values.MOST_VALUES or writer.is_computed:
        raise NoCodeError


def _together(block: Block, writer: FormulaWriter, body: Steps) -> None:
    """Assignments with the values from before the block."""
    for k, one in enumerate(block.assignments):
        _value(one, 2 * k, writer, body)
    for k, one in enumerate(block.assignments):
        body.add(plans.STEP_STORE, writer.store(one.kind), 2 * k)


def _may_test_input(condition: Node, writer: FormulaWriter) -> bool:
    """Whether a condition is `#n = number`, which may ask for input n: its numbers decide that."""
    match condition:
        case Call(function, (Parameter(Number() as index, True), Number())):
            is_input = index.number < INPUTS or not writer.is_of_the_shape(index)
            return function == EQUAL and is_input
        case _:
            return False


def jump(
    statement: Statement, writer: FormulaWriter, body: Steps, branches: Callable[[OWord], bool]
) -> None:
    """A jump to a place that is always the same, with its condition.

    `branches` says whether an O-word only jumps to where the line alone decides.
    """
    match statement:
        case Goto(Number()):
            body.add(plans.STEP_JUMP, plans.JUMP_COUNTS)
        case If(condition, Goto(Number())) if not _may_test_input(condition, writer):
            how = plans.JUMP_COUNTS | plans.JUMP_IF_TRUE
            body.add(plans.STEP_JUMP, how, writer.code(condition))
        case OWord(_, "ENDIF") if branches(statement):
            pass
        case OWord(_, kind, values) if kind in _BRANCHES and branches(statement):
            code: int | list[int] = writer.code(values[0]) if values else 0
            body.add(plans.STEP_JUMP, _BRANCHES[kind], code)
        case _:
            raise NoCodeError
