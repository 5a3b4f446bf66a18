"""What browsers ask of a text that is edited, answered by the engine of editors as plain data.

Every question is a row of QUESTIONS. Lines and columns count from 0, columns in 16-bit units.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

from openacr.editing.document import Place
from openacr.editing.outlines import Entry
from openacr.editing.symbols import Location
from openacr.editing.texts import markdown
from openacr.errors import OpenacrError, UserError
from openacr.panel.work.desk import Desk, Opened, State
from openacr.project import find_project
from openacr.source_check import read

MOST_FINDINGS = 500
MOST_PLACES = 1000


@dataclass(frozen=True, slots=True)
class About:
    """What a question is about: a place, lines, a word."""

    line: int = 0
    column: int = 0
    last: int = 0
    word: str = ""


class Entered(NamedTuple):
    """A line that a card stores: its number there, its line in the text from 1, the text."""

    number: int
    line: int
    text: str


Answer = Callable[[Opened, About], Any]
QUESTIONS: dict[str, Answer] = {}


def question(asked: Answer) -> Answer:
    """Enter a function under its name as the answer to a question."""
    QUESTIONS[asked.__name__] = asked
    return asked


@cache
def desk() -> Desk:
    """The texts of this process."""
    return Desk()


def answer(state: State, name: str, about: About) -> dict[str, Any]:
    """The answer to a question; `stale` where the text has to be sent whole, `refusal`: why not."""
    opened = desk().at(state)
    if opened is None:
        return {"stale": True}
    try:
        return {"version": opened.version, "answer": QUESTIONS[name](opened, about)}
    except OpenacrError as error:
        return {"version": opened.version, "answer": None, "refusal": str(error)}


def _place(opened: Opened, about: About) -> Place:
    return opened.place(about.line, about.column)


# --- words ----------------------------------------------------------------------------


@question
def colors(opened: Opened, about: About) -> object:
    """The parts of some lines: line, first and last column, kind."""
    found = opened.engine.colored(opened.path, about.line, about.last)
    return [
        [line, *opened.columns(line, mark.start, mark.end), mark.kind.name.lower()]
        for line, mark in found
        if mark.end > mark.start
    ]


@question
def hints(opened: Opened, about: About) -> object:
    """What the numbers of parameters and flags in some lines stand for: line, column, text."""
    found = opened.engine.shown(opened.path, about.line, about.last)
    return [[place.line, *opened.columns(*place), text] for place, text in found]


@question
def values(opened: Opened, about: About) -> object:
    """What has a value in some lines: line, program, each as it is written with its name."""
    return list(opened.engine.values(opened.path, about.line, about.last))


@question
def hover(opened: Opened, about: About) -> object:
    """What is at a place, as Markdown, and its span."""
    found = opened.engine.describe(opened.path, _place(opened, about))
    return {"text": found[0], "span": opened.span(found[1])} if found else None


@question
def complete(opened: Opened, about: About) -> object:
    """Proposals for what is being typed, and the span they are written to."""
    found = opened.engine.complete(opened.path, _place(opened, about))
    items = [
        {"label": each.label, "kind": each.kind.name.lower(), "detail": each.detail,
         "text": each.text or each.label, "doc": markdown(each.row)}
        for each in found.items
    ]  # fmt: skip
    return {"span": opened.span(found.span), "items": items}


@question
def signature(opened: Opened, about: About) -> object:
    """How the command or function at a place is written: its parts, and the present one."""
    found = opened.engine.signature(opened.path, _place(opened, about))
    if found is None:
        return None
    shown = found[0]
    return {"label": shown.label, "parts": list(shown.parts), "active": shown.active}


# --- names ----------------------------------------------------------------------------


def _places(opened: Opened, found: list[Location]) -> object:
    """Places in the text; `other` counts those in the set-up of the card."""
    here = [each for each in found if each.path == opened.path]
    places = [
        {"span": opened.span(each.span), "text": opened.document.lines[each.span.start.line]}
        for each in here[:MOST_PLACES]
    ]
    return {"places": places, "other": len(found) - len(here)}


@question
def definitions(opened: Opened, about: About) -> object:
    """Where the name at a place is defined."""
    return _places(opened, opened.engine.definitions(opened.path, _place(opened, about)))


@question
def references(opened: Opened, about: About) -> object:
    """Where the name at a place is used and defined."""
    return _places(opened, opened.engine.references(opened.path, _place(opened, about)))


@question
def renamable(opened: Opened, about: About) -> object:
    """The span and the text of the name at a place, if it can be renamed in this text alone."""
    place = _place(opened, about)
    span = opened.engine.renamable(opened.path, place)
    if span is None:
        return None
    line = opened.document.lines[span.start.line]
    return {"span": opened.span(span), "text": line[span.start.column : span.end.column]}


@question
def rename(opened: Opened, about: About) -> object:
    """The changes that give the name at a place another spelling."""
    changes = opened.engine.rename(opened.path, _place(opened, about), about.word)
    if set(changes) - {opened.path}:
        raise UserError("this name is defined on the card, not in this text: rename it there")
    return opened.edits(changes.get(opened.path, ()))


# --- the whole text -------------------------------------------------------------------


@question
def outline(opened: Opened, about: About) -> object:
    """Programs with their labels, and aliases: name, first line, and what is in it."""
    return list(map(_entry, opened.engine.entries(opened.path)))


def _entry(entry: Entry) -> dict[str, object]:
    return {
        "name": entry.name, "detail": entry.detail, "line": entry.first,
        "parts": list(map(_entry, entry.parts)),
    }  # fmt: skip


@question
def folds(opened: Opened, about: About) -> object:
    """First and last lines of what folds: programs, blocks, remarks."""
    return [[fold.first, fold.last] for fold in opened.engine.folds(opened.path)]


@question
def formatted(opened: Opened, about: About) -> object:
    """The changes that make the text look as LIST shows it."""
    return opened.edits(opened.engine.format(opened.path))


@question
def findings(opened: Opened, about: About) -> object:
    """What is wrong, with what mends it, and how many more findings there are."""
    engine = opened.engine
    every = engine.findings(engine.subject(opened.path)).get(opened.path, [])
    shown = [
        {"span": opened.span(each.span), "text": each.text, "is_warning": each.is_warning,
         "fix": each.fix and {"title": each.fix.title, "edits": opened.edits([each.fix.edit])}}
        for each in every[:MOST_FINDINGS]
    ]  # fmt: skip
    return {"findings": shown, "more": len(every) - len(shown)}


@question
def stored(opened: Opened, about: About) -> object:
    """By program: the lines of the text that a card stores, as its numbers and lines from 0."""
    return {
        level: [[each.number, each.line - 1] for each in lines]
        for level, lines in stored_lines(opened).items()
    }


def stored_lines(opened: Opened) -> dict[str, list[Entered]]:
    """The lines that a card stores, by program."""
    data = {path: each.data for path, each in opened.engine.copies().items()}
    reader = read(opened.path, find_project(opened.path, data), unsaved=data)
    return {
        f"{level.name}{number}": [
            Entered(line.number, line.place.number, line.stored.text) for line in text.in_order()
        ]
        for (level, number), text in reader.texts.items()
    }
