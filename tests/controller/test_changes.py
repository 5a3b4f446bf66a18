"""The log of changes: to the tick, from the present state on, in a buffer that may be full."""

from itertools import pairwise

import pytest

from openacr.controller import Controller
from openacr.controller.changes import MOVED, ROOM
from openacr.map.numbers import W_INPUTS, W_OUTPUTS
from openacr.map.rows import axes

OUT_32, OUT_33 = 32, 33


@pytest.fixture
def card() -> Controller:
    """A card whose outputs are logged, and of the inputs the first two."""
    card = Controller()
    card.bit[OUT_33] = True
    card.advance(1)
    card.log_changes([(W_OUTPUTS, -1), (W_INPUTS, 3)], [axes.psp_cnt[0]])
    return card


def entries(card: Controller) -> list[tuple[int, int, int]]:
    found = card.take_changes()
    return [(int(tick), int(word), int(value)) for tick, word, value in zip(*found, strict=True)]


def test_a_change_is_noted_with_its_tick_and_the_masked_value_and_taken_once(
    card: Controller,
) -> None:
    tick = card.lived_tk
    assert card.logged() == [2, 0]
    card.advance(3)
    card.bit[OUT_32] = True
    card.set_input(1, True)
    card.set_input(2, True)  # not of the mask
    card.advance(5)
    card.bit[OUT_33] = False
    card.advance(1)
    assert entries(card) == [
        (tick + 1, MOVED, 0),
        (tick + 4, 0, 3),
        (tick + 4, 1, 2),
        (tick + 9, 0, 1),
    ]
    assert entries(card) == []
    assert card.logged() == [1, 2]


def test_a_log_that_is_full_waits_and_then_notes_the_state_there_is(card: Controller) -> None:
    card.advance(1)
    card.take_changes()
    for _ in range(ROOM + 5):
        card.bit[OUT_32] = not card.bit[OUT_32]
        card.advance(1)
    found = entries(card)
    assert len(found) == ROOM - 2  # room for all words and the moved numbers is kept
    assert found[-1][0] == found[0][0] + len(found) - 1
    card.bit[OUT_33] = False
    card.advance(1)
    assert entries(card) == [(card.lived_tk, 0, int(card.bit[OUT_32]))]


def test_a_card_at_another_moment_is_logged_from_there_on(card: Controller) -> None:
    snapshot = card.snapshot()
    card.bit[OUT_32] = True
    card.advance(4)
    card.take_over(snapshot)
    card.advance(2)
    assert entries(card) == [(card.lived_tk - 1, MOVED, 0)]
    assert card.logged() == [2, 0]


def test_ticks_that_are_left_out_at_rest_hide_no_change(card: Controller) -> None:
    card.advance(20_000)
    card.take_changes()
    card.bit[OUT_32] = True
    card.advance(20_000)
    assert entries(card) == [(card.lived_tk - 19_999, 0, 3)]


def test_what_programs_switch_is_noted_in_its_tick_on_a_card_that_rests_between(
    card: Controller,
) -> None:
    card.log_changes([(W_OUTPUTS, 1)])
    for line in ("10 SET 32", "20 DWL 8", "30 CLR 32", "40 DWL 8", "50 GOTO 10"):
        card.send(f"PROG1\r{line}\r")
        card.advance(seconds=0.1)
    card.send("RUN\r")
    card.advance(seconds=33.0)
    found = entries(card)
    assert [value for _tick, _word, value in found] == [1, 0, 1, 0, 1]
    every_tk = round(8.0 / card.period_s)
    apart = [after[0] - before[0] for before, after in pairwise(found)]
    assert all(every_tk <= each <= every_tk + 3 for each in apart)


def test_the_log_is_no_part_of_the_state() -> None:
    both = Controller(), Controller()
    both[0].log_changes([(W_OUTPUTS, -1)])
    for card in both:
        card.bit[OUT_32] = True
        card.advance(1000)
    assert both[0].digest() == both[1].digest()
