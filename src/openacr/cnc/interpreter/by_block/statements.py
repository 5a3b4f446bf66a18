"""Statements: jumps, calls, PRINT and INPUT, made into functions of their line."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from openacr.cnc.canonical import Ask, Entry, Say
from openacr.cnc.reading.blocks import (
    Gosub,
    Goto,
    If,
    Include,
    Input,
    OWord,
    Print,
    Return,
    Statement,
)
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.reading.formulas import Formula, Number
from openacr.cnc.state.cells import HASH_TEST
from openacr.cnc.state.parameters import number

if TYPE_CHECKING:
    from openacr.cnc.interpreter.by_block.inside import Act, Inside
    from openacr.cnc.program.program import Node


def statement_of(statement: Statement, run: Inside, node: Node) -> Act:
    """A statement as a function of its line."""
    return _MAKERS[type(statement)](statement, run, node)


def _goto(statement: Goto, run: Inside, node: Node) -> Act:
    return _jump(statement, run, node, run.flow.jump)


def _gosub(statement: Gosub, run: Inside, node: Node) -> Act:
    return _jump(statement, run, node, run.flow.call_sub)


def _jump(statement: Goto | Gosub, run: Inside, node: Node, go: Callable[[Node], None]) -> Act:
    """A jump; the line of a label that is a number is looked up once."""
    flow, column = run.flow, statement.column
    if isinstance(statement.label, Number):
        label = number(statement.label.number)
        known: list[Node] = []

        def act(node: Node) -> None:
            if not known:
                known.append(flow.labelled(label, node, column))
            go(known[0])

        return act
    formula = Formula(statement.label, run.parameters)

    def act_by_value(node: Node) -> None:
        go(flow.labelled(number(formula.now()), node, column))

    return act_by_value


def _return(statement: Return, run: Inside, node: Node) -> Act:
    def act(node: Node) -> None:
        run.flow.go_back(statement.column)

    return act


def _if(statement: If, run: Inside, node: Node) -> Act:
    condition = Formula(statement.condition, run.parameters)
    then = _MAKERS[type(statement.then)](statement.then, run, node)
    test, parameters = statement.test, run.parameters
    if test is not None and run.cells.read(HASH_TEST):
        wanted, bit = float(test.wanted), float(test.number)

        def act_by_input(node: Node) -> None:
            if parameters.is_in_call:
                is_met = condition.now() != 0.0
            else:
                is_met = parameters.read_input(bit) == wanted
                if test.number in parameters.assigned:
                    run.doubt(node, "W211", statement.column, _input_test(test.number))
            if is_met:
                then(node)

        return act_by_input

    def act(node: Node) -> None:
        if condition.now() != 0.0:
            then(node)

    return act


def _input_test(n: int) -> str:
    """What is said of IF #n=0 or 1 in a program that has given #n a value."""
    return f"tests input {n}, not parameter {n} that was assigned: that is IF (#{n})=..."


def _print(statement: Print, run: Inside, node: Node) -> Act:
    items = [
        item if isinstance(item, str) else Formula(item, run.parameters) for item in statement.items
    ]

    def act(node: Node) -> None:
        texts = [item if isinstance(item, str) else shown(item.now()) for item in items]
        run.tell(Say(node.source, "".join(texts)))

    return act


def shown(value: float) -> str:
    """Up to 4 decimals, trailing zeros dropped."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _input(statement: Input, run: Inside, node: Node) -> Act:
    index = Formula(statement.parameter, run.parameters)
    kind = "#" if statement.is_hash else "P"

    def act(node: Node) -> Iterator[Entry]:
        yield from run.sync(node.source)
        parameter = number(index.now())
        run.tell(Ask(node.source, statement.text, parameter))
        yield from run.sync(node.source)
        answer = run.machine.answer(parameter)
        if answer is None:
            raise CodeError("A61", statement.column, statement.text)
        run.parameters.write(kind, parameter, answer)

    return act


def _include(statement: Include, run: Inside, node: Node) -> Act:
    return lambda node: None  # the added text follows by itself


def _o_word(statement: OWord, run: Inside, node: Node) -> Act:
    return run.o_words.act(statement, node)


_MAKERS: dict[type[Any], Callable[..., Act]] = {
    Goto: _goto,
    Gosub: _gosub,
    Return: _return,
    If: _if,
    Print: _print,
    Input: _input,
    Include: _include,
    OWord: _o_word,
}
