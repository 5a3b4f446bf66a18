"""Servo tuning from the screens, on a station driven by hand."""

import os
import signal
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.panel.bench import JOBS_S, HandStation, is_alive
from tests.waiting import until

from openacr.errors import UserError
from openacr.map.rows import compliant_loads
from openacr.panel.control.engineer import tuning
from openacr.panel.control.interlocks import MEASURED
from openacr.panel.control.jobs import KILLED
from openacr.panel.control.operator.orders import Order
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role
from openacr.sysvar.tabs import SERVO

SHORT = {"axis": "X", "time_s": 0.5, "bandwidth_hz": 30.0}
NAP_S = 2.0 * JOBS_S  # longer than any test waits


def jog_offset(hand: HandStation) -> float:
    return float(hand.station.link.machine.card.read("axis0.jog offset"))


def begun(hand: HandStation, name: str, **args: Any) -> list[dict[str, Any]]:
    """Give a command and let the axis begin to move; its answer comes into the list."""
    answers: list[dict[str, Any]] = []
    hand.station.order(Order(hand.me, name, args, hand.now_s, answers.append), hand.now_s)
    hand.until(lambda: jog_offset(hand) != 0.0 or bool(answers), limit_s=10.0)
    assert answers == []
    return answers


def test_an_axis_is_measured_and_gets_what_was_proposed(hand: HandStation) -> None:
    assert "measure it first" in hand.refused("tune.apply", axis="X")["text"]
    found = hand.do("tune.measure", **SHORT)
    assert found["is_sure"] is True
    assert found["refusal"] == ""
    assert found["proposed"]["margins"]["crossover_hz"] == pytest.approx(30.0, rel=1e-3)
    assert max(found["measured"]["actual_cnt"]) > 50
    assert hand.events("tune")[-1] == {"event": "tune", "done": 1600, "count": 1600, "to": 1}
    record = found["measured"]
    error = np.subtract(record["setpoint_cnt"], record["actual_cnt"])
    present, proposed = (found[name]["rms_error_cnt"] for name in ("present", "proposed"))
    assert present == pytest.approx(float(np.sqrt(np.mean(error**2))), rel=1e-4)
    assert 0.2 * present < proposed < 5.0 * present
    assert proposed != present
    before = found["present"]["gains"]
    assert hand.do("tune.gains", axis="x")["P Gain"] == pytest.approx(before["PGAIN"])
    applied = hand.do("tune.apply", axis="x", store=True)
    gains = found["proposed"]["gains"]
    assert applied["gains"] == gains
    gap = np.subtract(applied["measured"]["actual_cnt"], applied["predicted"]["actual_cnt"])
    assert np.abs(gap).max() <= 10.0
    read = hand.station.link.machine.card.read
    assert read("axis0.proportional gain") == pytest.approx(gains["PGAIN"]) != before["PGAIN"]
    assert hand.do("tune.gains", axis="x")["P Gain"] == pytest.approx(gains["PGAIN"], rel=1e-6)
    stored = hand.station.installation.store.read(SERVO.p_gain[0])
    assert stored == pytest.approx(gains["PGAIN"])


def test_a_step_with_the_present_gains_is_recorded_and_changes_nothing(hand: HandStation) -> None:
    read = hand.station.link.machine.card.read
    before = read("axis0.proportional gain")
    assert "from 5 to" in hand.refused("tune.step", axis="X", amplitude=4.0)["text"]
    found = hand.do("tune.step", axis="x", amplitude=50.0)
    record = found["measured"]
    assert (found["gains"], found["predicted"]) == ({}, None)
    assert (min(record["setpoint_cnt"]), max(record["setpoint_cnt"])) == (0.0, 50.0)
    assert record["setpoint_cnt"][-1] == 0.0
    shares = np.array(record["actual_cnt"])[np.array(record["setpoint_cnt"]) == 50.0] / 50.0
    overshoot = 100.0 * max(0.0, shares.max() - 1.0)
    assert found["figures"]["overshoot_percent"] == pytest.approx(overshoot, abs=2.0)
    assert 0.0 < found["figures"]["rise_s"] <= 0.3
    assert (read("axis0.proportional gain"), jog_offset(hand)) == (before, 0.0)
    hand.do("tune.measure", **SHORT)
    predicted = hand.do("tune.step", axis="X")["predicted"]
    assert max(predicted["actual_cnt"]) > 90.0


def without_step(*_args: object) -> object:
    """In the process that computes: a record of which nothing can be said."""
    raise UserError("the record has no step")


def killed(*_args: object) -> object:
    """In the process that computes: its end, as a system short of memory brings it about."""
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(NAP_S)
    return None


def napping(note: Path, *_args: object) -> object:
    """In the process that computes: note its number, then compute for long."""
    note.with_suffix(".new").write_text(str(os.getpid()))
    note.with_suffix(".new").replace(note)
    time.sleep(NAP_S)
    return None


def computing(hand: HandStation, note: Path, answers: list[dict[str, Any]]) -> int:
    """Let time pass until the process computes; its number."""
    until(note.exists, limit_s=JOBS_S, step=lambda: hand.run(0.01))
    assert answers == []
    return int(note.read_text())


def test_a_step_that_cannot_be_computed_is_answered_with_the_reason(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tuning, "stepped", without_step)
    assert hand.refused("tune.step", axis="X")["text"] == "the record has no step"
    monkeypatch.undo()
    assert hand.do("tune.step", axis="X")["predicted"] is None


def test_what_a_killed_process_was_computing_is_refused_and_the_next_one_computes(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tuning, "stepped", killed)
    assert hand.refused("tune.step", axis="X") == {"code": "refused", "text": KILLED}
    assert not hand.station.tuning.is_moving
    monkeypatch.undo()
    assert hand.do("tune.step", axis="X")["figures"]["rise_s"] > 0.0


def test_the_station_goes_on_while_another_process_computes_until_it_is_killed(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    note = tmp_path / "process"
    monkeypatch.setattr(tuning, "stepped", partial(napping, note))
    answers = begun(hand, "tune.step", axis="X")
    process = computing(hand, note, answers)
    assert process != os.getpid()
    before, tick = hand.places()[0], hand.tick
    hand.send("mdi.execute", line="G21 G91 G1 X2 F3000")
    hand.run(1.0)
    assert hand.places()[0] == pytest.approx(before + 2.0, abs=0.01)
    assert hand.tick - tick == pytest.approx(1000.0, abs=60.0)
    assert answers == []
    os.kill(process, signal.SIGTERM)
    hand.until(lambda: bool(answers))
    assert answers == [{"ok": False, "error": {"code": "refused", "text": KILLED}}]


def test_what_is_computed_ends_with_the_panel(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    note = tmp_path / "process"
    monkeypatch.setattr(tuning, "stepped", partial(napping, note))
    answers = begun(hand, "tune.step", axis="X")
    process = computing(hand, note, answers)
    hand.close()
    until(lambda: not is_alive(process), limit_s=JOBS_S)
    assert answers == []


def test_gains_proposed_for_a_former_session_are_not_set(
    hand: HandStation,
) -> None:
    answers = begun(hand, "tune.measure", **SHORT)
    while hand.station.tuning.is_moving:
        hand.run(0.01)
    hand.station.renew(hand.now_s)  # while it computes
    hand.until(lambda: bool(answers))
    assert answers[0]["ok"]
    assert "measure it first" in hand.refused("tune.apply", axis="X")["text"]


def test_an_emergency_stop_ends_the_measurement_with_its_program(hand: HandStation) -> None:
    answers = begun(hand, "tune.measure", **SHORT)
    hand.do("stop.estop")
    hand.run(1.0)
    hand.do("alarm.acknowledge")
    assert jog_offset(hand) == 0.0  # what the excitation has left is position
    hand.until(lambda: bool(answers))
    assert answers[0]["error"]["text"] == "PROG6: 0 of 1600 samples came: was it halted?"
    assert not hand.station.tuning.is_moving


@pytest.mark.parametrize("word", ["stop.hold", "stop.all"])
def test_every_stop_ends_the_excitation_and_the_card_takes_it_back(
    hand: HandStation, word: str
) -> None:
    answers = begun(hand, "tune.measure", **SHORT)
    assert "an axis is measured" in hand.refused("mdi.execute", line="G91 G1 X1 F100")["text"]
    assert "an axis is measured" in hand.refused("tune.measure", **SHORT)["text"]
    hand.do(word)
    hand.run(0.02)
    assert jog_offset(hand) == 0.0
    hand.until(lambda: bool(answers))
    assert answers[0]["error"]["text"].startswith("axis 0: ended, because it")
    assert not hand.station.tuning.is_moving


def test_a_browser_that_goes_ends_what_it_has_moved(hand: HandStation) -> None:
    answers = begun(hand, "tune.measure", **SHORT)
    hand.station.leave(99)
    hand.run(0.02)
    assert hand.station.link.machine.card.read_bit(104)
    hand.station.leave(1)
    hand.run(0.02)
    assert jog_offset(hand) == 0.0
    hand.until(lambda: bool(answers))
    assert "it was stopped" in answers[0]["error"]["text"]


@pytest.mark.parametrize(
    ("name", "args"),
    [
        ("timeline.pause", {}),
        ("timeline.run", {"speed": 0.1}),
        ("timeline.seek", {"tick": 0}),
        ("timeline.switch", {"number": 0}),
        *[("timeline.step", {"what": what}) for what in ("tick", "back", "line", "move")],
    ],
)
def test_the_time_of_the_card_goes_its_course_while_an_axis_is_measured(
    hand: HandStation, name: str, args: dict[str, Any]
) -> None:
    tick = hand.station.times.history.lived_tk
    answers = begun(hand, "tune.step", axis="X")
    args = args | ({"tick": tick} if "tick" in args else {})
    assert hand.refused(name, **args) == {"code": "refused", "text": MEASURED}
    hand.until(lambda: bool(answers))
    assert answers[0]["ok"]


def test_settings_that_are_stored_while_an_axis_is_measured_count_at_rest(
    hand: HandStation,
) -> None:
    session = hand.station.link.machine
    answers = begun(hand, "tune.step", axis="X")
    hand.station.installation.store.write(SERVO.p_gain[0], 0.002)
    hand.station.settings.note_stored(frozenset({SERVO.p_gain[0]}))
    hand.until(lambda: bool(answers))
    assert answers[0]["ok"]
    hand.run(0.1)
    assert hand.station.link.machine is not session


def test_what_is_done_at_rest_only_is_refused_while_an_axis_is_measured(hand: HandStation) -> None:
    answers = begun(hand, "tune.step", axis="X")
    wishes: dict[str, dict[str, Any]] = {
        "memory.read": {},
        "card.query": {"line": "MEM"},
        "card.send": {"program": 5, "text": "PROGRAM\nENDP\n"},
        "teach.length": {"h": 1},
        "teach.work": {"system": "G54"},
        "app.end": {},
    }
    refused = {name: hand.refused(name, **args)["text"] for name, args in wishes.items()}
    assert refused == {
        "memory.read": "the machine moves: the memory is shown and changed at rest only",
        "card.query": "the machine moves: only lines that begin with ? are sent",
        "card.send": "the machine moves: no program of the card is changed",
        "teach.length": "the machine is moving: a length can be taught only at rest",
        "teach.work": "the machine is moving: a work system can be taught only at rest",
        "app.end": "the machine is working: stop it first",
    }
    hand.until(lambda: bool(answers))
    assert answers[0]["ok"]


def test_only_the_service_measures_and_only_at_rest(hand: HandStation) -> None:
    other = Person(2, Role.SETUP, "10.0.0.2")
    hand.station.join(other)
    assert hand.send("tune.measure", who=other, axis="X")["error"]["needs"] == "service"
    hand.do("mdi.execute", line="G21 G91 G1 X50 F600")
    hand.run(0.3)
    assert not hand.send("tune.measure", axis="X")["ok"]
    assert jog_offset(hand) == 0.0


def test_what_is_out_of_range_is_refused_before_anything_moves(hand: HandStation) -> None:
    assert hand.refused("tune.measure", axis="X", amplitude=4.0)["text"] == (
        "amplitude [pulses] 4: from 5 to 100000"
    )
    assert "Q" in hand.refused("tune.measure", axis="Q")["text"]


def test_gains_that_need_a_notch_are_not_kept_without_it(hand: HandStation) -> None:
    controller = hand.installation.controller
    assert controller is not None
    for place, value in (
        (compliant_loads.damping_per_s, 60.0),
        (compliant_loads.inertia_ratio, 1.0),
        (compliant_loads.resonance_rad_s, 2000.0),
    ):
        controller.memory.F[place[0]] = value
    found = hand.do("tune.measure", axis="X", time_s=1.2, high_hz=500.0)
    assert found["proposed"]["filters"]["notch_hz"] == pytest.approx(318.3, rel=0.02)
    text = hand.refused("tune.apply", axis="X", store=True)["text"]
    assert text.startswith("the parameters of the machine have no NOTCH and LOPASS")
