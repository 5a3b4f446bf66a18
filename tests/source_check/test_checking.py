"""Controller files checked by a program: what editors and tests call."""

from pathlib import Path

import pytest

from openacr.controller import Controller
from openacr.controller.loading import LoadError
from openacr.errors import SourceError, UserError
from openacr.project import Place
from openacr.source_check import check, check_text

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
