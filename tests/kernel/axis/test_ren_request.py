"""REN requested by flag: served at rest, kept pending in motion."""

from openacr.compiled import pick
from openacr.kernel.tick_cy import tick
from openacr.motion.card import Card
from openacr.motion.jog import jog

REN_REQUEST, JOG_ACTIVE, OPEN_LOOP = 787, 792, 785
SCAN_TK = 100

_tick = pick(tick)


def ticks(card: Card, count: int) -> None:
    for _ in range(count):
        _tick(card.memory.F, card.memory.I, card.memory.S)


def test_a_ren_request_takes_the_actual_position_in_the_next_slow_scan() -> None:
    card = Card()
    card.memory.set_bit(OPEN_LOOP, True)  # feedback stays where it is
    card.memory.write(12290, 250)
    ticks(card, 2)
    card.memory.set_bit(REN_REQUEST, True)
    ticks(card, SCAN_TK)
    assert not card.memory.bit(REN_REQUEST)
    assert card.memory.read(12288) == card.memory.read(12295) == 250


def test_a_ren_request_in_motion_waits_for_rest_and_nothing_jumps() -> None:
    card = Card()
    card.memory.write(12348, 100)  # JOG VEL
    card.memory.write(12349, 1000)
    card.memory.write(12350, 1000)
    jog.absolute(card, 0, 20)
    ticks(card, 50)
    card.memory.set_bit(REN_REQUEST, True)
    before = card.memory.read(12294)
    ticks(card, SCAN_TK)
    assert card.memory.bit(REN_REQUEST)
    assert 0 < card.memory.read(12294) - before <= 100 * SCAN_TK * card.clock.period_s + 1
    ticks(card, 1000)
    assert not card.memory.bit(JOG_ACTIVE)
    assert not card.memory.bit(REN_REQUEST)
    assert card.memory.read(12294) == 20
