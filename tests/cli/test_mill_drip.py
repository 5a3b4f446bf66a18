"""`openacr mill drip` and `receive`, and the console of `mill run`."""

import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest
import serial
from tests.cli.keys import arrived
from tests.mill.shop import Shop
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.mill.console import COMMANDS, Console, command
from openacr.mill.config.overrides import Override
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession

PROGRAM = b"G90 F6000\nG1 X1\nY1\nX0\nM2\n"


@pytest.fixture
def line() -> Iterator[tuple[int, str]]:
    """A sender's end, and the port at the other."""
    master, slave = os.openpty()
    yield master, os.ttyname(slave)
    for end in (master, slave):
        os.close(end)


@pytest.fixture
def is_open(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Set when a port has been opened, which ends with forgetting what has arrived."""
    opened, event = serial.Serial.open, threading.Event()

    def open_port(port: serial.Serial) -> None:
        opened(port)
        event.set()

    monkeypatch.setattr(serial.Serial, "open", open_port)
    return event


def sending(master: int, data: bytes, is_open: threading.Event) -> None:
    """Send in pieces, when the far end has opened its port."""

    def work() -> None:
        is_open.wait()
        for n in range(0, len(data), 9):
            os.write(master, data[n : n + 9])
            time.sleep(0.01)

    threading.Thread(target=work, daemon=True).start()


def run(*words: str, typed: str = "") -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *words], input=typed)
    return result.exit_code, result.output


def test_a_program_is_run_from_a_serial_line(
    line: tuple[int, str], is_open: threading.Event
) -> None:
    master, port = line
    sending(master, PROGRAM, is_open)
    assert run("drip", "--port", port) == (0, "3 moves\n")


def test_an_error_in_what_arrives_names_its_line(
    line: tuple[int, str], is_open: threading.Event
) -> None:
    master, port = line
    sending(master, b"G90 F6000\nG1 X1\nG1 X\nM2\n", is_open)
    code, said = run("drip", "--port", port)
    assert code == 1
    assert "DRIP:3:" in said


def test_a_part_file_is_received_once(
    line: tuple[int, str], is_open: threading.Event, tmp_path: Path
) -> None:
    master, port = line
    target = tmp_path / "PART.TXT"
    sending(master, PROGRAM + b"\x1a", is_open)
    assert run("receive", str(target), "--port", port)[0] == 0
    assert target.read_bytes() == PROGRAM
    code, said = run("receive", str(target), "--port", port)
    assert code != 0
    assert "--force" in said


def test_without_a_port_there_is_an_error_and_no_waiting() -> None:
    for words in (("drip",), ("receive", "PART.TXT"), ("drip", "--port", "/dev/none")):
        code, said = run(*words)
        assert code != 0
        assert "serial port" in said


def test_the_console_says_what_it_does_not_know_and_ends_when_it_is_left(tmp_path: Path) -> None:
    file = tmp_path / "PART.TXT"
    file.write_text("G90 F600\nG1 X.2\nM0\nX.3\nM2\n")
    code, said = run("run", str(file), "--console", typed="fly\nstart 3\nback\nfov 15\n")
    assert "fly: unknown command" in said
    assert "start 3: unknown command" in said
    assert "back: cannot trace the path: the state is" in said
    assert "M0: no operator at the console to continue" in said
    assert code != 0


def test_the_help_of_a_run_lists_every_command_of_its_console() -> None:
    code, said = run("run", "--help")
    assert code == 0
    text = " ".join(said.split())
    for name, row in COMMANDS.items():
        assert f"{name} {row.value}".strip() + f" ({row.meaning})" in text
    assert {"stop", "resume", "start", "abort", "acknowledge", "fov"} <= set(COMMANDS)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("fov", "fov: unknown command; commands are stop, resume, start, abort, acknowledge,"
         " confirm, block, back, forward, halt, answer VALUE, fov CLICK, rov CLICK, sov CLICK"),
        ("fov 1 2", "fov 1 2: unknown command"),
        ("abort now", "abort now: unknown command"),
        ("fov x", "fov x: a click of the switch is a whole number from 0"),
        ("answer x", "answer x: x: enter a number"),
        ("answer 1", "answer 1: nothing is asked"),
    ],
)  # fmt: skip
def test_a_line_that_is_no_command_says_what_there_is(tmp_path: Path, line: str, said: str) -> None:
    file = tmp_path / "PART.TXT"
    file.write_text("G90 F600\nG1 X.2\nM0\nX.3\nM2\n")
    assert said in " ".join(run("run", str(file), "--console", typed=f"{line}\n")[1].split())


def test_the_overrides_are_chosen_by_their_names() -> None:
    shop = Shop()
    for name, override in (
        ("fov", Override.FEED),
        ("rov", Override.RAPID),
        ("sov", Override.SPINDLE),
    ):
        before = [shop.runner.overrides.factor(each) for each in Override]
        command([name, "3"])(shop.runner)
        changed = [
            each
            for each, factor in zip(Override, before, strict=True)
            if shop.runner.overrides.factor(each) != factor
        ]
        assert changed == [override]


@pytest.mark.req("MILL-BEY-RETRACE", "MILL-BEY-RETRACE-RESUME")
def test_the_console_traces_back_and_forward_and_resumes() -> None:
    shop = Shop(P650_006=300.0)
    shop.load("G90 F600\nG1 X4\nY4\nM2\n")
    reading, writing = os.pipe()
    with os.fdopen(reading) as source, os.fdopen(writing, "w", buffering=1) as keys:
        console = Console(source)
        place = cast(MillSession, SimpleNamespace(runner=shop.runner, is_virtual=False))

        def after(line: str, seconds: float) -> tuple[float, float, float]:
            keys.write(line + "\n")
            arrived(console._lines)
            for _ in range(round(seconds / 0.05)):
                console.attend(place)
                shop.pass_time(0.05)
            return shop.place()

        shop.pass_time(0.6)
        held = after("stop", 0.6)
        assert held[1] > 1.0
        assert after("back", 3.0) == (0.0, 0.0, 0.0)
        assert after("forward", 3.0) == pytest.approx(held, abs=1e-4)
        after("back", 0.2)
        halted = after("halt", 0.5)
        assert 0.0 < halted[1] < held[1]
        after("resume", 3.0)
    assert shop.runner.state is State.IDLE
    assert shop.pulses() == (40_000, 40_000, 0)
