"""Axes of a card excited, recorded, identified and given gains."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from tests.tuning.worlds import WORLD, true_motor

import openacr
from openacr.client import Card, Level
from openacr.errors import UserError
from openacr.tuning import measure as measuring
from openacr.tuning.excitation import Excitation
from openacr.tuning.identify import identify
from openacr.tuning.measure import Measurement, require_rest, settings_of, stop
from openacr.tuning.predict import figures
from openacr.tuning.propose import Wish, propose
from openacr.tuning.twin import run

SET_UP = [
    *("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS1 "Y"', "MULT Y4"),
    *("PGAIN Y0.006 DGAIN Y0.00007", "DRIVE ON Y"),
]
SHORT = Excitation(duration_s=0.5)
CAM = ["DIM LA1", "DIM LA0(2)", "CAM DIM Y1", "CAM SEG Y(0,100,LA0)"]
GAINS = range(12544 + 16, 12544 + 24)


@pytest.fixture
def card(host: openacr.Controller) -> Iterator[Card]:
    with Card.open(host) as found:
        for line in SET_UP:
            found.command(line)
        found.pause(0.1)
        yield found


def measure(card: Card, axis: int, excitation: Excitation, **more: Any) -> Measurement:
    return card.perform(lambda talk: measuring.measure(talk, axis, excitation, **more))


def test_the_motor_of_the_machine_file_is_found_over_the_link_of_the_card(card: Card) -> None:
    card.go(Level())
    before = card.command("DIM"), card.read("axis1.jog offset")
    found = measure(card, 1, Excitation())
    motor = identify(found.settings, found.record, (2.0, 60.0))
    assert len(found.record.setpoint_cnt) == 3600  # 1.5 s and 0.3 s of rest at 2 kHz
    assert motor.is_sure
    expected = true_motor(WORLD)
    assert motor.motor.accel_per_volt == pytest.approx(expected.accel_per_volt, rel=0.01)
    assert motor.motor.coulomb_accel == pytest.approx(expected.coulomb_accel, rel=0.05)
    assert abs(motor.motor.rate_per_s - expected.rate_per_s) < 3.0
    assert motor.motor.delay_tk == pytest.approx(0.0, abs=0.2)
    card.go(Level())
    assert (card.command("DIM"), card.read("axis1.jog offset")) == before
    assert card.listing(Level.program(7)) == []
    assert card.command("SAMP") == ["SAMP PERIOD 0"]


def test_gains_are_tried_and_stay_and_the_card_does_what_was_predicted(card: Card) -> None:
    first = measure(card, 1, SHORT)
    motor = identify(first.settings, first.record, (2.0, 60.0)).motor
    proposal = propose(first.settings, motor, Wish(bandwidth_hz=40.0))
    step = Excitation("step", 100.0, duration_s=0.3)
    tried = measure(card, 1, step, gains=proposal.gains)
    assert [card.read(row) for row in GAINS] == pytest.approx(list(proposal.gains.values()))
    predicted = run(tried.settings, motor, tried.record.setpoint_cnt, tried.record)
    assert figures(tried.record).overshoot_percent > 5.0
    assert np.abs(predicted.actual_cnt - tried.record.actual_cnt).max() <= 6.0


def test_the_card_sets_the_former_gains_where_new_ones_swing_beyond_the_bounds(card: Card) -> None:
    before = [card.read(row) for row in GAINS]
    with pytest.raises(UserError) as refused:
        measure(card, 1, SHORT, gains={"PGAIN": 0.2, "DGAIN": 0.0})
    assert "than 400 pulses;" in str(refused.value) or "exceeded 400" in str(refused.value)
    assert str(refused.value).endswith("; what was changed was taken back")
    assert [card.read(row) for row in GAINS] == before
    assert card.read("axis1.jog offset") == 0
    card.pause(0.5)
    card.perform(lambda talk: require_rest(talk, 1, 20.0))


def test_gains_that_swing_within_the_bounds_are_taken_back_too(card: Card) -> None:
    before = [card.read(row) for row in GAINS]
    wide = Excitation(duration_s=0.5, error_cnt=20_000.0, travel_cnt=20_000.0)
    with pytest.raises(UserError, match=r"axis 1 swings by \d+ pulses; what was changed was taken"):
        measure(card, 1, wide, gains={"PGAIN": 0.05, "DGAIN": 0.0})
    assert [card.read(row) for row in GAINS] == before


@pytest.mark.parametrize(
    ("bounds", "reason"),
    [
        ({"error_cnt": 100.0}, "the following error exceeded 100 pulses"),
        ({"travel_cnt": 100.0}, "the axis went further than 100 pulses"),
    ],
)
def test_a_bound_ends_the_excitation(card: Card, bounds: dict[str, Any], reason: str) -> None:
    card.command("AXIS1 DGAIN 0")  # it overshoots
    with pytest.raises(UserError, match=f"axis 1: ended, because {reason}"):
        measure(card, 1, Excitation("step", 100.0, duration_s=0.3, **bounds))
    assert card.read("axis1.jog offset") == 0


def test_a_stop_from_another_connection_takes_the_excitation_back(
    card: Card, host: openacr.Controller
) -> None:
    with Card.open(host) as other, pytest.raises(UserError) as ended:
        measure(card, 1, SHORT, progress=lambda done, count: other.perform(stop))
    assert str(ended.value) == (
        "axis 1: ended, because it was stopped; what was changed was taken back"
    )
    assert card.read("axis1.jog offset") == 0


def test_ctrl_c_takes_the_excitation_back_and_erases_the_program(card: Card) -> None:
    def interrupt(done: int, count: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        measure(card, 1, SHORT, progress=interrupt)
    assert card.read("axis1.jog offset") == 0
    assert card.listing(Level.program(7)) == []


def test_a_kill_ends_the_excitation(card: Card, host: openacr.Controller) -> None:
    def kill(done: int, count: int) -> None:
        host.bit[8499] = True

    with pytest.raises(UserError, match=r"its motion was killed \(a limit, a fault, or an op"):
        measure(card, 1, SHORT, progress=kill)
    assert card.read("axis1.jog offset") == 0


def test_a_lost_host_leaves_an_axis_that_comes_back_by_itself(
    card: Card, host: openacr.Controller
) -> None:
    before = [card.read(row) for row in GAINS]
    card.download(SHORT.checked().program(1, 0.0005, {"DGAIN": 0.0001}), to=Level.program(7))
    card.command("RUN", program=7)
    card.pause(0.2)
    assert host.p[12544 + 7] != 0  # under way
    card.close()
    host.advance(seconds=5.0)
    assert not host.bit[1031]  # PROG7 has ended
    assert (host.p[12544 + 9], host.p[12544 + 7]) == (0, 0)
    assert host.p[GAINS[4]] == pytest.approx(0.0001)
    # its program is no obstacle for the next one
    with Card.open(host) as other:
        measure(other, 1, SHORT, gains={"DGAIN": before[4]})
        assert other.listing(Level.program(7)) == []


@pytest.mark.parametrize(
    ("lines", "text"),
    [
        (["SET 8499"], "axis 1: its motion is killed: CLR 8499, or Ctrl-Y"),
        (["SET 817"], "axis 1: its servo loop is open: CLR 817"),
        (["DRIVE OFF Y", "SET 8500"], "axis 1 is not enabled: DRIVE ON"),
        (["JOG VEL Y1 JOG ACC Y1", "JOG FWD Y"], "axis 1 jogs: it has to be at rest"),
        (["GEAR SRC Y ENC5", "GEAR ON Y"], "axis 1 is geared: it has to be at rest"),
        ([*CAM, "CAM ON Y"], "axis 1 follows a cam: it has to be at rest"),
        (["AXIS1 KVP 1"], "KVP: the PV loop takes the place of the gains that are tuned: it is 1,"),
        (["SET 104"], "the sampler of the card is in use: SAMP CLEAR frees it"),
        (["VEL 20", "Y1000"], "axis 1 moves: it has to be at rest"),
        (
            ["PGAIN Y0", "DGAIN Y0", "P12553=101", "DWL 0.05"],
            "axis 1 is 101 pulses from its setpoint: at most 100 (is its drive off?)",
        ),
        (["AXIS1 OFF"], "axis 1 is off: ATTACH it, or AXIS1 ON"),
    ],
)
def test_an_axis_that_is_not_at_rest_and_enabled_is_refused(
    card: Card, lines: list[str], text: str
) -> None:
    if lines == ["SET 104"]:
        lines = ["DIM LA1", "DIM LA0(1000)", "SAMP 0 SRC P0", "SAMP 0 BASE LA0", *lines]
    for line in lines:
        card.command(line)
    jog = card.read("axis1.jog offset")
    with pytest.raises(UserError) as refused:
        measure(card, 1, SHORT)
    assert str(refused.value).startswith(text)
    if "jogs" not in text:
        assert card.read("axis1.jog offset") == jog


def test_a_card_that_does_not_follow_its_jog_offset_is_noticed(
    card: Card, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Excitation, "_height", lambda _excitation: "0")
    with pytest.raises(UserError) as refused:
        measure(card, 1, SHORT)
    text = "axis 1: its setpoint does not follow the jog offset of the card"
    assert str(refused.value) == text


def test_a_measurement_needs_an_empty_program_with_memory(card: Card) -> None:
    with pytest.raises(UserError) as refused:
        measure(card, 1, Excitation(duration_s=5.0))
    assert str(refused.value) == (
        "no empty program has 135392 bytes (the largest has 65536): less time (2.05 s fit), or"
        " DIM PROG7(135392)"
    )
    card.command("10 REM mine", program=7)
    card.go(Level())
    with pytest.raises(UserError, match="PROG7 of the card is not empty: NEW erases one"):
        measure(card, 1, SHORT, program=7)
    with pytest.raises(UserError, match=r"the largest has 65536.*DIM PROG6\("):
        measure(card, 1, Excitation(duration_s=5.0))
    measure(card, 1, SHORT)  # PROG6
    assert [line.text for line in card.listing(Level.program(7))] == ["REM mine"]


def test_a_program_that_no_time_fits_is_named_with_the_memory_it_needs(card: Card) -> None:
    with pytest.raises(UserError) as refused:
        measure(card, 1, Excitation(is_shortened=True), program=15)
    text = "PROG15 does not have 51392 bytes (the largest has 0): DIM PROG15(51392)"
    assert str(refused.value) == text


def test_a_sweep_takes_the_time_that_an_empty_program_has_room_for(card: Card) -> None:
    long = Excitation(duration_s=5.0, is_shortened=True)
    found = measure(card, 1, long)
    assert found.excitation.duration_s == 2.05
    assert len(found.record.setpoint_cnt) == 4700  # 2.05 s and 0.3 s of rest at 2 kHz
    assert found.excitation.memory_bytes(0.0005) <= 65536
    assert long.fitting(64592, 0.0005).duration_s == 2.05  # what it needs, to the byte
    assert long.fitting(64591, 0.0005).duration_s == 2.0
    assert Excitation(is_shortened=True).fitting(20192, 0.0005).duration_s == 0.2
    short = Excitation(is_shortened=True)
    assert short.fitting(20191, 0.0005) is short


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"height_cnt": 4.9}, "amplitude [pulses] 4.9: from 5 to 100000"),
        ({"duration_s": 10.1}, "time [s] 10.1: from 0.2 to 10"),
        ({"low_hz": 61.0}, "lowest frequency [Hz] 61: from 0.2 to 60"),
        ({"high_hz": 1.9}, "lowest frequency [Hz] 2: from 0.2 to 1.9"),
        ({"error_cnt": 99.0}, "bounds below the amplitude of 100 pulses end it early"),
    ],
)
def test_an_excitation_out_of_range_is_refused(wrong: dict[str, float], text: str) -> None:
    with pytest.raises(UserError) as refused:
        Excitation(**wrong).checked()  # type: ignore[arg-type]
    assert str(refused.value) == text


def test_bounds_are_four_times_the_amplitude_unless_given() -> None:
    assert (Excitation().checked().error_cnt, Excitation().checked().travel_cnt) == (400.0, 400.0)
    given = Excitation(error_cnt=100.0, travel_cnt=101.0).checked()
    assert (given.error_cnt, given.travel_cnt) == (100.0, 101.0)


def test_settings_are_those_of_the_axis(card: Card) -> None:
    card.command("AXIS1 LOPASS 200")
    found = card.perform(lambda talk: settings_of(talk, 1))
    assert (found.gain("PGAIN"), found.gain("DGAIN")) == pytest.approx((0.006, 0.00007))
    assert (found.is_filtering, found.period_s, len(found.coefficients())) == (True, 0.0005, 2)
