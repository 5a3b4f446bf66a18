"""One statement of Python: its arguments are evaluated, its handler called."""

from __future__ import annotations

from typing import Any

from openacr.basic import commands as _commands  # noqa: F401 - registers the commands
from openacr.basic.language import registry
from openacr.basic.language.nodes import Move, Statement
from openacr.basic.vm.run import Run, Wait


def perform(run: Run, statement: Statement | Move) -> Wait | None:
    """Call the handlers of a statement; of a move all targets are issued together."""
    if isinstance(statement, Statement):
        wait = _handle(run, statement)
        return wait if isinstance(wait, Wait) else None
    targets = [target for part in statement.parts for target in _handle(run, part) or ()]
    issued: Wait | None = registry.move_issuer()(run, tuple(targets))
    return issued


def _handle(run: Run, statement: Statement) -> Any:
    """Evaluate the arguments of a command and call its handler."""
    row = statement.command
    outer, run.prefix = run.prefix, statement.prefix
    try:
        indices = [run.integer(index) for index in statement.indices]
        given = zip(row.forms, statement.arguments, strict=True)
        values = [form.evaluate(run, read) for form, read in given]
        return row.handler(run, *indices, *values)
    finally:
        run.prefix = outer
