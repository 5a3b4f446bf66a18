"""The scope of a served card: its records over sockets and serial lines that break."""

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.mill.live import SERVE, Process, serial_line, until
from tests.panel.remote import Remote
from tests.proxy import Proxy

from openacr.client import Card
from openacr.panel.control.scope import Samples
from openacr.panel.machine import FOLDER

PROGRAM, COUNT = 5, 200
CLOCK = "P6916"  # ms


@dataclass(frozen=True, slots=True)
class Line:
    """A served card, its socket through a line that can be cut, its serial line."""

    process: Process
    proxy: Proxy
    serial: str
    other: Card  # another host


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Line]:
    folder = tmp_path_factory.mktemp("card")
    with ExitStack() as opened:
        near, far = opened.enter_context(serial_line())
        words = (*SERVE[1:], "--no-journal", "--serial", far)
        process = Process(SERVE[0], str(FOLDER), *words, store=folder / "card.db")
        opened.callback(process.close)
        until(lambda: "ascii=" in process.text, about="the card is served")
        found = re.search(r"ascii=(\S+)", process.text)
        assert found is not None
        other = opened.enter_context(Card.open(found[1]))
        for text in ("DIM LA(2)", f"DIM LA0({COUNT})", f"DIM LA1({COUNT})"):
            other.command(text, program=PROGRAM)
        proxy = opened.enter_context(Proxy(found[1]))
        yield Line(process, proxy, near, other)


@pytest.fixture
def reached(line: Line, tmp_path: Path) -> Iterator[Callable[[str], tuple[Remote, list[Samples]]]]:
    """Stations of the card at an address, with what their scopes record."""
    with ExitStack() as opened:

        def reach(address: str) -> tuple[Remote, list[Samples]]:
            remote, records = Remote(address, tmp_path), list[Samples]()
            opened.callback(remote.close)
            until(lambda: remote.station.snapshot.number > 0, limit_s=60.0)
            remote.station.sampled = records.append
            return remote, records

        yield reach


def begin(remote: Remote) -> None:
    """Record the clock of the card and a flag in every millisecond."""
    args = {"channels": [CLOCK, "BIT1921"], "period_ms": 1, "samples": COUNT, "program": PROGRAM}
    answer = remote.send("scope.arm", **args)
    assert answer["ok"], answer


def require_whole(records: list[Samples]) -> None:
    """Each record is of consecutive milliseconds; records follow each other."""
    for _, block, period_s in records:
        assert period_s == 0.001
        for first in range(0, block.shape[1], COUNT):
            clock = block[0, first : first + COUNT].tolist()
            assert clock == [clock[0] + k for k in range(COUNT)]


@pytest.mark.parametrize("kind", ["tcp", "serial"])
def test_records_over_a_link_have_every_millisecond(
    line: Line, reached: Callable[[str], tuple[Remote, list[Samples]]], kind: str
) -> None:
    remote, records = reached(line.proxy.address if kind == "tcp" else line.serial)
    assert remote.installation.kind == kind
    line.other.write_bit(1921, True)
    begin(remote)
    until(lambda: len(records) > 1, limit_s=60.0, about="two records")
    require_whole(records)
    assert {each for _, block, _ in records for each in block[1].tolist()} == {1.0}
    assert remote.send("scope.stop")["ok"]
    until(lambda: not line.other.read_bit(104), about="the sampler is disarmed")


def test_records_go_on_after_a_link_that_was_cut_shortly_and_end_with_a_session(
    line: Line, reached: Callable[[str], tuple[Remote, list[Samples]]]
) -> None:
    remote, records = reached(line.proxy.address)
    begin(remote)
    for _ in range(4):
        line.proxy.reset()
        records.clear()
        until(lambda: len(records) > 1, limit_s=60.0, about="records after a reset")
        require_whole(records)
    line.proxy.cut()
    until(lambda: remote.station.lost != "", limit_s=60.0, about="the card is lost")
    assert remote.station.scope.running is None
    line.proxy.mend()
    until(lambda: remote.station.lost == "", limit_s=90.0, about="the card is found")
    records.clear()
    begin(remote)
    until(lambda: bool(records), limit_s=60.0, about="a record of the new session")
    require_whole(records)
    line.process.close()  # in the middle of a record, or while it is read
    until(lambda: remote.station.lost != "", limit_s=60.0, about="the card has ended")
    assert remote.station.scope.running is None
