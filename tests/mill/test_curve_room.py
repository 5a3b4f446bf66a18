"""Planned paths on a card with a short move buffer: it could not rest without its host."""

import numpy as np
import pytest
from tests.mill.planned import ACCEL, JERK, SPEED, Point, highest
from tests.mill.test_planned_lost_host import ROUNDING, Host

from openacr.cnc.occupied import HOLD_AT, RAN_SHORT
from openacr.controller import Controller
from openacr.map.rows import masters
from openacr.mill.run.lifecycle import State
from openacr.sysvar.tabs import SPEEDS

LINE: list[Point] = [(30.0, 0.0), (60.0, 0.0)]
BYTES_PER_MOVE = 136


def dimensioned(bytes_of_0: int) -> Controller:
    """A card whose programs have memory each, as configuration code gives it to them."""
    card = Controller()
    card.send(f"SYS\rDIM PROG0({bytes_of_0})\rDIM PROG7(8192)\rDIM P(100)\r")
    card.advance(seconds=0.5)
    return card


@pytest.mark.parametrize("moves", [0, 60, 120])
def test_it_is_refused_where_the_buffer_is_too_short(moves: int) -> None:
    host = Host(LINE, card=dimensioned(1000 + BYTES_PER_MOVE * moves))
    host.live(1.0)
    (alarm,) = host.session.runner.alarms.active
    assert "needs a buffer of 135 moves, that of the card has 10" in alarm.text
    assert "DIM PROG0" in alarm.text
    assert np.ptp(host.places, axis=0) == pytest.approx(0.0)


def test_with_memory_for_the_buffer_a_late_host_brings_it_to_rest_within_the_limits() -> None:
    host = Host(LINE, card=dimensioned(1000 + BYTES_PER_MOVE * 210))
    host.live(0.4)
    assert host.speed > 0.0
    for late_s in (0.1, 0.25, 0.6):
        host.silent(late_s)
        host.live(0.6)
    host.finish()
    _, accel, jerk = highest(host.places, host.card.period_s)
    assert accel <= ACCEL * (1 + 1e-4)
    assert jerk <= JERK * (1 + ROUNDING)
    assert host.session.runner.state is State.IDLE
    assert host.places[-1] == pytest.approx([60.0, 0.0, 0.0], abs=1e-4)


@pytest.mark.parametrize("moves", [200, 150])
def test_a_buffer_that_is_dimensioned_already_is_used(moves: int) -> None:
    card = Controller()
    card.send(f"PROG0\rDIM MBUF({moves})\r")
    card.advance(seconds=0.1)
    host = Host([(100.0, 0.0), (200.0, 0.0)], card=card)
    host.live(0.6)
    assert host.speed == pytest.approx(SPEED, rel=1e-4)
    ahead = card.p[HOLD_AT] - card.p[masters.move_counter[0]]
    assert 15 < ahead <= 25
    host.silent(1.0)
    _, accel, jerk = highest(host.places, card.period_s)
    assert accel <= ACCEL * (1 + 1e-4)
    assert jerk <= JERK * (1 + ROUNDING)
    assert host.speed == 0.0


def test_a_machine_that_is_faster_gets_a_longer_buffer_and_rests_without_its_host() -> None:
    fast: dict[int, float] = {SPEEDS.max_machine_speed: 60 * 300.0}
    card = dimensioned(100_000)
    host = Host([(400.0, 0.0), (800.0, 0.0)], 60 * 300.0, card, fast)
    assert card.send("PROG0\rDIM\r").count("MBUF(255)") == 1
    host.live(0.8)
    assert host.speed == pytest.approx(300.0, rel=1e-4)
    host.silent(1.5)
    _, accel, jerk = highest(host.places, card.period_s)
    assert (host.speed, card.bit[RAN_SHORT]) == (0.0, True)
    assert accel <= ACCEL * (1 + 1e-4)
    assert jerk <= JERK * (1 + ROUNDING)


def test_a_faster_machine_is_refused_where_only_the_usual_buffer_has_room() -> None:
    fast: dict[int, float] = {SPEEDS.max_machine_speed: 60 * 300.0}
    card = dimensioned(1000 + BYTES_PER_MOVE * 210)
    host = Host(LINE, card=card, own=fast)
    host.live(1.0)
    (alarm,) = host.session.runner.alarms.active
    assert "needs a buffer of 255 moves, that of the card has 200" in alarm.text
    assert "lower the highest speed (P650000)" in alarm.text
    assert np.ptp(host.places, axis=0) == pytest.approx(0.0)
