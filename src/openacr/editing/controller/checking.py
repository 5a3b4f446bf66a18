"""What `openacr check` finds in the files of a project, as findings of texts in an editor."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from openacr.editing.document import Document, Edit, Place, Span
from openacr.editing.symbols import Finding, Fix
from openacr.errors import OpenacrError, SourceError
from openacr.source_check import Fault, check, meant


def findings(path: Path, unsaved: Mapping[Path, Document]) -> dict[Path, list[Finding]]:
    """What is wrong with a controller file or with the files of a project folder, by file.

    Every file of the folder that is being edited has an entry.
    """
    found: dict[Path, list[Finding]] = {each: [] for each in unsaved if path in (each, each.parent)}
    data = {each: document.data for each, document in unsaved.items()}
    try:
        for fault in check(path, unsaved=data):
            found.setdefault(Path(fault.path), []).append(_finding(fault))
    except SourceError as error:
        for each in error.errors:
            where = Path(each.path) if each.path else path
            found.setdefault(where, []).append(_refused(each.line, each.column, each))
    except OpenacrError as error:
        for where in found:
            found[where].append(_refused(1, 1, error))
    return found


def _finding(fault: Fault) -> Finding:
    line, column = fault.line - 1, fault.column - 1
    end = max(column + 1, min(column + fault.length, len(fault.text)))
    span = Span(Place(line, column), Place(line, end))
    word = meant(fault.hint)
    fix = Fix(f"Write {word}", Edit(span, word)) if word else None
    return Finding(span, fault.message, fault.hint, "", fault.is_warning, fix)


def _refused(line: int, column: int, error: Exception) -> Finding:
    """What keeps the files from being read at all."""
    place = Place(max(line - 1, 0), max(column - 1, 0))
    text = error.text if isinstance(error, SourceError) else str(error)
    hint = error.hint if isinstance(error, SourceError) else ""
    return Finding(Span(place, Place(place.line, place.column + 1)), text, hint)


def fixes(found: Iterable[Finding], span: Span) -> list[tuple[Finding, Fix]]:
    """The changes that the hints of findings within a span propose."""
    return [
        (each, each.fix)
        for each in found
        if each.fix is not None and each.span.start <= span.end and span.start <= each.span.end
    ]
