"""`openacr serve --realtime`: what is refused, and what it says at its end."""

import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest
from tests.cli.test_serve_on_bus import MACHINE
from typer.testing import CliRunner

from openacr import compiled
from openacr.cli.main import app
from openacr.io.realtime_rights import RealtimeRights

linux = pytest.mark.skipif(sys.platform != "linux", reason="the loop is for Linux")
SERVE = "from openacr.cli.main import main; main()"
FIGURES = (
    r"real time: period 0\.5 ms: (\d+) cycles, (\d+) missed \(\S+ s not made up\);"
    r" late by \d+ us \(median\), \d+ us \(99\.99 %\), \d+ us \(worst\);"
    r" computing \d+ us \(median\), \d+ us \(99\.99 %\), \d+ us \(worst\)\n"
)


@linux
@pytest.mark.parametrize(
    ("machine", "options", "text"),
    [
        ("", ["--core", "0"], "--core and --silence are for --realtime"),
        ("", ["--silence", "2"], "--core and --silence are for --realtime"),
        ("", ["--realtime", "--speed", "2"], "a card with --realtime runs in real time"),
        ("", ["--realtime", "--core", "99999"], "--core 99999: this process may use the cores"),
        (MACHINE, ["--realtime"], "no-such-if"),
        pytest.param(
            "", ["--realtime", "--silence", "0"], "a silence of 0 s: it has to be above 0",
            marks=pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core"),
        ),
        pytest.param(
            "", ["--realtime"], "a real-time loop needs the compiled core",
            marks=pytest.mark.skipif(compiled.is_compiled, reason="of plain Python"),
        ),
    ],
)  # fmt: skip
def test_what_a_real_time_loop_cannot_do_is_refused_before_anything_listens(
    tmp_path: Path, machine: str, options: list[str], text: str
) -> None:
    (tmp_path / "machine.toml").write_text(machine)
    (tmp_path / "card.8k").write_text("SYS\n")
    result = CliRunner().invoke(app, ["serve", str(tmp_path), *options])
    assert result.exit_code == 2
    assert text in result.output


def test_elsewhere_than_on_linux_it_is_refused_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    result = CliRunner().invoke(app, ["serve", "--realtime"])
    assert result.exit_code == 2
    assert "--realtime needs Linux (and the compiled core)" in result.output


@linux
@pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core")
def test_a_host_is_served_beside_the_loop_and_the_end_says_how_time_was_kept() -> None:
    command = [sys.executable, "-c", SERVE, "serve", "--realtime", "--core", "0"]
    command += ["--ascii-port", "0", "--binary-port", "0"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        found = re.match(r"listening ascii=127.0.0.1:(\d+) ", process.stdout.readline())
        assert found is not None
        with socket.create_connection(("127.0.0.1", int(found[1])), 60) as host:
            host.sendall(b"P0=1\rPRINT 2+3\r")
            heard = b""
            while b"5\r\n" not in heard:
                heard += host.recv(4096)
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0
    figures = re.search(FIGURES, said)
    assert figures is not None, said
    assert int(figures[1]) > 0


@linux
def test_a_right_that_is_refused_is_said_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*arguments: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr("os.sched_setscheduler", refuse)
    monkeypatch.setattr("ctypes.CDLL", lambda *_, **__: Refusing())
    rights = RealtimeRights()
    rights.take()
    rights.give_back()
    priority, memory = rights.missing
    assert priority.startswith("no real-time priority (Operation not permitted)")
    assert memory.startswith("memory is not locked (")


class Refusing:
    """A C library that refuses to lock memory."""

    def prctl(self, *arguments: int) -> int:
        return 0

    def mlockall(self, flags: int) -> int:
        return -1

    def munlockall(self) -> int:
        return 0
