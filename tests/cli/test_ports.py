"""A port that is in use is refused in one line, with the option that chooses another one."""

import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app


@pytest.fixture
def taken() -> Iterator[int]:
    """A port of this computer on which another program listens."""
    with socket.create_server(("127.0.0.1", 0)) as other:
        yield int(other.getsockname()[1])


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (("serve", "--no-journal", "--binary-port", "0", "--ascii-port"), "--ascii-port"),
        (("serve", "--no-journal", "--ascii-port", "0", "--binary-port"), "--binary-port"),
        (("panel", "--no-browser", "--port"), "--port"),
        (("debug", "--port"), "--port"),
    ],
)
def test_a_port_in_use_is_refused_in_one_line(
    taken: int,
    words: tuple[str, ...],
    option: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    store = ("--store", str(tmp_path / "sysvar.db")) if words[0] == "panel" else ()
    result = CliRunner().invoke(app, [*words, str(taken), *store])
    assert result.exit_code == 2
    assert result.stderr.removeprefix("starting the panel ...\n") == (
        f"error: port {taken} on 127.0.0.1 is in use (is it running already?);"
        f" choose another one with {option}, 0 picks a free one\n"
    )
