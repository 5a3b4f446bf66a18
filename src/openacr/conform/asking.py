"""Which cases may run on a card that is in use: those that only ask.

Such a case types lines whose answer is the same on every card, whatever its user has stored: PRINT
of expressions without parameters, flags and variables, changes of level, remarks. It needs no
machine, sends no bytes, stores no program and lets no time pass, so that nothing on the card
changes but the level of the connection, which is its own. With the permission of its user also
cases run that move one axis, or set what is put back (moving.py).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from openacr.basic.commands.character_io import Print
from openacr.basic.language import nodes
from openacr.basic.language.cursor import StatementError
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Command, Function
from openacr.basic.language.scope import Scope
from openacr.conform.form import Case, Machine, Step
from openacr.conform.moving import Permission, bar_of_line
from openacr.lang.lexer import LexError, tokens

ASKS = frozenset(("PRINT", "SYS", "PROG", "PLC"))
PLACES = (nodes.Parameter, nodes.Flag)
STORED = (
    nodes.Local,
    nodes.Element,
    nodes.StringLocal,
    nodes.StringElement,
    nodes.Alias,
)
CHANCE = "RND"  # its next number would be another one for the programs of the user
NOTHING = Permission()
_NOTED = re.compile(r"<\w+>")
WAITS = ("wait ", "note ")
_PROMPT = re.compile(r"(?:SYS|P\d\d|PLC\d)>")


def bar(case: Case, permission: Permission = NOTHING) -> str:
    """Why a case cannot run on a card that is in use; empty if it can."""
    if case.only:
        return "it needs the world around a virtual card"
    if case.machine != Machine() and case.moves is None:
        return "it needs a machine that is set up"
    if reason := permission.bar(case):
        return reason
    return next(filter(None, (_bar_of(case, step) for step in case.steps)), "")


def _bar_of(case: Case, step: Step) -> str:
    if (case.moves or case.changes) and step.word.form.startswith(WAITS):
        return ""
    if not step.word.asks:
        return f"line {step.at.number}: `{step.word.form}` does more than ask"
    text: str = next((each for each in step.values if not _PROMPT.fullmatch(each)), "")
    if step.word.form.startswith("?"):
        lines = (f"?{each.strip()}" for each in _NOTED.sub("0", text).split(";"))
        return next(filter(None, (_bar_of_line(case, step, each) for each in lines)), "")
    return _bar_of_line(case, step, text)


def _bar_of_line(case: Case, step: Step, text: str) -> str:
    is_free = bool(case.moves or case.changes)
    if is_free and (reason := bar_of_line(case, text)) is not None:
        return f"line {step.at.number}: `{text}`: {reason}" if reason else ""
    stored = STORED if is_free else PLACES + STORED
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
        if is_own or isinstance(part, stored) or (isinstance(part, Print) and part.device):
            return f"line {step.at.number}: `{text}` depends on what is stored or sent"
    return ""


def _parts(node: object) -> Iterator[object]:
    """A node of a tree and all in it."""
    yield node
    if not isinstance(node, Command | Function):
        for each in nodes.parts(node):
            yield from _parts(each)
