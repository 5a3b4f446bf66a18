"""What an editor shows about codes, names and parameters of the machine."""

from openacr.cnc.codes.ngc.named import Named
from openacr.cnc.codes.table import Code
from openacr.cnc.reference import group_of, words_of
from openacr.editing.texts import listed, markdown, page
from openacr.sysvar import lookup
from openacr.sysvar.reference import facts_of_cell
from openacr.sysvar.schema import Parameter as Cell


@markdown.register
def _(row: Code) -> str:
    words, group = words_of(row), group_of(row)
    facts = [f"* Words: {words}"] if words else []
    facts += [f"* Group: {group}"] if group else []
    return page(row.name if row.number or row.letter in "GM" else row.letter, row.summary, facts)


@markdown.register
def _(row: Cell) -> str:
    return page(str(row), row.row.doc, listed(facts_of_cell(row)))


@markdown.register
def _(row: Named) -> str:
    return page(row.shown, f"Read only: {row.meaning}.", ())


def cell(number: int) -> Cell | None:
    """The parameter of the machine with this number, if there is one."""
    return lookup.parameter(number) if number >= 0 else None
