"""Controller files written as LIST shows them.

Lines that cannot be read, that are joined with others or that LIST shows as several stay as they
are; so do empty lines. A comment after an apostrophe, which no card stores, is kept.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

from openacr.editing.controller.marks import marks_of
from openacr.editing.document import Document, Edit, Place, Span
from openacr.editing.marks import Kind
from openacr.errors import OpenacrError
from openacr.lang.characters import readable
from openacr.project import find_project
from openacr.source_check import listed, read

_NO_NAMES: frozenset[str] = frozenset()
_APOSTROPHES = frozenset("'\u2018\u2019")


def edits(document: Document, unsaved: Mapping[Path, Document]) -> list[Edit]:
    """The changes that make a document look as LIST shows it; none where it cannot be read."""
    data = {path: each.data for path, each in unsaved.items()} | {document.path: document.data}
    try:
        project = find_project(document.path, data)
        reader = read(document.path, project, unsaved=data)
    except OpenacrError:
        return []
    faulty = {fault.line for fault in reader.faults if not fault.is_warning}
    shown: dict[int, list[str]] = {}
    for line, text in listed(reader):
        texts = shown.setdefault(line.number, [])
        texts += ["", ""] if line.rests else [text]
    return list(_changed(document, shown, faulty))


def _changed(document: Document, shown: dict[int, list[str]], faulty: set[int]) -> Iterator[Edit]:
    for number, texts in shown.items():
        if len(texts) != 1 or number in faulty:
            continue
        line = document.lines[number - 1]
        new = f"{readable(texts[0])}{_comment(line)}"
        if new != line:
            yield Edit(Span(Place(number - 1, 0), Place(number - 1, len(line))), new)


def _comment(line: str) -> str:
    """The comment of a line, with a blank before it."""
    if _APOSTROPHES.isdisjoint(line):
        return ""
    for mark in marks_of(line, _NO_NAMES, _NO_NAMES, is_plc=False):
        if mark.kind is Kind.REMARK and line[mark.start] in _APOSTROPHES:
            return f" {line[mark.start :].rstrip()}"
    return ""
