"""Everything an editor asks, without a protocol: questions about texts, answered from the tables.

    engine = Engine()
    engine.open(Path("machine/prog0.8k"), "PROGRAM\\nDWL 5\\nENDP\\n")
    engine.describe(Path("machine/prog0.8k"), Place(1, 0))

A file that is not open has no answers; places outside of a text are the nearest ones in it.
"""

from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from openacr.editing import marks as marking
from openacr.editing.completions import Completion, Signature
from openacr.editing.document import Document, Edit, Place, Span
from openacr.editing.files import OpenFiles
from openacr.editing.languages import Language, is_controller
from openacr.editing.marks import Kind, Mark, Symbol
from openacr.editing.outlines import Entry, Fold
from openacr.editing.symbols import Finding, Fix, Location
from openacr.editing.texts import markdown
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.editing.controller.language import ControllerLanguage


class Colored(NamedTuple):
    """A part of a line and its kind."""

    line: int
    mark: Mark


class Shown(NamedTuple):
    """A text shown within a line."""

    place: Place
    text: str


class Engine:
    """The open files, and the answers about them; a language is imported for its first file."""

    def __init__(self, store: Path | None = None, dialect: str | None = None) -> None:
        self.files = OpenFiles()
        self._machine = store, dialect

    @cached_property
    def _controller(self) -> "ControllerLanguage":
        from openacr.editing.controller.language import ControllerLanguage

        return ControllerLanguage(self.files)

    @cached_property
    def _part_program(self) -> Language:
        from openacr.editing.part_programs.language import PartProgramLanguage

        return PartProgramLanguage(self.files, *self._machine)

    # texts

    def open(self, path: Path, text: str, language: str = "") -> Document:
        """Open a file with a text, or replace its text."""
        document = Document.of(path, text, language)
        self.files.put(document)
        return document

    def change(self, path: Path, edits: Iterable[Edit]) -> None:
        """Change an open file by edits, one after the other."""
        document = self.document(path)
        for edit in edits:
            document.apply(edit)
        self.files.forget()

    def prepare(self, path: Path) -> Iterator[None]:
        """Read ahead what the first keys in a file would wait for, in steps of some milliseconds.

        It may be changed or closed between two of them.
        """
        document = self.files.unsaved.get(path)
        if document is not None:
            yield from self.language(document).prepare(document)

    def close(self, path: Path) -> None:
        """Close a file."""
        document = self.files.unsaved.get(path)
        if document is not None:
            self.language(document).forget(path)
        self.files.remove(path)

    def document(self, path: Path) -> Document:
        """An open file; UserError if it is not open."""
        document = self.files.unsaved.get(path)
        if document is None:
            raise UserError(f"{path} is not open")
        return document

    def language(self, document: Document) -> Language:
        """The language of a document."""
        return self._controller if is_controller(document) else self._part_program

    def _asked(self, path: Path, place: Place) -> tuple[Document, Language, Place]:
        document = self.document(path)
        return document, self.language(document), document.nearest(place)

    def _mark(self, path: Path, place: Place) -> tuple[Document, Place, Mark | None]:
        document, language, place = self._asked(path, place)
        found = next(iter(language.marks(document, (place.line,))))[1]
        return document, place, marking.at(found, place.column)

    # words

    def describe(self, path: Path, place: Place) -> tuple[str, Span] | None:
        """What stands at a place, as Markdown; None if nothing is known of it."""
        document, place, mark = self._mark(path, place)
        if mark is None:
            return None
        text = self.language(document).describe(document, place.line, mark)
        return (text, _span(place.line, mark.start, mark.end)) if text else None

    def complete(self, path: Path, place: Place) -> Completion:
        """Proposals for what is being typed."""
        document, language, place = self._asked(path, place)
        return language.complete(document, place)

    def signature(self, path: Path, place: Place) -> tuple[Signature, str] | None:
        """How the command or function at a place is written, and what it does."""
        document, language, place = self._asked(path, place)
        found = language.signature(document, place)
        return (found, markdown(found.row)) if found else None

    # names

    def _symbol(self, path: Path, place: Place) -> tuple[Document, Place, Mark, Symbol] | None:
        document, place, mark = self._mark(path, place)
        if mark is None:
            return None
        symbol = self.language(document).symbol(document, place.line, mark)
        return (document, place, mark, symbol) if symbol else None

    def _occurrences(self, document: Document, symbol: Symbol) -> Iterator[tuple[Location, Mark]]:
        language = self.language(document)
        for each in language.related(document):
            lines = list(language.mentions(each, symbol))
            for line, marks in language.marks(each, lines):
                for mark in marking.symbols_in(marks):
                    if language.symbol(each, line, mark) == symbol:
                        yield Location(each.path, _span(line, *mark.own)), mark

    def definitions(self, path: Path, place: Place) -> list[Location]:
        """Where the name at a place is defined."""
        found = self._symbol(path, place)
        if found is None:
            return []
        return [
            where for where, mark in self._occurrences(found[0], found[3]) if mark.is_definition
        ]

    def references(
        self, path: Path, place: Place, *, has_definitions: bool = True
    ) -> list[Location]:
        """Where the name at a place stands."""
        found = self._symbol(path, place)
        if found is None:
            return []
        every = self._occurrences(found[0], found[3])
        return [where for where, mark in every if has_definitions or not mark.is_definition]

    def renamable(self, path: Path, place: Place) -> Span | None:
        """The name at a place, if it is one that can be changed everywhere."""
        found = self._symbol(path, place)
        if found is None or not any(
            mark.is_definition for _, mark in self._occurrences(found[0], found[3])
        ):
            return None
        return _span(found[1].line, *found[2].own)

    def rename(self, path: Path, place: Place, new: str) -> dict[Path, list[Edit]]:
        """The changes that give a name another spelling everywhere; UserError if it is refused."""
        found = self._symbol(path, place)
        if found is None or self.renamable(path, place) is None:
            raise UserError("there is no name here that this project defines")
        document, _, _, symbol = found
        language = self.language(document)
        if refusal := language.refusal(document, symbol, new):
            raise UserError(refusal)
        edits: dict[Path, list[Edit]] = {}
        for where, _ in self._occurrences(document, symbol):
            edits.setdefault(where.path, []).append(Edit(where.span, new))
        self._require_room(edits, language.longest)
        return edits

    def _require_room(self, edits: dict[Path, list[Edit]], longest: int) -> None:
        """Refuse changes that make a line longer than any may be."""
        for path, changes in edits.items():
            document = self.files.document(path)
            grown: dict[int, int] = {}
            for edit in changes:
                start, end = edit.span
                more = len(edit.text) - (end.column - start.column)
                grown[start.line] = grown.get(start.line, 0) + more
            for line, more in grown.items():
                if document is not None and len(document.lines[line]) + more > longest:
                    raise UserError(
                        f"line {line + 1} of {path.name} would have over {longest} characters"
                    )

    # the whole text

    def entries(self, path: Path) -> list[Entry]:
        """The outline of a file."""
        document = self.document(path)
        return self.language(document).entries(document)

    def folds(self, path: Path) -> list[Fold]:
        """The lines that fold together."""
        document = self.document(path)
        return sorted(self.language(document).folds(document))

    def format(self, path: Path) -> list[Edit]:
        """The changes that make a file look as it is listed."""
        document = self.document(path)
        return self.language(document).format(document)

    def colored(self, path: Path, first: int, last: int) -> Iterator[Colored]:
        """The parts of the lines from the first to the last one."""
        document = self.document(path)
        lines = range(max(first, 0), min(last + 1, len(document.lines)))
        for line, marks in self.language(document).marks(document, lines):
            for mark in sorted(marks, key=lambda each: each.start):
                yield Colored(line, mark)

    def shown(self, path: Path, first: int, last: int) -> Iterator[Shown]:
        """What the numbers of parameters and flags in some lines stand for."""
        document = self.document(path)
        language = self.language(document)
        for line, mark in self.colored(path, first, last):
            if text := language.hint(document, mark):
                yield Shown(Place(line, mark.end), text)

    def values(
        self, path: Path, first: int, last: int
    ) -> Iterator[tuple[int, str, list[tuple[str, str]]]]:
        """Lines of a controller file that name values: line, program, as written with its name."""
        document = self.document(path)
        if is_controller(document):
            lines = range(max(first, 0), min(last + 1, len(document.lines)))
            yield from self._controller.values(document, lines)

    # what is wrong

    def subject(self, path: Path) -> Path:
        """What is checked when a file has changed: itself, or the folder of its project."""
        document = self.document(path)
        return self.language(document).subject(document)

    def copies(self) -> dict[Path, Document]:
        """The open texts as they are now, to check them while they go on changing."""
        return {
            path: Document(path, list(each.lines), list(each.ends), each.language, each.revision)
            for path, each in self.files.unsaved.items()
        }

    def findings(
        self, subject: Path, documents: dict[Path, Document] | None = None
    ) -> dict[Path, list[Finding]]:
        """What is wrong with a subject, by file, as the command line finds it."""
        texts = self.copies() if documents is None else documents
        document = texts.get(subject)
        is_program = document is not None and not is_controller(document)
        language: Language = self._part_program if is_program else self._controller
        return language.findings(subject, texts)

    @staticmethod
    def fixes(found: Iterable[Finding], span: Span) -> list[tuple[Finding, Fix]]:
        """The changes that the findings within a span propose."""
        from openacr.editing.controller.checking import fixes

        return fixes(found, span)


def _span(line: int, start: int, end: int) -> Span:
    return Span(Place(line, start), Place(line, end))


__all__ = ["Colored", "Engine", "Kind", "Shown"]
