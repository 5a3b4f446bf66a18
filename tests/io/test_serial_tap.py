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
from tests.io.sessions import event, written

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.io.recorded_session import SessionRecorder, read_recording
from openacr.io.serial_port import LineSettings
from openacr.io.serial_tap import SerialTap
from openacr.io.session_replay import SessionReplay
from openacr.journal.entries import Entered

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


def recorded(path: Path) -> list[tuple[Entered, bytes]]:
    """What happened, with bytes of one end that follow each other joined."""
    found: list[tuple[Entered, bytes]] = []
    for entry in read_recording(path).entries:
        if found and found[-1][0] is entry.what:
            found[-1] = entry.what, found[-1][1] + entry.data
        else:
            found.append((entry.what, entry.data))
    return found


def test_all_bytes_pass_in_both_directions_and_are_recorded(tmp_path: Path) -> None:
    every = bytes(range(256))  # XON, XOFF and Ctrl-X among them
    with line() as (host, host_port), line() as (card, card_port):
        tap = SerialTap(host_port, card_port, LineSettings())
        with (tmp_path / "s").open("wb", buffering=0) as file:
            recorder = SessionRecorder(file, card_port, StreamKind.SERIAL)
            tap.start(recorder)
            os.write(host, every)
            assert received(card, 256) == every
            os.write(card, every[::-1])
            assert received(host, 256) == every[::-1]
            tap.close()
            tap.close()
    assert recorded(tmp_path / "s") == [
        (Entered.OPEN, b"serial"),
        (Entered.BYTES, every),
        (Entered.SENT, every[::-1]),
        (Entered.CLOSE, b""),
    ]
    found = read_recording(tmp_path / "s")
    assert (found.entries[0].data, found.header.card) == (b"serial", card_port)
    assert recorder.events == len(found.entries)
    assert {entry.number for entry in found.entries} == {1}


def test_an_end_that_takes_nothing_does_not_keep_the_tap_from_ending() -> None:
    with line() as (host, host_port), line() as (_, card_port):
        tap = SerialTap(host_port, card_port, LineSettings())
        tap.start(SessionRecorder(io.BytesIO(), card_port, StreamKind.SERIAL))
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
        tap.start(SessionRecorder(io.BytesIO(), card_port, StreamKind.SERIAL))
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
        recorder = SessionRecorder(Full(), card_port, StreamKind.SERIAL)
        tap.start(recorder)
        os.write(host, b"A\r")
        assert received(card, 2) == b"A\r"
        os.write(card, b"B\r")
        assert received(host, 2) == b"B\r"
        tap.close()
        assert recorder.events == 1


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
        path = written(
            tmp_path / kind.value,
            event(0.0, 1, Entered.OPEN, kind=kind),
            event(0.25, 1, Entered.BYTES, b"?6*7\r"),
            event(0.3, 1, Entered.SENT, answer[:4] + b"\x13\x11" + answer[4:]),
        )
        difference = SessionReplay(Controller()).run(read_recording(path))
        assert (difference is None) is is_same
