"""Journals of cards that run faster than their fingerprints are computed keep their memory."""

import threading
from collections.abc import Iterator
from concurrent.futures import wait
from pathlib import Path

import pytest
from tests.waiting import until

from openacr.controller import Controller, recorder
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.controller.ring import Ring, journals
from openacr.journal.records import MOST_WORKED_OUT, WORKER
from openacr.map.memory import digest_of


class Slow:
    """Stands for a thread that gets no processor time until `go`."""

    def __init__(self) -> None:
        self.go = threading.Event()
        self.held = 0

    def __call__(self, image: bytearray) -> str:
        self.held += 1
        assert self.go.wait(60.0)
        return digest_of(image)


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> Iterator[Slow]:
    made = Slow()
    monkeypatch.setattr(recorder, "digest_of", made)
    yield made
    made.go.set()


def digests(path: Path) -> int:
    return sum(each.is_digest and each.text != "" for each in read_journal(path).entries)


def test_a_card_in_real_time_leaves_fingerprints_out_and_says_so_once(
    tmp_path: Path, slow: Slow, caplog: pytest.LogCaptureFixture
) -> None:
    card = Controller()
    made = card.recorder = Recorder(card, tmp_path / "a.journal", waits=False)
    card.advance(seconds=20.5)  # nothing waits
    assert made.left_out == 20 - (MOST_WORKED_OUT - 1)  # the header is one of them
    assert len([each for each in caplog.messages if "left out" in each]) == 1
    slow.go.set()
    card.close()
    assert digests(tmp_path / "a.journal") == 20 - made.left_out + 1
    again = Replay(read_journal(tmp_path / "a.journal"))
    again.run()
    assert (again.equal, again.difference) == (20 - made.left_out + 1, None)


def test_a_card_that_may_wait_does_so_and_misses_no_fingerprint(tmp_path: Path, slow: Slow) -> None:
    card = Controller()
    card.recorder = Recorder(card, tmp_path / "a.journal")
    run = threading.Thread(target=card.advance, kwargs={"seconds": 20.5})
    run.start()
    until(lambda: card.lived_tk * card.period_s >= MOST_WORKED_OUT - 1e-6)
    run.join(0.2)  # time to go further, if it did not wait
    assert run.is_alive()
    assert card.lived_tk * card.period_s == pytest.approx(MOST_WORKED_OUT)
    slow.go.set()
    run.join(60.0)
    card.close()
    assert digests(tmp_path / "a.journal") == 21


def test_a_ring_begins_no_new_file_while_the_thread_is_late(tmp_path: Path, slow: Slow) -> None:
    card = Controller()
    card.recorder = Ring(card, tmp_path, file_s=30.0, waits=False)
    card.advance(seconds=400.0)
    assert len(journals(tmp_path)) == 1
    slow.go.set()
    wait(list(WORKER._open))
    card.advance(seconds=2.0)
    card.close()
    assert len(journals(tmp_path)) == 2
