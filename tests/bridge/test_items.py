"""The table of values: units, what is known of a machine, and what a lost one still says."""

from dataclasses import replace

import pytest
from tests.bridge.bench import RUNNING, VALUES, GivenFeed

from openacr.bridge.items import items_of, read_all
from openacr.bridge.load import parse_bridge
from openacr.bridge.moment import Moment
from openacr.bridge.rows import AXIS_ROWS, ROWS, Alarm, Kind, Value
from openacr.bridge.tools import CuttingTool
from openacr.mill.config.tools import Tip
from openacr.mill.run.lifecycle import State

TOOLS = (CuttingTool(3, 6.0, 50.25, Tip.FLAT), CuttingTool(12, None, -7.5, Tip.BALL))
ITEMS = items_of(GivenFeed().axes, parse_bridge(VALUES + "[prometheus]\n").value)


def values(moment: Moment) -> dict[str, Value]:
    return dict(zip((i.name for i in ITEMS), read_all(ITEMS, moment), strict=True))


def run_of(state: State) -> Moment:
    assert RUNNING.run is not None
    return replace(RUNNING, run=replace(RUNNING.run, state=state))


def test_every_value_of_a_running_machine_is_read() -> None:
    assert values(RUNNING) == {
        "available": True, "execution": "ACTIVE", "mode": "AUTOMATIC", "emergency_stop": "ARMED",
        "state": "RUN", "program": "plate.nc", "line": 12, "block": "G1 X1", "work_system": "G54",
        "tool": 3, "tools": TOOLS, "parts": 4, "run_time": 12.5, "time_left": None, "moving": True,
        "path_speed": 2.0, "feed": 2.0, "feed_override": 80.0, "rapid_override": 100.0,
        "spindle_speed": 900.0, "spindle_override": 100.0, "spindle_on": True, "flood": False,
        "mist": False, "dry_run": False, "single_block": False, "barred": False,
        "bus_stopped": None, "bus_alarm": None, "bus_frames_sent": None, "bus_frames_lost": None,
        "bus_frames_wrong": None, "bus_frames_late": None, "loop_cycles": None, "loop_missed": None,
        "loop_late_us": None, "loop_worst_late_us": None, "loop_worst_work_us": None,
        "message": "DOOR / COOLANT LOW", "alarms": (Alarm(34, "X: drive is off", "REFUSE"),),
        "X.actual": 1.5, "X.commanded": 1.0, "X.following_error": 0.5, "X.work": 11.0,
        "X.to_go": 0.0, "X.homed": True, "X.jogging": False,
        "Y.actual": -2.0, "Y.commanded": 2.0, "Y.following_error": 0.0, "Y.work": 12.0,
        "Y.to_go": 1.0, "Y.homed": False, "Y.jogging": False,
        "C.actual": 90.25, "C.commanded": 90.0, "C.following_error": 0.25, "C.work": 90.0,
        "C.to_go": 2.0, "C.homed": True, "C.jogging": False,
        "user.pulses": 400.0, "user.gate": True,
    }  # fmt: skip


def test_a_bus_has_its_counts_of_frames_and_why_it_is_stopped() -> None:
    counters = {"sent": 1000, "lost": 3, "wrong": 2, "late": 7}
    found = values(replace(RUNNING, bus={"alarm": "a device has left OP", "counters": counters}))
    assert {key: value for key, value in found.items() if key.startswith("bus")} == {
        "bus_stopped": True, "bus_alarm": "a device has left OP", "bus_frames_sent": 1000,
        "bus_frames_lost": 3, "bus_frames_wrong": 2, "bus_frames_late": 7,
    }  # fmt: skip
    found = values(replace(RUNNING, bus={"alarm": "", "counters": counters}))
    assert (found["bus_stopped"], found["bus_alarm"]) == (False, "")


def test_the_loop_of_a_bus_has_its_figures_where_it_is_one_in_real_time() -> None:
    bus = {"alarm": "", "counters": {"sent": 0, "lost": 0, "wrong": 0, "late": 0}}
    late = {"median_s": 1e-6, "most_s": 12e-6, "worst_s": 250e-6}
    computing = {"median_s": 2e-6, "most_s": 3e-6, "worst_s": 40e-6}
    loop = {"cycles": 5000, "missed": 0, "late": late, "computing": computing}
    found = values(replace(RUNNING, bus=bus | {"loop": loop}))
    assert {key: value for key, value in found.items() if key.startswith("loop")} == {
        "loop_cycles": 5000, "loop_missed": 0, "loop_late_us": pytest.approx(12.0),
        "loop_worst_late_us": pytest.approx(250.0), "loop_worst_work_us": pytest.approx(40.0),
    }  # fmt: skip
    found = values(replace(RUNNING, bus=bus | {"loop": None}))
    assert {found[name] for name in found if name.startswith("loop")} == {None}


def test_lengths_of_a_machine_in_inches_are_in_millimetres_but_degrees_stay() -> None:
    found = values(replace(RUNNING, mm_per_unit=25.4))
    assert found["X.actual"] == pytest.approx(38.1)
    assert found["C.actual"] == 90.25
    assert found["path_speed"] == pytest.approx(50.8)
    assert found["feed"] == pytest.approx(50.8)
    assert found["user.pulses"] == 400.0
    assert found["run_time"] == 12.5
    assert found["tools"] == (
        CuttingTool(3, 6.0 * 25.4, 50.25 * 25.4, Tip.FLAT),
        CuttingTool(12, None, -7.5 * 25.4, Tip.BALL),
    )


def test_units_of_rotary_axes_are_degrees_and_chosen_values_have_their_own() -> None:
    units = {item.name: str(item.unit) for item in ITEMS}
    assert (units["X.actual"], units["C.actual"]) == ("MILLIMETER", "DEGREE")
    assert (units["C.homed"], units["user.pulses"], units["user.gate"]) == ("", "pulses", "")


def test_a_lost_machine_says_that_it_is_and_keeps_its_alarms() -> None:
    found = values(replace(RUNNING, lost="the card does not answer"))
    known = {name: value for name, value in found.items() if value is not None}
    assert known == {"available": False, "alarms": (Alarm(34, "X: drive is off", "REFUSE"),)}


def test_a_card_without_its_cnc_side_has_positions_speed_and_chosen_values() -> None:
    found = values(replace(RUNNING, run=None, facts={}, tools=None))
    known = {name for name, value in found.items() if value is not None}
    positions = {f"{axis}.{row}" for axis in "XYC" for row in ("actual", "commanded")}
    assert known == positions | {
        "available", "moving", "path_speed", "user.pulses", "user.gate",
        "X.following_error", "Y.following_error", "C.following_error",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("state", "execution"),
    [
        (State.IDLE, "READY"), (State.RUN, "ACTIVE"), (State.WAIT, "WAIT"),
        (State.HOMING, "ACTIVE"), (State.PAUSED, "FEED_HOLD"), (State.HOLD, "PROGRAM_STOPPED"),
        (State.ALARM, "STOPPED"),
    ],
)  # fmt: skip
def test_every_state_of_a_run_has_its_execution(state: State, execution: str) -> None:
    assert values(run_of(state))["execution"] == execution


@pytest.mark.parametrize(
    ("mode", "shown"),
    [
        ("auto", "AUTOMATIC"), ("manual", "MANUAL"), ("mdi", "MANUAL_DATA_INPUT"),
        ("home", "MANUAL"), ("setup", "MANUAL"), ("diagnose", "MANUAL"),
    ],
)  # fmt: skip
def test_modes_of_the_screens_are_modes_of_the_control(mode: str, shown: str) -> None:
    facts = {**RUNNING.facts, "state": {**RUNNING.facts["state"], "mode": mode}}
    assert values(replace(RUNNING, facts=facts))["mode"] == shown


@pytest.mark.parametrize(("on", "alarm"), [(True, False), (False, True)])
def test_the_emergency_stop_is_triggered_by_its_input_or_its_alarm(on: bool, alarm: bool) -> None:
    stop = {"wired": True, "on": on, "alarm": alarm}
    facts = {**RUNNING.facts, "state": {**RUNNING.facts["state"], "estop": stop}}
    assert values(replace(RUNNING, facts=facts))["emergency_stop"] == "TRIGGERED"


def test_a_machine_without_a_program_has_an_empty_name() -> None:
    facts = {**RUNNING.facts, "program": {"loaded": None, "text": ""}}
    assert values(replace(RUNNING, facts=facts))["program"] == ""


def test_every_row_has_a_name_of_its_own_and_a_meaning() -> None:
    names = [item.name for item in ITEMS]
    assert len(names) == len(set(names)) == len(ROWS) + 3 * len(AXIS_ROWS) + 2
    assert all(item.row.meaning for item in ITEMS)
    assert [row.name for row in ROWS if row.kind is Kind.ALARMS] == ["alarms"]


def test_a_tool_is_a_line_of_text_where_a_system_has_no_tools() -> None:
    assert [str(tool) for tool in TOOLS] == [
        "T3 diameter 6 mm, length 50.25 mm, flat", "T12 length -7.5 mm, ball",
    ]  # fmt: skip
