from pathlib import Path

import pytest
from tests.client.cards import load_example, with_axis, wrapped

from openacr.client import Card, Level
from openacr.controller import Controller
from openacr.errors import UserError


def texts(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()}


@pytest.mark.parametrize("name", ["gantry", "error_handler"])
def test_a_restored_card_gives_the_same_backup(tmp_path: Path, name: str) -> None:
    card = Card.open(Controller())
    load_example(card, name)
    card.p[5] = 1.25
    names = card.backup(tmp_path / "one")
    assert names == ["setup.8k", "prog0.8k", "prog1.8k"]
    other = with_axis(Card.open(Controller()))
    other.restore(tmp_path / "one")
    assert other.level == Level()
    other.backup(tmp_path / "two")
    assert texts(tmp_path / "two") == texts(tmp_path / "one")
    assert "P5=1.25\n" in texts(tmp_path / "one")["setup.8k"]


def test_a_backup_is_a_project(tmp_path: Path) -> None:
    card = Card.open(Controller())
    load_example(card, "square")
    card.backup(tmp_path / "backup")
    again = Controller.from_project(tmp_path / "backup")
    assert again.p[12375] == 8000


def test_what_a_card_does_not_know_is_left_out_with_a_remark(tmp_path: Path) -> None:
    controller = Controller("ACR1505")
    card = Card.open(controller)
    card.go(Level())
    card.command('PASSWORD ON "x"')
    card.backup(tmp_path / "backup")
    setup = texts(tmp_path / "backup")["setup.8k"]
    assert "REM not readable: PROG0: Program is protected\n" in setup
    card.command('PASSWORD OFF "x"')
    card.restore(tmp_path / "backup")


def test_what_a_card_reports_in_another_form_is_kept_as_a_remark(tmp_path: Path) -> None:
    card, link = wrapped()
    card.command("DIM P(7)")
    link.alters = lambda data: data.replace(b"ATTACH AXIS", b"AXIS ").replace(b"DIM P(7)", b"P 7")
    card.backup(tmp_path / "backup")
    setup = texts(tmp_path / "backup")["setup.8k"]
    assert "REM not understood: DIM: P 7\n" in setup
    assert "REM not understood: ATTACH: AXIS 0 ENC0 DAC0 ENC0\n" in setup
    assert "AXIS7 PPU 1\n" in setup
    card.restore(tmp_path / "backup")


def test_progress_ends_at_its_total(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    Card.open(Controller()).backup(tmp_path / "b", lambda done, total: seen.append((done, total)))
    assert seen[-1][0] == pytest.approx(seen[-1][1], rel=0.1)
    assert all(done <= total for done, total in seen)


def test_a_folder_with_controller_files_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\n")
    with pytest.raises(UserError, match=r"setup\.8k is there already"):
        Card.open(Controller()).backup(tmp_path)


def test_a_folder_that_is_no_backup_changes_nothing(tmp_path: Path) -> None:
    card = Card.open(Controller())
    card.p["axis0.ppu"] = 5
    with pytest.raises(UserError, match=r"no setup\.8k"):
        card.restore(tmp_path)
    assert card.p["axis0.ppu"] == 5
