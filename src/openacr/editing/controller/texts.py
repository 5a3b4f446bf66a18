"""What an editor shows about commands, functions and instructions of PLCs."""

from inspect import cleandoc

from openacr.basic.language.registry import Command, Function
from openacr.basic.language.written import call, syntax
from openacr.basic.reference import facts as facts_of_command
from openacr.basic.reference import title
from openacr.editing.texts import markdown, page
from openacr.plc.instructions import Instruction, Operand


@markdown.register
def _(row: Command) -> str:
    return page(title(row), cleandoc(row.handler.__doc__ or ""), facts_of_command(row))


@markdown.register
def _(row: Function) -> str:
    return page(call(row), row.summary, ())


@markdown.register
def _(row: Instruction) -> str:
    facts = [f"* Written: `{written(row)}`"]
    facts += [f"* Also: `{synonym}`" for synonym in row.synonyms]
    return page(f"{row.name} (PLC)", row.summary, facts)


def written(row: Command | Instruction | Function) -> str:
    """How a command, an instruction or a function is written."""
    if isinstance(row, Command):
        return syntax(row)
    if isinstance(row, Function):
        return call(row)
    preload = " {preload}" if row.operand.takes_preload else ""
    operands = {Operand.NONE: "", Operand.FLAG: " flag"}
    return f"{row.name}{operands.get(row.operand, ' n')}{preload}"
