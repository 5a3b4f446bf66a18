"""`openacr compare`: cards, projects, backups and files, by what they mean."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.live import compare as command
from openacr.cli.main import app
from openacr.client import Card
from openacr.controller import Controller
from openacr.controller.controller import Controller as Virtual

GANTRY = Path(__file__).parents[2] / "examples" / "gantry"
NEVER = (
    "not compared: network address, passwords, local variables, strings, positions:"
    " no terminal reads them"
)


def compare(first: object, second: object, *options: str) -> Result:
    return CliRunner().invoke(app, ["compare", str(first), str(second), *options])


def shown(first: object, second: object) -> list[str]:
    """What is printed between the two names and the last line."""
    result = compare(first, second)
    lines = result.stdout.splitlines()
    assert [line[:3] for line in lines[:2]] == ["A: ", "B: "], result.output
    assert result.exit_code == (0 if lines[-1] == "equal" else 1)
    return lines[2:]


@pytest.fixture
def card() -> Virtual:
    return Controller.from_project(GANTRY)


@pytest.fixture
def backup(card: Virtual, tmp_path: Path) -> Path:
    with Card.open(card) as online:
        online.backup(tmp_path / "b")
    return tmp_path / "b"


@pytest.fixture
def linked(card: Virtual, monkeypatch: pytest.MonkeyPatch) -> str:
    """The address under which the command finds the card."""

    @contextmanager
    def connected(target: str, baud: int, silence_s: float) -> Iterator[Card]:
        assert (target, baud, silence_s) == ("card:5002", 38400, 10.0)
        with Card.open(card) as online:
            yield online

    monkeypatch.setattr(command, "connected", connected)
    return "card:5002"


def test_a_card_its_project_and_its_backup_are_equal(linked: str, backup: Path) -> None:
    assert shown(linked, backup) == [NEVER, "equal"]
    assert shown(backup, GANTRY) == [NEVER, "equal"]
    assert shown(GANTRY, linked) == [NEVER, "equal"]


def change(card: Virtual, *lines: str, program: int | None = None) -> None:
    with Card.open(card) as online:
        for line in lines:
            online.command(line, program=program)


def test_a_changed_setting_is_shown_by_its_line_both_values_and_name(
    linked: str, card: Virtual, backup: Path
) -> None:
    change(card, "#DEFINE feed P3", "AXIS1 PGAIN 0.005", "SET BIT8453", "P3=2.5")
    change(card, "ACC 12", program=1)
    assert shown(linked, backup) == [
        "#DEFINE feed: P3 | (not there)",
        "BIT8453: SET | CLR   AXIS0 Drive Fault Level Invert",
        "AXIS1 PGAIN: 0.005 | 0.002441   axis Y: Set the proportional gain [V/pulse]",
        "P3: 2.5 | 0   feed",
        "PROG1 ACC: 12 | 20   Set the acceleration of moves; 0 is no ramp [units/s2]",
        NEVER,
        "different: 5 settings, 0 places in programs",
    ]


def test_values_are_compared_as_numbers(backup: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.mkdir()
    for file in backup.iterdir():
        (other / file.name).write_text(file.read_text())
    text = (backup / "setup.8k").read_text()
    setup = other / "setup.8k"
    setup.write_text(text.replace("DGAIN 1E-05", "DGAIN 0.00001").replace("(24,0)", "(24.0,-0)"))
    assert setup.read_text() != text
    assert shown(backup, other) == [NEVER, "equal"]
    setup.write_text(text.replace("DGAIN 1E-05", "DGAIN 0.000011"))
    assert shown(backup, other)[-1] == "different: 3 settings, 0 places in programs"
    setup.write_text(text.replace("AXIS0 SLM (24,0)\n", "AXIS0 SLM (24,1)\n"))
    assert shown(backup, other)[0].startswith("AXIS0 SLM: (24,0) | (24,1)   axis X: ")


def test_lines_of_programs_are_compared_whatever_their_spelling(tmp_path: Path) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    for folder, text in (
        (one, "PROGRAM\nX10 Y5\nREM slow\nX20\nENDP\n"),
        (two, "PROGRAM\nx 10  y5.0\nREM slow\nX21\nX0\nENDP\n"),
    ):
        folder.mkdir()
        (folder / "prog2.8k").write_text(text)
    assert shown(one, two) == [
        "PROG2:",
        "  line 4",
        "  A X20",
        "  B X21",
        "  B X0",
        f"not compared: settings and variables: {one} holds programs only",
        f"not compared: settings and variables: {two} holds programs only",
        NEVER,
        "different: 0 settings, 1 place in programs",
    ]
    assert shown(one / "prog2.8k", one) == [
        f"not compared: settings and variables: {one}/prog2.8k holds programs only",
        f"not compared: the other programs and PLCs: not in {one}/prog2.8k",
        f"not compared: settings and variables: {one} holds programs only",
        NEVER,
        "equal",
    ]


def test_a_program_that_one_side_lacks_is_all_different(linked: str, backup: Path) -> None:
    (backup / "prog1.8k").unlink()
    (backup / "plc2.8k").write_text("PROGRAM\n10 LD BIT0\nENDP\n")
    lines = shown(linked, backup)
    assert lines[:3] == ["PROG1:", "  line 1", "  A PROGRAM"]
    at = lines.index("PLC2:")
    assert lines[at : at + 5] == ["PLC2:", "  line 1", "  B PROGRAM", "  B 10 LD BIT0", "  B ENDP"]


def test_one_file_of_a_backup_has_its_settings_only(backup: Path) -> None:
    file = backup / "setup.8k"
    assert shown(file, backup) == [
        f"not compared: the other programs and PLCs: not in {file}",
        NEVER,
        "equal",
    ]


def test_what_one_side_could_not_read_is_not_compared_and_named(linked: str, backup: Path) -> None:
    setup = backup / "setup.8k"
    text = setup.read_text()
    setup.write_text(
        text.replace("AXIS0 JOG VEL 0\n", "REM not readable: AXIS0 JOG VEL: Unknown command\n")
        .replace("AXIS1 JOG SRC CLK\n", "REM not understood: AXIS1 JOG SRC: TABLE\n")
    )  # fmt: skip
    assert setup.read_text() != text
    assert shown(linked, backup) == [
        f"not compared: AXIS0 JOG VEL: {backup}: Unknown command",
        f"not compared: AXIS1 JOG SRC: {backup}: TABLE",
        NEVER,
        "equal",
    ]


def test_an_extension_that_is_not_set_equals_one_that_is_not_there(
    linked: str, card: Virtual, backup: Path
) -> None:
    change(card, "LOOK TOL 0.25", program=0)
    assert shown(linked, backup)[0].startswith("PROG0 LOOK TOL: 0.25 | 0   ")
    change(card, "LOOK TOL 0", program=0)
    assert shown(linked, backup) == [NEVER, "equal"]


def test_programs_of_a_project_do_not_run_while_it_is_compared(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("CLEAR\nDIM P(10)\nP1=5\n")
    (tmp_path / "prog0.8k").write_text("PROGRAM\nPBOOT\nP1=7\nENDP\n")
    found = json.loads(compare(tmp_path, GANTRY, "--json").stdout)
    (variable,) = (each for each in found["settings"] if each["key"] == "P1")
    assert (variable["first"], variable["second"]) == ("5", "0")


def test_a_comparison_as_json_has_all_that_is_printed(
    linked: str, card: Virtual, backup: Path
) -> None:
    change(card, "AXIS0 PPU 8000")
    (backup / "prog1.8k").write_text("PROGRAM\nENDP\n")
    result = compare(linked, backup, "--json")
    found = json.loads(result.stdout)
    assert (result.exit_code, found["equal"]) == (1, False)
    assert found["first"] == {"name": linked, "version": "ACR9000 Version 1.18.06 Update 15"}
    assert found["settings"] == [
        {"key": "AXIS0 PPU", "name": "axis X: Set the pulses per unit [pulses/unit]",
         "first": "8000", "second": "40000"}
    ]  # fmt: skip
    assert [(each["program"], each["line"]) for each in found["programs"]] == [("PROG1", 2)]
    assert found["not_compared"] == [NEVER.removeprefix("not compared: ")]
    assert json.loads(compare(linked, linked, "--json").stdout)["equal"] is True


@pytest.mark.parametrize(
    ("side", "sentence"),
    [
        ("gone/away", "gone/away: there is no such file or folder, nor such a serial port"),
        ("gone.8k", "gone.8k: there is no such file or folder, nor such a serial port"),
        ("127.0.0.1:99999", "127.0.0.1:99999: port 99999 is not in 0..65535"),
    ],
)
def test_a_side_that_cannot_be_read_is_invalid(side: str, sentence: str) -> None:
    result = compare(GANTRY, side)
    assert (result.exit_code, result.stderr) == (2, f"error: {sentence}\n")


def test_a_project_that_a_card_refuses_is_invalid(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\nFLOP 7\n")
    result = compare(tmp_path, GANTRY)
    assert result.exit_code == 2
    assert result.stderr.startswith(f"error: {tmp_path}/setup.8k:2: Unknown command")
