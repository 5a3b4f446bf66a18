"""Commands that move a real machine never leave it moving, however they end."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests import warm

from openacr.client import Card
from openacr.map.words import mf1
from openacr.sysvar import Store

COOLANT_FLOOD = 800_010
SERVE = ["serve", "--ascii-port", "0", "--binary-port", "0", "--no-journal"]


def openacr(*words: str, store: Path) -> "subprocess.Popen[str]":
    return warm.Popen(
        [*words],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "OPENACR_STORE": str(store)},
    )


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    served = openacr(*SERVE, store=tmp_path / "none.db")
    assert served.stdout is not None
    lines = iter(served.stdout.readline, "")
    yield next(found[1] for line in lines if (found := re.search(r"ascii=(\S+)", line)))
    served.terminate()
    served.wait(60)
    served.stdout.close()


def is_moving(card: Card) -> bool:
    return bool(int(card.read(mf1.word[0])) & mf1.IN_MOTION)


@pytest.mark.skipif(sys.platform == "win32", reason="no signals of this kind")
@pytest.mark.parametrize(
    ("number", "times"), [(signal.SIGINT, 1), (signal.SIGINT, 3), (signal.SIGTERM, 1)]
)
def test_a_run_that_is_signalled_to_end_brings_the_machine_to_rest(
    tmp_path: Path, address: str, number: signal.Signals, times: int
) -> None:
    part = tmp_path / "PART.NC"
    part.write_text("M12\nM8\nF60\nG1 X100\nM2\n")
    with Store(tmp_path / "sysvar.db") as store:
        store.write(COOLANT_FLOOD, 41)
    run = openacr("mill", "run", str(part), "--host", address, store=tmp_path / "sysvar.db")
    with Card.open(address) as card:
        while not is_moving(card):
            time.sleep(0.05)
        assert card.read_bit(41)
        for _ in range(times):  # an impatient operator
            run.send_signal(number)
            time.sleep(0.01)
        output, _ = run.communicate(timeout=60)
        assert (run.returncode, "the machine is at rest at X" in output) == (130, True)
        assert not card.read_bit(41)
        places = {int(card.read(12288)) for _ in range(5)}
    assert len(places) == 1
    assert 0 < places.pop() < 1_000_000
