"""`openacr list` and `openacr check`: what the card would store, and every error at once."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app

GOOD = """\
REM set-up
SYS
DIM P(10)
DIM DEF(5)
#DEFINE Parts P0
PROG 3
PROGRAM
_Begin
for Parts = 1 to 10
if (Parts>3) then set 33
print "part ", Parts
next
goto Begin
ENDP
"""


def check(path: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["check", str(path), *options])


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_bytes(text.encode())
    return path


def test_commands_after_a_change_of_level_are_checked_there(tmp_path: Path) -> None:
    text = "DIM P(1) : PROG0 : ATTACH MASTER0 : ACC 5 : SYS : ACC 6"
    result = check(write(tmp_path, "levels.8k", text))
    assert "levels.8k:1:51: Unknown command" in result.stdout
    assert result.stdout.count("Unknown command") == 1


def test_a_file_without_errors_says_so(tmp_path: Path) -> None:
    path = write(tmp_path, "good.8k", GOOD)
    result = check(path)
    assert (result.exit_code, result.stdout) == (0, f"{path}: no errors\n")


def test_every_error_is_shown_with_line_column_and_hint(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        "bad.8k",
        'SYS\nDIM Q(1)\nPROG0\nPROGRAM\n  PRNT "x"\nFOR Parts = 1 TO 3\nENDP\n',
    )
    result = check(path)
    assert result.exit_code == 1
    shown = result.stdout
    assert f'{path}:5:3: Unknown command (did you mean PRINT?)\n      PRNT "x"\n      ^^^^' in shown
    assert f"{path}:6:5: " in shown
    assert "3 errors" in result.stderr


def test_a_misspelt_alias_is_suggested(tmp_path: Path) -> None:
    path = write(tmp_path, "bad.8k", GOOD.replace("for Parts", "for Prats"))
    assert "bad.8k:9:5: Syntax error (did you mean Parts?)" in check(path).stdout


@pytest.mark.parametrize(
    ("lines", "fault"),
    [
        ("SET 32\nGOTO nowhere", "3:6: Label not found: nowhere (there are no labels)"),
        ("_top\n_end\nGOTO edn", "4:6: Label not found: edn (did you mean end?)"),
        ("_top\n_b\nGOSUB x", "4:7: Label not found: x (labels: b, top)"),
        ("GOTO 500", "2:6: Line not found: 500 (the nearest: 30)"),
        ("NEXT", "2:1: NEXT without FOR (no block is open here)"),
        (
            "FOR P0=1 TO 2\nIF (P0)\nWEND\nENDIF\nNEXT",
            "4:1: WEND without WHILE (open here is the IF of line 3)",
        ),
        (
            "WHILE (P0)\nIF (P0)\nWEND",
            "3:1: IF without ENDIF (still open at the WEND of line 4)",
        ),
        ("IF (P0)\nSET 32", "2:1: IF without ENDIF (still open at the end)"),
        ("_a\n_a", "3:1: Duplicate label: a (the first is in line 2)"),
        ("X1,2", "2:3: Syntax error (after a target come other axes, a command or `:`)"),
        ("P0 = SQRT 4", "2:11: Syntax error (written: SQRT(number))"),
        ('P0 = LEN(MID$("a"))', "2:10: Syntax error (written: MID$(string, number, {number}))"),
        ("PRINT SIN(COS(1),2)", "2:7: Syntax error (written: SIN(number))"),
        ("PRINT SIN(1 2)", "2:13: Syntax error (written: SIN(number))"),
        ("VEL 5 6", "2:7: Syntax error (written: VEL {value})"),
        (
            'P0 = 3 + "4"',
            "2:6: Type mismatch (STR$ makes text of a number, VAL a number of text)",
        ),
        ('P0 = SIN("4")', "2:6: Type mismatch (written: SIN(number))"),
    ],
)
def test_what_does_not_fit_together_is_found(tmp_path: Path, lines: str, fault: str) -> None:
    write(tmp_path, "setup.8k", 'DIM P(1)\nPROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\n')
    path = write(tmp_path, "prog0.8k", f"PROGRAM\n{lines}\nENDP\n")
    result = check(path)
    assert result.exit_code == 1
    assert result.stdout.splitlines()[0] == f"{path}:{fault}"


def test_all_jumps_that_go_nowhere_are_listed(tmp_path: Path) -> None:
    path = write(tmp_path, "prog0.8k", "PROGRAM\nGOTO a\nSET 32\nGOSUB b\nENDP\n")
    assert [line for line in check(path).stdout.splitlines() if "prog0.8k" in line] == [
        f"{path}:2:6: Label not found: a (there are no labels)",
        f"{path}:4:7: Label not found: b (there are no labels)",
    ]


def test_an_error_does_not_pull_others_after_it(tmp_path: Path) -> None:
    path = write(tmp_path, "prog0.8k", "PROGRAM\nFOR ? = 1 TO 2\nSET 32\nNEXT\nENDP\n")
    result = check(path)
    assert result.stderr.strip() == "1 error"
    assert "prog0.8k:2:5" in result.stdout


def test_columns_count_in_the_file_as_it_is(tmp_path: Path) -> None:
    path = write(tmp_path, "bad.8k", "SYS> DIM P(1)\n\t SYS> FOO 1\r\n")
    result = check(path, "--json")
    assert result.exit_code == 1
    (fault,) = json.loads(result.stdout)
    assert (fault["line"], fault["column"], fault["length"]) == (2, 8, 3)


def test_json_names_everything(tmp_path: Path) -> None:
    path = write(tmp_path, "bad.8k", "DIM P(1)\nPRNT 5\n")
    assert json.loads(check(path, "--json").stdout) == [
        {
            "path": str(path),
            "line": 2,
            "column": 1,
            "length": 4,
            "message": "Unknown command",
            "hint": "did you mean PRINT?",
            "text": "PRNT 5",
            "severity": "error",
        }
    ]
    assert json.loads(check(write(tmp_path, "good.8k", GOOD), "--json").stdout) == []


def test_program_text_outside_a_program_level_is_explained(tmp_path: Path) -> None:
    result = check(write(tmp_path, "bad.8k", "PROGRAM\nSET 32\nENDP\n"))
    assert "bad.8k:1:1: Unknown command (not valid at the system level; `PROG n`" in result.stdout


def test_a_program_command_at_the_system_level_is_explained(tmp_path: Path) -> None:
    result = check(write(tmp_path, "bad.8k", "JOG FWD X\n"))
    assert "(not valid at the system level; `PROG n` goes to a program)" in result.stdout


def test_axes_are_those_the_program_has_attached(tmp_path: Path) -> None:
    text = 'PROG0\nATTACH MASTER0\nATTACH SLAVE0 AXIS0 "X"\nPROGRAM\nX10\nW10\nENDP\n'
    result = check(write(tmp_path, "bad.8k", text))
    assert [line for line in result.stdout.splitlines() if "bad.8k" in line] == [
        f"{tmp_path}/bad.8k:6:1: Unknown command "
        "(no command, alias or axis of this program has this name)"
    ]


def test_a_project_is_checked_as_a_whole(tmp_path: Path) -> None:
    write(tmp_path, "setup.8k", "DIM DEF(1)\n#DEFINE Lamp BIT32\n")
    write(tmp_path, "prog1.8k", "PROGRAM\nSET Lamp\nSET Lump\nENDP\n")
    write(tmp_path, "scenario.toml", "[[at]]\ntime_s = 1\n")
    result = check(tmp_path)
    assert result.exit_code == 1
    assert "scenario.toml:1:3: this entry does nothing" in result.stdout
    assert "prog1.8k:3:5: " in result.stdout
    assert "2 errors" in result.stderr


def test_a_program_file_alone_knows_the_setup_beside_it(tmp_path: Path) -> None:
    write(tmp_path, "setup.8k", "DIM DEF(1)\n#DEFINE Lamp BIT32\nFOO\n")
    path = write(tmp_path, "prog1.8k", "PROGRAM\nSET Lamp\nENDP\n")
    assert check(path).exit_code == 0


def test_a_file_that_cannot_be_read_is_bad_input(tmp_path: Path) -> None:
    result = check(write(tmp_path, "image.8k", "PROG0\n\0"))
    assert result.exit_code == 2
    assert "image.8k:2:1: not a text file" in result.stderr


def test_list_writes_the_spelling_of_the_card(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["list", str(write(tmp_path, "good.8k", GOOD))])
    assert result.exit_code == 0
    assert [line.replace(" (", "(") for line in result.stdout.splitlines()] == [
        "REM set-up",
        "SYS",
        "DIM P(10)",
        "DIM DEF(5)",
        "#DEFINE Parts P0",
        "PROG3",
        "PROGRAM",
        " _Begin",
        " FOR Parts = 1 TO 10",
        "  IF(Parts > 3) THEN SET 33",
        '  PRINT "part ",Parts',
        " NEXT",
        " GOTO Begin",
        "ENDP",
    ]


def test_list_shows_what_it_can_and_reports_the_rest(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["list", str(write(tmp_path, "bad.8k", "DIM P(1)\nFOO"))])
    assert result.exit_code == 1
    assert result.stdout.startswith("DIM P")
    assert "bad.8k:2:1: Unknown command" in result.stderr


def test_lines_that_cannot_be_read_do_not_hide_what_else_is_wrong(tmp_path: Path) -> None:
    text = "PROG0\nPROGRAM\n_here VELL 5\nGOTO here\nGOTO there\nFOR P0 = 1 TO 3\nENDP\n"
    result = check(write(tmp_path, "bad.8k", text))
    places = [line.split("bad.8k:")[1] for line in result.stdout.splitlines() if ".8k:" in line]
    assert [place.split(" (")[0] for place in places] == [
        "3:7: Syntax error",
        "5:6: Label not found: there",
        "6:1: FOR without NEXT",
    ]


def test_a_line_that_cannot_be_read_may_have_closed_a_level(tmp_path: Path) -> None:
    text = "PROG0\nPROGRAM\nIF (P0)\nENDIF 5 Q\nENDP\n"
    result = check(write(tmp_path, "bad.8k", text))
    assert "1 error\n" in result.stderr
