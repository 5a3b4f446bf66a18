"""The scope of a served card: its records over sockets and serial lines that break."""

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.mill.live import SERVE, Process, serial_line
from tests.panel.remote import Remote
from tests.proxy import Proxy
from tests.waiting import until

from openacr.client import Card
from openacr.panel.control.engineer.scope import Samples
from openacr.panel.control.machine import link
from openacr.panel.machine import FOLDER, opened
from openacr.sysvar.tabs import CONTROL

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
    with ExitStack() as opens:
        near, far = opens.enter_context(serial_line())
        words = (*SERVE[1:], "--no-journal", "--serial", far)
        process = Process(SERVE[0], str(FOLDER), *words, store=folder / "card.db")
        opens.callback(process.close)
        until(lambda: "ascii=" in process.text, about="the card is served")
        found = re.search(r"ascii=(\S+)", process.text)
        assert found is not None
        other = opens.enter_context(Card.open(found[1]))
        for text in ("DIM LA(2)", f"DIM LA0({COUNT})", f"DIM LA1({COUNT})"):
            other.command(text, program=PROGRAM)
        proxy = opens.enter_context(Proxy(found[1]))
        yield Line(process, proxy, near, other)


Reach = Callable[..., tuple[Remote, list[Samples]]]


@pytest.fixture
def reached(line: Line, tmp_path: Path) -> Iterator[Reach]:
    """Stations of the card at an address, with what their scopes record."""
    with ExitStack() as opens:

        def reach(address: str, timeout_s: float = 60.0) -> tuple[Remote, list[Samples]]:
            with opened(tmp_path / "sysvar.db") as store:
                store.write(CONTROL.link_timeout, timeout_s)
            remote, records = Remote(address, tmp_path), list[Samples]()
            opens.callback(remote.close)
            until(lambda: remote.station.snapshot.number > 0)
            remote.station.on_samples = lambda _to, each: records.append(each)
            return remote, records

        yield reach


def begin(remote: Remote) -> bool:
    """Record the clock of the card and a flag in every millisecond; False while it is lost."""
    args = {"channels": [CLOCK, "BIT1921"], "period_ms": 1, "samples": COUNT, "program": PROGRAM}
    return bool(remote.send("scope.arm", **args)["ok"])


def require_whole(records: list[Samples]) -> None:
    """Each record is of consecutive milliseconds; records follow each other."""
    for _, block, period_s in records:
        assert period_s == 0.001
        for first in range(0, block.shape[1], COUNT):
            clock = block[0, first : first + COUNT].tolist()
            assert clock == [clock[0] + k for k in range(COUNT)]


@pytest.mark.parametrize("kind", ["tcp", "serial"])
def test_records_over_a_link_have_every_millisecond(line: Line, reached: Reach, kind: str) -> None:
    remote, records = reached(line.proxy.address if kind == "tcp" else line.serial)
    assert remote.installation.kind == kind
    line.other.write_bit(1921, True)
    assert begin(remote)
    until(lambda: len(records) > 1, about="two records")
    require_whole(records)
    assert {each for _, block, _ in records for each in block[1].tolist()} == {1.0}
    assert remote.send("scope.stop")["ok"]
    until(lambda: not line.other.read_bit(104), about="the sampler is disarmed")


def test_records_go_on_after_a_link_that_was_cut_shortly(line: Line, reached: Reach) -> None:
    remote, records = reached(line.proxy.address)
    assert begin(remote)
    for _ in range(3):
        line.proxy.reset()
        records.clear()
        until(lambda: len(records) > 1, about="records after a reset")
        require_whole(records)


def test_records_end_with_a_session(
    line: Line, reached: Reach, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link, "RETRY_S", 0.1)
    remote, records = reached(line.proxy.address, 1.5)
    scope = remote.station.captures.of(1).scope

    def record() -> None:
        records.clear()
        until(
            lambda: bool(records) or (scope.running is None and begin(remote) and False),
            about="a record",
        )
        require_whole(records)

    record()
    line.proxy.cut()
    until(
        lambda: remote.station.link.lost != "" and scope.running is None, about="the card is lost"
    )
    line.proxy.mend()
    record()  # in the new session
    line.process.close()  # in the middle of a record, or while it is read
    until(lambda: remote.station.link.lost != "" and scope.running is None, about="it has ended")
