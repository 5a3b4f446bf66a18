"""`openacr restore` where the card cannot be given its former contents back."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.live import backup as cli
from openacr.cli.main import app
from openacr.client import Card, ConnectionLostError, RestoreError
from openacr.client import backup as reading
from openacr.controller import Controller


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    Card.open(Controller()).backup(tmp_path / "mine")
    return tmp_path / "mine"


def failing(monkeypatch: pytest.MonkeyPatch, failure: RestoreError) -> None:
    class FailingCard:
        def restore(self, folder: Path, progress: object) -> None:
            raise failure

    @contextmanager
    def connected(target: str, baud: int, silence_s: float) -> Iterator[FailingCard]:
        yield FailingCard()

    monkeypatch.setattr(cli, "connected", connected)


def test_contents_that_could_not_be_put_back_are_kept_beside_the_backup(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lost = ConnectionLostError("the line broke")
    failing(monkeypatch, RestoreError(lost, {"setup.8k": "SYS\n"}, ConnectionLostError("gone")))
    for name in ("mine-before", "mine-before1"):
        result = CliRunner().invoke(app, ["restore", "card:1", str(folder), "--yes"])
        assert result.exit_code == 1
        kept = folder.with_name(name)
        assert result.stderr == (
            "error: the line broke; the former contents could not be restored either: gone\n"
            f"what was on the card is in {kept}: openacr restore card:1 {kept}\n"
        )
        assert [path.name for path in kept.iterdir()] == ["setup.8k"]
        assert (kept / "setup.8k").read_text() == "SYS\n"


def test_contents_that_are_back_need_no_folder(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    failing(monkeypatch, RestoreError(ConnectionLostError("noise"), {"setup.8k": "SYS\n"}))
    result = CliRunner().invoke(app, ["restore", "card:1", str(folder), "--yes"])
    assert result.exit_code == 1
    assert result.stderr == "error: noise; the card has its former contents again\n"
    assert [path.name for path in folder.parent.iterdir()] == ["mine"]


def test_a_backup_names_what_it_could_not_keep(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    card = Card.open(Controller())

    @contextmanager
    def connected(target: str, baud: int, silence_s: float) -> Iterator[Card]:
        yield card

    monkeypatch.setattr(cli, "connected", connected)
    assert CliRunner().invoke(app, ["backup", "card:1", str(tmp_path / "a")]).exit_code == 0
    assert "guess" in (tmp_path / "a" / "machine.toml").read_text()
    original, remark = reading.write_folder, "REM not understood: AXIS0 JOG SRC: ?\n"
    monkeypatch.setattr(
        reading, "write_folder",
        lambda files, folder: original({"setup.8k": files["setup.8k"] + remark}, folder),
    )  # fmt: skip
    result = CliRunner().invoke(app, ["backup", "card:1", str(tmp_path / "b")])
    assert result.exit_code == 1
    assert result.stderr.endswith("not kept: AXIS0 JOG SRC: ?\n")


def test_a_backup_guesses_the_machine_of_its_model_and_keeps_one_that_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    card = Card.open(Controller("ACR8020"))

    @contextmanager
    def connected(target: str, baud: int, silence_s: float) -> Iterator[Card]:
        yield card

    monkeypatch.setattr(cli, "connected", connected)
    result = CliRunner().invoke(app, ["backup", "card:1", str(tmp_path / "a")])
    machine = tmp_path / "a" / "machine.toml"
    assert result.stdout == f"{tmp_path / 'a'}: setup.8k, machine.toml\n"
    assert result.stderr == f"{machine} is a guess: look for the word in it\n"
    assert 'model = "ACR8020"' in machine.read_text()
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "machine.toml").write_text("# mine\n")
    result = CliRunner().invoke(app, ["backup", "card:1", str(tmp_path / "b")])
    assert (result.stdout, result.stderr) == (f"{tmp_path / 'b'}: setup.8k\n", "")
    assert (tmp_path / "b" / "machine.toml").read_text() == "# mine\n"
