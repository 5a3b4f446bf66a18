"""What an editor shows about a word: Markdown made of the rows that the reference pages show."""

from collections.abc import Iterable
from functools import singledispatch
from inspect import cleandoc

from openacr.basic.language.registry import Command, Function
from openacr.basic.language.written import call, syntax
from openacr.basic.reference import facts as facts_of_command
from openacr.basic.reference import title
from openacr.cnc.codes.ngc.named import Named
from openacr.cnc.codes.table import Code
from openacr.cnc.reference import group_of, words_of
from openacr.map import explain, flags, flags_of, parameters
from openacr.map.lookup import Flag, Parameter
from openacr.plc.instructions import Instruction, Operand
from openacr.sysvar import lookup
from openacr.sysvar.reference import facts_of_cell
from openacr.sysvar.schema import Parameter as Cell


@singledispatch
def markdown(row: object) -> str:
    """Everything about a row of a table; empty for anything else."""
    return ""


@markdown.register
def _(row: Command) -> str:
    return _page(title(row), cleandoc(row.handler.__doc__ or ""), facts_of_command(row))


@markdown.register
def _(row: Function) -> str:
    return _page(call(row), row.summary, ())


@markdown.register
def _(row: Instruction) -> str:
    facts = [f"* Written: `{written(row)}`"]
    facts += [f"* Also: `{synonym}`" for synonym in row.synonyms]
    return _page(f"{row.name} (PLC)", row.summary, facts)


@markdown.register
def _(row: Code) -> str:
    words, group = words_of(row), group_of(row)
    facts = [f"* Words: {words}"] if words else []
    facts += [f"* Group: {group}"] if group else []
    return _page(row.name if row.number or row.letter in "GM" else row.letter, row.summary, facts)


@markdown.register
def _(row: Parameter) -> str:
    named = [flag for flag in flags_of(row.number) if explain.has_meaning(flag)]
    facts = _listed(explain.facts_of(row))
    facts += [f"* BIT{flag.number}: {flag.name}" for flag in named]
    return _page(f"P{row.number} {row.name}", row.description, facts)


@markdown.register
def _(row: Flag) -> str:
    return _page(f"BIT{row.number} {row.name}", row.description, _listed(explain.facts_of(row)))


@markdown.register
def _(row: Cell) -> str:
    return _page(str(row), row.row.doc, _listed(facts_of_cell(row)))


@markdown.register
def _(row: Named) -> str:
    return _page(row.shown, f"Read only: {row.meaning}.", ())


def parameter(number: int) -> Parameter | None:
    """The parameter of a card with this number, if there is one that has a meaning."""
    found = parameters().get(number)
    return found if found is not None and explain.has_meaning(found) else None


def flag(number: int) -> Flag | None:
    """The flag of a card with this number, if there is one that has a meaning."""
    found = flags().get(number)
    return found if found is not None and explain.has_meaning(found) else None


def cell(number: int) -> Cell | None:
    """The parameter of the machine with this number, if there is one."""
    return lookup.parameter(number) if number >= 0 else None


def short(record: Parameter | Flag) -> str:
    """The name of a parameter or flag with its object: `axis 0 current position`."""
    place = explain.object_of(record)
    return record.name if place.lower() in record.name.lower() else f"{place}: {record.name}"


def written(row: Command | Instruction | Function) -> str:
    """How a command, an instruction or a function is written."""
    if isinstance(row, Command):
        return syntax(row)
    if isinstance(row, Function):
        return call(row)
    preload = " {preload}" if row.operand.takes_preload else ""
    operands = {Operand.NONE: "", Operand.FLAG: " flag"}
    return f"{row.name}{operands.get(row.operand, ' n')}{preload}"


def _listed(facts: dict[str, str]) -> list[str]:
    return [f"* {name}: {value}" for name, value in facts.items()]


def _page(heading: str, text: str, facts: Iterable[str]) -> str:
    parts = [f"**{heading}**", text, "\n".join(facts)]
    return "\n\n".join(part for part in parts if part)
