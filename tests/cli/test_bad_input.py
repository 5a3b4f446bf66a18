"""Files that are no text, or not the text a command reads: what is said, where, exit code 2."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app

BINARY = b"\x7fELF\x02\x01\x01\x00\x00\x10\x9b2J\x1b[31m\n\x00\x05"
PART = "(plate)\n%\nG21 G90\nN10 G0 X1 Y2\nG1 X5 F100\nX7\nM30\n"
NO_MACHINE = "[x\x1b]0;owned\n"


def openacr(*words: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, list(map(str, words)))
    return result.exit_code, result.stdout, result.stderr


@pytest.mark.parametrize("command", ["check", "list", "run", "serve"])
@pytest.mark.parametrize("options", [(), ("--json",)])
def test_a_binary_file_is_no_controller_file(
    command: str, options: tuple[str, ...], tmp_path: Path
) -> None:
    if options and command in ("list", "serve"):
        pytest.skip("has no --json")
    file = tmp_path / "a.8k"
    file.write_bytes(BINARY)
    code, out, err = openacr(command, file, *options)
    text = "not a text file: byte 0x7F at offset 0 (controller files are plain text)"
    assert (code, err) == (2, f"error: {file}:1:1: {text}\n")
    if options:
        assert json.loads(out) == {
            "error": f"{file}:1:1: {text}",
            "errors": [
                {
                    "path": str(file),
                    "line": 1,
                    "column": 1,
                    "message": "not a text file: byte 0x7F at offset 0",
                    "hint": "controller files are plain text",
                }
            ],
        }
    else:
        assert out == ""


@pytest.mark.parametrize("command", ["check", "list", "time", "run", "plot"])
def test_a_binary_file_is_no_part_program(command: str, tmp_path: Path) -> None:
    file = tmp_path / "a.nc"
    file.write_bytes(b"G1 X1\nX2" + BINARY)
    picture = [tmp_path / "a.png"] if command == "plot" else []
    code, out, err = openacr("mill", command, file, *picture)
    text = "not a text file: byte 0x02 at offset 12 (part programs are plain text)"
    assert (code, out, err) == (2, "", f"error: {file}:2:7: {text}\n")


def test_leader_and_rubout_of_a_tape_are_no_binary_file(tmp_path: Path) -> None:
    file = tmp_path / "a.nc"
    file.write_bytes(b"\x00\x00\x7f\x12%\nG21 G0 X1\n\x14M2\n%\x00\x00\x13")
    code, out, _ = openacr("mill", "check", file)
    assert "not a text file" not in out
    assert code in (0, 1)


@pytest.mark.parametrize("command", ["check", "list", "run"])
def test_a_part_program_given_to_the_card_names_the_command_that_reads_it(
    command: str, tmp_path: Path
) -> None:
    file = tmp_path / "plate.nc"
    file.write_text(PART)
    code, out, err = openacr(command, file)
    said = f"{file}:3: a part program, not a controller file: G21 G90"
    hint = f"`openacr mill check {file}` reads it"
    assert (code, out, err) == (2, "", f"error: {said} ({hint})\n")


@pytest.mark.parametrize(
    "text",
    [
        "REM a\nPROG0\nPROGRAM\nP0 = 1\nENDP\n",
        "PROG0\n#DEFINE G1 BIT32\nG1 = 1\nM2=3\n",  # names that look like codes
        'PROG0\nATTACH SLAVE0 AXIS0 "G"\nPROGRAM\nG10\nINH 1\nDWL 1\nX1\nX2\nENDP\n',
    ],
)
def test_controller_files_of_any_suffix_are_read(text: str, tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text(text)
    assert "a part program" not in openacr("check", file)[2]


def test_a_quarter_of_the_lines_makes_a_part_program(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text("REM\nREM\n\nREM\nG1 X1\n")
    assert openacr("check", file)[0] == 2
    file.write_text("REM\nREM\n\nREM\nREM\nG1 X1\n")
    assert openacr("check", file)[0] == 1
    file.rename(tmp_path / "a.8k")
    (tmp_path / "a.8K").write_text("G1 X1\n")
    assert openacr("check", tmp_path / "a.8K")[0] == 1


def test_escape_sequences_of_a_machine_file_are_shown_not_obeyed(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(NO_MACHINE)
    _, out, err = openacr("check", tmp_path)
    assert "    [x^[]0;owned\n" in out
    assert "\x1b" not in out + err


def test_escape_sequences_of_a_refused_line_are_shown_not_obeyed(tmp_path: Path) -> None:
    file = tmp_path / "a.8k"
    file.write_text("P0 = \x1b[31m\n")
    code, out, err = openacr("run", file)
    assert code == 2
    assert "    P0 = ^[[31m\n" in err
    assert "\x1b" not in out + err
    code, out, err = openacr("check", file)
    assert code == 1
    assert "    P0 = ^[[31m\n" in out
    assert "\x1b" not in out + err


def test_escape_sequences_of_a_scenario_are_shown_not_obeyed(tmp_path: Path) -> None:
    (tmp_path / "prog0.8k").write_text("REM\n")
    (tmp_path / "scenario.toml").write_text(
        'duration_s = 0.1\n[[expect]]\nname = "\\u001b[31m"\nflag = 33\nis = true\n'
    )
    code, out, err = openacr("run", tmp_path)
    assert (code, "\x1b" in out + err) == (1, False)
    assert "failed: ^[[31m" in err


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("param", "999999"), "there is no parameter P999999"),
        (("flag", "999999"), "there is no flag BIT999999"),
        (("packet", "zz"), "'z' is no hex digit"),
        (("check", "nowhere"), "nowhere: no such file or folder"),
        (("run", "nowhere"), "nowhere: no such file or folder"),
        (("loop", "127.0.0.1:1"), "cannot connect to 127.0.0.1:1"),
        (("status", "127.0.0.1:1"), "cannot connect to 127.0.0.1:1"),
        (("monitor", "127.0.0.1:1", "P0"), "cannot connect to 127.0.0.1:1"),
        (("sysvar", "get", "P999999999"), "P999999999 is not in the store"),
        (("sysvar", "list", "NOTAB"), "unknown tab NOTAB"),
        (("mill", "check", "nowhere.nc"), "nowhere.nc: no such file"),
        (("mill", "time", "nowhere.nc"), "nowhere.nc: no such file"),
        (("mill", "run", "nowhere.nc"), "nowhere.nc: no such file"),
        (("mill", "part", "NOPART"), "there is no part NOPART"),
        (("mill", "import", "nowhere.dxf"), "nowhere.dxf"),
    ],
)
def test_with_json_unusable_input_is_an_object_on_standard_output(
    words: tuple[str, ...], error: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert openacr("sysvar", "set", "P100000=1")[0] in (0, 2)
    code, out, err = openacr(*words, "--json")
    record = json.loads(out)
    assert code == 2
    assert record["error"].startswith(error)
    assert err == "".join(f"error: {each['message']}\n" for each in record["errors"])
    assert [list(each) for each in record["errors"]] == [
        ["path", "line", "column", "message", "hint"]
    ]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("param", "--json"), "Missing argument 'NUMBER|NAME'."),
        (("mill", "run", "--json", "part.nc", "--line", "0"), "Invalid value for '--line'"),
        (("check", "gantry", "--json", "--no-such"), "No such option: --no-such"),
        (("replay", "--json"), "--json is for recordings of `openacr record`"),
    ],
)
def test_with_json_wrong_words_are_an_object_on_standard_output(
    words: tuple[str, ...], said: str
) -> None:
    code, out, err = openacr(*words)
    record = json.loads(out)
    assert (code, said in record["error"], said in err) == (2, True, True)
    assert record["errors"][0]["message"] == record["error"]


def test_without_json_standard_output_stays_empty(tmp_path: Path) -> None:
    code, out, _ = openacr("check", tmp_path / "nowhere")
    assert (code, out) == (2, "")


def test_with_json_all_lines_a_card_refuses_are_listed(tmp_path: Path) -> None:
    file = tmp_path / "a.8k"
    file.write_text("FOO\nPROG0\nBAR\n")
    code, out, _ = openacr("run", file, "--json")
    record = json.loads(out)
    assert code == 2
    assert record["error"] == f"{file}:1: Unknown command"
    assert [each["line"] for each in record["errors"]] == [1, 3]


def test_with_json_errors_of_a_machine_file_are_all_listed(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text("[card]\nmodel = 7\n[[axis]]\nnumber = 99\n")
    code, out, _ = openacr("run", tmp_path, "--json")
    assert code == 2
    assert [each["line"] for each in json.loads(out)["errors"]] == [2, 4]


def test_time_lists_the_errors_of_a_program_as_json(tmp_path: Path) -> None:
    file = tmp_path / "a.nc"
    file.write_text("G1 X1 F1\nM9999\n")
    code, out, _ = openacr("mill", "time", file, "--json")
    record = json.loads(out)
    assert code == 1
    assert [(each["code"], each["line"]) for each in record["errors"]] == [("E205", 2)]


def test_bytes_of_a_file_name_that_are_no_text_do_no_harm(tmp_path: Path) -> None:
    code, out, err = openacr("check", tmp_path / "\udcff", "--json")
    assert code == 2
    assert json.loads(out)["error"] == f"{tmp_path}/?: no such file or folder"
    assert err == f"error: {tmp_path}/?: no such file or folder\n"
