"""A serial line with a recorder in it: every byte passes, and is in the recording."""

import io
import os
import select
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.io.recording import Event, Recorder, What, read_recording
from openacr.io.serial_port import LineSettings
from openacr.io.serial_tap import SerialTap
from openacr.io.session_replay import SessionReplay

if sys.platform == "win32":
    pytest.skip("pseudo terminals are a POSIX thing", allow_module_level=True)

import pty
import tty


@contextmanager
def line() -> Iterator[tuple[int, str]]:
    """A serial line: our end, and the port at the other one."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    try:
        yield ours, os.ttyname(theirs)
    finally:
        for end in (ours, theirs):
            with suppress(OSError):  # a test has closed it
                os.close(end)


def received(fd: int, count: int) -> bytes:
    """Read this count of bytes, or what has come in 10 s."""
    data, end_s = b"", time.monotonic() + 10.0
    while len(data) < count and time.monotonic() < end_s:
        if select.select([fd], [], [], 0.1)[0]:
            data += os.read(fd, 4096)
    return data


def recorded(path: Path) -> list[tuple[What, bytes]]:
    """What happened, with bytes of one end that follow each other joined."""
    found: list[tuple[What, bytes]] = []
    for event in read_recording(path).events:
        if found and found[-1][0] is event.what:
            found[-1] = event.what, found[-1][1] + event.data
        else:
            found.append((event.what, event.data))
    return found


def test_all_bytes_pass_in_both_directions_and_are_recorded(tmp_path: Path) -> None:
    every = bytes(range(256))  # XON, XOFF and Ctrl-X among them
    with line() as (host, host_port), line() as (card, card_port):
        tap = SerialTap(host_port, card_port, LineSettings())
        with (tmp_path / "s").open("wb", buffering=0) as file:
            tap.start(Recorder(file, card_port, StreamKind.SERIAL))
            os.write(host, every)
            assert received(card, 256) == every
            os.write(card, every[::-1])
            assert received(host, 256) == every[::-1]
            tap.close()
            tap.close()
    assert recorded(tmp_path / "s") == [
        (What.OPEN, b""), (What.HOST, every), (What.CARD, every[::-1]), (What.CLOSE, b""),
    ]  # fmt: skip
    found = read_recording(tmp_path / "s")
    assert (found.kind, found.target) == (StreamKind.SERIAL, card_port)
    assert tap.events == len(found.events)
    assert {event.connection for event in found.events} == {1}


def test_an_end_that_takes_nothing_does_not_keep_the_tap_from_ending() -> None:
    with line() as (host, host_port), line() as (_, card_port):
        tap = SerialTap(host_port, card_port, LineSettings())
        tap.start(Recorder(io.BytesIO(), card_port, StreamKind.SERIAL))
        os.set_blocking(host, False)
        with suppress(BlockingIOError):
            for _ in range(1000):
                os.write(host, b"x" * 1000)  # more than the buffers of both lines
        begin_s = time.monotonic()
        tap.close()
        assert time.monotonic() - begin_s < 30.0  # it would wait without a limit
        assert not tap.has_failed


def test_a_port_that_disappears_ends_the_wait() -> None:
    with line() as (host, host_port), line() as (_, card_port):
        tap = SerialTap(host_port, card_port, LineSettings())
        tap.start(Recorder(io.BytesIO(), card_port, StreamKind.SERIAL))
        threading.Timer(0.1, os.close, [host]).start()
        tap.wait()
        tap.close()
        assert tap.has_failed


def test_a_recording_that_cannot_be_written_ends_and_the_line_goes_on() -> None:
    class Full(io.BytesIO):
        def write(self, data: object) -> int:
            if self.tell() > 100:
                raise OSError(28, "No space left on device")
            return super().write(data)  # type: ignore[arg-type]

    with line() as (host, host_port), line() as (card, card_port):
        tap = SerialTap(host_port, card_port, LineSettings())
        tap.start(Recorder(Full(), card_port, StreamKind.SERIAL))
        os.write(host, b"A\r")
        assert received(card, 2) == b"A\r"
        os.write(card, b"B\r")
        assert received(host, 2) == b"B\r"
        tap.close()
        assert tap.events == 1


def test_the_second_port_that_cannot_be_opened_leaves_the_first_one_free() -> None:
    with line() as (_, card_port):
        with pytest.raises(UserError, match="cannot open serial port /dev/missing"):
            SerialTap("/dev/missing", card_port, LineSettings())
        SerialTap(card_port, card_port, LineSettings()).close()


def test_flow_control_of_a_serial_card_is_no_difference(tmp_path: Path) -> None:
    card = Controller()
    stream = card.open_stream(StreamKind.SERIAL)
    card.receive(stream, b"?6*7\r")
    card.advance(seconds=0.1)
    answer = b"".join(iter(lambda: card.take_output(stream), b""))
    for kind, is_same in ((StreamKind.SERIAL, True), (StreamKind.TERMINAL, False)):
        with (tmp_path / kind.value).open("wb") as file:
            recorder = Recorder(file, "COM1", kind)
            recorder.add(Event(0.0, 1, What.OPEN))
            recorder.add(Event(0.25, 1, What.HOST, b"?6*7\r"))
            recorder.add(Event(0.3, 1, What.CARD, answer[:4] + b"\x13\x11" + answer[4:]))
        difference = SessionReplay(Controller()).run(read_recording(tmp_path / kind.value))
        assert (difference is None) is is_same
