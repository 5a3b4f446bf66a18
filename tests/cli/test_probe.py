"""`openacr probe`: what a card is, and what works with it; nothing changes on the card."""

import json
import socket
import threading
from collections.abc import Iterator

import pytest
from tests.client.cards import WrappedLink
from typer.testing import CliRunner

from openacr.cli.live import probe as command
from openacr.cli.live.probe import judged
from openacr.cli.main import app
from openacr.client import identity
from openacr.client.card import Card
from openacr.client.identity import Identity, identify
from openacr.client.options import Options
from openacr.controller import Controller
from openacr.models import MODELS


def card(version: str = "ACR9000 Version 1.18.06 Update 15", **other: object) -> Identity:
    found = identity.VERSION.match(version)
    values: dict[str, object] = {
        "address": "card:5002", "version": version, "model": found["model"] if found else "",
        "firmware": tuple(map(int, found["firmware"].split("."))) if found else (1, 18, 6),
        "update": 15, "serial_number": 90000000, "diagnostics": 0, "has_packets": True,
    }  # fmt: skip
    return Identity(**{**values, **other})  # type: ignore[arg-type]


def verdicts(found: Identity) -> dict[str, bool | None]:
    return {verdict.what.split(" (")[0]: verdict.works for verdict in judged(found)}


def test_a_virtual_card_is_identified_by_its_answers() -> None:
    found = identify(Controller("ACR8020"))
    assert (found.model, found.firmware, found.update) == ("ACR8020", (1, 18, 6), 15)
    assert found.serial_number == 80200000
    assert found.has_packets and found.diagnostics == 0
    assert found.hardware is MODELS["ACR8020"]
    assert found.options["PERIOD"] == ["0.0005"]
    assert found.options["CONFIG"][0].startswith("CONFIG ")


def test_only_queries_are_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    virtual = Controller()
    sent: list[bytes] = []

    class Watched(WrappedLink):
        def write(self, data: bytes) -> None:
            sent.append(data)
            super().write(data)

    def opened(target: Controller, options: Options, *, baud: int) -> Card:
        found = Card(Watched(target), options)
        found.connect()
        return found

    monkeypatch.setattr(Card, "open", opened)
    identify(virtual)
    lines = {line for data in sent for line in data.split(b"\r") if line.strip(b"\x1b\x00")}
    queries = {b"VER", b"CONFIG", b"MEM", b"PERIOD", b"ATTACH"}
    parameters = {b"?P7040", b"?P7042", b"?P7043", b"?P7044"}
    others = lines - queries - parameters
    assert lines >= queries
    # The client sets the echo and the level of its own stream, and marks the end of an answer.
    of_client = (b"SYS", b"ECHO 1", b'PRINT "=')
    assert all(line.startswith((*of_client, b"\x00\x88")) for line in others), others


def test_what_works_follows_from_model_and_firmware() -> None:
    assert verdicts(card()) == {
        "term, download, upload, backup, restore": True,
        "monitor and the client at full rate": True,
        "part programs on the card": True,
        "limits watched by the card": False,
        "NURBs": True, "look-ahead": True, "CANopen nodes": True,
        "memory kept by a battery": False, "the same card, virtual": True,
    }  # fmt: skip
    assert verdicts(card("ACR9000 Version 1.18.15"))["limits watched by the card"] is True
    assert verdicts(card("ACR9000 Version 1.18.14"))["limits watched by the card"] is False
    assert verdicts(card("ACR1500 Version 1.17.99"))["part programs on the card"] is False
    assert verdicts(card("ACR1500 Version 1.18.00"))["part programs on the card"] is True
    assert verdicts(card(has_packets=False))["part programs on the card"] is False
    assert verdicts(card("ACR1500 Version 1.18.00"))["NURBs"] is False
    assert verdicts(card("ACR8020 Version 1.18.06"))["memory kept by a battery"] is True
    assert verdicts(card("ACR8020 Version 1.18.06"))["CANopen nodes"] is False


def test_a_model_that_is_not_in_the_table_leaves_its_features_unknown() -> None:
    found = verdicts(card("ACR9600 Version 2.01"))
    assert found["NURBs"] is None and found["the same card, virtual"] is False
    assert found["part programs on the card"] is True


@pytest.fixture
def served() -> Iterator[Controller]:
    yield Controller()


def test_the_command_prints_one_page_or_one_object(
    served: Controller, monkeypatch: pytest.MonkeyPatch
) -> None:
    def at_hand(target: str, options: Options, *, baud: int) -> Identity:
        assert (target, options.timeout_s, baud) == ("card", 2.0, 38400)
        return card(options={"CONFIG": [], "MEM": ["1 free", "2"]}, diagnostics=5)

    monkeypatch.setattr(identity, "identify", at_hand)
    result = CliRunner().invoke(app, ["probe", "card", "--timeout", "2"])
    assert result.stdout.splitlines()[:9] == [
        "card          ACR9000 Version 1.18.06 Update 15",
        "address       card:5002",
        "serial        90000000",
        "diagnostics   0x5",
        "model         8 axes, 8 masters",
        "CONFIG        -",
        "MEM           1 free",
        "              2",
        "",
    ]
    assert "no       limits watched by the card (configure)" in result.stdout
    found = json.loads(
        CliRunner().invoke(app, ["probe", "card", "--timeout", "2", "--json"]).stdout
    )
    assert (found["model"], found["firmware"], found["axes"]) == ("ACR9000", "1.18.06", 8)
    assert found["is_known"] is True
    assert found["works"][0] == {
        "what": "term, download, upload, backup, restore", "works": True,
        "why": "they need the terminal alone",
    }  # fmt: skip
    assert command.judged is judged


def test_a_port_without_a_card_is_an_error_in_words() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    result = CliRunner().invoke(app, ["probe", f"127.0.0.1:{port}"])
    assert result.exit_code == 2
    assert result.stderr.startswith(f"error: cannot connect to 127.0.0.1:{port}: ")


@pytest.mark.parametrize("answer", [b"", b"SSH-2.0-OpenSSH_9\r\n"])
def test_a_peer_that_is_no_card_is_an_error_in_words(answer: bytes) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        stop = threading.Event()

        def serve() -> None:
            listener.settimeout(0.1)
            while not stop.is_set():
                try:
                    link, _ = listener.accept()
                except TimeoutError:
                    continue
                link.sendall(answer)
                stop.wait(5)
                link.close()

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            target = f"127.0.0.1:{listener.getsockname()[1]}"
            result = CliRunner().invoke(app, ["probe", target, "--timeout", "0.3", "--json"])
        finally:
            stop.set()
            thread.join()
    assert result.exit_code == 2
    assert json.loads(result.stdout)["error"].startswith(f"{target}: ")
    assert "Traceback" not in result.output
