"""Controller files checked by a program: what editors and tests call."""

from pathlib import Path

import pytest

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
