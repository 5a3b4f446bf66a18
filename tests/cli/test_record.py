"""`openacr record` and the replay of what it wrote, as commands."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from tests import warm
from tests.io.sessions import event, written
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.io.recorded_session import read_recording
from openacr.journal.entries import Entered

ROOT = Path(__file__).parents[2]


def openacr(*words: object) -> Result:
    return CliRunner().invoke(app, list(map(str, words)))


@contextmanager
def running(*words: object) -> Iterator[str]:
    """A server in a process of its own; yields the line it prints when it listens."""
    with warm.Popen([*map(str, words)], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield process.stdout.readline()
        finally:
            process.terminate()
            assert process.wait(60) == 0


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_session_is_recorded_and_replayed(tmp_path: Path) -> None:
    file = tmp_path / "session.jsonl"
    ports = ("--ascii-port", 0, "--binary-port", 0, "--no-journal")
    with running("serve", ROOT / "examples" / "square", *ports) as line:
        card = line.split("ascii=")[1].split()[0]
        with running("record", card, file, "--port", 0) as listening:
            assert listening.endswith(f" card={card}\n")
            place = listening.split()[1]
            ask(place)
    assert file.stat().st_mode & 0o777 == 0o600
    same = openacr("replay", file, "--project", ROOT / "examples" / "square")
    assert same.exit_code == 0, same.output
    assert same.stdout.endswith(": every answer is the same\n")


OLD = "an older session\n"
SAID: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}


@contextmanager
def square() -> Iterator[str]:
    """A card in a process of its own; where it is."""
    ports = ("--ascii-port", 0, "--binary-port", 0, "--no-journal")
    with running("serve", ROOT / "examples" / "square", *ports) as line:
        yield line.split("ascii=")[1].split()[0]


def ask(place: str) -> None:
    typed = warm.run(
        ["term", place], input="PROG0\n?6*7\n", text=True, check=True, capture_output=True
    )
    assert "42" in typed.stdout


def left(folder: Path) -> list[str]:
    return sorted(each.name for each in folder.iterdir())


def refused(file: Path, most_bytes: int, *options: str) -> str:
    """What a recording says whose file takes no more than some bytes."""
    with square() as card:
        words = ["record", card, str(file), "--port", "0", *options]
        with warm.Popen(words, most_bytes=most_bytes, **SAID) as process:
            assert process.stdout is not None
            if most_bytes:
                ask(process.stdout.readline().split()[1])
                process.terminate()
            _, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert said.splitlines()[-1] == f"error: {file}: cannot be written: file too large"
    return str(said)


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
@pytest.mark.parametrize("most_bytes", [0, 200])
def test_a_recording_that_is_not_whole_is_an_error(tmp_path: Path, most_bytes: int) -> None:
    file = tmp_path / "session.jsonl"
    said = refused(file, most_bytes)
    assert left(tmp_path) == ([file.name] if most_bytes else [])
    if most_bytes:
        assert "the recording ends here: file too large; connections go on" in said
        recording = read_recording(file)
        assert recording.is_whole
        assert f"{file}: {len(recording.entries)} events" in said.splitlines()


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
@pytest.mark.parametrize("most_bytes", [0, 100, 135])
def test_an_older_recording_is_kept_where_the_disk_takes_no_new_one(
    tmp_path: Path, most_bytes: int
) -> None:
    file = tmp_path / "session.jsonl"
    file.write_text(OLD)
    refused(file, most_bytes, "--force")
    assert (left(tmp_path), file.read_text()) == ([file.name], OLD)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_an_older_recording_is_replaced_with_the_first_bytes_of_the_new_one(tmp_path: Path) -> None:
    old, file = tmp_path / "old.jsonl", tmp_path / "session.jsonl"
    old.write_text(OLD)
    old.chmod(0o644)
    file.symlink_to(old)
    with square() as card:
        with running("record", card, file, "--port", 0, "--force"):
            assert old.read_text() == OLD
        assert (left(tmp_path), old.read_text()) == (["old.jsonl", "session.jsonl"], OLD)
        with running("record", card, file, "--port", 0, "--force") as listening:
            ask(listening.split()[1])
            assert len(read_recording(old).entries) > 2  # while it is recorded
    assert file.is_symlink()
    assert left(tmp_path) == ["old.jsonl", "session.jsonl"]
    assert old.stat().st_mode & 0o777 == 0o600
    recording = read_recording(file)
    assert recording.is_whole
    assert [event.what for event in recording.entries[:2]] == [Entered.OPEN, Entered.BYTES]
    assert recording.entries[-1].what is Entered.CLOSE


def received(fd: int, count: int) -> bytes:
    """Read this count of bytes, which may come in pieces."""
    data = b""
    while len(data) < count:
        data += os.read(fd, count - len(data))
    return data


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo terminals of POSIX")
def test_a_serial_line_is_recorded_until_a_signal(tmp_path: Path) -> None:
    import pty
    import tty

    (host, host_line), (card, card_line) = pty.openpty(), pty.openpty()
    for each in (host_line, card_line):
        tty.setraw(each)
    file, ports = tmp_path / "s.jsonl", (os.ttyname(card_line), os.ttyname(host_line))
    with running("record", ports[0], file, "--host-port", ports[1], "--baud", 9600) as line:
        assert line == f"joined {ports[1]} card={ports[0]}\n"
        for sender, receiver, data in (
            (host, card, b"?6*7\r"),
            (card, host, b"?6*7\r\n42\r\nSYS>"),
        ):
            os.write(sender, data)
            assert received(receiver, len(data)) == data
    for each in (host, host_line, card, card_line):
        os.close(each)
    assert file.stat().st_mode & 0o777 == 0o600
    replayed = openacr("replay", file)
    assert replayed.stdout.endswith(" events: every answer is the same\n")


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
@pytest.mark.parametrize("is_forced", [False, True])
def test_a_serial_line_goes_on_when_the_disk_is_full(tmp_path: Path, is_forced: bool) -> None:
    import pty
    import tty

    (host, host_line), (card, card_line) = pty.openpty(), pty.openpty()
    for each in (host_line, card_line):
        tty.setraw(each)
    file, ports = tmp_path / "s.jsonl", (os.ttyname(card_line), os.ttyname(host_line))
    words = ["record", ports[0], str(file), "--host-port", ports[1]]
    if is_forced:
        file.write_text(OLD)
        words.append("--force")
    with warm.Popen(words, most_bytes=125, **SAID) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("joined ")
        for _ in range(5):
            for sender, receiver in ((host, card), (card, host)):
                os.write(sender, b"?6*7\r")
                assert received(receiver, 5) == b"?6*7\r"
        assert process.poll() is None
        process.terminate()
        _, said = process.communicate(timeout=60)
    for each in (host, host_line, card, card_line):
        os.close(each)
    assert process.returncode == 2
    assert said.count("the recording ends here: file too large; the line goes on") == 1
    assert said.splitlines()[-1] == f"error: {file}: cannot be written: file too large"
    assert left(tmp_path) == [file.name]
    if is_forced:
        assert file.read_text() == OLD
    else:
        assert [event.what for event in read_recording(file).entries] == [Entered.OPEN]


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    return written(
        tmp_path / "s.jsonl",
        event(0.0, 1, Entered.OPEN),
        event(0.25, 1, Entered.BYTES, b"?P12375\r"),
        event(0.3, 1, Entered.SENT, b"?P12375\r\n800\r\nSYS>"),
    )


def test_an_answer_that_differs_is_shown_with_its_request(recording: Path) -> None:
    result = openacr("replay", recording)
    assert result.exit_code == 1
    assert result.stdout.splitlines() == [
        "connection 1, 0.2500 s: the answer to '?P12375\\r' differs",
        "  recorded  '800\\r\\n'",
        "  replayed  '1\\r\\n'",
    ]
    record = json.loads(openacr("replay", recording, "--json").stdout)
    assert record == {
        "events": 3,
        "difference": {
            "time_s": 0.25, "connection": 1, "sent": "?P12375\r", "recorded": "800\r\n",
            "replayed": "1\r\n",
        },
    }  # fmt: skip


def test_the_project_makes_the_difference(recording: Path) -> None:
    project = ROOT / "examples" / "homing_xyz"
    result = openacr("replay", recording, "--project", project)
    assert result.stdout == "3 events: every answer is the same\n"
    found = json.loads(openacr("replay", recording, "--project", project, "--json").stdout)
    assert found == {"events": 3, "difference": None}


def test_a_recording_that_is_cut_off_is_replayed_to_its_last_whole_line(recording: Path) -> None:
    recording.write_bytes(recording.read_bytes()[:-2])
    result = openacr("replay", recording)
    assert result.stdout == "2 events: every answer is the same\n"
    assert "the last line of the recording is cut off and was left out" in result.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["/dev/ttyUSB0"], "/dev/ttyUSB0 is recorded between two serial ports: give --host-port"),
        (["/dev/ttyNO", "--host-port", "/dev/ttyNO2"], "cannot open serial port /dev/ttyNO"),
        (["127.0.0.1:1", "--host-port", "COM1"], "--host-port is for a card on a serial port"),
        (["127.0.0.1:1", "--listen", "0.0.0.0"], "other machines reach 0.0.0.0"),
        (["127.0.0.1:1", "--allow", "10.0.0.0/8", "--insecure"], "exclude each other"),
        (["127.0.0.1:1", "--allow", "home"], "write networks like 192.168.10.0/24"),
        (["127.0.0.1:1"], "cannot connect to 127.0.0.1:1"),
    ],
)
def test_what_cannot_be_recorded_is_refused_before_a_file_is_made(
    tmp_path: Path, words: list[str], said: str
) -> None:
    target, *options = words
    result = openacr("record", target, tmp_path / "s.jsonl", *options)
    assert result.exit_code == 2
    assert said in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_not_replaced_without_force(tmp_path: Path) -> None:
    (tmp_path / "s.jsonl").write_text("mine")
    result = openacr("record", "127.0.0.1:1", tmp_path / "s.jsonl")
    assert result.exit_code == 2
    assert "is there already (--force replaces it)" in result.stderr
    assert (tmp_path / "s.jsonl").read_text() == "mine"


def test_what_is_no_file_is_not_replaced(tmp_path: Path) -> None:
    result = openacr("record", "127.0.0.1:1", tmp_path, "--force")
    assert result.exit_code == 2
    assert f"{tmp_path} is not a file that could be replaced" in result.stderr


def test_a_card_that_is_away_leaves_the_older_recording(tmp_path: Path) -> None:
    (tmp_path / "s.jsonl").write_text(OLD)
    result = openacr("record", "127.0.0.1:1", tmp_path / "s.jsonl", "--force")
    assert result.exit_code == 2
    assert (left(tmp_path), (tmp_path / "s.jsonl").read_text()) == (["s.jsonl"], OLD)


def test_an_option_of_recordings_is_refused_for_journals(tmp_path: Path) -> None:
    (tmp_path / "j").write_bytes(b"journal")
    result = openacr("replay", tmp_path / "j", "--json")
    assert result.exit_code == 2
    assert "--json is for recordings of `openacr record`" in result.stderr


@pytest.mark.parametrize("words", [["--check"], ["--until", "1"]])
def test_options_of_journals_are_refused_for_recordings(recording: Path, words: list[str]) -> None:
    result = openacr("replay", recording, *words)
    assert result.exit_code == 2
    assert f"{words[0]} is for journals" in result.stderr
