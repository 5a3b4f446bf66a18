"""The event log of a run: what happened to the machine, at its servo period."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.run.controlled import ControlledMachine
from openacr.cli.run.events import EventLog
from openacr.controller import Controller
from openacr.map.memory import Memory
from openacr.scenario.played import Failure


def no_failure(program: int) -> Failure:
    raise AssertionError(program)


AXES = (
    'PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS1 "Y"\rPPU Y1000\rPGAIN Y0.002\rDRIVE ON Y\r'
    "ACC 500\rDEC 500\rSTP 500\rVEL 20\r"
)


@pytest.mark.parametrize(
    ("bit", "text"),
    [
        (16132, "X: Positive Hardware Limit Encountered (BIT16132)"),
        (16133 + 32, "axis 1: Negative Hardware Limit Encountered (BIT16165)"),
        (16141 + 7 * 32, "axis 7: Negative Software Limit Encountered (BIT16365)"),
        (16135, "X: Home Failed (BIT16135)"),
        (8467 + 32, "axis 1: Kill All Motion Request (BIT8499)"),
        (8477, "X: Drive Fault (BIT8477)"),
        (522, "master 0: Kill All Moves Request (BIT522)"),
        (522 + 7 * 32, "master 7: Kill All Moves Request (BIT746)"),
    ],
)
def test_a_flag_that_is_set_is_an_event_once(bit: int, text: str) -> None:
    memory = Memory()
    log = EventLog(memory, 8, {0: "X"}, no_failure)
    assert log.poll(0.5) == []
    memory.set_bit(bit, True)
    (event,) = log.poll(1.25)
    assert (str(event), event.flag) == (f"1.2500 s: {text}", bit)
    assert log.poll(2.0) == []
    memory.set_bit(bit, False)
    assert log.poll(3.0) == []
    memory.set_bit(bit, True)
    assert len(log.poll(4.0)) == 1


def test_a_flag_that_was_set_before_the_run_is_no_event() -> None:
    memory = Memory()
    memory.set_bit(16132, True)
    log = EventLog(memory, 8, {}, no_failure)
    memory.set_bit(16133, True)
    assert [event.flag for event in log.poll(0.0)] == [16133]


def test_only_what_is_in_use_is_watched() -> None:
    card = Controller()
    machine = ControlledMachine(card)
    assert not machine.has_new_events()
    card.send(AXES)
    assert machine.has_new_events()
    assert machine.watch(())
    assert not machine.has_new_events()
    card.send("PROGRAM\r10 END\rENDP\r")
    assert machine.has_new_events()


def test_an_event_ends_an_advance_at_its_tick() -> None:
    card = Controller()
    card.send(AXES + "SLM Y(1,-1)\rSET 16182\rY5\r")
    machine = ControlledMachine(card)
    machine.watch(())
    begin = card.lived_tk
    machine.advance(4000)
    limit, kill = machine.events()
    assert limit.flag == 16172
    assert kill.flag == 522
    assert limit.time_s == pytest.approx((card.lived_tk - begin) * card.period_s)
    assert card.axis(1).commanded_u == pytest.approx(1.0, abs=0.02)
    assert card.lived_tk - begin < 1000


PROGRAM = """\
SYS
DIM PROG0(1000)
PROG0
PROGRAM
10 DWL 0.25
20 P1 = 1/0
ENDP
"""


def test_the_events_of_a_run_are_shown_and_in_the_summary(tmp_path: Path) -> None:
    file, summary = tmp_path / "a.8k", tmp_path / "s.json"
    file.write_text(PROGRAM)
    result = CliRunner().invoke(app, ["run", str(file), "--for", "1", "--summary", str(summary)])
    assert result.exit_code == 1
    text = f"PROG0: stopped in line 20 ({file}:6): Divide by zero"
    assert text in result.stderr
    (event,) = json.loads(summary.read_text())["events"]
    assert (event["text"], event["program"], event["flag"]) == (text, 0, None)
    assert event["time_s"] == pytest.approx(0.25, abs=0.005)
    quiet = CliRunner().invoke(app, ["run", str(file), "--for", "1", "--quiet"])
    assert "stopped in line" not in quiet.stderr
