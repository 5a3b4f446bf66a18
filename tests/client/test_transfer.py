from pathlib import Path

import pytest
from tests.client.cards import EXAMPLES, load_example, wrapped

from openacr.channels import EchoMode
from openacr.client import (
    Card,
    DownloadError,
    Level,
    Options,
    RefusedError,
    VerificationError,
)
from openacr.client.listing import Stored, is_numbered, meaning
from openacr.controller import Controller

P0, PLC0 = Level.program(0), Level.plc(0)
NAMES = sorted(path.name for path in EXAMPLES.iterdir() if (path / "setup.8k").is_file())
NUMBERED = '10 REM start\n20 X1 : Y/2\n30 IF (BIT 1) THEN PRINT ">" : GOTO 20\n40 GOTO 10\n'


@pytest.fixture
def card() -> Card:
    """A card with room for programs and two axes in program 0."""
    card = Card.open(Controller())
    for line in ("DIM PROG0(4000)", "DIM PLC0(2000)", "PROG0", "ATTACH MASTER0"):
        card.command(line)
    card.command('ATTACH SLAVE0 AXIS0 "X"')
    card.command('ATTACH SLAVE1 AXIS1 "Y"')
    return card


@pytest.mark.parametrize("name", NAMES)
def test_an_uploaded_example_downloads_to_the_same_listing(name: str) -> None:
    card = Card.open(Controller())
    levels = load_example(card, name)
    assert levels
    for level in levels:
        text = card.upload(level)
        assert text
        card.download(text, to=level)
        assert card.upload(level) == text


@pytest.mark.parametrize("echo", [1, 4, 0])
def test_a_program_is_stored_and_compared_in_every_echo_mode(echo: int) -> None:
    card = Card.open(Controller(), Options(echo=EchoMode(echo)))
    card.command("DIM PROG0(4000)")
    report = card.download("PROGRAM\n\n' gone\nP0 = 1 : REM kept\nENDP\n", to=P0)
    assert (report.sent, list(report.entered), report.remarks) == (4, [P0], [])
    assert card.upload(P0) == "PROGRAM\n P0 = 1 : REM kept\nENDP\n"
    assert (card.ask("1"), card.level) == (1, P0)


def test_a_numbered_program_comes_back_by_its_numbers(card: Card) -> None:
    card.download(NUMBERED, to=P0)
    text = card.upload(P0)
    assert text.splitlines()[0] == "NEW"
    card.command("15 REM another line", program=0)
    card.download(text, to=P0)
    assert card.upload(P0) == text


def test_numbered_lines_are_added_to_what_is_stored(card: Card) -> None:
    card.download(NUMBERED, to=P0)
    card.download("25 END\n40\n", to=P0)
    numbers = [line.split()[0] for line in card.upload(P0).splitlines()]
    assert numbers == ["NEW", "10", "20", "25", "30"]


def test_a_plc_is_stored_and_compared(card: Card) -> None:
    card.download("PROGRAM\nLD 0\nAND NOT 1\nOUT 32\nENDP\n", to=PLC0)
    text = card.upload(PLC0)
    card.download(text, to=PLC0)
    assert card.upload(PLC0) == text


def test_an_empty_program_uploads_as_nothing(card: Card) -> None:
    assert card.upload(Level.program(9)) == ""


def test_published_text_is_tolerated_like_in_a_file(card: Card) -> None:
    text = "P00>PRINT \u201ca\u201d : GOSUB Go\n_Go\nRETURN\n"
    card.download(text, to=P0)
    assert card.upload(P0) == 'PROGRAM\n PRINT "a" : GOSUB Go\n _Go\n RETURN\nENDP\n'


def test_a_refused_line_ends_the_download_with_its_place_and_erases_the_half(card: Card) -> None:
    with pytest.raises(DownloadError) as failed:
        card.download("PROGRAM\nX1\nfoo\nX2\nENDP\n", path="prog0.8k", to=P0)
    assert str(failed.value).startswith("prog0.8k:3: Unknown command (")
    assert "PROG0 was erased" in failed.value.hint
    assert card.upload(P0) == ""
    assert card.ask("5") == 5


def test_a_refused_setting_keeps_what_was_done_before(card: Card) -> None:
    with pytest.raises(DownloadError, match=r"setup\.8k:2: Unknown command"):
        card.download("AXIS0 PPU 7\nfoo\nAXIS0 PPU 8\n", path="setup.8k")
    assert card.p["axis0.ppu"] == 7


def test_a_line_that_cannot_be_sent_ends_the_download_as_well(card: Card) -> None:
    with pytest.raises(DownloadError, match=r"a\.8k:2: .*cannot be sent"):
        card.download("PROGRAM\nREM \u0416\nENDP\n", path="a.8k", to=P0)
    assert card.upload(P0) == ""


def test_a_running_program_is_not_replaced(card: Card) -> None:
    card.download("PROGRAM\n_L\nGOTO L\nENDP\n", to=P0)
    card.run(0)
    with pytest.raises(DownloadError, match=r":1: Program is running \(halt it first\)"):
        card.download("PROGRAM\nENDP\n", path="x", to=P0)


def test_reports_of_set_up_lines_are_kept_as_remarks(card: Card) -> None:
    report = card.download("AXIS0 PPU 5\nAXIS0 PPU\n")
    assert [(remark.line, remark.text) for remark in report.remarks] == [(2, "5")]


def test_progress_counts_every_line(card: Card) -> None:
    seen: list[tuple[int, int]] = []
    text = "PROGRAM\nX1\nENDP\n"
    card.download(text, to=P0, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_what_the_card_stores_differently_is_found() -> None:
    card, link = wrapped()
    card.command("DIM PROG0(2000)")
    link.alters = lambda data: data.replace(b" P1 = 2", b" P1 = 3")
    with pytest.raises(VerificationError, match=r"a:3: PROG0: the card lists 'P1 = 3'"):
        card.download("PROGRAM\nP0=1\nP1=2\nENDP\n", path="a", to=P0)
    card.download("PROGRAM\nP0=1\nP1=2\nENDP\n", to=P0, is_verified=False)


def test_a_protected_program_can_be_neither_verified_nor_uploaded(card: Card) -> None:
    card.go(Level())
    card.command('PASSWORD ON "abc"')
    with pytest.raises(VerificationError, match="Program is protected"):
        card.download("PROGRAM\nENDP\n", to=P0)
    with pytest.raises(RefusedError, match="Program is protected"):
        card.upload(P0)


def test_listings_with_forced_numbers_are_understood(card: Card) -> None:
    text = "PROGRAM\n P0 = 1\nENDP\n"
    card.bit[5651] = True
    card.download(text, to=P0)
    assert meaning(card.upload(P0).splitlines()[1]) == meaning("P0=1")


@pytest.mark.parametrize(
    ("one", "other", "is_same"),
    [
        ("x10:y/2.50", "X10 : Y/2.5", True),
        ("VEL 1e-005", "VEL 1E-05", True),
        ('PRINT "a"', 'PRINT "A"', False),
        ("REM  spaced  ", "REM spaced", True),
        ("X10", "X11", False),
    ],
)
def test_spelling_does_not_count_but_meaning_does(one: str, other: str, is_same: bool) -> None:
    assert (meaning(one) == meaning(other)) is is_same


@pytest.mark.parametrize(
    ("listed", "problem"),
    [
        (["PROGRAM", "X1", "ENDP"], None),
        (["PROGRAM", "X2", "ENDP"], (2, "the card lists 'X2'")),
        (["PROGRAM", "X1"], (3, "the card does not list this line")),
        (["PROGRAM", "X1", "ENDP", "X3"], (3, "the card also lists 'X3'")),
    ],
)
def test_the_first_difference_is_named(listed: list[str], problem: tuple[int, str] | None) -> None:
    stored = Stored(is_whole=True)
    for number, text in enumerate(("PROGRAM", "X1", "ENDP"), start=1):
        stored.add(text, number)
    assert stored.difference(listed) == problem


@pytest.mark.parametrize(
    ("text", "expected"),
    [(NUMBERED, True), (f"NEW\n{NUMBERED}", True), ("PROGRAM\n10 X1\nENDP\n", False), ("", False)],
)
def test_numbered_text_is_distinguished_from_published_text(text: str, expected: bool) -> None:
    assert is_numbered(text) is expected


def test_the_examples_are_there() -> None:
    assert len(NAMES) >= 6
    assert Path(EXAMPLES / "gantry").is_dir()
