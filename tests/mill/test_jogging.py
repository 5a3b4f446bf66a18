"""Axes moved by hand."""

import pytest
from tests.mill.shop import Shop

from openacr.mill.run.lifecycle import State


def shop_for_jogs(**cells: float) -> Shop:
    return Shop(**({"P350_000": 60.0, "P350_001": 600.0, "P350_003": 150.0} | cells))


def x_of(shop: Shop) -> float:
    """Position and jog offset."""
    return (shop.controller.axis(0).commanded_cnt) / 10000


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
