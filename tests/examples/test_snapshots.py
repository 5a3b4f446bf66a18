"""Every example goes on from a snapshot, and lives its journal once more, to the same digests."""

import os
import random
import subprocess
import sys
from pathlib import Path

import pytest
from tests.examples.observe import EXAMPLES, load

from openacr.compiled import is_compiled
from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.controller.snapshot_file import decode, encode

NAMES = sorted(path.parent.name for path in EXAMPLES.glob("*/machine.toml"))
IN_PLAIN_PYTHON_TK = 250
START = "SYS\rRUN ALL\rRUN PLC ALL\r"
_REPLAY = """
import sys
from pathlib import Path
from openacr.compiled import is_compiled
from openacr.controller.journal import read_journal
from openacr.controller.replay import Replay
assert not is_compiled
for path, folder in zip(sys.argv[1::2], sys.argv[2::2]):
    again = Replay(read_journal(Path(path)), Path(folder))
    again.run()
    print(again.equal, again.difference)
"""


def started(name: str) -> Controller:
    card = load(name)
    card.send(START)
    return card


def journal_of(name: str, folder: Path, ticks: int) -> Path:
    """The journal of an example from before its programs are started."""
    card, path = load(name), folder / f"{name}.journal"
    card.advance(50)
    card.recorder = Recorder(card, path)
    card.send(START)
    card.advance(ticks)
    card.send("?P12288\rPROG0\rHALT ALL")
    card.advance(20)
    card.close()
    return path


@pytest.mark.parametrize("name", NAMES)
def test_the_journal_of_an_example_is_replayed_to_equal_digests(name: str, tmp_path: Path) -> None:
    journal = read_journal(journal_of(name, tmp_path, 3000))
    again = Replay(journal, EXAMPLES / name)
    again.run()
    assert (again.difference, again.equal) == (None, 2)


@pytest.mark.parametrize("name", NAMES)
def test_a_journal_begun_in_the_middle_of_an_example_is_replayed(name: str, tmp_path: Path) -> None:
    card, path = started(name), tmp_path / "a.journal"
    card.advance(random.Random(name).randrange(200, 4000))
    card.recorder = Recorder(card, path)
    card.advance(3000)
    card.close()
    again = Replay(read_journal(path), EXAMPLES / name)
    again.run()
    assert (again.difference, again.equal) == (None, 2)


@pytest.mark.skipif(not is_compiled, reason="there is no compiled core to compare with")
def test_plain_python_replays_the_journals_of_all_examples(tmp_path: Path) -> None:
    paths = [
        str(path)
        for name in NAMES
        for path in (journal_of(name, tmp_path, IN_PLAIN_PYTHON_TK), EXAMPLES / name)
    ]
    found = subprocess.run(
        [sys.executable, "-c", _REPLAY, *paths],
        env=os.environ | {"OPENACR_PURE": "1"},
        check=True,
        capture_output=True,
        text=True,
    )
    assert found.stdout.splitlines() == ["1 None"] * len(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_card_restored_at_any_moment_agrees_at_every_later_tick(name: str) -> None:
    chance = random.Random(name)
    card = started(name)
    for _ in range(2):
        card.advance(chance.randrange(1, 1500))
        again = Controller(card.model, world=card.world, device_folder=card.device_folder)
        again.take_over(decode(encode(card.snapshot())))
        assert again.image() == card.image()
        for tick in range(10):
            for each in (card, again):
                each.advance(1)
            assert again.digest() == card.digest(), tick
        for each in (card, again):
            each.advance(700)
        assert again.digest() == card.digest()


def test_every_example_is_here() -> None:
    assert len(NAMES) == len([path for path in EXAMPLES.iterdir() if path.is_dir()])
    assert {"plc_excess_error", "canopen_io"} <= set(NAMES)
