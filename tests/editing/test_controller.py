"""AcroBASIC and PLC programs in an editor: every answer from the tables and the project."""

from pathlib import Path

import pytest

from openacr.basic.language import registry
from openacr.basic.language.written import syntax
from openacr.editing.controller.marks import marks_of
from openacr.editing.document import Edit, Place, Span
from openacr.editing.engine import Engine
from openacr.editing.marks import Kind
from openacr.editing.symbols import Location
from openacr.errors import UserError
from openacr.source_check import check

SETUP = """\
SYS
DIM PROG0(4000)
DIM DEF(5)
#DEFINE speed P12294
#DEFINE lamp BIT34
#DEFINE count LV0
PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
DIM LV(2)
"""
PROGRAM = """\
PROGRAM
REM the lamp
REM GOTO Head
_Head
VEL 5 ACC(speed) X10
SET 34 : CLR lamp ' a comment
IF (BIT516 AND P12288 > 3)
GOTO Head
ENDIF
JOG VEL X5 : INH -516
PRINT "Head", lamp : GOSUB Tail
sped = 3
_Tail
count = count + 1
RETURN
ENDP
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "setup.8k").write_text(SETUP)
    (tmp_path / "prog0.8k").write_text(PROGRAM)
    return tmp_path


@pytest.fixture
def engine(project: Path) -> Engine:
    found = Engine()
    found.open(project / "prog0.8k", PROGRAM)
    return found


def lines_of(places: list[Location]) -> list[tuple[str, int, int, int]]:
    return [
        (path.name, span.start.line, span.start.column, span.end.column) for path, span in places
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("JOG VEL X5", [(0, 3, Kind.COMMAND, "JOG VEL"), (4, 7, Kind.COMMAND, "JOG VEL"),
                        (8, 9, Kind.AXIS, "X"), (9, 10, Kind.NUMBER, "")]),
        ("10 SET 32 -33", [(0, 2, Kind.LABEL, "10"), (3, 6, Kind.COMMAND, "SET"),
                           (7, 9, Kind.FLAG, "BIT32"), (11, 13, Kind.FLAG, "BIT33")]),
        ("INH 516 (5)", [(0, 3, Kind.COMMAND, "INH"), (4, 7, Kind.FLAG, "BIT516"),
                         (9, 10, Kind.NUMBER, "")]),
        ("P(12288)=P99", [(0, 8, Kind.PARAMETER, "P12288"), (9, 12, Kind.VARIABLE, "P99")]),
        ("ATTACH AXIS0 ENC1", [(0, 6, Kind.COMMAND, "ATTACH AXIS #"),
                               (7, 11, Kind.COMMAND, "ATTACH AXIS #"),
                               (11, 12, Kind.NUMBER, "ATTACH AXIS #"),
                               (13, 16, Kind.KEYWORD, "ENC"), (16, 17, Kind.NUMBER, "")]),
        ("AXIS3 ON", [(0, 4, Kind.COMMAND, "AXIS # ON"), (4, 5, Kind.NUMBER, "AXIS # ON"),
                      (6, 8, Kind.COMMAND, "AXIS # ON")]),
        ("#DEFINE two2 P1", [(0, 7, Kind.COMMAND, "#DEFINE"), (8, 12, Kind.ALIAS, "two2"),
                             (13, 15, Kind.VARIABLE, "P1")]),
        ("GOSUB 50 : REM x", [(0, 5, Kind.COMMAND, "GOSUB"), (6, 8, Kind.LABEL, "50"),
                              (11, 16, Kind.REMARK, "")]),
        ('? "a" \' x', [(0, 1, Kind.COMMAND, "PRINT"), (2, 5, Kind.STRING, ""),
                        (6, 9, Kind.REMARK, "")]),
        ('PRINT "\u00e9\U0001d11e",SIN(lamp)', [(0, 5, Kind.COMMAND, "PRINT"),
                                                (6, 10, Kind.STRING, ""),
                                                (11, 14, Kind.FUNCTION, "SIN"),
                                                (15, 19, Kind.ALIAS, "lamp")]),
        ("DWL 1 ' \U0001d11e\u2026 on", [(0, 3, Kind.COMMAND, "DWL"), (4, 5, Kind.NUMBER, ""),
                                      (6, 13, Kind.REMARK, "")]),
        ("DWL 1 : REM \u2026\U0001d11e", [(0, 3, Kind.COMMAND, "DWL"), (4, 5, Kind.NUMBER, ""),
                                         (8, 14, Kind.REMARK, "")]),
        ("VEL \u2026 @ X1", [(0, 3, Kind.COMMAND, "VEL")]),
        ("VEL 5 @ X1", [(0, 3, Kind.COMMAND, "VEL"), (4, 5, Kind.NUMBER, "")]),
        ("X = INT(2.5)", [(0, 1, Kind.AXIS, "X"), (4, 7, Kind.FUNCTION, "INT"),
                          (8, 11, Kind.NUMBER, "")]),
    ],
)  # fmt: skip
def test_a_line_falls_into_parts(text: str, expected: list[tuple[int, int, Kind, str]]) -> None:
    found = marks_of(text, frozenset({"lamp"}), frozenset({"X"}), is_plc=False)
    assert [(mark.start, mark.end, mark.kind, mark.name) for mark in found] == expected


def test_a_line_of_a_plc_falls_into_instructions_and_flags() -> None:
    found = marks_of("LD 3 AND NOT lamp OUT TIM1", frozenset({"lamp"}), frozenset(), is_plc=True)
    assert [(mark.start, mark.end, mark.kind, mark.name) for mark in found] == [
        (0, 2, Kind.COMMAND, "LD"),
        (3, 4, Kind.FLAG, "BIT3"),
        (5, 8, Kind.COMMAND, "AND NOT"),
        (9, 12, Kind.COMMAND, "AND NOT"),
        (13, 17, Kind.ALIAS, "lamp"),
        (18, 21, Kind.COMMAND, "OUT"),
        (22, 25, Kind.KEYWORD, "TIM"),
        (25, 26, Kind.NUMBER, ""),
    ]


@pytest.mark.parametrize(
    ("line", "column", "begins", "holds"),
    [
        (4, 1, "**VEL**", "Written: `VEL {value}`"),
        (4, 12, "**speed**", "**P12294 Primary Setpoint**"),
        (4, 17, "**X**", "Axis 0"),
        (5, 5, "**BIT34 OUT 34**", "Output on connector"),
        (6, 6, "**BIT516 In Motion**", "Set while a move is active"),
        (6, 18, "**P12288 Current Position**", "Unit: "),
        (7, 6, "**Head**", "Label of PROG0"),
        (9, 5, "**JOG VEL**", "units/s"),
    ],
)
def test_words_are_described_by_the_rows_of_the_tables(
    engine: Engine, project: Path, line: int, column: int, begins: str, holds: str
) -> None:
    found = engine.describe(project / "prog0.8k", Place(line, column))
    assert found is not None
    assert found[0].startswith(begins)
    assert holds in found[0]


def test_nothing_is_said_of_remarks_strings_and_empty_places(engine: Engine, project: Path) -> None:
    for place in (Place(1, 5), Place(10, 8), Place(0, 99), Place(99, 0), Place(5, 20)):
        found = engine.describe(project / "prog0.8k", place)
        assert found is None or found[0].startswith("**PROGRAM**")


def test_every_command_is_described_with_its_form() -> None:
    path = Path("/none/a.8k")
    engine = Engine()
    for row in registry.commands():
        is_known_by_its_form = row.words[0] in ("LET", "MOV", "K", "W")
        if is_known_by_its_form or row.words[0].startswith("#") or row.name == "AXIS #":
            continue
        text = " ".join(word.replace("#", "0") for word in row.words)
        engine.open(path, f"PROG0\n{text}\n")
        found = engine.describe(path, Place(1, 1))
        assert found is not None, row.name
        assert f"Written: `{syntax(row)}`" in found[0], row.name


def test_labels_are_found_in_their_program_alone(engine: Engine, project: Path) -> None:
    path = project / "prog0.8k"
    assert lines_of(engine.definitions(path, Place(7, 5))) == [("prog0.8k", 3, 1, 5)]
    assert lines_of(engine.references(path, Place(3, 2))) == [
        ("prog0.8k", 3, 1, 5),
        ("prog0.8k", 7, 5, 9),
    ]
    without = engine.references(path, Place(3, 2), has_definitions=False)
    assert lines_of(without) == [("prog0.8k", 7, 5, 9)]
    engine.open(project / "prog1.8k", "PROGRAM\n_Head\nGOTO Head\nENDP\n")
    assert lines_of(engine.references(project / "prog1.8k", Place(1, 2))) == [
        ("prog1.8k", 1, 1, 5),
        ("prog1.8k", 2, 5, 9),
    ]


def test_aliases_and_axes_are_found_in_all_files_of_the_project(
    engine: Engine, project: Path
) -> None:
    path = project / "prog0.8k"
    assert lines_of(engine.definitions(path, Place(4, 12))) == [("setup.8k", 3, 8, 13)]
    assert lines_of(engine.references(path, Place(5, 14))) == [
        ("prog0.8k", 5, 13, 17),
        ("prog0.8k", 10, 14, 18),
        ("setup.8k", 4, 8, 12),
    ]
    assert lines_of(engine.definitions(path, Place(9, 8))) == [("setup.8k", 8, 21, 22)]


def test_a_name_gets_another_spelling_everywhere(engine: Engine, project: Path) -> None:
    path = project / "prog0.8k"
    changes = engine.rename(path, Place(3, 1), "Begin")
    assert changes == {
        path: [
            Edit(Span(Place(3, 1), Place(3, 5)), "Begin"),
            Edit(Span(Place(7, 5), Place(7, 9)), "Begin"),
        ]
    }
    changes = engine.rename(path, Place(13, 0), "total")
    assert {file.name: len(edits) for file, edits in changes.items()} == {
        "prog0.8k": 2,
        "setup.8k": 1,
    }


@pytest.mark.parametrize(
    ("line", "column", "new", "reason"),
    [
        (3, 1, "Tail", "Tail is another label of PROG0"),
        (3, 1, "1st", "1st: a label has up to 32 letters and digits, a letter first"),
        (4, 12, "lamp", "lamp is another name in this project"),
        (4, 12, "X", "X is another name in this project"),
        (4, 12, "goto", "goto: a name has at most 24 letters and is no word of the language"),
        (4, 12, "", ": a name has at most 24 letters and is no word of the language"),
        (4, 17, "Total", "Total: the name of an axis has one to four letters"),
        (4, 0, "QQ", "there is no name here that this project defines"),
        (11, 0, "QQ", "there is no name here that this project defines"),
    ],
)
def test_a_spelling_that_would_change_the_program_is_refused(
    engine: Engine, project: Path, line: int, column: int, new: str, reason: str
) -> None:
    with pytest.raises(UserError) as refused:
        engine.rename(project / "prog0.8k", Place(line, column), new)
    assert str(refused.value) == reason


def test_line_numbers_keep_their_order(project: Path) -> None:
    engine = Engine()
    path = project / "prog1.8k"
    engine.open(path, "10 GOTO 20\n20 END\n")
    assert lines_of(engine.definitions(path, Place(0, 8))) == [("prog1.8k", 1, 0, 2)]
    with pytest.raises(UserError, match="cannot be renamed"):
        engine.rename(path, Place(0, 8), "L20")


def test_a_spelling_that_makes_a_line_too_long_is_refused(project: Path) -> None:
    engine = Engine()
    path = project / "prog1.8k"
    engine.open(path, f"PROGRAM\n_a\nGOTO a : REM {'x' * 242}\nENDP\n")
    assert len(engine.document(path).lines[2]) == 255
    with pytest.raises(UserError, match=r"line 3 of prog1\.8k would have over 255 characters"):
        engine.rename(path, Place(1, 1), "bb")
    assert engine.rename(path, Place(1, 1), "b")


@pytest.mark.parametrize(
    ("text", "labels", "typed"),
    [
        ("JOG ", ["ACC", "VEL"], ""),
        ("JOG VE", ["VEL"], "VE"),
        ("GOTO He", ["Head"], "He"),
        ("GOSUB _", ["Head", "Tail"], ""),
        ("ACC(P1229", ["P12290", "P12291"], "1229"),
        ("SET 3", ["BIT3", "BIT30"], "3"),
        ("INH BIT51", ["BIT510", "BIT511"], "51"),
        ("sp", ["speed"], "sp"),
        ("X", ["X"], "X"),
        ("P0 = SI", ["SIN"], "SI"),
        ("#DE", ["#DEFINE"], "#DE"),
        ("VEL foll", ["AXIS 0: Following Error (P12291)"], "foll"),
        ("REM GO", [], ""),
        ('PRINT "GO', [], ""),
    ],
)
def test_what_fits_is_proposed(
    engine: Engine, project: Path, text: str, labels: list[str], typed: str
) -> None:
    path = project / "prog0.8k"
    engine.change(path, [Edit(Span(Place(8, 0), Place(8, 0)), f"{text}\n")])
    found = engine.complete(path, Place(8, len(text)))
    assert found.span == Span(Place(8, len(text) - len(typed)), Place(8, len(text)))
    shown = [item.label for item in found.items]
    assert [label for label in shown if label in labels] == labels
    assert bool(shown) is bool(labels)


def test_a_plc_gets_its_instructions(project: Path) -> None:
    engine = Engine()
    engine.open(project / "plc0.8k", "LD 1\nO\n")
    shown = [item.label for item in engine.complete(project / "plc0.8k", Place(1, 1)).items]
    assert shown == ["OR", "OR NOT", "OR LD", "OUT", "OUT NOT"]


@pytest.mark.parametrize(
    ("text", "label", "active"),
    [
        ("VEL ", "VEL {value}", -1),
        ("ACC 5 JOG VEL X", "JOG VEL {axis {value} ...}", -1),
        ("P0 = SIN(3", "SIN(number)", 0),
        ('$V0 = LEFT$("a",', "LEFT$(string, number)", 1),
    ],
)
def test_a_call_says_how_it_is_written(
    engine: Engine, project: Path, text: str, label: str, active: int
) -> None:
    path = project / "prog0.8k"
    engine.change(path, [Edit(Span(Place(8, 0), Place(8, 0)), f"{text}\n")])
    answer = engine.signature(path, Place(8, len(text)))
    assert answer is not None
    assert (answer[0].label, answer[0].active) == (label, active)
    assert all(part in label for part in answer[0].parts)


def test_the_outline_has_programs_labels_and_aliases(engine: Engine, project: Path) -> None:
    (entry,) = engine.entries(project / "prog0.8k")
    assert (entry.name, entry.first, entry.last) == ("PROG0", 0, 16)
    assert [(part.name, part.first) for part in entry.parts] == [("Head", 3), ("Tail", 12)]
    engine.open(project / "setup.8k", SETUP)
    found = [(each.name, [part.name for part in each.parts])
             for each in engine.entries(project / "setup.8k")]  # fmt: skip
    assert found == [("SYS", ["speed", "lamp", "count"]), ("PROG0", [])]


def test_programs_blocks_and_remarks_fold(engine: Engine, project: Path) -> None:
    folds = [tuple(fold) for fold in engine.folds(project / "prog0.8k")]
    assert folds == [(0, 15, "region"), (1, 2, "comment"), (6, 8, "")]
    engine.open(
        project / "prog2.8k",
        "PROGRAM\nFOR LV0 = 1 TO 3\nIF (1) THEN SET 32\nWHILE (1)\nWEND\nNEXT\nENDP\n",
    )
    folds = [tuple(fold) for fold in engine.folds(project / "prog2.8k")]
    assert folds == [(0, 6, "region"), (1, 5, ""), (3, 4, "")]


def test_numbers_of_parameters_and_flags_are_named(engine: Engine, project: Path) -> None:
    shown = [(place.line, place.column, text) for place, text in
             engine.shown(project / "prog0.8k", 4, 9)]  # fmt: skip
    assert shown == [
        (5, 6, "OUTPUT: OUT 34"),
        (6, 10, "MASTER 0: In Motion"),
        (6, 21, "AXIS 0: Current Position"),
        (9, 21, "MASTER 0: In Motion"),
    ]


def test_findings_are_those_of_check_and_a_hint_becomes_a_change(
    engine: Engine, project: Path
) -> None:
    path = project / "prog0.8k"
    subject = engine.subject(path)
    assert subject == project
    found = engine.findings(subject)[path]
    expected = [fault for fault in check(project) if fault.path == str(path)]
    assert [(f.span.start.line + 1, f.span.start.column + 1, f.message, f.hint, f.is_warning)
            for f in found] == [
        (e.line, e.column, e.message, e.hint, e.is_warning) for e in expected
    ]  # fmt: skip
    ((finding, fix),) = engine.fixes(found, Span(Place(11, 0), Place(11, 0)))
    assert finding.message == "Unknown command"
    assert fix == ("Write speed", Edit(Span(Place(11, 0), Place(11, 4)), "speed"))
    assert engine.fixes(found, Span(Place(12, 0), Place(12, 0))) == []


def test_an_unsaved_set_up_counts_for_the_programs(engine: Engine, project: Path) -> None:
    path = project / "prog0.8k"
    engine.open(project / "setup.8k", SETUP.replace("#DEFINE speed", "#DEFINE sped"))
    lines = [f.span.start.line for f in engine.findings(project)[path] if not f.is_warning]
    assert lines == [4]
    assert engine.findings(project)[project / "setup.8k"] == []


def test_a_file_outside_of_a_project_is_checked_alone(tmp_path: Path) -> None:
    engine = Engine()
    path = tmp_path / "part.8k"
    engine.open(path, "QQ 5\n")
    assert engine.subject(path) == path
    assert [f.message for f in engine.findings(path)[path]] == ["Unknown command"]
    engine.open(path, "")
    assert [f.message for f in engine.findings(path)[path]] == ["the file is empty"]


def test_what_keeps_a_project_from_being_read_is_a_finding(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text("[card\n")
    (tmp_path / "PROG1.8K").write_text("END\n")
    engine = Engine()
    path = tmp_path / "prog1.8k"
    engine.open(path, "END\n")
    (found,) = engine.findings(engine.subject(path))[path]
    assert "is the same file; keep one" in found.message


def test_a_closed_file_is_not_open(engine: Engine, project: Path) -> None:
    path = project / "prog0.8k"
    engine.close(path)
    with pytest.raises(UserError, match="is not open"):
        engine.describe(path, Place(0, 0))


@pytest.mark.parametrize("mark", ["'", "\u2018", "\u2019"])
def test_formatting_keeps_a_comment_after_an_apostrophe(tmp_path: Path, mark: str) -> None:
    path = tmp_path / "prog0.8k"
    engine = Engine()
    engine.open(path, f"PROGRAM\nset   32 {mark} lamp\nclr  32\nENDP\n")
    assert [edit.text for edit in engine.format(path)] == [f" SET 32 {mark} lamp", " CLR 32"]
