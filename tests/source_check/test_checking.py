"""Controller files checked by a program: what editors and tests call."""

from pathlib import Path

import pytest

from openacr.controller import Controller
from openacr.controller.loading import LoadError
from openacr.errors import SourceError, UserError
from openacr.project import Place, find_project
from openacr.source_check import check, check_text, listed, listing, meant, read

EXAMPLES = Path(__file__).parents[2] / "examples"


def places(path: Path, text: str) -> list[tuple[str, int, int, str]]:
    return [
        (fault.path, fault.line, fault.column, fault.message) for fault in check_text(text, path)
    ]


@pytest.mark.parametrize(
    "folder", sorted(p.parent for p in EXAMPLES.glob("*/machine.toml")), ids=str
)
def test_an_example_has_no_errors(folder: Path) -> None:
    assert [str(fault) for fault in check(folder) if not fault.is_warning] == []


def test_a_text_is_checked_as_the_file_it_is_to_be(tmp_path: Path) -> None:
    setup = tmp_path / "setup.8k"
    setup.write_text(
        "SYS\nDIM PROG0(1000)\nDIM DEF(5)\n#DEFINE speed P3\nPROG0\nATTACH MASTER0\n"
        'ATTACH SLAVE0 AXIS0 "Q"\n'
    )
    program = tmp_path / "prog0.8k"
    good = "PROGRAM\n10 Q 5\n20 speed = 2\nENDP\n"
    assert places(program, good) == []
    wrong = places(program, good.replace("Q 5", "R 5"))
    assert [(path, line, column) for path, line, column, _ in wrong] == [(str(program), 2, 4)]
    assert not program.exists()


def test_the_level_of_a_name_without_one_is_given(tmp_path: Path) -> None:
    text = "10 GOTO 50\n"
    (tmp_path / "part.txt").write_text(text)
    found = check_text(text, tmp_path / "part.txt", (Place.PROGRAM, 3))
    assert [fault.line for fault in found] == [1]
    assert [fault.line for fault in check(tmp_path / "part.txt", (Place.PROGRAM, 3))] == [1]


def test_what_cannot_be_read_at_all_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no such file or folder"):
        check(tmp_path / "none.8k")
    (tmp_path / "empty.8k").write_text("")
    with pytest.raises(SourceError, match="the file is empty"):
        check(tmp_path / "empty.8k")


BROKEN = """\
PROGRAM
 QQ : IF (1 +
\t 2 +
    3) THEN SET 32 : XYZ 1
PRINT (1 +
2)
SET 33
ENDP
"""


def test_a_fault_in_the_rest_of_a_broken_line_is_placed_where_it_is(tmp_path: Path) -> None:
    text = BROKEN.replace(" QQ : ", " ")
    for number, column, wrong in (
        (2, 2, BROKEN),
        (2, 6, text.replace("(1 +\n\t", "(* +\n\t")),
        (3, 6, text.replace("\t 2 +", "\t 2 *;")),
        (4, 4, text.replace("    3) THEN", "   PP) THEN")),
        (4, 22, text),
    ):
        found = places(tmp_path / "prog0.8k", wrong)
        assert [(line, at) for _, line, at, _ in found][:1] == [(number, column)], wrong
        (tmp_path / "prog0.8k").write_text(wrong)
        with pytest.raises(LoadError) as refused:
            Controller.from_project(tmp_path)
        assert refused.value.line == number
    (tmp_path / "prog0.8k").unlink()
    bare = text.replace(" : XYZ 1", "").replace("2)\n", "2) + *\n")
    assert [each[1:3] for each in places(tmp_path / "prog0.8k", bare)] == [(6, 6)]


def test_unsaved_files_of_a_project_replace_those_on_the_disk_and_add_to_them(
    tmp_path: Path,
) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nDIM PROG0(1000)\nDIM DEF(5)\n")
    (tmp_path / "prog0.8k").write_text("")
    with pytest.raises(SourceError, match="the file is empty"):
        check(tmp_path)
    unsaved = {
        tmp_path / "setup.8k": b"SYS\nDIM PROG0(1000)\nDIM DEF(5)\n#DEFINE speed P8192\n",
        tmp_path / "prog0.8k": b"PROGRAM\nspeed = 2\nsped = 2\nENDP\n",
        tmp_path / "plc1.8k": b"LDD 1\n",
    }
    found = check(tmp_path, unsaved=unsaved)
    assert [(Path(each.path).name, each.line, each.column) for each in found] == [
        ("plc1.8k", 1, 1),
        ("prog0.8k", 3, 1),
    ]
    assert [meant(each.hint) for each in found] == ["", "speed"]
    alone = check(tmp_path / "prog0.8k", unsaved=unsaved)
    assert [(each.line, each.column) for each in alone] == [(3, 1)]


@pytest.mark.parametrize(
    ("line", "column"),
    [
        ('PRINT "\u00e9\u20ac" : QQ', 14),  # two and three bytes before it
        ("VEL \u20135 : QQ", 10),  # a dash is one character for the card
        ('QQ : PRINT "\u00e9"', 1),
        ("PRINT 1 : QQ : REM \u00e9", 11),
    ],
)
def test_columns_count_characters_not_bytes(tmp_path: Path, line: str, column: int) -> None:
    found = check_text(f"PROG0\nATTACH MASTER0\n{line}\n", tmp_path / "a.8k")
    assert [(fault.line, fault.column) for fault in found] == [(3, column)]
    assert line[column - 1 :].startswith("QQ")
    close = check_text(f"PROG0\n{line.replace('QQ', 'SETT 1')}\n", tmp_path / "a.8k")
    assert [fault.hint for fault in close] == ["did you mean SET?"]


def test_a_text_is_checked_with_its_typographic_characters(tmp_path: Path) -> None:
    program = tmp_path / "prog0.8k"
    text = "PROGRAM\nPRINT \u201ca\u201d\nENDP\n"
    program.write_text(text, encoding="utf-8")
    assert check_text(text, program) == check(program) == []


def test_hints_that_propose_a_word_say_which() -> None:
    assert meant("did you mean GOTO?") == "GOTO"
    assert meant("did you mean loop?") == "loop"
    assert meant("labels: loop, start") == ""
    assert meant("the nearest: 10") == ""


def test_a_listing_knows_the_lines_it_is_made_of(tmp_path: Path) -> None:
    path = tmp_path / "a.8k"
    path.write_text("prog0 : vel 5\n\nprogram\nfor p0=1 to 2\nset 3\nnext\nendp\n")
    reader = read(path, find_project(path))
    found = [(line.number, text) for line, text in listed(reader)]
    assert found == [
        (1, "PROG0"),
        (1, ": VEL 5"),
        (3, "PROGRAM"),
        (4, " FOR P0 = 1 TO 2"),
        (5, "  SET 3"),
        (6, " NEXT"),
        (7, "ENDP"),
    ]
    assert list(listing(reader)) == [text for _, text in found]
