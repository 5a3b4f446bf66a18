from pathlib import Path

import pytest
from tests.client.cards import WrappedLink, load_example, with_axis, wrapped

from openacr.basic.memory import saved
from openacr.client import (
    Card,
    ConnectionLostError,
    DownloadError,
    Level,
    Options,
    RestoreError,
)
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


def test_an_extension_is_in_a_backup_only_where_it_is_set(tmp_path: Path) -> None:
    card = one_axis(Card.open(Controller()), "PROG1", "ATTACH MASTER1")
    card.backup(tmp_path / "plain")
    assert "LOOK TOL" not in texts(tmp_path / "plain")["setup.8k"]
    card.command("LOOK TOL 0.25", program=1)
    card.backup(tmp_path / "set")
    lines = texts(tmp_path / "set")["setup.8k"].splitlines()
    assert [line for line in lines if "LOOK TOL" in line] == ["LOOK TOL 0.25"]
    at = lines.index("LOOK TOL 0.25")
    assert [line for line in lines[:at] if line.startswith("PROG")][-1] == "PROG1"


class OtherCard(WrappedLink):
    """A card that does not know LOOK TOL, or whose line breaks or is interrupted at a text."""

    fails_at: tuple[bytes, BaseException] | None = None

    def write(self, data: bytes) -> None:
        if self.fails_at is not None and self.fails_at[0] in data:
            failure, self.fails_at = self.fails_at[1], None
            raise failure
        super().write(data.replace(b"LOOK TOL", b"LOOK TOX"))

    def read(self, timeout_s: float | None) -> bytes:
        return super().read(timeout_s).replace(b"LOOK TOX", b"LOOK TOL")


def other_card(reconnect_s: float = 10.0) -> tuple[Card, OtherCard]:
    link = OtherCard(Controller())
    return Card(link, Options(reconnect_s=reconnect_s)), link


def contents(card: Card, folder: Path) -> dict[str, str]:
    card.backup(folder)
    return texts(folder)


ONE_AXIS = (
    "DETACH ALL", "ATTACH AXIS0 ENC0 DAC0 ENC0", "DIM PROG0(2000)", "PROG0", "ATTACH MASTER0",
    'ATTACH SLAVE0 AXIS0 "X"', "SYS",
)  # fmt: skip


def one_axis(card: Card, *lines: str) -> Card:
    """A card that is quickly read, with a program."""
    for line in (*ONE_AXIS, *lines):
        card.command(line)
    card.download("PROGRAM\nX1\nENDP\n", to=Level.program(0))
    return card


def small_backup(folder: Path, *lines: str) -> Path:
    """A backup that differs from what `one_axis` gives."""
    card = one_axis(Card.open(Controller()), "AXIS0 JOG VEL 7", "PROG0", *lines)
    card.backup(folder)
    return folder


def test_a_backup_leaves_out_what_clear_allocates_by_itself(tmp_path: Path) -> None:
    small_backup(tmp_path, "SYS", "DIM PROG1(65535)", "DIM PROG8(65536)", "DIM P(5)")
    lines = texts(tmp_path)["setup.8k"].splitlines()
    assert [line for line in lines if line.startswith("DIM")] == [
        "DIM PROG0(2000)", "DIM PROG1(65535)", "DIM PROG8(65536)", "DIM P(5)",
    ]  # fmt: skip


def test_a_backup_with_a_setting_the_card_does_not_know_changes_nothing(tmp_path: Path) -> None:
    backup = small_backup(tmp_path / "b", "LOOK TOL 0.25")
    number = texts(backup)["setup.8k"].splitlines().index("LOOK TOL 0.25") + 1
    card, _ = other_card()
    one_axis(card)
    card.go(Level.program(3))
    before = contents(card, tmp_path / "before")
    with pytest.raises(DownloadError) as refused:
        card.restore(backup)
    assert (refused.value.path, refused.value.line) == (f"{backup}/setup.8k", number)
    assert refused.value.text.startswith("the card does not know LOOK TOL: ")
    assert (
        refused.value.hint == "an extension of openacr: real cards refuse it; nothing was changed"
    )
    assert contents(card, tmp_path / "after") == before


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("AXIS20 PPU 5", "AXIS20 PPU: Invalid argument"),
        ("AXIS0 TMOV 1", "AXIS0 TMOV: Syntax error"),
        ("AXIS0 ALM (5,-5)\nENC99 MULT 4", "ENC99 MULT: Invalid argument"),
    ],
)
def test_a_backup_of_another_model_changes_nothing(tmp_path: Path, line: str, text: str) -> None:
    small_backup(tmp_path / "b")
    setup = tmp_path / "b" / "setup.8k"
    setup.write_text(setup.read_text() + line + "\n")
    card = Card.open(Controller())
    card.p["axis0.ppu"] = 5
    with pytest.raises(DownloadError) as refused:
        card.restore(tmp_path / "b")
    assert refused.value.text == f"the card does not know {text}"
    assert refused.value.hint == "nothing was changed"
    assert card.p["axis0.ppu"] == 5


def test_a_backup_with_look_ahead_changes_nothing_on_a_model_without_it(tmp_path: Path) -> None:
    backup = small_backup(tmp_path / "b", "LOOK MINVEL 5")
    card = Card.open(Controller("ACR1500"))
    card.p["axis0.ppu"] = 5
    with pytest.raises(DownloadError) as refused:
        card.restore(backup)
    assert refused.value.text == "the card does not know LOOK: Not supported"
    assert refused.value.hint == "nothing was changed"
    assert card.p["axis0.ppu"] == 5


def test_a_card_that_refuses_a_line_gets_its_former_contents_back(tmp_path: Path) -> None:
    backup = small_backup(tmp_path / "b")
    (backup / "prog0.8k").write_text("PROGRAM\nX1\nFOO BAR 1\nENDP\n")
    card = one_axis(Card.open(Controller()), "DIM P(10)", "P5=1.25", "AXIS0 PPU 8000")
    before = contents(card, tmp_path / "before")
    with pytest.raises(RestoreError) as failed:
        card.restore(backup)
    assert failed.value.is_back
    assert failed.value.former == before
    assert str(failed.value).startswith(f"{backup}/prog0.8k:3: Unknown command")
    assert str(failed.value).endswith("; the card has its former contents again")
    assert contents(card, tmp_path / "after") == before


def test_a_line_that_breaks_in_a_restore_leaves_the_former_contents(tmp_path: Path) -> None:
    backup = small_backup(tmp_path / "b")
    card, link = other_card()
    one_axis(card)
    before = contents(card, tmp_path / "before")
    link.fails_at = (b"AXIS0 JOG VEL 7", ConnectionLostError("the line broke"))
    with pytest.raises(
        RestoreError, match=r"the line broke; the card has its former contents again"
    ):
        card.restore(backup)
    assert contents(card, tmp_path / "after") == before


def test_ctrl_c_in_a_restore_leaves_the_former_contents(tmp_path: Path) -> None:
    backup = small_backup(tmp_path / "b")
    card, link = other_card()
    one_axis(card)
    before = contents(card, tmp_path / "before")
    link.fails_at = (b"AXIS0 JOG VEL 7", KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        card.restore(backup)
    assert contents(card, tmp_path / "after") == before


def test_former_contents_that_cannot_be_put_back_are_in_the_error(tmp_path: Path) -> None:
    backup = small_backup(tmp_path / "b")
    card, link = other_card(reconnect_s=0)
    one_axis(card)
    before = contents(card, tmp_path / "before")
    link.is_reachable = False  # once it is closed
    link.fails_at = (b"AXIS0 JOG VEL 7", ConnectionLostError("the line broke"))
    with pytest.raises(RestoreError) as failed:
        card.restore(backup)
    assert not failed.value.is_back
    assert failed.value.former == before
    assert str(failed.value) == (
        "the line broke; the former contents could not be restored either: cannot connect"
    )


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
    link.alters = lambda data: (
        data.replace(b"ATTACH AXIS", b"AXIS ")
        .replace(b"DIM P(7)", b"P 7")
        .replace(b"?P32770\r\n1", b"?P32770\r\nUnknown command")
    )
    card.backup(tmp_path / "backup")
    setup = texts(tmp_path / "backup")["setup.8k"]
    assert "REM not understood: DIM: P 7\n" in setup
    assert "REM not understood: ATTACH: AXIS 0 ENC0 DAC0 ENC0\n" in setup
    assert "REM not readable: ?P32770: Unknown command\n" in setup
    assert "AXIS7 PPU 1\n" in setup
    card.restore(tmp_path / "backup")


def test_progress_ends_at_its_total(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    Card.open(Controller()).backup(tmp_path / "b", lambda done, total: seen.append((done, total)))
    assert seen[-1][0] == pytest.approx(seen[-1][1], rel=0.1)
    assert all(done <= total for done, total in seen)


def test_a_folder_with_controller_files_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("SYS\n")
    with pytest.raises(UserError, match=r"setup\.8k already exists"):
        Card.open(Controller()).backup(tmp_path)


def test_a_folder_that_is_no_backup_changes_nothing(tmp_path: Path) -> None:
    card = Card.open(Controller())
    card.p["axis0.ppu"] = 5
    with pytest.raises(UserError, match=r"no setup\.8k"):
        card.restore(tmp_path)
    assert card.p["axis0.ppu"] == 5


SOURCES = ("JOG SRC ENC3", "GEAR SRC ENC2", "CAM SRC P38912", "BSC SRC ENC7")


def test_a_backup_keeps_the_sources_of_axes(tmp_path: Path) -> None:
    card = Card.open(Controller())
    load_example(card, "gantry")
    lines = [f"AXIS{axis} {line}" for axis in (0, 2) for line in (*SOURCES, "HDW SRC ENC4")]
    for line in lines:
        card.command(line, program=0)
    card.backup(tmp_path / "one")
    kept = texts(tmp_path / "one")["setup.8k"].splitlines()
    assert set(lines) <= set(kept)
    assert [line for line in kept if "not understood" in line] == []
    other = Card.open(Controller())
    other.restore(tmp_path / "one")
    for line in lines:
        query, _, source = line.rpartition(" ")
        assert other.command(query, program=0) == [source]
    assert other.command("AXIS1 GEAR SRC", program=0) == ["NONE"]


def varied(value: object, index: int = 0) -> object:
    """Another value of the same kind, that seven digits hold, each object with its own."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, list | tuple):
        return [varied(each, index + place) for place, each in enumerate(value)]
    return round(value + 1.0 + 0.25 * index, 2) if isinstance(value, float) else value + 1  # type: ignore[operator]


# What has few values, or names others: attachments, sources, and the address, which stays.
CHOSEN = {
    "PERIOD": 0.001,
    "ENC # MULT": [[2]] * 20,
    "ADC POS": [7, 6, 5, 4, 3, 2, 1, 0],
    "CONFIG": ["ENC8", "DAC4", "NONE", "ADC8"],
    "BIT8448": [0, 1 << 5, 1 << 16, 1 << 20, 1 << 21, 1 << 22, 1 << 23, 0],
    "BIT16128": [1 << 16, 1 << 17, 1 << 18, 1 << 24, 1 << 25, 1 << 26, 0, 0],
    "BIT5632": [1 << 19],
}
STAY = {"IP", "ADC MODE", "VECDEF", "CANopen"}


def is_left(words: str) -> bool:
    """Whether the test leaves it as it is, or sets it by commands."""
    is_source = words.split()[-1] == "SRC" and words != "ENC # SRC"
    return words in STAY or words.startswith("ATTACH") or is_source


def kept_by_esave(controller: Controller) -> dict[str, object]:
    return saved.take(controller.system)


def card_with_masters() -> Controller:
    """A card whose eight programs have a master and an axis each."""
    controller = Controller("ACR9000")
    card = Card.open(controller)
    for number in range(8):
        card.command(f"ATTACH MASTER{number}", program=number)
        card.command(f'ATTACH SLAVE0 AXIS{number} "X"', program=number)
    return controller


def test_a_replacement_card_keeps_everything_that_esave_keeps(tmp_path: Path) -> None:
    worn = card_with_masters()
    before = kept_by_esave(worn)
    for item in saved.all_saved():
        if not is_left(item.words):
            item.put(worn.system, CHOSEN.get(item.words) or varied(before[item.words]))
    card = Card.open(worn)
    for line in ("AXIS1 VECDEF 3", "TMOV 3", "TMOV OFF"):
        card.command(line, program=1)
    for number in (32768, 32769, 32770, 32771, 32772, 33024, 33072, 33282, 33283, 33778, 33779):
        card.command(f"P{number}={card.ask(f'P{number}') + 1}")
    wanted = kept_by_esave(worn)
    assert {words for words in wanted if wanted[words] == before[words]} == {
        words for words in wanted if is_left(words)
    } - {"VECDEF", "CANopen"}
    card.backup(tmp_path / "b")
    assert kept_by_esave(worn) == wanted  # reading switches nothing
    other = Controller("ACR9000")
    Card.open(other).restore(tmp_path / "b")
    assert kept_by_esave(other) == wanted
    Card.open(other).backup(tmp_path / "again")
    assert texts(tmp_path / "again") == texts(tmp_path / "b")


def test_a_backup_of_a_card_turns_nothing_on(tmp_path: Path) -> None:
    controller = Controller.from_project("examples/gantry")
    before = kept_by_esave(controller)
    Card.open(controller).backup(tmp_path / "b")
    assert kept_by_esave(controller) == before
    assert not any(before["PM ON"])  # type: ignore[arg-type]
