"""Controller files as a language of editors."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from openacr.basic.language.aliases import LONGEST_ALIAS, check_name
from openacr.basic.language.parser import LONGEST_LABEL
from openacr.basic.language.registry import Level
from openacr.editing.completions import Completion, Item, Signature
from openacr.editing.controller import checking, completing, formatting
from openacr.editing.controller.facts import facts_of
from openacr.editing.controller.folding import folds
from openacr.editing.controller.marks import marks_of
from openacr.editing.controller.names import ProjectNames, names_of
from openacr.editing.controller.outline import Outline, Section, outline
from openacr.editing.controller.values import value_name, values_in
from openacr.editing.document import Document, Edit, Place
from openacr.editing.languages import Files, in_steps
from openacr.editing.marks import Kind, Mark, Symbol
from openacr.editing.outlines import Entry, Fold
from openacr.editing.symbols import Finding
from openacr.editing.texts import flag, markdown, parameter, short
from openacr.errors import CardError
from openacr.lang.lexer import LINE_LIMIT
from openacr.map import flag_names, parameter_names
from openacr.project import Place as FilePlace
from openacr.project import place_of

MACHINE = "machine.toml"
NO_NAMES: frozenset[str] = frozenset()
_LABEL = re.compile(rf"[A-Za-z][A-Za-z0-9]{{0,{LONGEST_LABEL - 1}}}")
_AXIS = re.compile(r"[A-Za-z]{1,4}")
_DIGITS = re.compile(r"\d")


class ControllerLanguage:
    """AcroBASIC and PLC programs."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._outlines: dict[Path, tuple[int, Document, Outline]] = {}
        self._names: tuple[tuple[object, ...], ProjectNames] | None = None

    # what the questions below are answered from

    def outline(self, document: Document) -> Outline:
        """The sections of a document, kept until it changes."""
        known = self._outlines.get(document.path)
        if known is None or known[0] != document.revision or known[1] is not document:
            earlier = known[2] if known is not None else None
            known = document.revision, document, outline(document, earlier)
            self._outlines[document.path] = known
        return known[2]

    def names(self, document: Document) -> ProjectNames:
        """The aliases and axes of a project, kept until one of its files changes."""
        related = list(self.related(document))
        key = tuple((each.path, id(each), each.revision) for each in related)
        if self._names is None or self._names[0] != key:
            self._names = key, names_of((each, self.outline(each)) for each in related)
        return self._names[1]

    def section(self, document: Document, line: int) -> Section:
        """The program or PLC a line belongs to."""
        return self.outline(document).section_at(line)

    @property
    def longest(self) -> int:
        """The characters a line may have."""
        return LINE_LIMIT

    def marks(
        self, document: Document, lines: Iterable[int]
    ) -> Iterator[tuple[int, tuple[Mark, ...]]]:
        """The parts of lines."""
        names, outlined = self.names(document), self.outline(document)
        for line in lines:
            section = outlined.section_at(line)
            axes = names.axes_of(section.number) if section.level is Level.PROG else NO_NAMES
            text = document.lines[line]
            yield line, marks_of(text, names.alias_names, axes, is_plc=section.is_plc)

    def _marks(self, document: Document, line: int) -> tuple[Mark, ...]:
        return next(self.marks(document, (line,)))[1]

    def values(
        self, document: Document, lines: Iterable[int]
    ) -> Iterator[tuple[int, str, list[tuple[str, str]]]]:
        """Lines that name values: the line, its program, and what `values_in` finds."""
        targets = self._value_targets(document)
        for line, marks in self.marks(document, lines):
            if found := list(values_in(document.lines[line], marks, targets)):
                yield line, self.section(document, line).title, found

    def _value_targets(self, document: Document) -> dict[str, str]:
        """The values that aliases stand for."""
        found = {}
        for alias, target in self.names(document).aliases.items():
            marks = marks_of(target, NO_NAMES, NO_NAMES, is_plc=False)
            if marks and (name := value_name(target, marks[0])):
                found[alias] = name
        return found

    # names

    def related(self, document: Document) -> Iterable[Document]:
        """The document, and the controller files of the project it belongs to."""
        yield document
        for path in sorted(self._files.beside(document.path)):
            place, _ = place_of(path)
            is_part = place is not FilePlace.SETUP or path.name.lower() == "setup.8k"
            if path.suffix.lower() == ".8k" and is_part and path != document.path:
                other = self._files.document(path)
                if other is not None:
                    yield other

    def symbol(self, document: Document, line: int, mark: Mark) -> Symbol | None:
        """Labels belong to a program in a file, axes to a program, aliases to the project."""
        if mark.kind is Kind.ALIAS:
            return Symbol(Kind.ALIAS, mark.name)
        section = self.section(document, line)
        if mark.kind is Kind.LABEL:
            return Symbol(Kind.LABEL, mark.name, f"{document.path}:{section.title}")
        if mark.kind is Kind.AXIS and mark.number < 0:
            return Symbol(Kind.AXIS, mark.name, section.title)
        return None

    def mentions(self, document: Document, symbol: Symbol) -> Iterator[int]:
        """The lines that hold the letters of a name."""
        name = symbol.name.upper()
        for line, text in enumerate(document.lines):
            if name in text.upper():
                yield line

    def refusal(self, document: Document, symbol: Symbol, new: str) -> str:
        """Why a name may not be given to a symbol."""
        if symbol.kind is Kind.LABEL:
            return self._label_refusal(document, symbol, new)
        names = self.names(document)
        taken = {name.upper() for name in names.alias_names} | names.all_axes
        if new.upper() in taken - {symbol.name.upper()} or new in names.alias_names:
            return f"{new} is another name in this project"
        if symbol.kind is Kind.AXIS and not _AXIS.fullmatch(new):
            return f"{new}: the name of an axis has one to four letters"
        try:
            check_name(new, has_digits=_DIGITS.search(symbol.name) is not None)
        except (CardError, IndexError):
            return (
                f"{new}: a name has at most {LONGEST_ALIAS} letters and is no word of the language"
            )
        return ""

    def _label_refusal(self, document: Document, symbol: Symbol, new: str) -> str:
        if symbol.name.isdigit():
            return "line numbers say the order of lines; they cannot be renamed"
        if not _LABEL.fullmatch(new):
            return f"{new}: a label has up to {LONGEST_LABEL} letters and digits, a letter first"
        outlined = self.outline(document)
        for section in outlined.sections:
            is_same = f"{document.path}:{section.title}" == symbol.scope
            if is_same and any(label == new for label, _ in outlined.labels(section)):
                return f"{new} is another label of {section.title}"
        return ""

    # what parts of lines are

    def describe(self, document: Document, line: int, mark: Mark) -> str:
        """What a part of a line is."""
        if mark.kind is Kind.PARAMETER:
            return markdown(parameter(mark.number))
        if mark.kind is Kind.FLAG:
            return markdown(flag(mark.number))
        if mark.kind is Kind.ALIAS:
            return self._alias(document, mark.name)
        if mark.kind is Kind.AXIS:
            return self._axis(document, line, mark)
        if mark.kind is Kind.LABEL:
            return f"**{mark.name}**\n\nLabel of {self.section(document, line).title}"
        return markdown(mark.row)

    def _alias(self, document: Document, name: str) -> str:
        target = self.names(document).aliases.get(name)
        if target is None:
            return ""
        texts = [f"**{name}**", f"`#DEFINE {name} {target}`"]
        for mark in marks_of(target, NO_NAMES, NO_NAMES, is_plc=False):
            texts.append(self.describe(document, 0, mark) if mark.number >= 0 else "")
        return "\n\n".join(filter(None, texts))

    def _axis(self, document: Document, line: int, mark: Mark) -> str:
        number = mark.number
        if number < 0:
            number = self.names(document).axis(self.section(document, line).number, mark.name)
        return f"**{mark.name}**\n\nAxis {number}" if number >= 0 else ""

    def hint(self, document: Document, mark: Mark) -> str:
        """The name of a parameter or flag that is written as a number."""
        record = parameter(mark.number) if mark.kind is Kind.PARAMETER else None
        if mark.kind is Kind.FLAG:
            return short(found) if (found := flag(mark.number)) else ""
        return short(record) if record else ""

    # typing

    def complete(self, document: Document, place: Place) -> Completion:
        """Proposals for what is being typed."""
        section = self.section(document, place.line)
        names, labels = self.names(document), self.outline(document).labels(section)
        named = [Item(name, Kind.ALIAS, target) for name, target in names.aliases.items()]
        if section.level is Level.PROG:
            axes = sorted(names.axes_of(section.number))
            named += [Item(name, Kind.AXIS, f"axis of {section.title}") for name in axes]
        marks = self._marks(document, place.line)
        known = [label for label, _ in labels]
        text = document.lines[place.line]
        return completing.complete(text, place, marks, section.level, named, known)

    def signature(self, document: Document, place: Place) -> Signature | None:
        """How the command or function at a place is written."""
        text = document.lines[place.line]
        return completing.signature(text, place.column, self._marks(document, place.line))

    # the whole text

    def entries(self, document: Document) -> list[Entry]:
        """Programs and PLCs with their labels, and aliases."""
        found: list[Entry] = []
        outlined = self.outline(document)
        for section in outlined.sections:
            last = max(section.first, section.last - 1)
            entry = Entry(section.title, "", None, section.first, last)
            for line, facts in outlined.facts:
                if not section.first <= line < section.last:
                    continue
                if facts.label and not facts.label.isdigit():
                    entry.parts.append(Entry(facts.label, "label", Kind.LABEL, line, line))
                if facts.alias:
                    entry.parts.append(Entry(*facts.alias, Kind.ALIAS, line, line))
            if entry.parts or section.level is not Level.SYS:
                found.append(entry)
        return found

    def folds(self, document: Document) -> Iterator[Fold]:
        """Programs, blocks and remarks."""
        return folds(self.outline(document))

    def format(self, document: Document) -> list[Edit]:
        """The changes that make a text look as LIST shows it."""
        return formatting.edits(document, self._files.unsaved)

    def subject(self, document: Document) -> Path:
        """The folder of a project, where the file is part of one."""
        path = document.path
        place, _ = place_of(path)
        is_part = place is not FilePlace.SETUP or path.name.lower() == "setup.8k"
        siblings = {each.name.lower() for each in self._files.beside(path)}
        is_project = bool(siblings & {MACHINE, "setup.8k"})
        return path.parent if is_part and is_project else path

    def findings(
        self, subject: Path, documents: Mapping[Path, Document]
    ) -> dict[Path, list[Finding]]:
        """What `openacr check` finds."""
        return checking.findings(subject, documents)

    def prepare(self, document: Document) -> Iterator[None]:
        """Read the names of the map, and what the lines say."""
        for names in (parameter_names, flag_names):
            names()
            yield
        yield from in_steps(facts_of, document.lines)
        self.names(document)

    def forget(self, path: Path) -> None:
        """Do nothing: what is known of a text belongs to the text."""
