"""Axes moved by hand."""

import pytest
from tests.mill.shop import Shop, at, end, line, src

from openacr.cnc import canonical as c
from openacr.errors import UserError
from openacr.mill.card.alarms import AlarmError
from openacr.mill.run.lifecycle import State


def shop_for_jogs(**cells: float) -> Shop:
    return Shop(**({"P350_000": 60.0, "P350_001": 600.0, "P350_003": 150.0} | cells))


def x_of(shop: Shop) -> float:
    """Position and jog offset."""
    return (shop.controller.axis(0).commanded_cnt) / 10000


@pytest.mark.req("MILL-JOG-HOLD")
def test_a_held_jog_moves_until_it_is_released_and_then_ramps_to_rest() -> None:
    shop = shop_for_jogs()
    shop.runner.jog(lambda jog: jog.hold(0, 1))
    shop.pass_time(1.0)
    assert 0.9 < x_of(shop) < 1.0
    assert shop.controller.axis(0).velocity_ups == pytest.approx(1.0, abs=1e-6)
    shop.runner.jogging.release(0)
    shop.pass_time(0.5)
    assert shop.controller.axis(0).velocity_ups == 0.0
    assert shop.place()[0] == pytest.approx(x_of(shop))  # the offset has become position
    assert not shop.runner.is_busy


def test_a_stop_while_no_axis_is_jogged_sets_no_limit_for_a_later_jog() -> None:
    shop = shop_for_jogs()
    shop.runner.jogging.stop_all()
    shop.controller.advance(seconds=60.0)
    shop.runner.jog(lambda jog: jog.hold(0, 1))
    shop.pass_time(1.0)
    assert shop.runner.state is State.IDLE
    assert shop.runner.alarms.active == []
    assert 0.9 < x_of(shop) < 1.0
    shop.runner.jogging.release(0)
    shop.pass_time(0.5)
    assert shop.controller.axis(0).velocity_ups == 0.0


@pytest.mark.req("MILL-JOG-INC")
@pytest.mark.parametrize("preset", range(1, 6))
def test_an_increment_is_exact(preset: int) -> None:
    shop = shop_for_jogs()
    for _ in range(3):
        shop.runner.jog(lambda jog: jog.increment(0, -1, preset))
        shop.pass_time(2.0)
    assert shop.pulses()[0] == -3 * 10 ** (5 - preset)


@pytest.mark.req("MILL-JOG-SLOWFAST")
@pytest.mark.parametrize(("fast", "per_minute"), [(False, 10), (True, 100)])
@pytest.mark.parametrize("axis", [0, 2])
def test_without_other_settings_the_speeds_are_10_and_100_per_minute(
    axis: int, fast: bool, per_minute: float
) -> None:
    shop = Shop()
    shop.runner.jog(lambda jog: jog.hold(axis, -1, fast=fast))
    shop.pass_time(0.5)
    assert shop.controller.axis(axis).velocity_ups == pytest.approx(-per_minute / 60)


@pytest.mark.req("MILL-JOG-SLOWFAST", "MILL-JOG-MAXSPEED")
@pytest.mark.req("MILL-SYS-JOG-FEED", "MILL-SYS-JOG-RAPID")
@pytest.mark.parametrize(
    ("fast", "most", "speed"), [(False, 6e3, 1), (True, 6e3, 10), (True, 300, 5)]
)
def test_jogs_have_two_speeds_below_that_of_the_machine(
    fast: bool, most: float, speed: float
) -> None:
    shop = shop_for_jogs(P650_000=most)
    shop.runner.jog(lambda jog: jog.hold(0, 1, fast=fast))
    shop.pass_time(0.5)
    assert shop.controller.axis(0).velocity_ups == pytest.approx(speed)


@pytest.mark.req("MILL-JOG-MULTI")
def test_axes_can_be_jogged_at_the_same_time() -> None:
    shop = shop_for_jogs(P351_000=120.0)
    shop.runner.jog(lambda jog: jog.hold(0, 1))
    shop.runner.jog(lambda jog: jog.hold(1, -1))
    shop.pass_time(0.5)
    assert shop.controller.axis(0).velocity_ups == pytest.approx(1.0)
    assert shop.controller.axis(1).velocity_ups == pytest.approx(-2.0)


@pytest.mark.req("MILL-JOG-SOFTLIM")
def test_a_jog_ends_at_the_soft_limit_and_goes_on_only_away_from_it() -> None:
    shop = shop_for_jogs(P200_000=0.5, P200_001=-0.5, P200_002=0, P271=1)
    shop.runner.jog(lambda jog: jog.hold(0, 1))
    shop.pass_time(2.0)
    assert shop.pulses()[0] == 5000
    with pytest.raises(AlarmError, match="Soft limit axis X"):
        shop.runner.jog(lambda jog: jog.hold(0, 1))
    with pytest.raises(AlarmError, match="Soft limit"):
        shop.runner.jog(lambda jog: jog.increment(0, 1, 3))
    shop.runner.jog(lambda jog: jog.increment(0, -1, 2))
    shop.pass_time(1.0)
    assert shop.pulses()[0] == 4000


@pytest.mark.req("MILL-JOG-RUNLOCK")
def test_a_jog_is_refused_while_a_program_runs_and_allowed_while_it_is_held() -> None:
    shop = shop_for_jogs()
    shop.start(line(1, at(1)), c.Stop(src(2), c.Pause.STOP), line(3, at(2)), end())
    shop.pass_time(0.05)
    with pytest.raises(UserError, match="cannot jog: the state is RUN"):
        shop.runner.jog(lambda jog: jog.hold(0, 1))
    shop.until(State.HOLD)
    shop.runner.jog(lambda jog: jog.increment(1, 1, 2))
    shop.runner.jog(lambda jog: jog.increment(2, 1, 2))
    shop.pass_time(1.0)
    assert shop.pulses() == (10000, 1000, 1000)
    shop.runner.start()
    shop.until(State.IDLE)
    assert shop.pulses() == (20000, 0, 0)


@pytest.mark.req("MILL-SYS-JOG-DIR")
@pytest.mark.parametrize(("is_negative", "sign"), [(0, 1), (1, -1)])
def test_jog_direction_turns_keys_and_increments_alike(is_negative: int, sign: int) -> None:
    shop = shop_for_jogs(P350_005=is_negative)
    shop.runner.jog(lambda jog: jog.increment(0, 1, 2))
    shop.pass_time(1.0)
    assert shop.pulses()[0] == sign * 1000
    shop.runner.jog(lambda jog: jog.increment(0, -1, 3))
    shop.pass_time(1.0)
    assert shop.pulses()[0] == sign * 900
    shop.runner.jog(lambda jog: jog.hold(0, 1))
    shop.pass_time(0.3)
    shop.runner.jog(lambda jog: jog.release(0))
    shop.pass_time(1.0)
    assert sign * shop.pulses()[0] > 900


def test_an_axis_that_must_be_homed_is_not_jogged_before() -> None:
    shop = shop_for_jogs(P200_007=1)
    with pytest.raises(AlarmError, match="Axis X not homed"):
        shop.runner.jog(lambda jog: jog.hold(0, 1))
