"""A panel on a served card whose link breaks and comes back, and stores that cannot be written."""

import re
import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from tests.mill.live import SERVE, Process
from tests.panel.remote import ME, Remote
from tests.proxy import Proxy
from tests.waiting import until

from openacr.client import Card, ConnectionLostError, Level, links
from openacr.client.links import TcpLink, link_to
from openacr.client.stored import listing, rooms
from openacr.panel.control.engineer import terminal
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.orders import Order
from openacr.panel.machine import FOLDER, opened


@pytest.fixture
def served(tmp_path: Path) -> Iterator[str]:
    process = Process(SERVE[0], str(FOLDER), *SERVE[1:], "--no-journal", store=tmp_path / "card.db")
    until(lambda: "ascii=" in process.text, about="the card is served")
    found = re.search(r"ascii=(\S+)", process.text)
    assert found is not None
    yield found[1]
    process.close()


def test_a_card_that_is_not_there_is_said_and_found_when_it_comes(
    served: str, tmp_path: Path
) -> None:
    with Proxy(served) as proxy:
        proxy.cut()
        remote = Remote(proxy.address, tmp_path)
        try:
            until(lambda: remote.station.link.lost.startswith("NO CARD FOUND"))
            answer = remote.send("home.start", axes="X")
            assert answer["error"]["code"] == "refused"
            assert answer["error"]["text"].startswith("NO CARD FOUND")
            assert remote.link() == "lost"
            proxy.mend()
            until(lambda: remote.station.link.lost == "")
            until(lambda: remote.link() == "ok")
        finally:
            remote.close()


def test_a_held_axis_rests_when_the_card_is_lost_and_the_card_is_found_again(
    served: str, tmp_path: Path
) -> None:
    with Proxy(served) as proxy, Card.open(served) as watcher:
        remote = Remote(proxy.address, tmp_path)
        try:
            until(lambda: remote.station.snapshot.number > 0)

            def press() -> bool:
                number = 1 + max((e["press"] for e in remote.events if "press" in e), default=0)
                args = {"axis": "X", "direction": 1, "first": True}
                tick = remote.station.snapshot.tick_ms
                return bool(remote.send("jog.press", press=number, tick=tick, **args)["ok"])

            until(press, about="the jog begins")
            proxy.cut()
            until(lambda: any(event["event"] == "jog" for event in remote.events))
            places = [float(watcher.read(12288 + 9))]

            def rests() -> bool:
                places.append(float(watcher.read(12288 + 9)))
                return len(places) > 5 and len(set(places[-5:])) == 1

            until(rests, about="the axis rests")
            proxy.mend()
            until(lambda: remote.station.link.lost == "" and remote.link() == "ok", limit_s=90.0)
        finally:
            remote.close()


def test_another_panel_on_one_machine_is_refused_with_the_reason(
    served: str, tmp_path: Path
) -> None:
    first = Remote(served, tmp_path)
    (tmp_path / "second").mkdir()
    second = Remote(served, tmp_path / "second")
    try:
        both = (first, second)
        until(lambda: all(each.station.link.lost == "" for each in both))
        (loser,) = [each for each in both if each.installation.lacks]
        assert loser.installation.lacks.startswith("another program drives this machine")
        assert not loser.send("run.begin")["ok"]
    finally:
        first.close()
        second.close()


def test_programs_of_a_served_card_are_sent_listed_run_heard_and_halted(
    served: str, tmp_path: Path
) -> None:
    remote = Remote(served, tmp_path)
    text = "PROGRAM\nDIM LV(1)\n_more\nLV0 = LV0+1\nDWL 0.02\nPRINT LV0\nGOTO more\nENDP\n"
    try:
        until(lambda: remote.link() == "ok")
        assert remote.send("card.send", program=3, text=text)["result"] == {
            "name": "PROG3", "sent": 8,
        }  # fmt: skip
        future = remote.call(
            lambda station: station.on_card.aside.begin(
                lambda talk: listing(talk, Level.program(3))
            )
        )
        assert [(line.number, line.text) for line in future.result(60.0)][3:5] == [
            (40, " LV0 = LV0+1"), (50, " DWL 0.02"),
        ]  # fmt: skip
        assert remote.send("watch.begin", topic="programs", hz=10)["ok"]
        assert remote.send("card.listen", program=3)["ok"]
        assert remote.send("card.run", program=3)["ok"]
        until(lambda: state_of(remote, "PROG3") not in ("", "halted"))
        until(lambda: len(heard(remote).split()) >= 3)
        assert remote.send("card.halt", program=3)["ok"]
        until(lambda: state_of(remote, "PROG3") == "halted")
    finally:
        remote.close()


def state_of(remote: Remote, name: str) -> str:
    events = [event for event in remote.events if event["event"] == "programs"]
    states = {each["name"]: each["state"] for each in events[-1]["programs"]} if events else {}
    return str(states.get(name, ""))


def heard(remote: Remote) -> str:
    return "".join(e["text"] for e in remote.events if e["event"] == "listen")


def test_a_card_that_does_not_answer_does_not_hold_up_the_control_thread(
    served: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    remote = Remote(served, tmp_path)
    is_free = threading.Event()
    try:
        until(lambda: remote.link() == "ok")
        monkeypatch.setattr(TcpLink, "open", lambda _link: is_free.wait(60.0) and None)
        future = remote.call(lambda station: station.on_card.aside.begin(rooms))
        steps = [remote.call(lambda station: station.snapshot.number) for _ in range(3)]
        until(lambda: remote.call(lambda station: station.snapshot.number) > steps[-1] + 3)
        assert not future.done()
        remote.call(lambda station: station.on_card.end())
        assert isinstance(future.exception(60.0), ConnectionLostError)
    finally:
        is_free.set()
        remote.close()


@pytest.fixture
def deaf() -> Iterator[str]:
    """The address of a peer that accepts nothing: the queue of its connections is full."""
    with ExitStack() as sockets:
        server = sockets.enter_context(socket.socket())
        server.bind(("127.0.0.1", 0))
        server.listen(0)
        address = server.getsockname()
        for _ in range(20):
            caller = sockets.enter_context(socket.socket())
            caller.setblocking(False)
            caller.connect_ex(address)
        yield f"{address[0]}:{address[1]}"


def test_a_terminal_of_a_peer_that_accepts_nothing_does_not_hold_up_the_control_thread(
    served: str, deaf: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    remote = Remote(served, tmp_path)
    answers: list[dict[str, Any]] = []
    try:
        until(lambda: remote.link() == "ok")
        monkeypatch.setattr(terminal, "link_to", lambda _target: link_to(deaf))
        monkeypatch.setattr(links, "CONNECT_S", 60.0)
        remote.control.put(Order(ME, "term.open", {}, remote.control.now_s(), answers.append))
        steps = [remote.call(lambda station: station.snapshot.number) for _ in range(3)]
        until(lambda: remote.call(lambda station: station.snapshot.number) > steps[-1] + 3)
        assert remote.send("term.line", text="?P0")["error"]["text"] == "the terminal is not open"
        assert answers == []
        assert remote.send("term.close")["ok"]
        monkeypatch.setattr(terminal, "link_to", lambda _target: link_to("127.0.0.1:1"))
        refused = remote.send("term.open")
        assert "cannot connect to 127.0.0.1:1: Connection refused" in refused["error"]["text"]
        monkeypatch.setattr(terminal, "link_to", link_to)
        assert remote.send("term.open")["ok"]  # another try is a new connection
        assert remote.send("term.line", text="?P0")["ok"]
    finally:
        remote.close()


def test_a_terminal_that_is_left_while_it_is_opened_is_closed_once_it_is_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    is_free = threading.Event()
    link = TcpLink("127.0.0.1", 1)
    is_closed = threading.Event()
    monkeypatch.setattr(link, "open", lambda: is_free.wait(60.0) and None)
    monkeypatch.setattr(link, "close", is_closed.set)
    monkeypatch.setattr(terminal, "link_to", lambda _target: link)
    installation = Installation.at("127.0.0.1:1", opened(tmp_path / "sysvar.db"), tmp_path)
    beside = terminal.Terminal(installation)
    opening = beside.open(1)
    assert beside.open(2) is opening
    beside.close(1)
    beside.close(2)
    assert not is_closed.is_set()
    is_free.set()
    assert is_closed.wait(60.0)
    assert beside.poll() == ""
    installation.close()


def test_a_terminal_whose_connection_breaks_says_so_and_the_machine_goes_on(
    served: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Proxy(served) as proxy:
        remote = Remote(served, tmp_path)
        try:
            until(lambda: remote.link() == "ok")
            monkeypatch.setattr(terminal, "link_to", lambda _target: link_to(proxy.address))
            assert remote.send("term.open")["ok"]
            proxy.cut()
            until(lambda: printed(remote).endswith(terminal.LOST))
            before = remote.call(lambda station: station.snapshot.tick_ms)
            until(lambda: remote.call(lambda station: station.snapshot.tick_ms) > before)
            assert printed(remote).count(terminal.LOST) == 1
            proxy.mend()
            assert remote.send("term.open")["ok"]
            assert remote.send("term.line", text="?P0")["ok"]
            until(lambda: not printed(remote).endswith(terminal.LOST))
        finally:
            remote.close()


def printed(remote: Remote) -> str:
    return "".join(e["text"] for e in remote.events if e["event"] == "term")
