"""`openacr bridge` and `openacr panel --bridge` as processes."""

import re
import signal
from pathlib import Path

import httpx
import pytest
from tests.io.served import serving
from tests.mill.live import Process
from tests.waiting import LIMIT_S, until
from typer.testing import CliRunner

from openacr.cli.main import app

FILE = 'name = "mill"\n[prometheus]\nport = 0\n'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "bridge.toml"
    path.write_text(FILE)
    return path


def metrics(process: Process) -> str:
    """The metrics of a process, once it says where they are."""
    until(lambda: "bridge prometheus http" in process.text, about="the bridge listens")
    found = re.search(r"bridge prometheus (http://127\.0\.0\.1:\d+/metrics)", process.text)
    assert found is not None
    return httpx.get(found[1], timeout=LIMIT_S).text


def test_a_panel_with_a_bridge_publishes_its_program_and_ends_cleanly(
    tmp_path: Path, file: Path
) -> None:
    words = ("panel", "--no-browser", "--port", "0", "--store", str(tmp_path / "sysvar.db"))
    process = Process(*words, "--bridge", str(file), store=tmp_path / "other.db")
    try:
        until(
            lambda: 'openacr_program{machine="mill",text="plate.nc"} 1.0' in metrics(process),
            about="the sample part is loaded",
        )
        process.signal(signal.SIGTERM)
        assert process.ended() == 0
    finally:
        process.close()


def test_a_bridge_publishes_a_served_card_and_ends_cleanly(tmp_path: Path, file: Path) -> None:
    with serving() as served:
        words = ("bridge", str(file), f"127.0.0.1:{served.ascii_port}")
        process = Process(*words, store=tmp_path / "other.db")
        try:
            until(
                lambda: 'openacr_axis_actual_mm{axis="X",machine="mill"} 0.0' in metrics(process),
                about="the card is read",
            )
            process.signal(signal.SIGTERM)
            assert process.ended() == 0
        finally:
            process.close()


@pytest.mark.parametrize("command", ["bridge", "panel"])
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no system is configured"),
        ('[prometheus]\npassword_file = "nowhere"\n', "nowhere: cannot be read"),
        (FILE.replace("port = 0", 'port = 0\naddress = "192.0.2.1"\npassword_file = "bridge.toml"'),
         "cannot listen on 192.0.2.1:0"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_said_in_one_line(
    tmp_path: Path, file: Path, command: str, text: str, said: str
) -> None:
    file.write_text(text)
    store = ("--no-browser", "--port", "0", "--store", str(tmp_path / "sysvar.db"))
    words = ("--bridge", str(file), *store) if command == "panel" else (str(file),)
    result = CliRunner(env={"OPENACR_STORE": str(tmp_path / "other.db")}).invoke(
        app, [command, *words]
    )
    assert result.exit_code == 2
    (error,) = result.stderr.removeprefix("starting the panel ...\n").splitlines()
    assert error.startswith("error: ") and said in error
