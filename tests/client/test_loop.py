"""The servo loop view: what flows through the loop of an axis, from offsets to volts."""

import json

import pytest
from tests.io.served import LOOPBACK, serving
from typer.testing import CliRunner

from openacr.cli.live.loop import GAINS, OUTPUT, PATH, Loop, lines_of, read_loop
from openacr.cli.main import app
from openacr.client import Card
from openacr.client.links import ProcessLink
from openacr.controller import Controller
from openacr.plant.describe.load import parse_world

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


def axis_loop(number: int, pgain: float = 0.00244141, no_output: str = "") -> Loop:
    path = dict.fromkeys(PATH, -7)
    return Loop(number, path, dict.fromkeys(GAINS, pgain), dict.fromkeys(OUTPUT, 1.0), no_output)


def test_as_many_axes_as_there_is_room_for_are_side_by_side() -> None:
    # 19 columns of names, and 12 of each axis (0.00244141 and a gap): five axes need 79.
    loops = [axis_loop(number) for number in range(7)]
    titles = [line.split() for line in lines_of(loops, 79) if "axis" in line]
    assert titles == [
        ["axis", "0", "axis", "1", "axis", "2", "axis", "3", "axis", "4"],
        ["axis", "5", "axis", "6"],
    ]
    assert max(map(len, lines_of(loops, 79))) == 79
    assert "axis 4" not in lines_of(loops, 78)[0]
    assert lines_of(loops, 79)[1] == "current position   " + "          -7" * 5


def test_an_axis_wider_than_the_terminal_is_shown_all_the_same() -> None:
    lines = lines_of([axis_loop(0), axis_loop(1)], 10)
    assert [line.split() for line in lines if "axis" in line] == [["axis", "0"], ["axis", "1"]]


def test_a_reason_for_no_output_has_a_line_of_its_own() -> None:
    lines = lines_of([axis_loop(0), axis_loop(3, no_output="the servo loop is open")], 80)
    assert lines[-1] == "axis 3 has no output: the servo loop is open"
    assert [line for line in lines if "no output" in line] == lines[-1:]


def test_the_command_prints_a_table_or_json() -> None:
    with serving() as served:
        target = f"{LOOPBACK}:{served.ascii_port}"
        table = CliRunner().invoke(app, ["loop", target, "--axis", "1"])
        answered = CliRunner().invoke(app, ["loop", target, "--axis", "0", "--axis", "2", "--json"])
    lines = [line.split() for line in table.stdout.splitlines() if line.strip()]
    assert lines[0] == ["axis", "1"]
    assert ["PGAIN", "0.00244141"] in lines
    assert ["output", "signal", "[V]", "0.0000"] in lines
    found = json.loads(answered.stdout)
    assert [one["axis"] for one in found] == [0, 2]
    assert found[0]["gains"]["PGAIN"] == pytest.approx(0.002441406)
