"""`openacr serve` of a machine on a bus, as far as no network is needed: what is refused before."""

import json
import os
import pty
import subprocess
import tty
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from tests import warm
from tests.network.talk import Bench, axis, control
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.serve_on_bus import Served, what_can_happen
from openacr.client import Card
from openacr.plant.describe.load import parse_world

MACHINE = """
[bus]
interface = "no-such-if"

[[axis]]
number = 0
name = "X"
counts_per_rev = 4000
drive = { mode = "exact" }

[axis.bus]
position = 0
mode = "csp"
"""

CAN = """
[card]
model = "ACR9000"

[canopen]
interface = "no-such-thing"
channel = "can7"

[[canopen.node]]
id = 3
digital_inputs = 8
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "machine.toml").write_text(MACHINE)
    return tmp_path


@pytest.mark.parametrize(
    ("machine", "options", "text"),
    [
        (MACHINE, ["--real"], "--real lets drives be enabled and outputs switched: say --yes"),
        (MACHINE, ["--speed", "2"], "a card with a bus runs in real time"),
        (CAN, ["--real"], "outputs switched: say --yes"),
        (CAN, ["--speed", "2"], "a card with a bus runs in real time"),
        (CAN, ["--bus", "eth1"], "no machine.toml with [bus]"),
        (CAN, ["--bus", "none", "--real"], "nothing of machine.toml is on a bus"),
        (CAN, ["--ascii-port", "0"], "CAN can7: "),
        (MACHINE.replace('interface = "no-such-if"', ""), [], "names no interface"),
        (MACHINE.partition("[[axis]]")[2].partition("[axis.bus]")[0], ["--real"], "nothing of"),
        (MACHINE.partition("[[axis]]")[2].partition("[axis.bus]")[0], ["--bus", "e"], "no machine"),
        (MACHINE, ["--bus", "none", "--real"], "nothing of machine.toml is on a bus"),
    ],
)
def test_what_cannot_be_served_is_refused_before_anything_listens(
    tmp_path: Path, machine: str, options: list[str], text: str
) -> None:
    prefix = "" if machine.lstrip().startswith("[") else "[[axis]]"
    (tmp_path / "machine.toml").write_text(prefix + machine)
    result = CliRunner().invoke(app, ["serve", str(tmp_path), *options])
    assert result.exit_code == 2
    assert text in result.output


def test_an_interface_that_does_not_exist_is_named(project: Path) -> None:
    result = CliRunner().invoke(app, ["serve", str(project), "--ascii-port", "0"])
    assert result.exit_code == 2
    assert "no-such-if" in result.output


class Process:
    """A card on an emulated bus in a process of its own."""

    def __init__(self, project: Path, *options: str) -> None:
        words = ["serve", str(project), "--bus", "emulated", "--report-bus", "--no-journal"]
        words += ["--ascii-port", "0", "--binary-port", "0", *options]
        self.process = warm.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
        )

    def line(self, start: str) -> str:
        """The rest of the next line with this start."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            if line.startswith(start):
                return str(line.removeprefix(start))
        raise AssertionError(f"it has ended without a line {start!r}")

    def say(self, text: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(text)
        self.process.stdin.flush()

    def report_where(self, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        while True:
            report: dict[str, Any] = json.loads(self.line("bus "))
            if holds(report):
                return report


@pytest.fixture
def served(project: Path) -> Iterator[Process]:
    one = Process(project, "--real")
    try:
        yield one
    finally:
        with suppress(ProcessLookupError):
            one.process.kill()
        one.process.wait(timeout=60)
        for pipe in (one.process.stdin, one.process.stdout):
            if pipe is not None:
                pipe.close()


def test_an_emulated_bus_needs_no_interface_and_no_question_and_is_reported(
    served: Process,
) -> None:
    address = served.line("listening ascii=").split()[0]
    report = served.report_where(lambda one: one["counters"]["sent"] > 100)
    assert (report["interface"], report["is_real"], report["alarm"]) == ("emulated", True, "")
    assert [one["state"] for one in report["devices"]] == ["OP"]
    with Card.open(address) as card:
        card.command("ATTACH AXIS0 ENC0 DAC0 ENC0", program=0)
        card.command("AXIS0 DRIVE ON", program=0)
        report = served.report_where(lambda one: one["drives"][0]["is_enabled"])
    assert (report["drives"][0]["state"], report["drives"][0]["mode"]) == ("OPERATING", 8)
    before = report["counters"]["sent"]
    served.say("reset\n")
    served.report_where(lambda one: one["counters"]["sent"] < before)


def test_a_card_ends_with_the_process_that_reads_its_reports(served: Process) -> None:
    served.line("bus ")
    assert served.process.stdin is not None
    served.process.stdin.close()
    assert served.process.wait(timeout=60) == 0


def test_what_is_real_can_be_on_several_buses_and_all_of_it_is_named_before_consent() -> None:
    drive = '[[drive]]\naxis = 1\ntype = "aries"\nserial = "/dev/ttyUSB0"\n'
    sentences = list(what_can_happen(parse_world(CAN + MACHINE + axis(1) + drive), "eth1"))
    assert sentences == [
        "Drives on eth1 can be enabled and axes X can move.",
        "CANopen nodes on can7 can switch their outputs.",
        "The drive of axis 1 on /dev/ttyUSB0 can be set and commanded.",
    ]


@pytest.mark.parametrize(("is_real", "state"), [(True, "all commands are sent"), (False, "read")])
def test_served_drives_are_talked_to_until_the_end(
    is_real: bool, state: str, tmp_path: Path, caplog: pytest.LogCaptureFixture,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    path = tmp_path / "drive"
    text = axis(0) + f'[[drive]]\naxis = 0\ntype = "aries"\nserial = "{path}"\n'
    bench = Bench(axes=1)
    served = Served(bench.card, parse_world(text), "", is_real=is_real, is_reported=False)
    served.begin()
    assert f"Drive Talk {path}: {state}" in capsys.readouterr().err
    bench.open(0)
    far, theirs = pty.openpty()
    tty.setraw(theirs)
    path.symlink_to(os.ttyname(theirs))
    os.set_blocking(far, False)
    bench.card.bit[control(0, 2)] = True  # send the configuration
    bench.card.advance(seconds=0.1)
    served.close()
    os.close(theirs)
    try:
        heard = os.read(far, 100)
    except OSError:
        heard = b""
    os.close(far)
    assert heard == (b"1_DMODE0\r" if is_real else b"")
    assert ("was not sent" in caplog.text) is not is_real
