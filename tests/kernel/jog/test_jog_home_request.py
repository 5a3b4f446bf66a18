"""The flag form of JOG HOME: senary axis flags 8 (request) and 9 (direction)."""

import pytest

from openacr.compiled import pick
from openacr.kernel.tick_cy import tick
from openacr.motion.card import Card

HOME_REQUEST, HOME_NEGATIVE = 17160, 17161
JOG_ACTIVE, HOMING, KILL = 792, 16131, 8467

_tick = pick(tick)


def card_with_jog() -> Card:
    card = Card()
    card.memory.write(12348, 5)  # JOG VEL
    return card


def ticks(card: Card, count: int) -> None:
    for _ in range(count):
        _tick(card.memory.F, card.memory.I, card.memory.S)


@pytest.mark.parametrize(("negative", "direction"), [(False, 1), (True, -1)])
def test_the_request_flag_starts_a_home_search_in_the_direction_of_its_flag(
    negative: bool, direction: int
) -> None:
    card = card_with_jog()
    card.memory.set_bit(HOME_NEGATIVE, negative)
    card.memory.set_bit(HOME_REQUEST, True)
    ticks(card, 4000)
    assert not card.memory.bit(HOME_REQUEST)
    assert card.memory.bit(HOMING)
    assert card.memory.bit(JOG_ACTIVE)
    assert card.memory.I[12297] * direction > 0


def test_a_killed_axis_does_not_search_on_request() -> None:
    card = card_with_jog()
    card.memory.set_bit(KILL, True)
    ticks(card, 1)
    card.memory.set_bit(HOME_REQUEST, True)
    ticks(card, 100)
    assert not card.memory.bit(HOMING)
    assert card.memory.I[12297] == 0
