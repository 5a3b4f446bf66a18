"""Programs, homing, zeros and MDI of a panel, on a station whose time passes by hand."""

from math import isnan

import pytest
from tests.panel.bench import HandStation, card_of

from openacr.cnc.loading.load import load
from openacr.map.rows import axes
from openacr.mill.session import Start
from openacr.panel.control.machine.snapshot import Light
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role
from openacr.panel.work.paths import read_file
from openacr.sysvar.tabs import CONTROL, FOV, ROV, SPINDLE

SQUARE = "G21 G90 G54\nG0 X10 Y10 Z60\nG1 X20 F1200\nY20\nM0\nX10\nY10\nM2\n"


def loaded(hand: HandStation, text: str = SQUARE) -> None:
    (hand.installation.programs / "t.nc").write_text(text)
    hand.do("program.load", path="t.nc")
    hand.run(0.1)


def test_a_program_is_loaded_started_stopped_and_ends(hand: HandStation) -> None:
    loaded(hand)
    assert hand.events("program")[-1]["loaded"]["name"] == "t.nc"
    hand.do("run.begin")
    hand.until(lambda: hand.state == "HOLD")
    hand.run(0.05)
    assert hand.station.snapshot.line in (4, 5)
    assert hand.events("state")[-1]["reason"] == "M0"
    hand.do("run.start")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.places() == (210.0, 160.0, 0.0)
    assert hand.station.snapshot.work == (10.0, 10.0, 60.0)


def test_the_executing_block_is_one_of_a_program_only_while_that_runs(hand: HandStation) -> None:
    """Not a block of MDI, not the last one of a program that has ended, not of another text."""
    (hand.installation.programs / "SUB.TXT").write_text("; sub\nN500 G1 X1\nRET\n")
    loaded(hand, "G21 G91 F300\nG1 X1\nGOSUB 500\nX1\nM2\n$I SUB.TXT\n")
    seen = []

    def note() -> bool:
        now = hand.station.part.data()
        block = (now["file"], now["line"], now["text"], hand.station.snapshot.line)
        if block[:2] == ("SUB.TXT", 2) and block[3] != 0:
            return False  # the snapshot is older than the program
        if block[0] and block[0] == "t.nc" and block[3] != block[1]:
            return False
        if block not in seen:
            seen.append(block)
        return not hand.is_busy

    hand.do("run.begin")
    assert hand.events("state")[-1]["running"]
    hand.until(note)
    assert [block for block in seen if block[0]] == [
        ("t.nc", 2, "G1 X1", 2),
        ("SUB.TXT", 2, "N500 G1 X1", 0),
        ("t.nc", 4, "X1", 4),
    ]
    hand.run(0.1)
    for command, args in (
        ("mode", {"mode": "auto"}),
        ("mdi.execute", {"line": "G91 G1 X2 F300"}),
        ("home.start", {"axes": "Z"}),
    ):
        hand.do(command, **args)
        hand.run(0.2)
        now = hand.station.part.data()
        assert (now["file"], now["line"], now["text"]) == ("", 0, "")
        assert hand.station.snapshot.line == 0
        assert not hand.events("state")[-1]["running"]
        assert hand.is_busy is (command != "mode")
        hand.until(lambda: not hand.is_busy)


def test_stop_holds_the_feed_and_resume_goes_on(hand: HandStation) -> None:
    loaded(hand)
    hand.do("run.begin")
    hand.until(lambda: hand.station.snapshot.line == 3)
    hand.do("stop.hold")
    hand.run(1.0)
    assert hand.state == "PAUSED"
    at = hand.places()
    hand.run(0.5)
    assert hand.places() == at
    assert hand.refused("run.start", old_s=1.0)["code"] == "stale"
    hand.do("run.resume")
    hand.until(lambda: hand.state == "HOLD")
    hand.do("run.abort")
    hand.until(lambda: not hand.is_busy)
    assert hand.events("state")[-1]["aborted"]


def test_a_viewer_stops_a_program_and_starts_nothing(hand: HandStation) -> None:
    viewer = Person(5, Role.VIEW, "10.0.0.5")
    hand.station.join(viewer)
    loaded(hand)
    assert hand.send("run.begin", who=viewer)["error"]["code"] == "role"
    hand.do("run.begin")
    hand.run(0.3)
    assert hand.send("stop.all", who=viewer)["ok"]
    hand.until(lambda: not hand.is_busy)
    assert hand.send("run.begin", who=viewer)["error"] == {
        "code": "role", "text": "this needs the role operate", "needs": "operate",
    }  # fmt: skip


def test_a_start_line_is_rehearsed_and_confirmed(hand: HandStation) -> None:
    loaded(hand)
    assert "safe" in hand.refused("run.begin", line=4)["text"]
    result = hand.do("run.begin", line=4, safe_z=0.0)
    rehearsal = result["rehearsal"]
    names = [each["name"] for each in rehearsal["differences"]]
    assert any("osition" in name or "X" in name for name in names)
    assert not hand.is_busy
    assert "confirmed first" in hand.refused("run.begin", line=4, confirm="x")["text"]
    assert "was confirmed" in hand.refused("run.begin", line=5, confirm=rehearsal["token"])["text"]
    rehearsal = hand.do("run.begin", line=4, safe_z=0.0)["rehearsal"]
    hand.do("run.begin", line=4, confirm=rehearsal["token"])
    hand.until(lambda: hand.state == "HOLD")
    hand.run(0.05)
    assert hand.places()[:2] == (220.0, 170.0)


def test_a_program_with_errors_is_not_started(hand: HandStation) -> None:
    loaded(hand, "G21 G90\nG1 X F100\nM2\n")
    assert hand.events("program")[-1]["loaded"]["errors"] == 1
    error = hand.refused("run.begin")
    assert "cannot be started: t.nc:2:" in error["text"]


def test_a_missing_program_is_said(hand: HandStation) -> None:
    assert hand.refused("program.load", path="no.nc")["text"] == "no.nc: no such file"
    assert (
        hand.refused("program.load", path="../x.nc")["text"] == "../x.nc: this name is not allowed"
    )
    assert hand.refused("run.begin")["text"] == "no program is loaded"


def test_another_program_is_refused_while_one_runs(hand: HandStation) -> None:
    loaded(hand)
    hand.do("run.begin")
    hand.run(0.3)
    assert "a program runs" in hand.refused("program.load", path="plate.nc")["text"]
    hand.do("stop.all")
    hand.until(lambda: not hand.is_busy)
    hand.do("program.load", path="plate.nc")


def test_block_stops_after_every_block(hand: HandStation) -> None:
    loaded(hand)
    hand.do("run.block", on=True)
    assert hand.events("state")[-1]["options"]["single"]
    hand.do("run.begin")
    hand.until(lambda: hand.state == "HOLD")
    first = hand.station.snapshot.line
    hand.do("run.start")
    hand.run(0.1)
    hand.until(lambda: hand.state == "HOLD")
    assert hand.station.snapshot.line > first


def test_a_batch_runs_its_programs_one_after_the_other(hand: HandStation) -> None:
    for name, x in (("a.nc", 1), ("b.nc", 2)):
        (hand.installation.programs / name).write_text(f"G21 G90\nG0 X{x}\nM2\n")
    (hand.installation.programs / "list.txt").write_text("a.nc L2\nb.nc\n")
    hand.do("program.batch", path="list.txt")
    hand.run(0.1)
    assert hand.events("program")[-1]["batch"]["names"] == ["a.nc", "a.nc", "b.nc"]
    hand.do("run.begin")
    hand.until(lambda: hand.events("program")[-1]["batch"]["index"] == 2)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 2.0


def test_a_batch_does_not_leave_the_folder(hand: HandStation) -> None:
    (hand.installation.programs.parent / "x.nc").write_text("M2\n")
    (hand.installation.programs / "list.txt").write_text("../x.nc\n")
    error = hand.refused("program.batch", path="list.txt")
    assert "outside the folder" in error["text"]


# --- home, zero, MDI ------------------------------------------------------------------


def test_home_finds_the_reference_points(hand: HandStation) -> None:
    assert hand.do("home.start", axes="") == {"axes": ["X", "Y", "Z"]}
    hand.until(lambda: hand.state == "IDLE" and not hand.is_busy, 120.0)
    hand.run(0.1)
    assert hand.events("state")[-1]["homed"] == ["X", "Y", "Z"]
    x, y, z = hand.places()
    assert (round(x, 2), round(y, 2), round(z, 2)) == (3.0, 3.0, -2.0)
    assert [axis["homed"] for axis in hand.events("home")[-1]["axes"]] == [True, True, True]
    seen = [event["axes"][2]["state"] for event in hand.events("home")]
    assert [state for n, state in enumerate(seen) if n and state != seen[n - 1]] == [
        "switch", "rest", "release of the switch", "marker", "rest", "done"
    ]  # fmt: skip


def test_stop_ends_homing_with_its_alarm(hand: HandStation) -> None:
    hand.do("home.start", axes="X")
    hand.run(0.5)
    assert hand.events("home")[-1]["axes"][0]["state"] == "switch"
    hand.do("stop.hold")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert [a["code"] for a in hand.events("alarms")[-1]["active"]] == [34]
    assert hand.events("home")[-1]["axes"][0]["state"] == "failed"
    assert hand.do("alarm.acknowledge") == {"left": []}


def test_zeros_are_set_cleared_and_gone_to(hand: HandStation) -> None:
    hand.do("jog.increment", axis="X", direction=1, distance=7.5, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    hand.run(0.05)
    result = hand.do("zero.set", axes="XY")
    assert (result["position"]["X"], result["position"]["Y"]) == (0.0, 0.0)
    hand.run(0.1)
    assert hand.station.snapshot.work[:2] == (0.0, 0.0)
    hand.do("jog.increment", axis="X", direction=1, distance=5.0, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    hand.do("zero.goto", axes="X")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.places()[0] == 7.5
    hand.do("zero.clear")
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == pytest.approx(7.5 - 200.0)


def test_goto_zero_does_not_become_part_of_the_mdi_text(hand: HandStation) -> None:
    hand.do("zero.set", axes="")
    hand.do("zero.goto", axes="")
    hand.until(lambda: not hand.is_busy)
    assert hand.do("mdi.buffer") == {"lines": [], "on": True}


def test_mdi_runs_blocks_in_order_and_keeps_their_text(hand: HandStation) -> None:
    hand.do("mdi.execute", lines=["G21 G90 G0 X5", "G1 X8 F600", "G91 G0 X1"])
    hand.until(lambda: not hand.is_busy and not hand.station.typed.data()["queue"])
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 9.0
    hand.do("mdi.execute", line="G0 X1")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 10.0  # still incremental
    assert hand.do("mdi.buffer")["lines"] == ["G21 G90 G0 X5", "G1 X8 F600", "G91 G0 X1", "G0 X1"]


def test_mdi_keeps_the_last_blocks_that_it_has_executed(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("openacr.panel.control.operator.typed.MOST_TEXT", 2)
    for block in ("G21", "G90", "G91"):
        hand.do("mdi.execute", line=block)
        hand.until(lambda: not hand.is_busy)
    assert hand.do("mdi.buffer")["lines"] == ["G90", "G91"]


def test_mdi_keeps_what_it_executes_only_while_its_buffer_is_on(hand: HandStation) -> None:
    hand.do("mdi.execute", line="G21 G90 G0 X5")
    hand.until(lambda: not hand.is_busy)
    assert hand.do("mdi.buffer", on=False) == {"lines": ["G21 G90 G0 X5"], "on": False}
    hand.do("mdi.execute", line="G0 X6")
    hand.until(lambda: not hand.is_busy)
    assert hand.do("mdi.buffer", lines=["G0 X7"]) == {"lines": ["G0 X7"], "on": False}
    hand.do("mdi.buffer", on=True)
    hand.do("mdi.execute", line="G0 X8")
    hand.until(lambda: not hand.is_busy)
    assert hand.do("mdi.buffer") == {"lines": ["G0 X7", "G0 X8"], "on": True}


def test_an_error_in_mdi_drops_the_blocks_after_it(hand: HandStation) -> None:
    hand.do("mdi.execute", lines=["G21 G90 G0 X5", "G1 Q8", "G0 X50"])
    hand.run(3.0)
    assert hand.station.snapshot.work[0] == 5.0
    assert hand.said[-1] == "MDI:1:4: E206 word has no meaning in this block: Q"
    assert hand.events("alarms")[-1]["active"] == []
    assert hand.station.typed.data()["queue"] == []


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("G1 Q8", "MDI:1:4: E206 word has no meaning in this block: Q"),
        ("G2 X5", "MDI:1:1: E231"),
        ("G1 X5 F0", "MDI:1:7: E222"),
    ],
)
def test_what_only_execution_finds_in_a_block_of_mdi_is_refused_without_an_alarm(
    hand: HandStation, line: str, text: str
) -> None:
    before = hand.places()
    assert text in hand.refused("mdi.execute", line=line)["text"]
    hand.run(0.3)
    assert (hand.places(), hand.state) == (before, "IDLE")
    assert hand.events("alarms")[-1]["history"] == []
    assert hand.do("mdi.buffer")["lines"] == []
    hand.do("mdi.execute", line="G21 G90 G0 X5")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 5.0


def test_a_position_is_set_to_a_value_in_the_unit_of_the_machine(hand: HandStation) -> None:
    hand.do("mdi.execute", line="G20 G90 G0 X1")  # the unit of MDI is another one
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    at = hand.places()
    result = hand.do("zero.preset", values={"X": 12.5, "Z": -3.0})
    assert (result["position"]["X"], result["position"]["Z"]) == (12.5, -3.0)
    hand.run(0.1)
    assert hand.station.snapshot.work[0] == 12.5
    assert hand.station.snapshot.work[2] == -3.0
    assert hand.places() == at
    assert "axis Q is not configured" in hand.refused("zero.preset", values={"Q": 1.0})["text"]


def test_stop_drops_the_blocks_that_wait(hand: HandStation) -> None:
    hand.do("mdi.execute", lines=["G21 G90 G1 X-190 F600", "G0 X0"])
    hand.run(0.5)
    hand.do("stop.hold")
    hand.run(1.0)
    hand.do("run.abort")
    hand.until(lambda: not hand.is_busy)
    at = hand.places()
    hand.run(1.0)
    assert hand.places() == at


def test_teach_makes_the_position_the_zero_of_a_system(hand: HandStation) -> None:
    hand.do("jog.increment", axis="Y", direction=1, distance=3.0, tick=hand.tick)
    hand.until(lambda: not hand.is_busy)
    hand.do("teach.work", system="G54", axes="Y")
    hand.run(0.1)
    assert hand.station.snapshot.work[1] == 0.0
    assert hand.installation.store.read(911) == 3.0


def test_overrides_are_chosen_by_their_clicks(hand: HandStation) -> None:
    hand.do("override.choose", which="feed", click=5)
    hand.run(0.1)
    assert hand.station.snapshot.feed_percent == 50.0
    assert hand.events("overrides")[-1]["feed"]["click"] == 5
    assert hand.refused("override.choose", which="feed", click=16)["code"] == "bad"


def test_the_stop_of_all_drives_is_an_alarm_that_names_its_screen(hand: HandStation) -> None:
    loaded(hand)
    hand.do("name", name="Anna")
    hand.do("run.begin")
    hand.run(0.5)
    hand.do("stop.estop")
    hand.run(0.5)
    assert hand.state == "ALARM"
    (alarm,) = hand.events("alarms")[-1]["active"]  # no excess error of an undriven axis
    assert alarm["text"] == "Stopped at a screen: Anna"
    assert hand.speeds() == (0.0, 0.0, 0.0)
    assert "alarm 9" in hand.refused("run.begin")["text"]
    hand.do("alarm.acknowledge")
    hand.run(0.5)
    assert hand.state == "IDLE"
    at = card_of(hand).p[axes.actual_position[0]]
    assert hand.press(1)["ok"]
    hand.keep(1, 0.5)
    assert card_of(hand).p[axes.actual_position[0]] > at + 1000  # its drive is on again


def test_the_machine_is_set_up_again_when_settings_were_stored(hand: HandStation) -> None:
    before = hand.tick
    hand.installation.store.write(350_000, 1200.0)
    hand.station.settings.note_stored(frozenset({350_000}))
    hand.run(0.1)
    assert hand.tick > before
    assert hand.press(1)["ok"]
    hand.keep(1, 0.5)
    assert hand.speeds(0.04)[0] == pytest.approx(20.0, abs=0.5)


def test_settings_of_motion_wait_for_the_end_of_the_program(hand: HandStation) -> None:
    loaded(hand)
    hand.do("run.begin")
    hand.run(0.3)
    session = hand.station.link.session
    hand.station.settings.note_stored(frozenset({650_002}))
    hand.run(0.3)
    assert hand.station.link.session is session
    hand.do("stop.all")
    hand.until(lambda: hand.station.link.session is not session)


@pytest.mark.parametrize(
    ("lines", "text"),
    [
        (["G1 X1O"], "MDI:1:6: E104 unexpected character"),
        (["G21 G90 G0 X5", "GO X6"], "MDI:2:2: E105 value expected after letter"),
        (["G0 X5", "G0 X6", "G0 X7 X8"], "MDI:3:7: E202 word given twice: X"),
    ],
)
def test_a_typing_error_in_mdi_is_refused_before_anything_runs(
    hand: HandStation, lines: list[str], text: str
) -> None:
    error = hand.refused("mdi.execute", lines=lines)
    assert (error["code"], error["text"]) == ("refused", text)
    hand.run(0.5)
    assert hand.places() == (0.0, 0.0, 0.0)
    assert hand.do("mdi.buffer")["lines"] == []
    assert hand.station.typed.data()["queue"] == []
    assert hand.events("alarms")[-1]["history"] == []
    hand.do("mdi.execute", line="G21 G90 G54 G0 X5")
    hand.until(lambda: not hand.is_busy)


def test_the_run_time_is_0_before_the_first_run_and_stays_after_its_end(hand: HandStation) -> None:
    hand.run(2.0)
    assert hand.station.snapshot.run_s == 0.0
    loaded(hand, "G4 P1.5\nM2\n")
    for _ in range(2):
        begin_s = hand.now_s
        hand.do("run.begin")
        hand.until(lambda: not hand.is_busy)
        taken_s = hand.now_s - begin_s
        hand.run(0.1)
        assert hand.station.snapshot.run_s == pytest.approx(taken_s, abs=0.03)
        assert hand.station.snapshot.run_s > 1.5
        kept_s = hand.station.snapshot.run_s
        hand.run(2.0)
        assert hand.station.snapshot.run_s == kept_s
    hand.press(1)
    hand.keep(1, 0.5)
    assert hand.station.snapshot.run_s == kept_s  # an axis moved by hand is no run


def predicted(hand: HandStation, text: str) -> float:
    """Load a program that is read in full, as the server does; the time it is predicted, s."""
    loaded(hand, text)
    store = hand.installation.store.path
    assert store is not None
    part = hand.station.part.required
    found = read_file(part.file, store, part.dialect, has_path=False)
    hand.station.part.note_facts(part.version, found.facts(), found.findings)
    assert found.seconds is not None
    return found.seconds


def left_s(hand: HandStation) -> float:
    """The time left as the screens show it now."""
    hand.run(0.1)
    return hand.station.snapshot.left_s


def pass_by(hand: HandStation, seconds: float) -> float:
    """Let time pass; how much less time is left then."""
    before_s = left_s(hand)
    hand.run(seconds)
    return before_s - left_s(hand)


TOOLS = "G21 G90 G54\nG1 X20 F600\nG4 P2\nT2 M6\nG1 X0\nM0\nG1 X20\nG0 X200\nM2\n"


def test_the_time_left_passes_with_moves_and_dwells_and_waits_with_everything_else(
    hand: HandStation,
) -> None:
    whole_s = predicted(hand, TOOLS)
    assert isnan(left_s(hand))  # nothing runs
    hand.do("run.begin")
    assert left_s(hand) == pytest.approx(whole_s - 0.1, abs=0.06)
    assert pass_by(hand, 0.5) == pytest.approx(0.6, abs=0.05)
    hand.do("stop.hold")
    hand.run(1.0)
    assert pass_by(hand, 1.0) == 0.0
    hand.do("run.resume")
    hand.until(lambda: hand.station.link.machine.runner.reason.startswith("dwell"))
    assert pass_by(hand, 0.5) == pytest.approx(0.6, abs=0.05)
    hand.do("stop.hold")
    assert pass_by(hand, 1.0) == 0.0
    hand.do("run.resume")
    hand.until(lambda: "tool" in hand.station.link.machine.runner.reason)
    hand.run(0.5)
    assert pass_by(hand, 2.0) == 0.0
    hand.do("run.confirm")
    hand.until(lambda: hand.state == "HOLD")
    assert pass_by(hand, 1.0) == 0.0
    hand.do("run.start")
    hand.until(lambda: hand.station.link.machine.runner.pass_s > whole_s - 0.2)
    hand.until(lambda: not hand.is_busy)
    assert hand.station.link.machine.runner.pass_s == pytest.approx(whole_s, abs=0.2)
    assert isnan(left_s(hand))
    hand.do("home.start", axes="X")
    hand.until(lambda: hand.state == "HOMING")
    assert isnan(left_s(hand))


def test_the_time_left_passes_as_the_override_of_the_move_lets_it(hand: HandStation) -> None:
    read = hand.installation.store.read
    feed, rapid = read(FOV.percents[5]) / 100.0, read(ROV.percents[2]) / 100.0
    predicted(hand, "G21 G90 G54\nG1 X50 F600\nG0 X0 Y200 Z-50\nM2\n")
    hand.do("override.choose", which="feed", click=5)
    hand.do("override.choose", which="rapid", click=2)
    hand.do("run.begin")
    hand.run(0.5)
    assert pass_by(hand, 1.9) == pytest.approx(2.0 * feed, rel=0.02)
    tracker = hand.station.link.machine.runner.stream.tracker
    hand.until(lambda: tracker.current is not None and tracker.current.is_rapid)
    assert pass_by(hand, 1.9) == pytest.approx(2.0 * rapid, rel=0.02)
    assert len({feed, rapid, 1.0}) == 3


def test_a_repeated_program_begins_with_its_whole_time(hand: HandStation) -> None:
    hand.installation.store.write(CONTROL.repeat_forever, 1.0)
    hand.station.settings.must_renew = True  # as where the store tells that it was written
    hand.run(0.1)
    whole_s = predicted(hand, "G21 G90 G54\nG4 P2\nM2\n")
    hand.do("run.begin")
    hand.until(lambda: hand.station.link.machine.runner.passes == 1)
    assert left_s(hand) == pytest.approx(whole_s - 0.1, abs=0.05)
    hand.do("run.abort")
    hand.until(lambda: not hand.is_busy)


@pytest.mark.parametrize("how", [{"dry": True}, {"line": 3, "safe_z": 0.0}])
def test_a_run_without_a_prediction_shows_no_time_left(
    hand: HandStation, how: dict[str, object]
) -> None:
    predicted(hand, "G21 G90 G54\nG1 X20 F600\nG1 X0\nM2\n")
    answer = hand.do("run.begin", **how)
    if "rehearsal" in answer:
        hand.do("run.begin", **how, confirm=answer["rehearsal"]["token"])
    hand.until(lambda: hand.is_busy)
    assert isnan(left_s(hand))
    hand.until(lambda: not hand.is_busy)


def test_a_program_over_a_serial_line_has_not_the_time_left_of_the_loaded_one(
    hand: HandStation,
) -> None:
    predicted(hand, "G21 G90 G54\nG1 X20 F600\nM2\n")
    other = load("G21 G90 G1 X20 F600\nM2\n", hand.installation.store)
    hand.station.link.machine.start(other, Start())
    assert isnan(left_s(hand))
    assert hand.station.part.executing.is_under_way
    hand.until(lambda: not hand.is_busy)


def test_a_block_that_an_alarm_refuses_is_no_line_of_the_mdi_buffer(hand: HandStation) -> None:
    hand.do("home.start", axes="XYZ")
    hand.until(lambda: not hand.is_busy)
    for line in ("G21 G90 G54 G0 X1", "G0 X2"):
        hand.do("mdi.execute", line=line)
        hand.until(lambda: not hand.is_busy)
    hand.do("mdi.execute", line="G0 X9999")
    hand.until(lambda: hand.station.link.machine.runner.alarms.bars_start)
    hand.run(0.1)
    assert hand.do("mdi.buffer")["lines"] == ["G21 G90 G54 G0 X1", "G0 X2"]
    assert hand.events("mdi")[-1]["buffer"] == ["G21 G90 G54 G0 X1", "G0 X2"]
    hand.do("alarm.acknowledge")


def test_a_block_that_was_begun_and_then_stopped_stays_in_the_mdi_buffer(hand: HandStation) -> None:
    hand.do("mdi.execute", line="G21 G90 G54 G1 X100 F600")
    hand.run(0.5)
    hand.station.link.machine.runner.fail("a test")
    hand.until(lambda: not hand.is_busy)
    hand.run(0.1)
    assert hand.do("mdi.buffer")["lines"] == ["G21 G90 G54 G1 X100 F600"]


def test_the_virtual_mill_has_a_spindle_that_turns_both_ways_and_the_screens_show_it(
    hand: HandStation,
) -> None:
    read = hand.installation.store.read
    wired = [int(read(cell)) for cell in (SPINDLE.cw_output, SPINDLE.ccw_output)]
    for block, state, outputs, rpm in (
        ("M3 S1200", 3, [True, False], 1200.0),
        ("M4", 4, [False, True], 1200.0),
        ("M5", 5, [False, False], 0.0),
    ):
        hand.do("mdi.execute", line=block)
        hand.run(0.5)
        assert [hand.station.link.machine.card.read_bit(output) for output in wired] == outputs
        snapshot = hand.station.snapshot
        assert (snapshot.spindle_rpm, bool(snapshot.lights & Light.SPINDLE)) == (rpm, rpm > 0.0)
        assert hand.events("modals")[-1]["spindle"] == state
    loaded(hand, "G21 G90\nM3 S100\nG4 P1\nM5\nM2\n")
    assert [each["code"] for each in hand.station.part.required.findings()] == []


def test_the_screens_show_mist_and_flood_as_they_are_switched(hand: HandStation) -> None:
    for block, mist, flood in (
        ("M8", False, True),
        ("M7", True, True),
        ("M9", False, False),
        ("M7", True, False),
    ):
        hand.do("mdi.execute", line=block)
        hand.run(0.5)
        lights = hand.station.snapshot.lights
        assert (bool(lights & Light.MIST), bool(lights & Light.FLOOD)) == (mist, flood), block
        assert hand.events("modals")[-1]["coolant"] == mist + 2 * flood


@pytest.mark.parametrize("dialect", ["acromill", "rs274ngc"])
def test_the_line_while_a_cycle_drills_is_that_of_the_block_that_calls_it(
    hand: HandStation, dialect: str
) -> None:
    holes = [f"X{x}" for x in range(21, 31)]
    first = ["G21 G90 G54", "G0 X10 Y10 Z60", "G1 X20 F6000", "G81 X20 Y10 Z59.5 R59.7 F300"]
    text = "\n".join([*first, *holes, "G80", "G1 X40", "M2"]) + "\n"
    (hand.installation.programs / "t.nc").write_text(text)
    hand.do("program.load", path="t.nc", dialect=dialect)
    hand.run(0.1)
    hand.do("run.begin")
    seen: list[int] = []
    in_cycle = set()

    def note() -> bool:
        line = hand.station.snapshot.line
        if line and seen[-1:] != [line]:
            seen.append(line)
        if "CYCLES" in hand.events("program")[-1]["file"]:
            in_cycle.add(line)
        return not hand.is_busy and bool(seen)

    hand.until(note)
    assert [line for line in seen if line > 3] == [*range(4, 15), 16]
    assert in_cycle == set(range(4, 15))
    hand.run(0.1)
    assert hand.station.snapshot.line == 0
