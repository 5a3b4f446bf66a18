"""`openacr serve --realtime`: what is refused, and what it says at its end."""

import asyncio
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.cli.test_serve_on_bus import CAN, MACHINE
from tests.fieldbus.test_drives_on_a_card import machine
from tests.fieldbus.test_realtime_bus import PATIENCE_S, PATIENT, segment_beside
from tests.network.talk import axis
from typer.testing import CliRunner

from openacr import compiled
from openacr.cli.main import app
from openacr.cli.serve_realtime import (
    RealtimeOptions,
    ServedInRealTime,
    in_real_time,
    missing_for_real_time,
)
from openacr.controller import Controller
from openacr.io.realtime_rights import RealtimeRights
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.real_world import real_world

linux = pytest.mark.skipif(sys.platform != "linux", reason="the loop is for Linux")
SERIAL = axis(0) + '[[drive]]\naxis = 0\ntype = "aries"\nserial = "/dev/no-such"\n'
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
        (MACHINE, ["--realtime", "--report-bus"], "no-such-if"),
        (MACHINE, ["--realtime", "--bus", "emulated"], "live in the time of the card; leave the"),
        (CAN, ["--realtime"], "--realtime: real CANopen nodes are worked on by Python"),
        (SERIAL, ["--realtime"], "--realtime: drives on serial ports are worked on by Python"),
        ("", ["--realtime", "--report-bus"], "--report-bus: the bus of the project is not opened"),
        (CAN, ["--report-bus"], "--report-bus: the bus of the project is not opened"),
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


def test_what_bars_real_time_on_this_computer_is_a_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = parse_world(MACHINE)
    monkeypatch.setattr(compiled, "is_compiled", True)
    monkeypatch.setattr(sys, "platform", "linux")
    assert missing_for_real_time(world, None) == missing_for_real_time(world, "eth1") == ""
    assert "live in the time of the card" in missing_for_real_time(world, "emulated")
    fast, slow = (f"[card]\nperiod_s = {period}\n{MACHINE}" for period in (0.00019, 0.0002))
    assert missing_for_real_time(parse_world(slow), None) == ""
    assert "200 us and more" in missing_for_real_time(parse_world(fast), None)
    monkeypatch.setattr(compiled, "is_compiled", False)
    assert "Linux and the compiled core" in missing_for_real_time(world, None)
    monkeypatch.setattr(compiled, "is_compiled", True)
    monkeypatch.setattr(sys, "platform", "darwin")
    assert "Linux and the compiled core" in missing_for_real_time(world, None)


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
@pytest.mark.skipif(not compiled.is_compiled, reason="needs the compiled core")
def test_a_bus_in_real_time_is_reported_as_lines_and_reset_by_a_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = machine(more=PATIENT)
    world = parse_world(text)
    ours, typed = os.pipe()
    with segment_beside(text) as (link, _), open(ours) as heard, open(typed, "w") as typing:
        monkeypatch.setattr("openacr.io.ethercat_link.RawLink", lambda _interface: link)
        monkeypatch.setattr(sys, "stdin", heard)
        card = Controller(world.card.board, world=real_world(world))
        card.send("PERIOD 0.002\r")
        options = RealtimeOptions(None, PATIENCE_S, world, "pair", is_real=True, is_reported=True)

        async def live(served: ServedInRealTime) -> None:
            served.begin()

            async def report_where(holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
                limit_s = time.monotonic() + PATIENCE_S
                while time.monotonic() < limit_s:
                    served.card.advance()
                    await asyncio.sleep(0.001)
                    for line in capsys.readouterr().out.splitlines():
                        report = json.loads(line.removeprefix("bus "))
                        if holds(report):
                            return dict(report)
                raise AssertionError("no such report")

            report = await report_where(lambda one: one["counters"]["sent"] > 100)
            assert report["loop"]["cycles"] > 90
            typing.write("reset\n")
            typing.flush()
            await report_where(lambda one: one["counters"]["sent"] < report["counters"]["sent"])

        with in_real_time(card, options) as served:
            asyncio.run(live(served))
        card.close()


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
