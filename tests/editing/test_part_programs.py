"""Part programs in an editor: both dialects, answered from their tables."""

from pathlib import Path

import pytest

from openacr.cnc.codes.table import DIALECTS
from openacr.editing.completions import MOST_ITEMS
from openacr.editing.document import Edit, Place, Span
from openacr.editing.engine import Engine
from openacr.editing.marks import Kind
from openacr.editing.part_programs.marks import marks_of
from openacr.errors import UserError
from openacr.mill.plan.estimate.checking import check_text
from openacr.sysvar.location import open_to_read

ACROMILL = """\
; dialect acromill
(the part)
(of two lines)
N10 G1 X(P5 + 1) F100
P650015 = 2
IF P5 > 3 THEN GOTO 10
GOSUB 20
G65 P20 A1
M2
N20 (drill it)
RET
"""
NGC = """\
;dialect rs274ngc
#<depth> = 2
O<drill> sub
#<depth> = [#<depth> + #1]
#<_total> = #<_x>
O<drill> endsub
O100 if [#<depth> GT 1]
O<Dri ll> call [3]
O100 endif
G2 X1 Y1 I1
M2
"""


@pytest.fixture
def engine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Engine:
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "store.db"))
    found = Engine()
    found.open(tmp_path / "a.nc", ACROMILL)
    found.open(tmp_path / "b.ngc", NGC)
    return found


@pytest.mark.parametrize(
    ("dialect", "text", "expected"),
    [
        ("acromill", "N10 G1X-1.5 (a)", [(0, 3, Kind.LABEL, "10"), (4, 6, Kind.CODE, "G1"),
                                         (6, 11, Kind.WORD, "X"), (12, 15, Kind.REMARK, "")]),
        ("acromill", "X(P5+1)", [(0, 1, Kind.WORD, "X"), (2, 4, Kind.CELL, "P5"),
                                 (5, 6, Kind.NUMBER, "")]),
        ("acromill", "IF P5>3 THEN GOTO 10", [(0, 2, Kind.COMMAND, "IF"), (3, 5, Kind.CELL, "P5"),
                                              (6, 7, Kind.NUMBER, ""),
                                              (8, 12, Kind.COMMAND, "THEN"),
                                              (13, 17, Kind.COMMAND, "GOTO"),
                                              (18, 20, Kind.LABEL, "10")]),
        ("acromill", "G65 P20 A1", [(0, 3, Kind.CODE, "G65"), (4, 7, Kind.LABEL, "20"),
                                    (8, 10, Kind.WORD, "A")]),
        ("acromill", "G4 F1;P5=3", [(0, 2, Kind.CODE, "G4"), (3, 5, Kind.WORD, "F"),
                                    (5, 10, Kind.REMARK, "")]),
        ("rs274ngc", "O<a> call [1]", [(0, 4, Kind.ROUTINE, "A"), (5, 9, Kind.COMMAND, "CALL"),
                                       (11, 12, Kind.NUMBER, "")]),
        ("rs274ngc", "O007 while [#<x> LT 2]", [(0, 4, Kind.ROUTINE, "7"),
                                                (5, 10, Kind.COMMAND, "WHILE"),
                                                (12, 16, Kind.NAMED, "X"),
                                                (17, 19, Kind.OPERATOR, "LT"),
                                                (20, 21, Kind.NUMBER, "")]),
        ("rs274ngc", "#<_feed>=#<_x>", [(0, 8, Kind.NAMED, "_FEED"), (9, 14, Kind.NAMED, "_X")]),
        ("rs274ngc", "G4 P2", [(0, 2, Kind.CODE, "G4"), (3, 5, Kind.WORD, "P")]),
        ("rs274ngc", "M98 P100", [(0, 3, Kind.CODE, "M98"), (4, 8, Kind.ROUTINE, "100")]),
        ("rs274ngc", "X SIN[30]", [(0, 1, Kind.WORD, "X"), (2, 5, Kind.FUNCTION, "SIN"),
                                   (6, 8, Kind.NUMBER, "")]),
        ("rs274ngc", "%", []),
    ],
)  # fmt: skip
def test_a_line_falls_into_parts(
    dialect: str, text: str, expected: list[tuple[int, int, Kind, str]]
) -> None:
    found = marks_of(text, dialect)
    assert [(mark.start, mark.end, mark.kind, mark.name) for mark in found] == expected


@pytest.mark.parametrize("dialect", sorted(DIALECTS))
def test_every_code_is_described_by_its_row(tmp_path: Path, dialect: str) -> None:
    engine = Engine(tmp_path / "store.db", dialect)
    table = DIALECTS[dialect].table
    for code in (*table.gcodes.values(), *table.mcodes.values()):
        engine.open(tmp_path / "c.nc", f"{code.name}\n")
        found = engine.describe(tmp_path / "c.nc", Place(0, 0))
        assert found is not None
        assert found[0].startswith(f"**{code.name}**\n\n{code.summary}"), code.name


@pytest.mark.parametrize(
    ("name", "line", "column", "begins"),
    [
        ("a.nc", 3, 4, "**G1**"),
        ("a.nc", 4, 2, "**P650015 "),
        ("a.nc", 3, 17, "**F**"),
        ("a.nc", 9, 1, "**N20**"),
        ("b.ngc", 4, 12, "**#<_x>**"),
        ("b.ngc", 2, 2, "**ODRILL**"),
    ],
)
def test_words_are_described(
    engine: Engine, tmp_path: Path, name: str, line: int, column: int, begins: str
) -> None:
    found = engine.describe(tmp_path / name, Place(line, column))
    assert found is not None
    assert found[0].startswith(begins)


def places(engine: Engine, path: Path, line: int, column: int) -> list[tuple[int, int, int]]:
    return [
        (span.start.line, span.start.column, span.end.column)
        for _, span in engine.references(path, Place(line, column))
    ]


def test_labels_routines_and_named_parameters_are_found(engine: Engine, tmp_path: Path) -> None:
    a, b = tmp_path / "a.nc", tmp_path / "b.ngc"
    assert places(engine, a, 9, 1) == [(6, 6, 8), (7, 5, 7), (9, 1, 3)]
    assert [each.span.start for each in engine.definitions(a, Place(5, 21))] == [Place(3, 1)]
    assert places(engine, b, 7, 4) == [(2, 2, 7), (5, 2, 7), (7, 2, 8)]
    assert [each.span.start for each in engine.definitions(b, Place(7, 4))] == [Place(2, 2)]


def test_a_local_name_belongs_to_its_subroutine(engine: Engine, tmp_path: Path) -> None:
    path = tmp_path / "b.ngc"
    assert places(engine, path, 1, 3) == [(1, 2, 7), (6, 11, 16)]
    assert places(engine, path, 3, 3) == [(3, 2, 7), (3, 14, 19)]


def test_a_subroutine_in_a_file_of_its_own_is_found(engine: Engine, tmp_path: Path) -> None:
    other = tmp_path / "bore.ngc"
    other.write_text("O<bore> sub\nO<bore> endsub\nM2\n")
    engine.open(tmp_path / "m.ngc", ";dialect rs274ngc\nO<bore> call\nM2\n")
    (found,) = engine.definitions(tmp_path / "m.ngc", Place(1, 3))
    assert found == (other, Span(Place(0, 2), Place(0, 6)))


def test_names_get_another_spelling(engine: Engine, tmp_path: Path) -> None:
    changes = engine.rename(tmp_path / "a.nc", Place(9, 1), "30")
    assert [edit.span.start for edit in changes[tmp_path / "a.nc"]] == [
        Place(6, 6), Place(7, 5), Place(9, 1),
    ]  # fmt: skip
    changes = engine.rename(tmp_path / "b.ngc", Place(3, 3), "deep")
    assert [edit.span.start for edit in changes[tmp_path / "b.ngc"]] == [Place(3, 2), Place(3, 14)]


@pytest.mark.parametrize(
    ("name", "line", "column", "new", "reason"),
    [
        ("a.nc", 9, 1, "10", "10 is another name in this file"),
        ("a.nc", 9, 1, "0", "0: a label is a whole number from 1 to 999999"),
        ("a.nc", 9, 1, "A", "A: a label is a whole number from 1 to 999999"),
        ("b.ngc", 3, 3, "_deep", "_deep: names that begin with _ belong to the whole program,"),
        ("b.ngc", 4, 3, "_x", "_x is a name of the language"),
        ("b.ngc", 2, 3, "a b", "a b: a name has letters, digits and underscores"),
    ],
)
def test_a_spelling_that_would_change_the_program_is_refused(
    engine: Engine, tmp_path: Path, name: str, line: int, column: int, new: str, reason: str
) -> None:
    with pytest.raises(UserError) as refused:
        engine.rename(tmp_path / name, Place(line, column), new)
    assert str(refused.value).startswith(reason)


@pytest.mark.parametrize(
    ("name", "text", "labels"),
    [
        ("a.nc", "G8", ["G80", "G81"]),
        ("a.nc", "GOTO ", ["10", "20"]),
        ("a.nc", "PRI", ["PRINT"]),
        ("b.ngc", "O", ["100", "<drill>"]),
        ("b.ngc", "G1 X#<de", ["#<depth>"]),
        ("b.ngc", "M9", ["M9", "M98"]),
    ],
)
def test_what_fits_is_proposed(
    engine: Engine, tmp_path: Path, name: str, text: str, labels: list[str]
) -> None:
    path = tmp_path / name
    engine.change(path, [Edit(Span(Place(1, 0), Place(1, 0)), f"{text}\n")])
    shown = [item.label for item in engine.complete(path, Place(1, len(text))).items]
    assert [label for label in shown if label in labels] == labels


@pytest.mark.parametrize("name", ["c.nc", "prog0.8k"])
@pytest.mark.parametrize(("count", "is_whole"), [(MOST_ITEMS, True), (MOST_ITEMS + 1, False)])
def test_of_very_many_labels_the_first_are_proposed_and_others_as_the_word_goes_on(
    engine: Engine, tmp_path: Path, name: str, count: int, is_whole: bool
) -> None:
    label = "N{} G1 X1\n" if name == "c.nc" else "{} DWL 1\n"
    labels = range(1000, 1000 + count)
    path = tmp_path / name
    engine.open(path, "".join(map(label.format, labels)) + "GOTO 1500")
    found = engine.complete(path, Place(count, 5))
    assert [item.label for item in found.items] == [str(each) for each in labels[:MOST_ITEMS]]
    assert found.is_whole is is_whole
    typed = engine.complete(path, Place(count, 8))
    assert typed.is_whole
    last = [str(each) for each in labels if each >= 1500]
    assert [item.label for item in typed.items] == last


def test_outline_folds_and_hints(engine: Engine, tmp_path: Path) -> None:
    a, b = tmp_path / "a.nc", tmp_path / "b.ngc"
    assert [(each.name, each.detail, each.first) for each in engine.entries(a)] == [
        ("N20", "drill it", 9)
    ]
    assert [(each.name, each.first, each.last) for each in engine.entries(b)] == [("ODRILL", 2, 5)]
    assert [tuple(fold) for fold in engine.folds(a)] == [(0, 2, "comment")]
    assert [tuple(fold) for fold in engine.folds(b)] == [(2, 5, ""), (6, 8, "")]
    assert [(place, text) for place, text in engine.shown(a, 4, 4)] == [(Place(4, 7), "Path jerk")]
    assert engine.format(a) == []
    assert engine.signature(a, Place(3, 5)) is None


def test_findings_are_those_of_mill_check(engine: Engine, tmp_path: Path) -> None:
    for name in ("a.nc", "b.ngc"):
        path = tmp_path / name
        text = engine.document(path).text
        with open_to_read(None) as cells:
            expected = check_text(text, path, cells)
        found = engine.findings(engine.subject(path))[path]
        assert [(f.code, f.message, f.hint, f.span.start, not f.is_warning) for f in found] == [
            (e.code, e.text, e.hint, Place(e.line - 1, e.column - 1), e.is_error) for e in expected
        ]
    assert [f.code for f in found] == [f.code for f in found if f.code]


def test_a_missing_file_of_cycles_is_added(engine: Engine, tmp_path: Path) -> None:
    path = tmp_path / "d.nc"
    engine.open(path, "G81 X1 Y1 Z-1 R1 F100\nM2")
    found = engine.findings(path)[path]
    ((finding, fix),) = engine.fixes(found, Span(Place(0, 0), Place(0, 0)))
    assert finding.code == "E251"
    engine.change(path, [fix.edit])
    assert engine.document(path).text.endswith("M2\n$I CYCLES.TXT\n")
    assert [each.code for each in engine.findings(path)[path] if each.code == "E251"] == []
