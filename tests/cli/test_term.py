"""`openacr term`: piped lines and a person at a keyboard."""

import os
import select
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tests import warm
from tests.io.fake_card import FakeCard
from tests.io.threaded import served


def test_piped_lines_are_answered_and_the_end_of_input_ends_it() -> None:
    with served(FakeCard()) as at:
        done = warm.run(
            ["term", str(at)], input=b"LEN 12\nSLEEP 50\n", capture_output=True, timeout=60
        )
    assert done.stdout == b"LEN 12\n6\nSYS>SLEEP 50\nok\nSYS>"
    assert (done.returncode, done.stderr) == (0, b"")


def read_until(fd: int, end: bytes) -> bytes:
    seen, deadline = b"", time.monotonic() + 60
    while end not in seen and time.monotonic() < deadline:
        if select.select([fd], [], [], 0.1)[0]:
            seen += os.read(fd, 1000)
    assert end in seen
    return seen


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo terminals of POSIX")
def test_keys_pass_through_arrows_recall_and_ctrl_c_leaves(tmp_path: Path) -> None:
    import pty

    card = FakeCard()
    ours, theirs = pty.openpty()
    with (
        served(card) as at,
        warm.Popen(
            ["term", str(at)],
            stdin=theirs,
            stdout=theirs,
            stderr=subprocess.PIPE,
            env={**os.environ, "XDG_STATE_HOME": str(tmp_path)},
        ) as process,
    ):
        assert process.stderr is not None
        assert b"Ctrl-C leaves" in process.stderr.readline()
        assert read_until(ours, b"SYS>") == b"\r\nok\r\nSYS>"  # without a key pressed
        os.write(ours, b"LEN 12\r")
        assert read_until(ours, b"SYS>") == b"LEN 12\r\n6\r\nSYS>"
        os.write(ours, b"\x18\x1a\x1b[A\r")
        assert read_until(ours, b"SYS>") == b"LEN 12\r\n6\r\nSYS>"
        assert card.controls == ["CTRL_X", "CTRL_Z"]
        os.write(ours, b"\x03")
        assert process.wait(60) == 0
    assert (tmp_path / "openacr" / "term_history").read_bytes() == b"LEN 12\n"
    os.close(ours)
    os.close(theirs)


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo terminals of POSIX")
def test_it_says_when_the_card_ends_the_connection() -> None:
    with served(FakeCard()) as at:
        process = warm.Popen(
            ["term", str(at)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(b"LEN\nSLEEP 1000000\n")
        process.stdin.flush()
        assert process.stdout.readline() == b"LEN\n"
        time.sleep(0.2)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert b"connection ended" in err


def test_a_card_that_is_not_there_is_an_error_of_the_user() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    done = warm.run(
        ["term", f"127.0.0.1:{port}"],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: cannot connect to 127.0.0.1:{port}: ")


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo terminals of POSIX")
def test_a_serial_line_does_as_well(tmp_path: Path) -> None:
    import pty

    card_end, line = pty.openpty()
    ours, theirs = pty.openpty()
    with warm.Popen(
        ["term", os.ttyname(line)],
        stdin=theirs,
        stdout=theirs,
        stderr=subprocess.PIPE,
        env={**os.environ, "XDG_STATE_HOME": str(tmp_path)},
    ) as process:
        assert process.stderr is not None
        assert b"Ctrl-C leaves" in process.stderr.readline()
        assert read_until(card_end, b"\r") == b"\x1b\r"  # asks for the prompt
        os.write(ours, b"VER\r")
        assert read_until(card_end, b"\r") == b"VER\r"
        os.write(card_end, b"VER\r\n1.18\r\nSYS>")
        assert read_until(ours, b"SYS>") == b"VER\r\n1.18\r\nSYS>"
        os.write(ours, b"\x03")
        assert process.wait(60) == 0
    for end in (card_end, line, ours, theirs):
        os.close(end)
