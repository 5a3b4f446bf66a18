"""`openacr configure --recover`: from a project, one of its files or a card over a link."""

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli import configure as command
from openacr.cli.main import app
from openacr.client import Card, Options
from openacr.client.identity import Identity, identify
from openacr.configure import parse_answers
from openacr.controller import Controller
from openacr.plant.describe.load import parse_world

EXAMPLES = Path(__file__).parents[2] / "examples"
GANTRY = EXAMPLES / "gantry"


def recover(source: Path | str, *options: str) -> Result:
    return CliRunner().invoke(app, ["configure", "--recover", str(source), *options])


def test_a_project_and_its_set_up_file_give_the_same_answers() -> None:
    whole, file = recover(GANTRY), recover(GANTRY / "setup.8k")
    assert (whole.exit_code, whole.stderr) == (0, "")
    assert whole.stdout == file.stdout
    assert [axis.name for axis in parse_answers(whole.stdout).axis] == ["X", "Y", "Z"]


def test_what_answers_cannot_hold_is_noted_beside_them(tmp_path: Path) -> None:
    code = (GANTRY / "setup.8k").read_text() + "\nSYS\nAXIS1 JOG VEL 2\n"
    (tmp_path / "setup.8k").write_text(code)
    result = recover(tmp_path)
    assert result.exit_code == 0
    assert result.stderr == "note: AXIS1 JOG VEL is 2; these answers make it 0\n"
    assert result.stdout == recover(GANTRY).stdout


def test_answers_that_contradict_each_other_are_shown_and_refused(tmp_path: Path) -> None:
    code = (GANTRY / "setup.8k").read_text() + "\nSYS\nAXIS1 SLM (1,4)\n"
    (tmp_path / "setup.8k").write_text(code)
    result = recover(tmp_path)
    assert result.exit_code == 1
    assert "soft = [1, 4]" in result.stdout
    assert result.stderr.startswith("error: no valid answers: recovered:18:12:")
    assert "the positive limit is not above the negative" in result.stderr


def test_a_card_over_a_link_is_asked_and_nothing_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    virtual = Controller.from_project(GANTRY)
    open_link, found = Card.open, identify(virtual)

    def opened(target: str, options: Options, *, baud: int) -> Card:
        assert (target, baud) == ("card:5002", 9600)
        return open_link(virtual, options)

    def identified(target: str, options: Options, *, baud: int) -> Identity:
        assert (target, options.timeout_s, baud) == ("card:5002", 2.0, 9600)
        return found

    monkeypatch.setattr("openacr.client.Card.open", opened)
    monkeypatch.setattr("openacr.client.identity.identify", identified)
    before = [virtual.p[number] for number in range(12288, 12400)]
    result = recover("card:5002", "--baud", "9600", "--timeout", "2")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == recover(GANTRY).stdout
    assert [virtual.p[number] for number in range(12288, 12400)] == before


def test_a_line_that_a_card_refuses_has_no_answer() -> None:
    card = command.Answering(Card.open(Controller.from_project(GANTRY)))
    assert card.command("AXIS0 FLOP") == []
    assert card.command("AXIS0 TLM") == ["10,-10"]
    assert card.command("VEL", program=1) == ["10"]
    assert card.command("AXIS1 HLBIT") == ["3"]


@pytest.mark.parametrize("other", [("out",), ("--force",), ("--explain",)])
def test_options_of_generation_do_not_go_with_recovery(other: tuple[str, ...]) -> None:
    result = recover(GANTRY, *other)
    assert result.exit_code == 2
    assert "--recover prints answers" in result.stderr


def test_a_first_machine_of_a_project_is_printed() -> None:
    result = CliRunner().invoke(app, ["configure", "--machine", str(GANTRY)])
    assert (result.exit_code, result.stderr) == (0, "")
    assert [axis.name for axis in parse_world(result.stdout).axis] == ["X", "Y", "Z"]


def test_a_first_machine_goes_with_no_other_option() -> None:
    result = CliRunner().invoke(app, ["configure", "--machine", "--recover", str(GANTRY)])
    assert result.exit_code == 2
    assert "--machine prints a file: it takes neither a folder nor other options" in result.stderr


@pytest.mark.parametrize("option", ["--recover", "--machine"])
def test_uploads_without_a_set_up_are_refused_in_one_line(tmp_path: Path, option: str) -> None:
    (tmp_path / "prog0.8k").write_text((GANTRY / "prog0.8k").read_text())
    result = CliRunner().invoke(app, ["configure", option, str(tmp_path)])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == (
        f"error: {tmp_path}: setup.8k is missing: without it nothing is known of the set-up"
        " (`openacr backup HOST FOLDER` reads it from a card)\n"
    )
