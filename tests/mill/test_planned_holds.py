"""Feed hold, override, abort and losses while a planned curve is on the card."""

import numpy as np
import pytest
from tests.mill.planned import (
    ACCEL,
    JERK,
    SPEED,
    SQUARE,
    TOLERANCE,
    follow,
    go_on,
    highest,
    motion_s,
    off_path,
    path,
    planned_shop,
    square,
    stop,
    wave,
)
from tests.mill.shop import Shop, end

from openacr.cnc import canonical as c
from openacr.mill.config.overrides import Override
from openacr.mill.run.feeding import Starved
from openacr.mill.run.lifecycle import State
from openacr.protocol.bits import SetBit
from openacr.sysvar.tabs import FOV
from openacr.trajectory import Setpoints, TrajectoryError, TrajectoryPlanner

ROUNDING = 0.03  # of the jerk: positions of 24 bits over the cube of 4 ms


def limits(places: np.ndarray, shop: Shop) -> None:
    """Assert that no limit is exceeded in any tick."""
    speed, accel, jerk = highest(places, shop.controller.period_s)
    assert speed <= SPEED * (1 + 1e-4)
    assert accel <= ACCEL * (1 + 1e-3)
    assert jerk <= JERK * (1 + ROUNDING)


@pytest.mark.parametrize("at_s", [0.05, 0.2, 0.31, 0.44, 0.61, 0.83])
def test_a_hold_rests_within_the_limits_and_the_path_goes_on(at_s: float) -> None:
    shop = planned_shop()
    places = follow(shop, *square(), actions=[(at_s, stop), (at_s + 0.7, go_on)])
    limits(places, shop)
    assert shop.pulses() == (0, 0, 0)
    assert off_path(places, SQUARE) <= 2 * TOLERANCE
    rests = np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) == 0.0)
    first = rests[rests > at_s / shop.controller.period_s][0] * shop.controller.period_s
    assert first - at_s <= 0.35  # the hold itself, what is on the card, and two polls


def test_two_holds_in_one_program() -> None:
    shop = planned_shop()
    actions = [(0.2, stop), (0.7, go_on), (1.1, stop), (1.6, go_on)]
    places = follow(shop, *path(wave(150)), end(), actions=actions)
    limits(places, shop)
    assert shop.pulses() == follow_end(wave(150))


def follow_end(points: list[tuple[float, ...]]) -> tuple[int, ...]:
    return tuple(round(10_000 * value) for value in points[-1])


def test_a_hold_is_over_only_when_the_card_rests() -> None:
    shop, states = planned_shop(), []

    def refuse(shop: Shop) -> None:
        states.append(shop.runner._pausing.has_rested)

    actions = [(0.25, stop), (0.3, refuse), (0.8, refuse), (0.9, go_on)]
    follow(shop, *square(), actions=actions)
    assert states == [False, True]


def test_an_override_scales_the_time_of_the_curve() -> None:
    period_s = planned_shop().controller.period_s
    whole = motion_s(follow(planned_shop(), *square()), period_s)
    shop = planned_shop()
    shop.runner.overrides.choose(
        Override.FEED, [shop.store.read(cell) for cell in FOV.percents].index(50.0)
    )
    half = motion_s(follow(shop, *square()), period_s)
    assert half == pytest.approx(2 * whole, abs=0.15)  # from the first poll on


def test_an_abort_comes_to_rest_on_the_path() -> None:
    shop = planned_shop()
    places = follow(shop, *square(), actions=[(0.2, lambda shop: shop.runner.abort())])
    limits(places, shop)
    assert shop.runner.state is State.IDLE
    assert off_path(places, SQUARE) <= TOLERANCE
    assert 15.0 < places[-1][0] < 29.0
    assert tuple(places[-1] * 10_000) == pytest.approx(shop.pulses(), abs=0.5)
    follow(shop, *path([(0.0, 0.0)]), end())  # and another program runs
    assert shop.pulses() == (0, 0, 0)


def test_a_kill_drops_the_curve() -> None:
    shop = planned_shop()
    places = follow(
        shop, *square(), actions=[(0.2, lambda shop: shop.card.tell(SetBit(KILL_MOVES)))]
    )
    assert shop.runner.state is State.ALARM
    assert 5.0 < places[-1][0] < 29.0
    assert (places[-20:] == places[-1]).all()
    shop.runner.acknowledge()
    follow(shop, *path([(0.0, 0.0)]), end())
    assert shop.pulses() == (0, 0, 0)


KILL_MOVES = 522


def test_a_hold_of_the_card_itself_is_no_jump() -> None:
    shop = planned_shop()
    places = follow(
        shop, *square(), actions=[(0.2, lambda shop: shop.card.tell(SetBit(520))), (0.6, stop),
                                  (1.4, go_on)],
    )  # fmt: skip
    assert shop.pulses() == (0, 0, 0)
    assert highest(places, shop.controller.period_s)[1] < 3 * ACCEL


def test_a_path_that_cannot_be_planned_ends_at_rest_before_that(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    take = TrajectoryPlanner.take
    taken: list[Setpoints] = []

    def fails(planner: TrajectoryPlanner, most: int = 1024) -> Setpoints | None:
        if len(taken) >= 100:
            raise TrajectoryError("line 70: no speed keeps the limits")
        found = take(planner, most)
        taken.extend([] if found is None else [found])
        return found

    monkeypatch.setattr(TrajectoryPlanner, "take", fails)
    shop = planned_shop()
    places = follow(shop, *path(wave(900)), end())
    limits(places, shop)
    assert shop.runner.state is State.ALARM
    assert [(a.kind.code, a.detail) for a in shop.runner.alarms.active] == [
        (60, "line 70: no speed keeps the limits")
    ]
    assert 30.0 < places[-1][0] < 300.0
    assert off_path(places, wave(900)) <= TOLERANCE


@pytest.mark.parametrize("late_polls", [100, 150, 400])
def test_a_program_that_arrives_slowly_rests_on_its_path_and_goes_on(late_polls: int) -> None:
    points = wave(240)
    whole: list[c.Entry] = [*path(points), end()]
    late: list[c.Entry] = [Starved()] * late_polls  # type: ignore[list-item]
    moves = [*whole[:79], *late, *whole[79:159], *late, *whole[159:]]
    shop = planned_shop()
    places = follow(shop, *moves)
    limits(places, shop)
    assert shop.runner.state is State.IDLE
    assert shop.pulses() == follow_end(points)
    assert off_path(places, points) <= TOLERANCE
    rests = np.abs(np.diff(places[100:-100], axis=0)).max(axis=1) == 0.0
    assert int(np.diff(rests.astype(int)).clip(0).sum()) == 2
