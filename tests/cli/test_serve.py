"""`openacr serve` as a process: one line when ready, a clean end on a signal."""

import os
import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = """
import asyncio, signal
signal.signal(signal.SIGHUP, signal.{hangup})
from openacr.cli.serve import Ports, serve_card
from tests.io.fake_card import FakeCard
asyncio.run(serve_card(FakeCard(), Ports({host!r}, serial={serial!r})))
"""


def start(
    host: str = "127.0.0.1", hangup: str = "SIG_DFL", serial: str | None = None
) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM.format(host=host, hangup=hangup, serial=serial)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT", "SIGHUP"])
def test_it_announces_its_ports_and_ends_cleanly_on_a_signal(name: str) -> None:
    with start() as process:
        assert process.stdout is not None
        line = process.stdout.readline()
        found = re.fullmatch(r"listening ascii=127.0.0.1:(\d+) binary=127.0.0.1:(\d+)\n", line)
        assert found is not None, line
        for port in found.groups():
            with socket.create_connection(("127.0.0.1", int(port)), 60) as connection:
                connection.sendall(bytes.fromhex("00 30 02 01"))
                assert connection.recv(8)[:4] == bytes.fromhex("00 30 02 01")
        process.send_signal(getattr(signal, name))
        out, err = process.communicate(timeout=60)
        assert (process.returncode, out, err) == (0, "", "")


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_with_nohup_it_outlives_its_terminal() -> None:
    with start(hangup="SIG_IGN") as process:
        assert process.stdout is not None
        port = re.search(r"binary=127.0.0.1:(\d+)", process.stdout.readline())
        assert port is not None
        process.send_signal(signal.SIGHUP)
        with socket.create_connection(("127.0.0.1", int(port[1])), 60) as connection:
            connection.sendall(bytes.fromhex("00 30 02 01"))
            assert connection.recv(8)[:4] == bytes.fromhex("00 30 02 01")
        process.terminate()
        process.communicate(timeout=60)
        assert process.returncode == 0


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_it_names_the_serial_port_it_serves() -> None:
    ours, theirs = os.openpty()
    try:
        with start(serial=os.ttyname(theirs)) as process:
            assert process.stdout is not None
            line = process.stdout.readline()
            assert line.endswith(f" serial={os.ttyname(theirs)}\n")
            process.terminate()
            process.communicate(timeout=60)
    finally:
        os.close(ours)
        os.close(theirs)


def test_it_warns_when_other_machines_can_reach_it() -> None:
    with start("0.0.0.0") as process:
        assert process.stdout is not None
        assert "ascii=0.0.0.0:" in process.stdout.readline()
        process.terminate()
        _, err = process.communicate(timeout=60)
        assert "WARNING" in err
        assert "trusted network" in err
