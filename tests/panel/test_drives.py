"""Drives of any axis: switched on with the reason where they stay off, switched off, reset."""

from typing import Any

import pytest
from tests.panel.bench import HandStation, card_of

from openacr.client import Card
from openacr.client.drives import Drive
from openacr.map.words import af1, af4, af5, ef
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role

Z = 2
MISC = 4272  # BIT5645, 5646: Motion Enable Input


def drive(hand: HandStation) -> Drive:
    (found,) = [each for each in hand.station.drives.look() if each.axis == Z]
    return found


def typed(hand: HandStation, *lines: str) -> None:
    with Card.open(card_of(hand)) as there:
        for line in lines:
            there.command(f"AXIS2 {line}")
    hand.run(0.1)


def has(hand: HandStation, parameter: int, mask: int, *, on: bool = True) -> None:
    word = int(card_of(hand).p[parameter]) & 0xFFFFFFFF
    word = word | mask & 0xFFFFFFFF if on else word & ~mask
    card_of(hand).p[parameter] = word - (1 << 32 if word >> 31 else 0)


def switch(hand: HandStation, order: str) -> Any:
    return hand.send(f"drive.{order}", axis="AXIS2")


def test_a_drive_is_switched_off_and_on_and_the_answer_comes_once_it_is_on(
    gantry: HandStation,
) -> None:
    assert drive(gantry).is_enabled
    assert switch(gantry, "off")["ok"]
    assert not drive(gantry).is_enabled
    assert switch(gantry, "on")["ok"]
    assert drive(gantry).is_enabled


@pytest.mark.parametrize(
    ("parameter", "mask", "key", "words"),
    [
        (MISC, 1 << 14, "enable.open", "the Motion Enable Input is open: 24 V are missing"),
        (MISC, 1 << 13, "enable.latched", "Input was open: RESET clears its latch"),
        (af4.word[Z], af4.DRIVE_FAULT_INPUT | af4.DRIVE_I_O_ENABLE, "input", "its fault input"),
        (ef.word[Z], ef.ENCODER_SIGNAL_FAULT, "encoder", "encoder ENC2 has a signal fault"),
        (ef.word[Z], ef.ENCODER_SIGNAL_LOST, "encoder", "ENC2 RES clears it"),
    ],
)
def test_what_bars_a_drive_is_named_and_nothing_is_commanded(
    gantry: HandStation, parameter: int, mask: int, key: str, words: str
) -> None:
    switch(gantry, "off")
    has(gantry, parameter, mask)
    gantry.run(0.05)
    has(gantry, parameter, mask)
    assert key in drive(gantry).wrong
    error = switch(gantry, "on")["error"]["text"]
    assert error.startswith(f"the drive of axis {gantry.installation.axis_name(Z)} cannot be")
    assert words in error
    gantry.run(0.3)
    assert not drive(gantry).is_enabled


@pytest.mark.parametrize(
    ("parameter", "mask", "key"),
    [
        (af4.word[Z], af4.DRIVE_FAULT, "fault"),
        (af4.word[Z], af4.EXCESS_ERROR_FAULT, "excess"),
        (af4.word[Z], af4.KILL_ALL_MOTION_REQUEST, "killed"),
        (af5.word[Z], af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED, "hard.plus"),
        (af5.word[Z], af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED, "hard.minus"),
        (af5.word[Z], af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED, "soft.plus"),
        (af5.word[Z], af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED, "soft.minus"),
    ],
)
def test_what_drive_on_lifts_is_shown_and_lifted(
    gantry: HandStation, parameter: int, mask: int, key: str
) -> None:
    switch(gantry, "off")
    has(gantry, parameter, mask)
    assert drive(gantry).wrong == (key,)
    assert drive(gantry).bars == []
    assert switch(gantry, "on")["ok"]
    assert drive(gantry).wrong == ()
    assert drive(gantry).is_enabled


def test_an_open_motion_enable_input_is_named_once(gantry: HandStation) -> None:
    has(gantry, MISC, 1 << 14)
    gantry.run(0.05)
    assert int(card_of(gantry).p[MISC]) & 1 << 13  # its latch is set as well
    assert "enable.open" in drive(gantry).wrong
    assert "enable.latched" not in drive(gantry).wrong


def test_a_fault_input_that_is_inverted_reports_a_fault_while_it_is_off(
    gantry: HandStation,
) -> None:
    has(gantry, af4.word[Z], af4.DRIVE_I_O_ENABLE, on=False)
    has(gantry, af4.word[Z], af4.DRIVE_FAULT_LEVEL_INVERT)
    assert "input" not in drive(gantry).wrong  # without drive I/O it has no meaning
    has(gantry, af4.word[Z], af4.DRIVE_I_O_ENABLE)
    assert "input" in drive(gantry).wrong
    has(gantry, af4.word[Z], af4.DRIVE_FAULT_INPUT)
    assert "input" not in drive(gantry).wrong


def test_a_drive_that_does_not_come_on_says_what_bars_it(gantry: HandStation) -> None:
    switch(gantry, "off")
    answers: list[Any] = []
    future = gantry.station.drives.on(Z, gantry.now_s)
    future.add_done_callback(lambda done: answers.append(done.exception()))
    has(gantry, MISC, 1 << 14)
    gantry.run(0.498)
    assert answers == []
    gantry.run(0.01)
    (error,) = answers
    assert "stays off: the Motion Enable Input is open" in str(error)


def test_reset_clears_the_fault_and_the_latch_of_the_motion_enable_input(
    gantry: HandStation,
) -> None:
    has(gantry, af4.word[Z], af4.DRIVE_FAULT)
    has(gantry, MISC, 1 << 13)
    assert switch(gantry, "reset")["ok"]
    gantry.run(0.2)
    assert drive(gantry).wrong == ()


@pytest.mark.parametrize("stop", ["stop.estop", "stop.drives"])
def test_a_moving_axis_keeps_its_drive_until_everything_is_switched_off(
    gantry: HandStation, stop: str
) -> None:
    typed(gantry, "JOG ACC 100", "JOG DEC 100", "JOG VEL 0.1", "JOG FWD")
    assert drive(gantry).is_jogged
    error = switch(gantry, "off")["error"]["text"]
    assert "DRIVE OFF is refused" in error
    assert "STOP" in error
    viewer = Person(9, Role.VIEW, "10.0.0.9")
    gantry.station.join(viewer)
    assert gantry.send(stop, who=viewer)["ok"]
    gantry.run(0.1)
    assert not any(each.is_enabled for each in gantry.station.drives.look())
    at = drive(gantry).setpoint_u
    gantry.run(0.5)
    assert drive(gantry).setpoint_u == at


def test_a_drive_is_not_switched_on_while_the_panel_moves_an_axis(gantry: HandStation) -> None:
    assert gantry.press(1, "AXIS2", speed=0.1)["ok"]
    text = "the panel moves the machine: drives are switched on at rest"
    assert gantry.refused("drive.on", axis="AXIS1")["text"] == text


def test_lengths_are_in_units_of_the_axis(gantry: HandStation) -> None:
    typed(gantry, "JOG ACC 100", "JOG DEC 100", "JOG VEL 1", "JOG ABS 0.25")
    gantry.run(1.0)
    found = drive(gantry)
    assert found.setpoint_u == pytest.approx(0.25)
    assert found.actual_u == pytest.approx(0.25, abs=0.01)
    assert found.ppu == 40000.0
    assert found.setpoint_u - found.actual_u == pytest.approx(found.following_u, abs=1e-3)
    assert (found.plus_output_v, found.minus_output_v) == (10.0, -10.0)
    assert found.plus_error_u > 0.0 > found.minus_error_u
    assert not found.is_jogged
    word = int(card_of(gantry).p[af1.word[Z]])
    assert not word & af1.JOG_ACTIVE
