"""Which cases may run on a card that is in use: those that only ask.

Such a case types lines whose answer is the same on every card, whatever its user has stored: PRINT
of expressions without parameters, flags and variables, changes of level, remarks. It needs no
machine, sends no bytes, stores no program and lets no time pass, so that nothing on the card
changes but the level of the connection, which is its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass

from openacr.basic.commands.character_io import Print
from openacr.basic.language import nodes
from openacr.basic.language.cursor import StatementError
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Command, Function
from openacr.basic.language.scope import Scope
from openacr.conform.form import Case, Machine, Step
from openacr.lang.lexer import LexError, tokens

ASKS = frozenset(("PRINT", "SYS", "PROG", "PLC"))
STORED = (
    nodes.Parameter,
    nodes.Flag,
    nodes.Local,
    nodes.Element,
    nodes.StringLocal,
    nodes.StringElement,
    nodes.Alias,
)
CHANCE = "RND"  # its next number would be another one for the programs of the user
_PROMPT = re.compile(r"(?:SYS|P\d\d|PLC\d)>")


def bar(case: Case) -> str:
    """Why a case cannot run on a card that is in use; empty if it can."""
    if case.only:
        return "it needs the world around a virtual card"
    if case.moves:
        return f"it moves {case.moves}"
    if case.machine != Machine():
        return "it needs a machine that is set up"
    return next(filter(None, map(_bar_of, case.steps)), "")


def _bar_of(step: Step) -> str:
    if not step.word.asks:
        return f"line {step.at.number}: `{step.word.form}` does more than ask"
    text: str = next((each for each in step.values if not _PROMPT.fullmatch(each)), "")
    if step.word.form.startswith("?"):
        return next(
            filter(None, (_bar_of_line(step, f"?{each.strip()}") for each in text.split(";"))), ""
        )
    return _bar_of_line(step, text)


def _bar_of_line(step: Step, text: str) -> str:
    try:
        tree = Parser(tokens(text.strip(), 1), Scope()).line()
    except (StatementError, LexError):
        return f"line {step.at.number}: what the card makes of `{text}` is not certain"
    for part in _parts(tree):
        is_label = isinstance(part, nodes.LineTree) and part.label is not None
        if (
            is_label
            or isinstance(part, nodes.Move)
            or (isinstance(part, nodes.Statement) and part.command.name not in ASKS)
        ):
            return f"line {step.at.number}: `{text}` may change the card"
        is_own = isinstance(part, nodes.Apply) and (
            part.function.wants_run or part.function.name == CHANCE
        )
        if is_own or isinstance(part, STORED) or (isinstance(part, Print) and part.device):
            return f"line {step.at.number}: `{text}` depends on what is stored or sent"
    return ""


def _parts(node: object) -> Iterator[object]:
    """A node of a tree and all in it."""
    yield node
    if isinstance(node, tuple):
        for each in node:
            yield from _parts(each)
    elif is_dataclass(node) and not isinstance(node, Command | Function | type):
        for each in fields(node):
            yield from _parts(getattr(node, each.name))
