"""Part programs as a language of editors."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from openacr.cnc.codes.ngc.named import PREDEFINED
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.loading.supplied import found_in
from openacr.cnc.reading.parser import LAST_LABEL, LONGEST
from openacr.editing.completions import Completion, Item, Signature
from openacr.editing.document import Document, Edit, Place
from openacr.editing.languages import Files, in_steps
from openacr.editing.marks import Kind, Mark, Symbol
from openacr.editing.outlines import COMMENT, Entry, Fold
from openacr.editing.part_programs.checking import findings
from openacr.editing.part_programs.facts import facts_of
from openacr.editing.part_programs.marks import marks_of
from openacr.editing.part_programs.store import StoreOfMachine
from openacr.editing.part_programs.texts import cell
from openacr.editing.symbols import Finding
from openacr.editing.texts import markdown, parameter
from openacr.sysvar.schema import CARD_PARAMETERS

_WORD = re.compile(r"(?:#\s*<[^<>]*|[$A-Za-z]+\d*\.?\d*)$")
_JUMP = re.compile(r"GO(?:TO|SUB)\s*(\d*)$", re.IGNORECASE)
_ROUTINE = re.compile(r"^\s*(?:N\d+\s*)?O\s*(<?\w*)$", re.IGNORECASE)
_NAME = re.compile(r"[A-Za-z_]\w*")
_DIGITS = re.compile(r"[1-9]\d{0,5}")
FIRST_OF_MACHINE = 100


class PartProgramLanguage:
    """RS-274 in the dialect of each file."""

    def __init__(self, files: Files, store: Path | None = None, dialect: str | None = None) -> None:
        self._files, self._store = files, StoreOfMachine(store, dialect)

    def dialect(self, document: Document) -> str:
        """The dialect of a program, as `openacr mill check` chooses it."""
        return self._store.dialect_of(document)

    def marks(
        self, document: Document, lines: Iterable[int]
    ) -> Iterator[tuple[int, tuple[Mark, ...]]]:
        """The parts of lines."""
        dialect = self.dialect(document)
        for line in lines:
            yield line, marks_of(document.lines[line], dialect)

    # names

    def related(self, document: Document) -> Iterable[Document]:
        """The document; subroutines in files of their own are found when they are looked for."""
        yield document
        for name in sorted(self._called(document)):
            path = found_in(document.path.parent, f"{name}.NGC")
            other = self._files.document(path) if path and path != document.path else None
            if other is not None:
                yield other

    def _called(self, document: Document) -> set[str]:
        if not DIALECTS[self.dialect(document)].grammar.has_o_words:
            return set()
        called: set[str] = set()
        for text in document.lines:
            if facts := facts_of(text):
                called.update({facts.routine} if facts.kind == "CALL" else ())
        return called

    def symbol(self, document: Document, line: int, mark: Mark) -> Symbol | None:
        """Labels belong to a file, local names to a subroutine."""
        if mark.kind is Kind.ROUTINE:
            return Symbol(Kind.ROUTINE, mark.name)
        if mark.kind is Kind.LABEL:
            return Symbol(Kind.LABEL, mark.name, str(document.path))
        if mark.kind is Kind.NAMED and mark.row is None and mark.name:
            is_global = mark.name.startswith("_")
            scope = "" if is_global else f"{document.path}:{self._subroutine(document, line)}"
            return Symbol(Kind.NAMED, mark.name, scope)
        return None

    @staticmethod
    def _subroutine(document: Document, line: int) -> str:
        """The subroutine around a line; empty in the main program."""
        inside = ""
        for text in document.lines[: line + 1]:
            facts = facts_of(text)
            if facts is not None and facts.kind == "SUB":
                inside = facts.routine
            elif facts is not None and facts.kind == "ENDSUB" and text is not document.lines[line]:
                inside = ""
        return inside

    def mentions(self, document: Document, symbol: Symbol) -> Iterator[int]:
        """The lines that hold the letters of a name, blanks left out."""
        for line, text in enumerate(document.lines):
            if symbol.name in text.upper().replace(" ", "").replace("\t", ""):
                yield line

    def refusal(self, document: Document, symbol: Symbol, new: str) -> str:
        """Why a name may not be given to a symbol."""
        if symbol.kind is Kind.LABEL:
            if not (_DIGITS.fullmatch(new) and int(new) <= LAST_LABEL):
                return f"{new}: a label is a whole number from 1 to {LAST_LABEL}"
        elif symbol.name.isdigit():
            if not _DIGITS.fullmatch(new):
                return f"{new}: the name of this O-word is a whole number"
        elif not _NAME.fullmatch(new):
            return f"{new}: a name has letters, digits and underscores, a letter first"
        elif symbol.kind is Kind.NAMED and new.startswith("_") != symbol.name.startswith("_"):
            return f"{new}: names that begin with _ belong to the whole program, others to one call"
        if new.upper() in PREDEFINED and symbol.kind is Kind.NAMED:
            return f"{new} is a name of the language"
        is_taken = any(
            mark.kind is symbol.kind and mark.name == new.upper()
            for _, marks in self.marks(document, range(len(document.lines)))
            for mark in marks
        )
        return f"{new} is another name in this file" if is_taken else ""

    @property
    def longest(self) -> int:
        """The characters a line may have."""
        return LONGEST

    # what parts of lines are

    def describe(self, document: Document, line: int, mark: Mark) -> str:
        """What a part of a line is."""
        if mark.kind is Kind.CELL:
            return markdown(self._record(document, mark.number))
        if mark.kind is Kind.LABEL:
            return f"**N{mark.name}**\n\nLabel"
        if mark.kind is Kind.ROUTINE:
            return f"**O{mark.name}**\n\nSubroutine or structure"
        return markdown(mark.row)

    def _record(self, document: Document, number: int) -> object:
        """What a numbered parameter is in the dialect of a file."""
        if DIALECTS[self.dialect(document)].parameters is not None:
            return None  # numbers are those of that language, not of the store
        return parameter(number) if number in CARD_PARAMETERS else cell(number)

    def hint(self, document: Document, mark: Mark) -> str:
        """The name of a parameter that is written as a number."""
        if mark.kind is not Kind.CELL or mark.number < FIRST_OF_MACHINE:
            return ""
        record = self._record(document, mark.number)
        name = getattr(record, "name", "")
        axis = getattr(record, "axis", None)
        return f"{name} (axis {axis})" if name and axis is not None else name

    # typing

    def complete(self, document: Document, place: Place) -> Completion:
        """Proposals for what is being typed."""
        before = document.lines[place.line][: place.column]
        dialect = DIALECTS[self.dialect(document)]
        if jump := _JUMP.search(before):
            return Completion.of(place, jump[1], self._labels(document, jump[1]))
        if dialect.grammar.has_o_words and (routine := _ROUTINE.match(before)):
            return Completion.of(place, routine[1], self._routines(document))
        word = _WORD.search(before)
        typed = word[0] if word else ""
        if typed.startswith("#"):
            return Completion.of(place, typed, self._named(document))
        table = dialect.table
        codes = [*table.gcodes.values(), *table.mcodes.values()]
        items = [Item(code.name, Kind.CODE, code.summary, row=code) for code in codes]
        letters = [(name, row) for name, row in table.letters.items() if len(name) == 1]
        items += [Item(name, Kind.WORD, row.summary, row=row) for name, row in letters]
        grammar = dialect.grammar
        items += [Item(name, Kind.COMMAND) for name in sorted(grammar.statements)]
        items += [Item(name, Kind.FUNCTION) for name in sorted(grammar.functions)]
        return Completion.of(place, typed, items)

    def _labels(self, document: Document, typed: str) -> Iterator[Item]:
        facts = filter(None, map(facts_of, document.lines))
        names = {each.label for each in facts if each.label and each.label.startswith(typed)}
        return (Item(name, Kind.LABEL, "label") for name in sorted(names, key=int))

    def _routines(self, document: Document) -> list[Item]:
        found = {f.routine for text in document.lines if (f := facts_of(text)) and f.routine}
        return [
            Item(name if name.isdigit() else f"<{name.lower()}>", Kind.ROUTINE)
            for name in sorted(found)
        ]

    def _named(self, document: Document) -> list[Item]:
        lines = [line for line, text in enumerate(document.lines) if "<" in text]
        own = {
            mark.name
            for _, marks in self.marks(document, lines)
            for mark in marks
            if mark.kind is Kind.NAMED and mark.row is None
        }
        items = [Item(f"#<{name.lower()}>", Kind.NAMED) for name in sorted(own)]
        return items + [
            Item(row.shown, Kind.NAMED, row.meaning, row=row) for row in PREDEFINED.values()
        ]

    def signature(self, document: Document, place: Place) -> Signature | None:
        """Part programs have words, not calls."""
        return None

    # the whole text

    def entries(self, document: Document) -> list[Entry]:
        """Subroutines and labels that stand alone in their lines or before remarks."""
        found: list[Entry] = []
        for line, text in enumerate(document.lines):
            facts = facts_of(text)
            if facts is None:
                continue
            if facts.kind in ("SUB", ""):
                if facts.routine:
                    found.append(Entry(f"O{facts.routine}", "", Kind.ROUTINE, line, line))
                elif facts.label and facts.is_bare:
                    found.append(Entry(f"N{facts.label}", facts.remark, Kind.LABEL, line, line))
            elif facts.kind == "ENDSUB" and found and found[-1].name == f"O{facts.routine}":
                found[-1].last = line
        return found

    def folds(self, document: Document) -> Iterator[Fold]:
        """Structures of O-words, and remarks of several lines."""
        waiting: dict[str, list[int]] = {}
        remark = last_remark = -2
        for line, text in enumerate(document.lines):
            facts = facts_of(text)
            if facts is None:
                continue
            if facts.is_remark:
                if line != last_remark + 1:
                    yield from _fold(remark, last_remark)
                    remark = line
                last_remark = line
            if facts.opens:
                waiting.setdefault(facts.routine, []).append(line)
            elif facts.closes and waiting.get(facts.routine):
                yield Fold(waiting[facts.routine].pop(), line)
        yield from _fold(remark, last_remark)

    def format(self, document: Document) -> list[Edit]:
        """`openacr mill list` shows the lines as they are."""
        return []

    def subject(self, document: Document) -> Path:
        """The file itself."""
        return document.path

    def findings(
        self, subject: Path, documents: Mapping[Path, Document]
    ) -> dict[Path, list[Finding]]:
        """What `openacr mill check` finds."""
        return findings(documents[subject], self._store)

    def prepare(self, document: Document) -> Iterator[None]:
        """Choose the dialect, and read what the lines say."""
        self.dialect(document)
        yield
        yield from in_steps(facts_of, document.lines)

    def forget(self, path: Path) -> None:
        """Choose the dialect of a file anew when it is opened again."""
        self._store.forget(path)


def _fold(first: int, last: int) -> Iterator[Fold]:
    if 0 <= first < last:
        yield Fold(first, last, COMMENT)
