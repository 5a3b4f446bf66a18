"""`openacr serve` of a machine on a bus, as far as no network is needed: what is refused before."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.serve_on_bus import what_can_happen
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


def test_what_is_real_can_be_on_several_buses_and_all_of_it_is_named_before_consent() -> None:
    sentences = list(what_can_happen(parse_world(CAN + MACHINE), "eth1"))
    assert sentences == [
        "Drives on eth1 can be enabled and axes X can move.",
        "CANopen nodes on can7 can switch their outputs.",
    ]
