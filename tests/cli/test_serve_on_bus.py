"""`openacr serve` of a machine on a bus, as far as no network is needed: what is refused before."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app

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


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "machine.toml").write_text(MACHINE)
    return tmp_path


@pytest.mark.parametrize(
    ("machine", "options", "text"),
    [
        (MACHINE, ["--real"], "--real lets drives be enabled: say --yes"),
        (MACHINE, ["--speed", "2"], "a card with a bus runs in real time"),
        (MACHINE.replace('interface = "no-such-if"', ""), [], "names no interface"),
        (MACHINE.partition("[[axis]]")[2].partition("[axis.bus]")[0], ["--real"], "no drive"),
        (MACHINE.partition("[[axis]]")[2].partition("[axis.bus]")[0], ["--bus", "e"], "no machine"),
        (MACHINE, ["--bus", "none", "--real"], "no drive is on a bus"),
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
