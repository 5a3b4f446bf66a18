"""How much of a planned curve waits on a card over a link."""

import math

import numpy as np
import pytest
from tests.mill.test_planned_lost_host import cells

from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curve_reserve import Reserve
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS


def reserve(most: int = 200, own: dict[int, float] | None = None) -> Reserve:
    store = Store()
    for cell, value in (cells() | (own or {})).items():
        store.write(cell, value)
    return Reserve(Settings(store), most)


def at_speed(found: Reserve, speed_ups: float, axis: int = 0, count: int = 10) -> Reserve:
    place = np.zeros(3)
    for _ in range(count):
        found.note(place.copy())
        place[axis] += speed_ups * PERIOD_S
    found.note(place)
    return found


@pytest.mark.parametrize(
    ("speed_ups", "ramp_s"),
    [(0.0, 0.0), (10.0, 2 * math.sqrt(10 / 20_000)), (50.0, 0.1), (100.0, 0.15), (-100.0, 0.15)],
)
def test_it_is_a_multiple_of_the_quickest_ramp_and_the_time_to_notice(
    speed_ups: float, ramp_s: float
) -> None:
    pieces = (2.4 * ramp_s + 0.07) / 0.004
    assert at_speed(reserve(), speed_ups).least == 8 * math.ceil(pieces / 8)


def test_the_axis_with_the_least_acceleration_counts() -> None:
    slow = reserve(own={AXIS.max_axis_acceleration[2]: 500.0})
    ramp_s = 100.0 / 500.0 + 500.0 / 20_000.0
    assert at_speed(slow, 100.0).least == 8 * math.ceil((2.4 * ramp_s + 0.07) / 0.004 / 8)


def test_the_highest_speed_of_what_may_wait_counts_until_it_is_gone() -> None:
    found = reserve(150)
    place = np.zeros(3)
    for wanted, count in ((0.4, 10), (0.0, 140), (0.0, 20)):
        for _ in range(count):
            place[0] += wanted
            found.note(place.copy())
        if count > 10:
            assert found.least == (112 if count == 140 else 24)


def test_it_leaves_room_for_what_is_on_the_line() -> None:
    found = at_speed(reserve(100), 100.0)
    assert (found.least, found.on_the_line) == (75, 25)
