"""The tutorial gantry: configuration code, camera cycle and light curtain."""

from itertools import pairwise
from math import sqrt
from pathlib import Path

import pytest
from tests.examples.observe import EXAMPLES, Observation, load, observe
from tests.examples.watches import GANTRY

from openacr.controller import Controller

MOTION, LIFTING, CAMERA, CURTAIN = 516, 548, 34, 10
SLICES_S = 0.003  # a program acts in its own millisecond of the ring
PLACES = [(6, 6), (12, 6), (18, 6), (18, 12), (12, 12), (6, 12)]


@pytest.fixture(scope="module")
def minute() -> Observation:
    return observe(GANTRY)


def lines(text: str) -> list[str]:
    return [line for line in text.split("\r\n") if line]


@pytest.mark.req("ACR-TUT-05", "ACR-TUT-07")
def test_the_camera_visits_six_places_for_five_seconds_each(minute: Observation) -> None:
    departures = minute.rises(MOTION)
    assert [tuple(round(u, 3) for u in event.commanded_u[:2]) for event in departures] == [
        (0.0, 0.0),
        *PLACES,
        *PLACES[: len(departures) - 7],
    ]
    assert all(CAMERA in event.flags for event in departures)
    for before, after in pairwise(departures):
        assert after.time_s - before.time_s == pytest.approx(5.0, abs=SLICES_S)


def test_moves_take_the_time_of_their_ramps_and_cruise(minute: Observation) -> None:
    diagonal, straight = minute.spans_s(MOTION)[:2]
    # 5/10 s up, 5/10 s down, 2.5 in on both ramps, the rest at 5 in/s
    assert diagonal == pytest.approx(1.0 + (6 * sqrt(2) - 2.5) / 5, abs=0.001)
    assert straight == pytest.approx(1.0 + (6 - 2.5) / 5, abs=0.001)


@pytest.mark.req("ACR-TUT-06", "ACR-TUT-08")
def test_the_camera_is_up_while_the_carriage_is_behind_the_curtain(minute: Observation) -> None:
    entries, exits = minute.rises(CURTAIN), minute.falls(CURTAIN)
    assert [round(event.commanded_u[0], 1) for event in entries + exits] == [15.0] * 4
    lifts = minute.rises(LIFTING)
    assert len(lifts) == len(entries) + len(exits) == 4
    for start, edge in zip(lifts, sorted(entries + exits, key=lambda e: e.time_s), strict=True):
        assert 0.0 < start.time_s - edge.time_s <= SLICES_S + 0.002
    # 5 in at 20 in/s2 just reach 10 in/s: half a second up, half a second down
    assert minute.spans_s(LIFTING) == pytest.approx([1.0] * 4, abs=0.002)
    heights = [round(event.commanded_u[2], 3) for event in minute.falls(LIFTING)]
    assert heights == [5.0, 0.0, 5.0, 0.0]


def test_no_axis_lags_or_is_stopped(minute: Observation) -> None:
    for axis in range(3):
        assert 0.0 < minute.card.statistics(axis).peak_following_error_u < 0.2
        assert not any(minute.card.bit[flag + 32 * axis] for flag in (8467, 8477, 8479))
        assert not any(minute.card.bit[flag + 32 * axis] for flag in (16132, 16133))


def test_the_camera_works_at_rest_only_if_the_program_waits(tmp_path: Path) -> None:
    for name in ("machine.toml", "setup.8k", "prog0.8k"):
        text = (EXAMPLES / "gantry" / name).read_text()
        (tmp_path / name).write_text(text.replace("SET 34", "INH -516\nSET 34"))
    card = Controller.from_project(tmp_path)
    card.send("PROG 0\rRUN\r")
    for place in PLACES:
        assert card.until(CAMERA, timeout_s=10.0)
        started_s = card.time_s
        card.advance(seconds=0.1)
        assert [card.axis(0).actual_u, card.axis(1).actual_u] == pytest.approx(place, abs=0.001)
        assert card.until(CAMERA, is_=False, timeout_s=10.0)
        assert card.time_s - started_s == pytest.approx(5.0, abs=SLICES_S)


@pytest.mark.req("ACR-WIZ-18", "ACR-WIZ-19", "ACR-TUT-03")
def test_the_card_reports_what_the_configuration_code_has_set() -> None:
    card = load("gantry")
    card.send("ECHO 6\rPROG0\r")
    reports = {
        "PPU X": "40000",  # 39999.999404 in single precision
        "EXC Y": "0.2,-0.2",
        "TLM X": "10,-10",
        "ACC": "10",
        "VEL": "5",
        "STP": "10",
    }
    for command, report in reports.items():
        assert card.send(f"{command}\r").strip() == report, command
    assert lines(card.send("ATTACH\r")) == [
        "ATTACH MASTER0",
        'ATTACH SLAVE0 AXIS0 "X"',
        'ATTACH SLAVE1 AXIS1 "Y"',
    ]
    card.send("PROG1\r")
    assert lines(card.send("ATTACH\r")) == ["ATTACH MASTER1", 'ATTACH SLAVE0 AXIS2 "Z"']
    assert [card.send(f"{name}\r").strip() for name in ("ACC", "DEC", "VEL")] == ["20", "20", "10"]
    assert [card.send(f"AXIS{axis}\r").strip() for axis in (2, 3, 7)] == ["ON", "OFF", "OFF"]


@pytest.mark.req("ACR-LIM-02", "ACR-LIM-03", "ACR-LIM-04", "ACR-LIM-16")
def test_a_closed_contact_that_opens_stops_its_master_and_no_other() -> None:
    card = load("gantry")
    assert card.bit[0]
    assert not card.bit[16128]  # the switch is closed, so the limit is not active
    card.send("PROG0\rDRIVE ON X Y\r")
    card.advance(seconds=0.2)
    card.send("X24 Y1\r")
    card.until(MOTION, is_=False)
    card.send("PROG1\rDRIVE ON Z\r")
    card.advance(seconds=0.2)
    card.send("VEL 0.5 Z5\rPROG0\rJOG VEL X5\rJOG ACC X100\rJOG FWD X\r")
    assert card.until(16132, timeout_s=5.0)
    assert not card.bit[0]
    at_u, speed_ups = card.axis(0).commanded_u, card.axis(0).velocity_ups
    assert at_u == pytest.approx(24.5, abs=0.01)
    card.advance(seconds=0.5)
    # HLDEC 500 from 5 in/s
    assert card.axis(0).commanded_u - at_u == pytest.approx(speed_ups**2 / 1000, abs=0.003)
    assert all(card.bit[flag] for flag in (8467, 8499, 522))
    assert not any(card.bit[flag] for flag in (8531, 554))
    assert card.axis(2).velocity_ups == pytest.approx(0.5)
