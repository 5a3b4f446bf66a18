"""The servo loop view: what flows through the loop of an axis, from offsets to volts."""

import json

import pytest
from tests.io.served import LOOPBACK, serving
from typer.testing import CliRunner

from openacr.cli.loop import read_loop
from openacr.cli.main import app
from openacr.client import Card
from openacr.client.links import ProcessLink
from openacr.controller import Controller
from openacr.plant.load import parse_world

STILL = """
[[axis]]
number = 0
counts_per_rev = 4096
drive = { mode = "ideal", revs_per_s_per_volt = 1e-6, lag_s = 0.001 }
"""


@pytest.fixture
def card() -> Controller:
    """An axis that has jogged, been geared and moved while its motor stands still."""
    card = Controller(world=parse_world(STILL))
    card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rACC 0 DEC 0 STP 0 VEL 10000\r')
    card.send("JOG ACC X0\rJOG DEC X0\rJOG VEL X10000\rPGAIN X0.01\rDGAIN X0.00001\rTLM X10\r")
    card.send("GEAR SRC X ENC3\rGEAR RATIO X2\rGEAR ON X\rX100\rJOG ABS X30\r")
    card.advance(seconds=0.1)
    card.send("ENC3 RES 0\r")
    return card


@pytest.mark.req("ACR-SERVO-06")
def test_offsets_setpoints_gains_and_output_of_an_axis(card: Controller) -> None:
    with Card(ProcessLink(card)) as host:
        one = read_loop(host, 0)
    assert one.path_cnt["current position"] == 100
    assert one.path_cnt["jog offset"] == 30
    offsets = sum(one.path_cnt[f"{part} offset"] for part in ("gear", "jog", "cam"))
    assert one.path_cnt["primary setpoint"] == 100 + offsets
    slow = one.path_cnt["ballscrew offset"] + one.path_cnt["backlash offset"]
    assert one.path_cnt["secondary setpoint"] == one.path_cnt["primary setpoint"] + slow
    error = one.path_cnt["secondary setpoint"] - one.path_cnt["actual position"]
    assert one.path_cnt["following error"] == error == 130
    assert one.gains["PGAIN"] == pytest.approx(0.01)
    assert one.gains["DGAIN"] == pytest.approx(0.00001)
    assert one.output_v["summation point"] == pytest.approx(1.3)
    assert one.output_v["output signal"] == pytest.approx(1.3)


def test_the_command_prints_a_table_or_json() -> None:
    with serving() as served:
        target = f"{LOOPBACK}:{served.ascii_port}"
        table = CliRunner().invoke(app, ["loop", target, "--axis", "1"])
        told = CliRunner().invoke(app, ["loop", target, "--axis", "0", "--axis", "2", "--json"])
    lines = [line.split() for line in table.stdout.splitlines() if line.strip()]
    assert lines[0] == ["axis", "1"]
    assert ["PGAIN", "0.00244141"] in lines
    assert ["output", "signal", "[V]", "0.0000"] in lines
    found = json.loads(told.stdout)
    assert [one["axis"] for one in found] == [0, 2]
    assert found[0]["gains"]["PGAIN"] == pytest.approx(0.002441406)
