"""What the figures measure is in order; how fast it is, is no matter of tests."""

from pathlib import Path

from bench import busy, check
from openacr.project import Place, SourceFile
from openacr.source_check.source import Reader


def test_the_program_of_the_check_figure_has_no_errors() -> None:
    reader = Reader()
    reader.read(SourceFile(Path("setup.8k"), check.SET_UP.encode()))
    text = check.program(2000)
    reader.read(SourceFile(Path("prog0.8k"), text.encode(), Place.PROGRAM))
    assert [fault for fault in reader.faults if not fault.is_warning] == []
    assert len(text.splitlines()) > 2000


def test_everything_of_the_busy_card_is_at_work() -> None:
    card = busy.busy()
    card.advance(seconds=0.2)
    assert all(card.p[number] > 0 for number in range(16))
    assert all(card.bit[1024 + 32 * number] for number in range(16))
    assert all(card.bit[1536 + 32 * number] for number in range(8))
    assert all(card.bit[792 + 32 * number] for number in range(8))
