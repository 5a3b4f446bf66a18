"""What holds for all texts: no question raises, changes keep the meaning, LIST is the form."""

from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.search import IS_WHOLE

from openacr.editing.controller.outline import outline
from openacr.editing.document import Document, Edit, Place, Span
from openacr.editing.engine import Engine
from openacr.errors import UserError
from openacr.project import find_project
from openacr.source_check import check, listing, read

EXAMPLES = Path(__file__).parents[2] / "examples"
PROJECTS = sorted(path.parent for path in EXAMPLES.glob("*/setup.8k"))
PARTS = (
    "PROGRAM\n", "ENDP\n", "_a\n", "GOTO a\n", "PROG1\n", "PLC0\n", "SYS\n", "#DEFINE b P1\n",
    "b = 2 : X1\n", "SET 32\n", "IF (1)\n", "ENDIF\n", "LD 1 OUT 2\n", "REM x\n", 'PRINT "a',
    "ATTACH SLAVE0 AXIS0 \"X\"\n", "JOG VEL", " ", "(", "\u00e9", "\U0001d11e", "\x00", "\x0c",
    "\r", "\n", "\ud800", "P1229", "10 END\n", "'c\n", "?", "#",
    "N10 G1 X(P5)\n", "O<s> sub\n", "#<v> = [1\n", "G65 P10\n", "M98 P1", "%\n", "@1", ";d\n",
)  # fmt: skip
TEXTS = st.lists(st.sampled_from(PARTS), max_size=12).map("".join)
PLACES = st.builds(Place, st.integers(-1, 12), st.integers(-1, 12))
EDITS = st.builds(Edit, st.builds(Span, PLACES, PLACES), TEXTS)
NAMES = ("prog0.8k", "plc1.8k", "setup.8k", "a.nc", "b.ngc", "noname")


def ask_everything(engine: Engine, path: Path, place: Place) -> None:
    engine.describe(path, place)
    engine.complete(path, place)
    engine.signature(path, place)
    engine.definitions(path, place)
    engine.references(path, place)
    with suppress(UserError):
        engine.rename(path, place, "other")
    engine.entries(path)
    engine.folds(path)
    engine.format(path)
    list(engine.colored(path, 0, 99))
    list(engine.shown(path, 0, 99))


@settings(max_examples=30)
@given(st.sampled_from(NAMES), TEXTS, st.lists(st.tuples(EDITS, PLACES), max_size=3))
def test_no_text_and_no_place_raises(
    name: str, text: str, changes: list[tuple[Edit, Place]]
) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder, name)
        engine = Engine(Path(folder, "store.db"))
        engine.open(path, text)
        for edit, place in changes:
            engine.change(path, [edit])
            ask_everything(engine, path, place)


@settings(max_examples=15)
@given(st.sampled_from(NAMES), TEXTS)
def test_every_text_can_be_checked(name: str, text: str) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder, name)
        engine = Engine(Path(folder, "store.db"))
        engine.open(path, text)
        assert path in engine.findings(engine.subject(path))


@given(TEXTS, st.lists(EDITS, max_size=5))
def test_an_outline_that_follows_changes_is_that_of_the_text(text: str, edits: list[Edit]) -> None:
    document = Document.of(Path("prog3.8k"), text)
    followed = outline(document)
    for edit in edits:
        document.apply(edit)
        followed = outline(document, followed)
        assert followed == outline(Document.of(document.path, document.text))


@settings(max_examples=20)
@given(TEXTS, st.lists(EDITS, min_size=1, max_size=3), PLACES)
def test_answers_after_changes_are_those_for_the_text(
    text: str, edits: list[Edit], place: Place
) -> None:
    path = Path("/no-folder/prog0.8k")
    changed, fresh = Engine(), Engine()
    changed.open(path, text)
    changed.complete(path, place)
    changed.change(path, edits)
    fresh.open(path, changed.document(path).text)
    for engine in (changed, fresh):
        engine.files.forget()
    assert changed.complete(path, place) == fresh.complete(path, place)
    assert changed.describe(path, place) == fresh.describe(path, place)
    assert changed.references(path, place) == fresh.references(path, place)
    assert changed.entries(path) == fresh.entries(path)
    assert changed.folds(path) == fresh.folds(path)
    assert list(changed.colored(path, 0, 99)) == list(fresh.colored(path, 0, 99))
    assert changed.findings(path) == fresh.findings(path)


@pytest.mark.parametrize("project", PROJECTS, ids=lambda path: path.name)
def test_a_formatted_example_is_its_listing_and_stays_so(project: Path, tmp_path: Path) -> None:
    for source in sorted(project.glob("*.8k")):
        path = project / source.name
        engine = Engine()
        engine.open(path, source.read_text(encoding="utf-8"))
        edits = engine.format(path)
        engine.change(path, edits[::-1])
        text = engine.document(path).text
        assert engine.format(path) == []
        before = read(path, find_project(path))
        unsaved = {path: text.encode()}
        after = read(path, find_project(path, unsaved), unsaved=unsaved)
        assert list(listing(after)) == list(listing(before))
        written = [line.rstrip() for line in text.splitlines() if line.strip()]
        assert written == [line.rstrip() for line in listing(before)]


def renamed(engine: Engine, path: Path, place: Place, new: str) -> dict[Path, Document]:
    """The texts after a name has got another spelling."""
    texts = dict(engine.copies())
    for file, edits in engine.rename(path, place, new).items():
        document = Document.of(file, file.read_text(encoding="utf-8"))
        for edit in sorted(edits, reverse=True):
            document.apply(edit)
        texts[file] = document
    return texts


@pytest.mark.search
@pytest.mark.parametrize("project", PROJECTS, ids=lambda path: path.name)
def test_check_finds_the_same_after_every_name_was_changed(project: Path) -> None:
    expected = [(fault.path, fault.line, fault.message) for fault in check(project)]
    for source in sorted(project.glob("*.8k")):
        engine = Engine()
        engine.open(source, source.read_text(encoding="utf-8"))
        symbols = {
            (mark.kind, mark.name): Place(line, mark.own[0])
            for line, mark in engine.colored(source, 0, 10_000)
            if engine.renamable(source, Place(line, mark.own[0])) and not mark.name.isdigit()
        }
        for place in list(symbols.values())[:: 1 if IS_WHOLE else 4]:
            texts = renamed(engine, source, place, "QXJ")
            unsaved = {path: document.data for path, document in texts.items()}
            found = [(f.path, f.line, f.message) for f in check(project, unsaved=unsaved)]
            assert found == expected, place
            assert any(document.text.count("QXJ") for document in texts.values())
