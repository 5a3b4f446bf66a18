"""`openacr panel` as a process: it starts, serves, and ends with the machine at rest."""

import re
import signal
import socket
from contextlib import ExitStack
from http.client import HTTPConnection
from pathlib import Path

import httpx
import pytest
from tests.io.served import serving
from tests.mill.live import Process
from tests.waiting import LIMIT_S, until
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.client import Card

JSON = {"Content-Type": "application/json"}


def asked(url: str, body: str | None = None) -> HTTPConnection:
    """A call that is on its way; its answer is not waited for."""
    at = httpx.URL(url)
    connection = HTTPConnection(at.host, at.port, timeout=LIMIT_S)
    connection.request("POST" if body else "GET", at.path, body, JSON if body else {})
    return connection


def test_the_panel_starts_without_configuration_and_ends_cleanly_while_it_computes_a_path(
    tmp_path: Path,
) -> None:
    words = ("panel", "--no-browser", "--port", "0", "--store", str(tmp_path / "sysvar.db"))
    process = Process(*words, store=tmp_path / "other.db")
    try:
        until(lambda: "panel http" in process.text, about="the panel listens")
        found = re.search(r"panel (http://127\.0\.0\.1:\d+/)", process.text)
        assert found is not None
        assert process.text.startswith("starting the panel ...\n")
        assert httpx.get(f"{found[1]}api/me", timeout=LIMIT_S).json()["role"] == "service"
        names = httpx.get(f"{found[1]}api/programs", timeout=LIMIT_S).json()["entries"]
        assert "plate.nc" in [entry["name"] for entry in names]
        parts = f"{found[1]}api/parts"
        name = httpx.get(parts, timeout=LIMIT_S).json()["parts"][0]["name"]
        waiting = asked(f"{parts}/{name}/path", '{"values": {}}')
        assert httpx.get(parts, timeout=LIMIT_S).status_code == 200  # the other one has arrived
        process.signal(signal.SIGTERM)
        assert process.ended() == 0
        assert waiting.getresponse().status in (422, 200)  # 200: it was quicker than the signal
        assert "Traceback" not in process.text
    finally:
        process.close()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("--address", "0.0.0.0"), "no password is set"),
        (("--port", "70000"), "port 70000 is not in 0..65535"),
        (("a:b:c",), "'a:b:c' is neither HOST, HOST:PORT nor a serial port"),
        (("card:70000",), "card:70000: port 70000 is not in 0..65535"),
        (("jobs/mill",), "jobs/mill: there is no such folder, nor such a serial port"),
        (("nofolder",), "nofolder: there is no such folder, and no host has this name"),
        ((__file__,), "test_command_line.py is a file: a project is a folder"),
        (("--set-password", "boss"), "'boss' is not one of view, operate, setup, service"),
    ],
)
def test_a_wrong_start_is_said_in_one_line(
    tmp_path: Path, words: tuple[str, ...], text: str
) -> None:
    store = ("--no-browser", "--port", "0", "--store", str(tmp_path / "sysvar.db"))
    result = CliRunner().invoke(app, ["panel", *store, *words])
    assert result.exit_code == 2
    (said,) = result.stderr.removeprefix("starting the panel ...\n").splitlines()
    assert said.startswith("error: ") and text in said


def test_the_virtual_mill_makes_the_folder_of_its_programs(tmp_path: Path) -> None:
    store, folder = ("--store", str(tmp_path / "sysvar.db")), tmp_path / "parts"
    words = ("panel", "--no-browser", "--port", "70000", *store, "--programs", str(folder))
    assert "port 70000" in CliRunner().invoke(app, words).stderr
    assert (folder / "plate.nc").is_file()
    refused = CliRunner().invoke(app, (*words[:-1], str(tmp_path / "none"), "card"))
    assert refused.stderr == f"error: --programs {tmp_path / 'none'}: there is no such folder\n"


def test_a_serial_port_that_is_not_plugged_in_yet_is_waited_for(tmp_path: Path) -> None:
    words = ("panel", "/dev/openacr-none", "--no-browser", "--port", "0")
    process = Process(*words, "--store", str(tmp_path / "sysvar.db"), store=tmp_path / "other.db")
    try:
        found = "/dev/openacr-none: NO CARD FOUND"
        until(lambda: found in process.text, about="the port is looked for")
        until(lambda: "panel http" in process.text, about="the panel listens")
    finally:
        process.close()


def test_a_card_that_cannot_be_reached_is_said_in_the_terminal(tmp_path: Path) -> None:
    words = ("panel", "127.0.0.1:1", "--no-browser", "--port", "0")
    process = Process(
        *words, "--store", str(tmp_path / "sysvar.db"), "--programs", str(tmp_path),
        store=tmp_path / "other.db",
    )  # fmt: skip
    try:
        until(lambda: "tried again" in process.text, about="the reason is printed")
        assert "127.0.0.1:1: NO CARD FOUND (" in process.text
        assert process.text.count("NO CARD FOUND") == 1  # once, however often it is tried
        process.signal(signal.SIGTERM)
        assert process.ended() == 0
    finally:
        process.close()


def test_a_card_is_set_up_at_the_start_where_that_is_asked_for(tmp_path: Path) -> None:
    with serving() as served, Card.open(f"127.0.0.1:{served.ascii_port}") as card:
        card.command("DIM P(100)")
        words = ("panel", card.name, "--set-up", "--no-browser", "--port", "0")
        store = ("--store", str(tmp_path / "sysvar.db"), "--programs", str(tmp_path))
        process = Process(*words, *store, store=tmp_path / "other.db")
        try:
            attached = 'ATTACH SLAVE0 AXIS0 "X"'
            until(lambda: attached in card.command("ATTACH", program=0), about="it is set up")
            process.signal(signal.SIGTERM)
            assert process.ended() == 0
        finally:
            process.close()


def test_the_panel_ends_in_one_line_while_it_opens_a_card_that_does_not_answer(
    tmp_path: Path,
) -> None:
    with ExitStack() as sockets:
        server = sockets.enter_context(socket.socket())
        server.bind(("127.0.0.1", 0))
        server.listen(0)  # and the queue of its connections is full
        address, port = server.getsockname()
        for _ in range(20):
            caller = sockets.enter_context(socket.socket())
            caller.setblocking(False)
            caller.connect_ex((address, port))
        words = ("--no-browser", "--port", "0", "--store", str(tmp_path / "sysvar.db"))
        process = Process("panel", f"{address}:{port}", *words, store=tmp_path / "other.db")
        try:
            until(lambda: "panel http" in process.text, about="the panel listens")
            found = re.search(r"panel (http://127\.0\.0\.1:\d+/)", process.text)
            assert found is not None
            calls = [asked(f"{found[1]}api/{path}") for path in ("pparm", "card/programs")]
            assert httpx.get(f"{found[1]}api/me", timeout=LIMIT_S).status_code == 200
            process.signal(signal.SIGTERM)
            assert process.ended() == 0
            assert {call.getresponse().status for call in calls} <= {422, 503}
            assert "Traceback" not in process.text
            assert "Exception" not in process.text
        finally:
            process.close()
