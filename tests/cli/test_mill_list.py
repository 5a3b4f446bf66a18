"""`openacr mill list`: part programs with the moves compensation inserts."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app

PART = """\
P1001=.25 P910=10
G54 G0 X0 Y-1
G42 D1 G1 F10 X0 Y0
X1
Y1 (corner before)
G40 X0 Y1
M2
"""


def listed(folder: Path, text: str) -> tuple[int, list[str]]:
    file = folder / "PART.NC"
    file.write_text(text)
    result = CliRunner().invoke(app, ["mill", "list", str(file)])
    return result.exit_code, result.output.splitlines()


@pytest.mark.req("MILL-COMP-10")
def test_inserted_moves_are_lines_between_the_blocks_of_their_corner(tmp_path: Path) -> None:
    code, lines = listed(tmp_path, PART)
    assert code == 0
    program = PART.splitlines()
    assert lines == [*program[:4], "<ins> G3 X1.25 Y0 I1 J0", *program[4:]]


def test_what_a_loop_inserts_is_listed_once(tmp_path: Path) -> None:
    text = PART.replace("M2", "P5=P5+1\nIF P5<3 THEN GOTO 100\nM2").replace("G54", "N100 G54")
    _, lines = listed(tmp_path, text.replace("P910=10", "P910=10 P5=0"))
    assert sum(line.startswith("<ins>") for line in lines) == 1


def test_millimetres_have_three_decimals(tmp_path: Path) -> None:
    _, lines = listed(tmp_path, "G21\n" + PART.replace("X1\n", "X10\n"))
    assert "<ins> G3 X16.35 Y0 I10 J0" in lines


def test_errors_are_listed_after_the_program(tmp_path: Path) -> None:
    code, lines = listed(tmp_path, PART.replace("Y1 (corner before)", "X1.1 Y.1\nG41 Y1 X(1/0)"))
    assert code == 1
    assert any("E210" in line for line in lines)
