"""Where a card over a link has to hold a planned curve, by the points that were sent of it."""

import math

import numpy as np
import pytest
from tests.mill.test_planned_lost_host import cells

from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import moves_needed
from openacr.mill.plan.curves.curve_reserve import Reserve
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, SPEEDS

NOTICED = 18  # pieces, 0.07 s
UNCOUNTED = 6  # points that complete no piece


def settings_of(own: dict[int, float]) -> Settings:
    store = Store()
    for cell, value in (cells() | own).items():
        store.write(cell, value)
    return Settings(store)


def reserve(own: dict[int, float] | None = None) -> Reserve:
    return Reserve(settings_of(own or {}))


def needed(ramp_s: float) -> int:
    """Pieces that a card needs after the one at which it holds."""
    return math.ceil((2.4 * ramp_s + 0.07) / PERIOD_S)


def run(found: Reserve, *speeds_ups: float, axis: int = 0) -> Reserve:
    """Note a point at rest and further ones, one at each speed after the one before."""
    place = np.zeros(3)
    found.note(place.copy())
    for speed_ups in speeds_ups:
        place[axis] += speed_ups * PERIOD_S
        found.note(place.copy())
    return found


@pytest.mark.parametrize(
    ("speed_ups", "ramp_s"),
    [(0.0, 0.0), (10.0, 2 * math.sqrt(10 / 20_000)), (50.0, 0.1), (100.0, 0.15), (-100.0, 0.15)],
)
def test_it_holds_a_multiple_of_the_quickest_ramp_and_the_time_to_notice_before_the_end(
    speed_ups: float, ramp_s: float
) -> None:
    found = run(reserve(), *[speed_ups] * 200)
    assert found.hold_at == 201 - UNCOUNTED - needed(ramp_s)


def test_the_axis_with_the_least_acceleration_counts() -> None:
    slow = run(reserve({AXIS.max_axis_acceleration[2]: 500.0}), *[100.0] * 250)
    assert slow.hold_at == 251 - UNCOUNTED - needed(100.0 / 500.0 + 500.0 / 20_000.0)


def test_any_axis_is_the_fastest() -> None:
    assert run(reserve(), *[100.0] * 200, axis=2).hold_at == 195 - needed(0.15)


@pytest.mark.parametrize("count", [0, 1, NOTICED])
def test_what_ends_before_the_card_can_notice_may_not_begin(count: int) -> None:
    assert run(reserve(), *[0.0] * (UNCOUNTED - 1 + count)).hold_at == 0


def test_with_as_much_as_it_takes_to_notice_it_may_be_held_at_its_first_piece() -> None:
    assert run(reserve(), *[0.0] * (UNCOUNTED + NOTICED)).hold_at == 1


def test_a_fast_part_keeps_the_card_before_it_until_enough_of_it_is_sent() -> None:
    """100 points at 5 mm/s, then 100 mm/s: the slow ones after which it is reached too soon."""
    found, slow = run(reserve(), *[5.0] * 100), needed(2 * math.sqrt(5 / 20_000))
    before = found.hold_at
    assert before == 101 - UNCOUNTED - slow
    last, held = np.array([5.0 * PERIOD_S * 100, 0.0, 0.0]), []
    for _ in range(100):
        last[0] += 100.0 * PERIOD_S
        found.note(last.copy())
        held.append(found.hold_at)
    concerned = 99 - slow  # the first piece from which one at the higher speed, 99, is too near
    enough = concerned + needed(0.15) - (101 - UNCOUNTED)  # points at the higher speed
    assert held[: enough - 1] == [before + 1, before + 2] + [concerned - 1] * (enough - 3)
    assert held[enough - 1 :] == list(range(concerned, concerned + 101 - enough))


def test_a_slow_part_after_a_fast_one_lets_the_card_go_further() -> None:
    found = run(reserve(), *[100.0] * 200, *[0.0] * 120)
    assert found.hold_at == 321 - UNCOUNTED - NOTICED


def test_another_curve_begins_with_nothing() -> None:
    found = run(reserve(), *[100.0] * 300)
    found.begin()
    assert found.hold_at == 0
    assert run(found, *[0.0] * 100).hold_at == 101 - UNCOUNTED - NOTICED


def test_a_long_curve_is_counted_on_although_its_beginning_is_forgotten() -> None:
    found = reserve()
    for k in range(3000):
        found.note(np.array([0.4 * k, 0.0, 0.0]))
        assert found.hold_at == max(k + 1 - UNCOUNTED - needed(0.15), 0) or k < 150
    assert len(found._speeds) < 1000


def test_a_card_needs_room_for_the_reserve_and_a_tenth_of_a_second() -> None:
    assert moves_needed(settings_of({})) == needed(0.15) + 25 + 2
    faster = {SPEEDS.max_machine_speed: 60 * 250.0}
    assert moves_needed(settings_of(faster)) == needed(0.25 + 0.05) + 25 + 2


def test_the_speed_of_the_fastest_axis_counts() -> None:
    slow_axes = dict.fromkeys(AXIS.max_axis_speed[:2], 60 * 20.0)
    assert moves_needed(settings_of(slow_axes)) == needed(0.15) + 25 + 2
    all_slow = dict.fromkeys(AXIS.max_axis_speed[:3], 60 * 20.0)
    assert moves_needed(settings_of(all_slow)) == needed(2 * math.sqrt(20 / 20_000)) + 25 + 2
