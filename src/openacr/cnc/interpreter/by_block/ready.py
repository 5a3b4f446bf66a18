"""A block made ready to run: its plan, with formulas bound to where their operands come from."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from msgspec.structs import replace

from openacr.cnc.canonical import Entry, Output, SetBit
from openacr.cnc.codes.block_plan import Plan
from openacr.cnc.codes.table import Code, check_limit
from openacr.cnc.interpreter.by_block.inside import Act, Assign, Inside, Quick, Ready
from openacr.cnc.interpreter.by_block.statements import statement_of
from openacr.cnc.reading.blocks import Assignment, Block, Input, OWord, Print
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import HOT, Formula, Number, names_for
from openacr.cnc.reading.parser import parse
from openacr.cnc.state.parameters import NotAtRestError, Parameters, number

if TYPE_CHECKING:
    from openacr.cnc.program.program import Node


def ready(node: Node, run: Inside) -> Ready:
    """Read and plan the line of a node."""
    block = parse(node.raw, run.language(node.part)[0].grammar)
    return _prepared(block if not block.is_percent else Block(), node, run)


def _prepared(block: Block, node: Node, run: Inside) -> Ready:
    dialect, planner = run.language(node.part)
    plan = planner.plan(block)
    if plan.is_computed:
        return Ready(plan, False, (), (), _computed(block, run), (), (), (), None, None, False)
    assigns = tuple(_assign(one, run) for one in block.assignments)
    late: tuple[Assign, ...] = ()
    if dialect.assigns_last:
        assigns, late = (), _together(block.assignments, run)
    statement = statement_of(block.statement, run, node) if block.statement else None
    values: tuple[tuple[str, Formula], ...] = ()
    if plan.numbers is None:
        transfers = any(code.letter == "T#" for code in plan.acts)
        values = tuple(
            (letter, Formula(word.value, run.parameters))
            for letter, word in plan.words.items()
            if word.parameter is None or not transfers
        )
    acts = acting(plan, run)
    limits = tuple(limit for code in plan.acts for limit in code.limits) if values else ()
    beside = block.messages or late
    quick: Quick | None = None
    if statement is not None and not isinstance(block.statement, Input | OWord) and not beside:
        quick = _Statement(statement)
    elif _are_quick(block) and assigns and not (beside or statement):
        quick = _Quick(block.assignments, assigns, run.parameters)
    is_plain = bool(block.words) and not (assigns or beside or statement)
    is_bare = not (block.is_skippable or isinstance(block.statement, Print))
    return Ready(
        plan,
        block.is_empty,
        assigns,
        late,
        statement,
        values,
        limits,
        acts,
        quick,
        quick if is_bare else None,
        is_plain,
    )


def acting(plan: Plan, run: Inside) -> tuple[Code, ...]:
    """The codes of a block that act: in DRY RUN not all do."""
    return tuple(code for code in plan.acts if code.acts_dry or not run.options.is_dry)


def _computed(block: Block, run: Inside) -> Act:
    """A block with codes that are formulas: made ready again each time, with their values."""
    formulas = {
        k: Formula(word.value, run.parameters)
        for k, word in enumerate(block.words)
        if word.letter in "GM" and not isinstance(word.value, Number)
    }

    def act(node: Node) -> Iterator[Entry]:
        words = list(block.words)
        for k, formula in formulas.items():
            words[k] = replace(words[k], value=Number(formula.now()))
        known = replace(block, words=words, messages=[])
        return run.execution.execute(node, _prepared(known, node, run))

    return act


def _are_quick(block: Block) -> bool:
    """Whether a block is assignments of parameters and nothing else."""
    return not block.words and all(one.kind in "P#<" for one in block.assignments)


def values_of(ready: Ready) -> dict[str, float]:
    """The words of a block as numbers, checked against their limits."""
    plan = ready.plan
    if plan.numbers is not None:
        return plan.numbers
    words = {}
    for letter, formula in ready.values:
        value = words[letter] = formula.now()
        if not math.isfinite(value):
            raise CodeError("E210", plan.column(letter))
    for limit in ready.limits:
        if limit.letter in words:
            check_limit(limit, words[limit.letter], plan.column(limit.letter))
    return words


def _assign(one: Assignment, run: Inside) -> Assign:
    """An assignment as a function."""
    value = Formula(one.value, run.parameters)
    if one.kind in ("OUT", "BIT"):
        return _switch(one, value, run)
    write, kind = run.parameters.write, one.kind
    if isinstance(one.index, str):
        name = one.index
        return lambda node: write(kind, name, value.now())
    if isinstance(one.index, Number):
        n = one.index.number
        return lambda node: write(kind, n, value.now())
    index = Formula(one.index, run.parameters)
    return lambda node: write(kind, index.now(), value.now())


class _Statement:
    """A jump, a call or PRINT."""

    __slots__ = ("now",)

    def __init__(self, act: Act) -> None:
        self.now = act


class _Quick:
    """Assignments that are executed again and again: one Python function in the end."""

    __slots__ = ("_assigns", "_lines", "_needs", "_parameters", "_uses", "now")

    def __init__(
        self, many: list[Assignment], assigns: tuple[Assign, ...], parameters: Parameters
    ) -> None:
        self._assigns = assigns
        self._lines = [line for one in many for line in _lines(one, parameters)]
        self._needs = _needs("\n".join(self._lines))
        self._parameters = parameters
        self._uses = 0
        self.now: Assign = self._first

    def _first(self, node: Node) -> None:
        self._uses += 1
        if self._uses == HOT:
            self.now = self._compiled()
        _rest_for(self._needs, self._parameters)
        for assign in self._assigns:
            assign(node)

    def _compiled(self) -> Assign:
        names = names_for(self._parameters)
        lines = [self._needs, *self._lines]
        exec("def assign(node):\n    " + "\n    ".join(lines), names)
        work: Assign = names["assign"]
        return work


_LOCAL = re.compile(r"if values\[0\](?:: values\[\d+\] = v)?\s*else:? \w+\([^()]*\)")
_CARD = re.compile(r"card\(|read_|write\(")
NEVER, OUTSIDE, ALWAYS = "pass", "values[0] or rest()", "rest()"


def _needs(source: str) -> str:
    """Whether the machine has to rest first, as Python: all of a block acts, or nothing."""
    if _CARD.search(_LOCAL.sub("", source)):
        return ALWAYS
    return OUTSIDE if _CARD.search(source) else NEVER


def _rest_for(needs: str, parameters: Parameters) -> None:
    if needs == ALWAYS or (needs == OUTSIDE and not parameters.is_in_call):
        parameters.rest()


def _lines(one: Assignment, parameters: Parameters) -> list[str]:
    """One assignment in Python: the value is found and checked, then it is kept."""
    lines = [f"v = {one.value.source(parameters)}", "if v - v != 0.0: wrong()"]
    kind, index = repr(one.kind), one.index
    if isinstance(index, str):
        return [*lines, f"write({kind}, {index!r}, v)"]
    if isinstance(index, Number):
        n = index.number
        if one.kind == "#" and 1 <= n <= parameters.last_local:
            store = _store(one.kind, n, parameters)
            return [*lines, f"if values[0]: values[{int(n)}] = v", f"else: {store}"]
        return [*lines, _store(one.kind, n, parameters)]
    return [*lines, f"write({kind}, {index.source(parameters)}, v)"]


def _store(kind: str, n: float, parameters: Parameters) -> str:
    """The fastest function that writes a parameter."""
    is_hash = kind == "#"
    if parameters.is_free_cell(n, is_hash=is_hash):
        return f"keep({int(n)}, v)"
    if parameters.is_plain_cell(n, is_hash=is_hash):
        return f"put({int(n)}, v)"
    if parameters.is_card_cell(n, is_hash=is_hash):
        return f"set_card({int(n)}, v)"
    return f"write({kind!r}, {n!r}, v)"


def _switch(one: Assignment, value: Formula, run: Inside) -> Assign:
    """`OUT(n) = x`, `BIT(n) = x`: at rest, as everything that reads the machine."""
    if isinstance(one.index, str):
        raise TypeError(one.index)
    index = Formula(one.index, run.parameters)
    made = Output if one.kind == "OUT" else SetBit

    def act(node: Node) -> None:
        if not run.is_rested:
            raise NotAtRestError
        run.tell(made(node.source, number(index.now()), value.now() != 0.0))

    return act


def _together(many: list[Assignment], run: Inside) -> tuple[Assign, ...]:
    """All assignments of a block with the values from before it."""
    if not many:
        return ()
    pairs = [(one, Formula(one.value, run.parameters)) for one in many]
    named = [one.index for one in many]
    indices = [None if isinstance(at, str) else Formula(at, run.parameters) for at in named]

    def act(node: Node) -> None:
        values = [value.now() for _, value in pairs]
        numbers = [index.now() if index else 0.0 for index in indices]
        for (one, _), n, value in zip(pairs, numbers, values, strict=True):
            run.parameters.write(one.kind, one.index if isinstance(one.index, str) else n, value)

    return (act,)
