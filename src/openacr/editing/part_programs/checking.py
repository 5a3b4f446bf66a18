"""What `openacr mill check` finds in a part program, as findings of texts in an editor."""

from pathlib import Path

from openacr.cnc.reading.findings import Finding as Found
from openacr.editing.document import Document, Edit, Place, Span
from openacr.editing.part_programs.store import StoreOfMachine
from openacr.editing.symbols import Finding, Fix
from openacr.errors import OpenacrError
from openacr.mill.plan.estimate.checking import check_text

CYCLES = "$I CYCLES.TXT"  # as the hint of E251 names it


def findings(document: Document, store: StoreOfMachine) -> dict[Path, list[Finding]]:
    """What is wrong with a part program and with the files it includes, by file."""
    path = document.path
    found: dict[Path, list[Finding]] = {path: []}
    try:
        with store.open() as cells:
            for each in check_text(document.text, path, cells, store.dialect):
                where = path if each.file == path.name else path.parent / each.file
                if where == path or where.exists():
                    found.setdefault(where, []).append(_finding(each, document))
    except OpenacrError as error:
        found[path].append(Finding(Span(Place(0, 0), Place(0, 1)), str(error)))
    return found


def _finding(each: Found, document: Document) -> Finding:
    start = Place(each.line - 1, each.column - 1)
    end = Place(each.line - 1, max(each.column, len(each.block.rstrip())))
    span = Span(start, end)
    fix = None
    if each.hint.startswith(CYCLES):
        last = document.whole.end
        text = f"\n{CYCLES}\n" if last.column else f"{CYCLES}\n"
        fix = Fix(f"Add {CYCLES} at the end", Edit(Span(last, last), text))
    return Finding(span, each.text, each.hint, each.code, not each.is_error, fix)
