"""Held keys and increments of an axis that only a program of the card has: Z of the gantry."""

from typing import Any

import pytest
from tests.panel.bench import STEP_S, HandStation, card_of

from openacr.client import Card
from openacr.map.rows import axes
from openacr.map.words import af1
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role

Z = 2
SPEED = 0.1  # in/s; JOG DEC 100: a ramp of 1 ms
REST_S = 0.22  # of card time, from the last sign of the browser


def position(hand: HandStation) -> float:
    """The commanded position of Z in its units."""
    pulses = card_of(hand).p[axes.primary_setpoint[Z]]
    return float(pulses / card_of(hand).p[axes.ppu[Z]])


def is_jogged(hand: HandStation) -> bool:
    return bool(int(card_of(hand).p[af1.word[Z]]) & af1.JOG_ACTIVE)


def press(hand: HandStation, number: int = 1, direction: int = 1, **more: Any) -> Any:
    return hand.press(number, "AXIS2", direction, **{"speed": SPEED, **more})


def ended(hand: HandStation) -> list[tuple[int, str]]:
    return [(event["press"], event["ended"]) for event in hand.events("jog")]


def time_to_rest(hand: HandStation) -> float:
    """Card time until Z rests [s]; at most a second."""
    first_s = card_of(hand).time_s
    while is_jogged(hand) and card_of(hand).time_s < first_s + 1.0:
        hand.run(STEP_S)
    return card_of(hand).time_s - first_s


def test_the_axis_moves_with_the_speed_of_the_pane_while_its_key_is_held(
    gantry: HandStation,
) -> None:
    assert press(gantry)["ok"]
    gantry.keep(1, 1.0)
    before = position(gantry)
    gantry.keep(1, 0.5)
    assert position(gantry) - before == pytest.approx(0.5 * SPEED, rel=0.01)
    gantry.do("jog.release", press=1)
    assert time_to_rest(gantry) <= 0.02
    assert ended(gantry) == [(1, "released")]


def test_at_rest_the_jog_is_position_and_the_axis_has_its_own_jog_speed(
    gantry: HandStation,
) -> None:
    card_of(gantry).p[axes.jog_veloc_setting[Z]] = 0.25
    press(gantry, direction=-1)
    gantry.keep(1, 0.3)
    assert card_of(gantry).p[axes.jog_veloc_setting[Z]] == pytest.approx(SPEED)
    gantry.do("jog.release", press=1)
    gantry.run(0.1)
    at = position(gantry)
    assert at < -0.02
    assert card_of(gantry).p[axes.jog_offset[Z]] == 0.0
    assert card_of(gantry).p[axes.current_position[Z]] / 40000 == pytest.approx(at)
    assert card_of(gantry).p[axes.jog_veloc_setting[Z]] == 0.25


def test_a_link_that_is_frozen_has_the_axis_at_rest_within_220_ms(gantry: HandStation) -> None:
    press(gantry)
    gantry.keep(1, 0.5)
    assert 0.19 <= time_to_rest(gantry) <= REST_S
    assert ended(gantry) == [(1, "silence")]
    at = position(gantry)
    gantry.keep(1, 0.5)
    assert not press(gantry, 1)["ok"]
    assert position(gantry) == at


def test_a_page_that_shows_old_positions_has_the_axis_at_rest(gantry: HandStation) -> None:
    press(gantry)
    tick = gantry.tick
    for _ in range(20):
        gantry.run(0.05)
        gantry.send("jog.keep", press=1, tick=tick)
    assert ended(gantry) == [(1, "silence")]
    assert position(gantry) < 0.42 * SPEED
    assert press(gantry, 2, tick=tick)["error"]["code"] == "stale"


def test_a_browser_that_is_cut_off_leaves_the_axis_at_rest(gantry: HandStation) -> None:
    press(gantry)
    gantry.keep(1, 0.2)
    gantry.station.leave(1)
    assert time_to_rest(gantry) <= 0.02
    assert ended(gantry) == [(1, "link")]


@pytest.mark.parametrize("stop", ["stop.hold", "stop.all", "stop.estop", "jog.stop"])
@pytest.mark.parametrize("is_held", [True, False])
def test_every_stop_ends_the_jog(gantry: HandStation, stop: str, is_held: bool) -> None:
    if is_held:
        press(gantry)
    else:
        gantry.do(
            "jog.increment", axis="AXIS2", direction=1, distance=5.0, speed=SPEED, tick=gantry.tick
        )
    gantry.run(0.15)
    assert is_jogged(gantry)
    viewer = Person(9, Role.VIEW, "10.0.0.9")
    gantry.station.join(viewer)
    assert gantry.send(stop, who=viewer)["ok"]
    assert time_to_rest(gantry) <= 0.02
    at = position(gantry)
    gantry.run(0.7)
    assert position(gantry) == at


def test_a_second_browser_moves_nothing_and_taking_control_stops_the_first(
    gantry: HandStation,
) -> None:
    other = Person(2, Role.OPERATE, "10.0.0.2")
    gantry.station.join(other)
    press(gantry)
    gantry.keep(1, 0.2)
    assert press(gantry, 1, who=other)["error"]["code"] == "control"
    assert ended(gantry) == []
    assert gantry.send("control.take", who=other, force=True)["ok"]
    assert time_to_rest(gantry) <= 0.02
    assert ended(gantry) == [(1, "control")]


def test_two_keys_of_the_axis_stop_both(gantry: HandStation) -> None:
    press(gantry)
    gantry.keep(1, 0.1)
    assert press(gantry, 2, -1)["error"]["text"].endswith("is jogged by another key: both stop")
    assert time_to_rest(gantry) <= 0.02


def test_a_host_that_does_nothing_more_leaves_the_axis_at_rest(gantry: HandStation) -> None:
    press(gantry)
    gantry.keep(1, 0.3)
    card_of(gantry).advance(seconds=0.6)
    at = position(gantry)
    assert not is_jogged(gantry)
    card_of(gantry).advance(seconds=0.5)
    assert position(gantry) == at


def test_an_increment_is_made_whole_in_units_of_the_axis(gantry: HandStation) -> None:
    at = position(gantry)
    step = {"axis": "AXIS2", "distance": 0.25, "speed": 0.2}
    gantry.do("jog.increment", direction=1, tick=gantry.tick, **step)
    assert "still moving" in press(gantry)["error"]["text"]
    gantry.until(lambda: not gantry.station.card_jogs.are_active)
    assert position(gantry) == pytest.approx(at + 0.25, abs=1e-6)
    gantry.do("jog.increment", direction=-1, tick=gantry.tick, **step)
    gantry.until(lambda: not gantry.station.card_jogs.are_active)
    assert position(gantry) == pytest.approx(at, abs=1e-6)


def typed(hand: HandStation, *lines: str) -> None:
    with Card.open(card_of(hand)) as there:
        for line in lines:
            there.command(line, program=1)
    hand.run(0.1)


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (("SET 8532", "DRIVE OFF Z"), "the drive of axis {} is off: DRIVE ON {} switches it on"),
        (("SET 8531",), "the motion of axis {} is killed"),
        (("JOG DEC Z0",), "axis {} has no jog ramps (JOG ACC 100, JOG DEC 0)"),
        (("JOG ACC Z0",), "axis {} has no jog ramps (JOG ACC 0, JOG DEC 100)"),
        (("JOG VEL Z0.1", "JOG FWD Z"), "axis {} is still moving"),
        (("RUN PROG1",), "PROG1 runs and may move axis {}: STOP or HALT it first"),
        (("F0.1", "Z9"), "MASTER1 has a move under way: wait until axis {} rests"),
    ],
)
def test_an_axis_that_may_not_be_moved_says_why(
    gantry: HandStation, lines: tuple[str, ...], why: str
) -> None:
    typed(gantry, *lines)
    name = gantry.installation.axis_name(Z)
    at = card_of(gantry).p[axes.jog_offset[Z]]
    assert why.format(name, name) in press(gantry)["error"]["text"]
    assert ended(gantry) == []
    if "JOG FWD Z" not in lines:
        gantry.run(0.3)
        assert card_of(gantry).p[axes.jog_offset[Z]] == at


def test_an_axis_of_a_program_that_is_paused_may_be_moved(gantry: HandStation) -> None:
    typed(gantry, "RUN PROG1", "PAUSE PROG1")
    gantry.run(0.2)
    assert press(gantry)["ok"]


def test_a_kill_during_the_jog_ends_the_press_with_the_words_of_the_card(
    gantry: HandStation,
) -> None:
    press(gantry)
    gantry.keep(1, 0.2)
    typed(gantry, "SET 8531")
    gantry.keep(1, 0.2)
    (event,) = gantry.events("jog")
    assert event["ended"] == "refused"
    assert gantry.installation.axis_name(Z) in event["text"]
    assert time_to_rest(gantry) <= 0.02
    assert not gantry.station.card_jogs.are_active


def test_speeds_belong_to_the_axes_that_are_not_acromills(gantry: HandStation) -> None:
    text = "axis AXIS2 is not AcroMill's: give its speed in units/s"
    assert gantry.press(1, "AXIS2")["error"]["text"] == text
    assert (
        gantry.refused(
            "jog.increment", axis="AXIS2", direction=1, preset=2, speed=1.0, tick=gantry.tick
        )["text"]
        == "axis AXIS2 is not AcroMill's: give a distance, no preset"
    )
    if gantry.station.link.required.is_set_up:
        text = "axis AXIS0 is AcroMill's: its speeds are SLOW and FAST of JOG"
        assert gantry.press(2, "AXIS0", speed=1.0)["error"]["text"] == text
        assert gantry.press(3, "X", speed=1.0)["error"]["text"].startswith("axis X is AcroMill's")
    else:
        assert gantry.press(2, "X", speed=1.0)["error"]["text"].startswith("AcroMill's axis")
        assert press(gantry, 3)["ok"]


def test_the_past_is_not_shown_while_such_an_axis_moves(gantry: HandStation) -> None:
    press(gantry)
    gantry.keep(1, 0.1)
    assert "the panel moves the machine" in gantry.refused("timeline.seek", tick=100)["text"]
