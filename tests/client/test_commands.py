"""`openacr download`, `upload`, `monitor`, `backup` and `restore` on a served card."""

import json
import shutil
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.client.cards import EXAMPLES
from tests.io.served import LOOPBACK, Served, serving
from typer.testing import CliRunner, Result

from openacr.cli.main import app


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    """One card; the tests change it one after the other."""
    with serving(EXAMPLES / "gantry") as served:
        yield served


@pytest.fixture
def target(served: Served) -> str:
    return f"{LOOPBACK}:{served.ascii_port}"


def openacr(*arguments: str | Path) -> Result:
    """Run a command line in this process."""
    return CliRunner().invoke(app, [str(item) for item in arguments])


def test_a_project_is_downloaded_and_verified(target: str) -> None:
    ended = openacr("download", target, EXAMPLES / "square")
    assert ended.exit_code == 0, ended.output
    assert "setup.8k: 39 lines\n" in ended.stdout
    assert "prog0.8k: 13 lines, PROG0 verified" in ended.stdout


def test_a_refused_line_ends_a_download_with_1_and_its_place(target: str, tmp_path: Path) -> None:
    path = tmp_path / "prog0.8k"
    path.write_text("PROGRAM\nX1\nfoo\nENDP\n")
    ended = openacr("download", target, path)
    assert ended.exit_code == 1
    assert f"error: {path}:3: Unknown command" in ended.stderr


def test_a_file_goes_to_the_program_that_is_chosen(target: str, tmp_path: Path) -> None:
    openacr("download", target, EXAMPLES / "gantry")
    path = tmp_path / "test.8k"
    path.write_text("PROGRAM\nP1 = 2\nENDP\n")
    ended = openacr("download", target, path, "--program", "2", "--no-verify")
    assert (ended.exit_code, "PROG2 stored, not verified" in ended.stdout) == (0, True)
    printed = openacr("upload", target, "--program", "2")
    assert printed.stdout == "PROGRAM\n P1 = 2\nENDP\n"
    assert openacr("download", target, path, "--program", "2", "--plc", "1").exit_code == 2
    assert openacr("download", target, path, "--program", "16").exit_code == 2


def test_programs_are_uploaded_one_or_all(target: str, tmp_path: Path) -> None:
    openacr("download", target, EXAMPLES / "gantry")
    assert openacr("upload", target, tmp_path / "prog1.8k").exit_code == 0
    assert (tmp_path / "prog1.8k").read_text().startswith("PROGRAM\n DRIVE ON Z")
    ended = openacr("upload", target, tmp_path / "all")
    assert ended.exit_code == 0
    assert sorted(path.name for path in (tmp_path / "all").iterdir()) == ["prog0.8k", "prog1.8k"]
    empty = openacr("upload", target, "--plc", "3")
    assert (empty.exit_code, empty.stderr) == (1, "PLC3 is empty\n")
    assert openacr("upload", target).exit_code == 2
    assert openacr("upload", target, tmp_path / "x.8k").exit_code == 2


def test_monitor_gives_one_json_object_per_sample(target: str) -> None:
    ended = openacr(
        "monitor", target, "P6916", "BIT516", "axis1.ppu", "--axis", "5",
        "--json", "--every", "0.05", "--for", "0.1",
    )  # fmt: skip
    samples = [json.loads(line) for line in ended.stdout.splitlines()]
    assert [sample["time_s"] for sample in samples] == pytest.approx([0, 0.05, 0.1], abs=0.2)
    assert samples[0]["axis5"] == {
        "position": 0, "actual": 0, "following_error": 0,
        "enabled": False, "killed": False, "jogging": False,
    }  # fmt: skip
    assert samples[0]["BIT516"] is False
    assert samples[0]["axis1.ppu"] == pytest.approx(40000)
    assert samples[0]["P6916"] < samples[2]["P6916"]


def test_monitor_shows_the_axes_that_are_on(target: str) -> None:
    openacr("download", target, EXAMPLES / "gantry")
    ended = openacr("monitor", target, "--for", "0")
    assert ended.exit_code == 0
    assert [axis in ended.stdout for axis in ("axis0", "axis2", "axis3")] == [True, True, False]
    assert openacr("monitor", target, "nonsense here", "--for", "0").exit_code == 2


def test_a_backup_is_restored_when_one_is_sure(target: str, tmp_path: Path) -> None:
    folder = tmp_path / "backup"
    openacr("download", target, EXAMPLES / "gantry")
    assert openacr("backup", target, folder).exit_code == 0
    assert openacr("backup", target, folder).exit_code == 2
    openacr("download", target, EXAMPLES / "square")
    unsure = openacr("restore", target, folder)
    assert (unsure.exit_code, "say --yes" in unsure.stderr) == (2, True)
    ended = openacr("restore", target, folder, "--yes")
    assert (ended.exit_code, "PROG0, PROG1, verified" in ended.stdout) == (0, True), ended.output
    shutil.rmtree(folder)
    assert openacr("restore", target, folder, "--yes").exit_code == 2


def test_no_card_there_ends_it_with_2() -> None:
    with socket.create_server((LOOPBACK, 0)) as taken:
        port = taken.getsockname()[1]
    ended = openacr("monitor", f"{LOOPBACK}:{port}")
    assert ended.exit_code == 2
    assert f"cannot connect to {LOOPBACK}:{port}" in ended.stderr
    assert "Traceback" not in ended.stderr


def test_what_monitor_cannot_show_is_named_as_what_it_was_meant_to_be(target: str) -> None:
    for item, text in (
        ("P99999", "there is no parameter P99999"),
        ("BIT99999", "there is no flag BIT99999"),
        ("axis0.foo", "no parameter and no flag is named 'axis0.foo'"),
    ):
        ended = openacr("monitor", target, item, "--for", "1")
        assert (ended.exit_code, text in ended.stderr) == (2, True), ended.stderr


def test_a_monitor_ends_in_time_and_with_its_line(target: str) -> None:
    ended = openacr("monitor", target, "P12288", "--every", "0", "--for", "0.1")
    assert (ended.exit_code, ended.stdout[-1:]) == (0, "\n")
    refused = openacr("monitor", target, "P12288", "--for", "-1")
    assert (refused.exit_code, "--for -1: give a number" in refused.stderr) == (2, True)


@pytest.mark.parametrize("command", ["monitor", "term"])
def test_a_port_beyond_the_last_is_no_address(command: str) -> None:
    ended = openacr(command, f"{LOOPBACK}:99999")
    assert (ended.exit_code, "port 99999 is not in 0..65535" in ended.stderr) == (2, True)


@pytest.mark.parametrize("command", ["status", "term"])
def test_a_missing_serial_port_is_named_once(command: str) -> None:
    ended = openacr(command, "/dev/no-such-port")
    assert ended.exit_code == 2
    assert "cannot open serial port /dev/no-such-port: No such file or directory" in ended.stderr
