"""`openacr list` and `openacr check` on PLC files."""

from pathlib import Path

from typer.testing import CliRunner

from openacr.cli.main import app

GOOD = "REM doors\r\n10 ld 0:and not 1\r\n20 OUT 32\r\n"


def run(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    return result.exit_code, result.output


def written(folder: Path, text: str, name: str = "plc2.8k") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_a_plc_is_listed_as_the_card_lists_it(tmp_path: Path) -> None:
    path = written(tmp_path, GOOD)
    assert run("list", path) == (0, "REM doors\n10 LD 0 : AND NOT 1\n20 OUT 32\n")
    assert run("check", path) == (0, f"{path}: no errors\n")


def test_a_plc_is_drawn_as_a_ladder(tmp_path: Path) -> None:
    assert run("list", written(tmp_path, GOOD), "--ladder") == (
        0,
        "PLC2\n    10 |--[0]--[/1]--(32)\n       |\n",
    )


def test_every_error_of_a_plc_is_found_with_its_place(tmp_path: Path) -> None:
    path = written(tmp_path, "10 LD 0\n20 JMP 5\n30 OUT 9000\n")
    code, output = run("check", path)
    assert code == 1
    assert f"{path}:2:4: Unknown command" in output
    assert f"{path}:3:8: Invalid bit" in output


def test_rungs_are_checked_as_run_does(tmp_path: Path) -> None:
    path = written(tmp_path, "10 LD 0\n20 OR LD\n30 OUT 32\n")
    code, output = run("check", path)
    assert code == 1
    assert f"{path}:2:1: PLC error line 20: Stack underflow" in output
    assert run("list", path, "--ladder")[0] == 1


def test_a_plc_that_is_too_long_is_reported_at_its_last_line(tmp_path: Path) -> None:
    path = written(tmp_path, "".join(f"{n} {'LD 0 OUT 32 ' * 11}\n" for n in range(1, 11)))
    assert f"{path}:10:1: PLC too long" in run("check", path)[1]


def test_aliases_of_the_set_up_are_known(tmp_path: Path) -> None:
    written(tmp_path, "DIM PLC2(99)\nDIM DEF(2)\n#DEFINE Door BIT5\n", "setup.8k")
    path = written(tmp_path, "10 LD Door\n20 OUT 32\n")
    assert run("list", path) == (0, "10 LD Door\n20 OUT 32\n")
