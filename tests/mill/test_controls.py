"""Axes moved by hand through keys, joystick and hand wheel."""

from itertools import pairwise

import pytest
from tests.mill.shop import STEP_S, Shop, at, end, line

from openacr.errors import UserError
from openacr.map.rows import encoders
from openacr.mill.card.alarms import AlarmError
from openacr.mill.run.lifecycle import State

LIMITS = {"P200_000": 0.5, "P200_001": -0.5, "P200_002": 0.0, "P271": 1.0}
STICK, KEY = 8, 13
WHEEL = encoders.parameters[10]


def handy(**cells: float) -> Shop:
    """Jogs at 1 unit/s, fast at 10; one wheel, encoder 10, for X and Y."""
    rows = {"P200_009": 10.0, "P201_009": 10.0, "P201_010": 0.02}
    for axis in range(3):
        rows |= {f"P35{axis}_000": 60.0, f"P35{axis}_001": 600.0, f"P35{axis}_003": 150.0}
    return Shop(**(rows | cells))


def speed(shop: Shop, axis: int = 0) -> float:
    return float(shop.controller.axis(axis).velocity_ups)


def position(shop: Shop, axis: int = 0) -> float:
    """With the jog that is not position yet."""
    return float(shop.controller.axis(axis).commanded_u)


def stick(shop: Shop, which: int, on: bool) -> None:
    shop.controller.set_input(STICK + which, on)


def turn(shop: Shop, clicks: int) -> None:
    """A click every 10 ms."""
    for _ in range(abs(clicks)):
        shop.controller.p[WHEEL] += 4 if clicks > 0 else -4
        shop.pass_time(0.01)


# --- keys -------------------------------------------------------------------------------


def test_a_lost_panel_releases_its_own_keys_and_no_others() -> None:
    shop = handy()
    shop.runner.controls.press("screen 1", 0, 1)
    shop.runner.controls.press("screen 2", 1, -1)
    shop.pass_time(0.2)
    shop.runner.controls.drop("screen 1")
    shop.pass_time(0.1)
    assert (speed(shop, 0), speed(shop, 1)) == pytest.approx((0.0, -1.0))


@pytest.mark.req("MILL-SYS-JOG-STP")
@pytest.mark.parametrize("ramp", [100.0, 25.0])
def test_stop_ends_a_jog_on_its_stop_ramp_and_a_release_on_its_deceleration(ramp: float) -> None:
    for stop, expected in ((True, ramp), (False, 10.0)):
        shop = handy(P350_004=ramp, P350_003=10.0)
        shop.runner.jog(lambda jog: jog.hold(0, 1, fast=True))
        shop.pass_time(1.0)
        if stop:
            shop.runner.stop()
        else:
            shop.runner.jogging.release(0)
        shop.pass_time(0.01)
        first = speed(shop)
        shop.pass_time(0.05)
        assert (first - speed(shop)) / 0.05 == pytest.approx(expected, rel=1e-3)


@pytest.mark.req("MILL-SYS-IO-SOFTLIM")
@pytest.mark.parametrize(("key", "pulses"), [(True, 5000), (False, 10000)])
def test_the_soft_limits_input_enforces_the_limits_of_hands(key: bool, pulses: int) -> None:
    shop = handy(P400_005=KEY, **LIMITS)
    shop.controller.set_input(KEY, key)
    shop.pass_time(0.01)
    shop.runner.jog(lambda jog: jog.hold(0, 1, fast=True))
    shop.pass_time(0.3)
    assert speed(shop) <= (10.0 if key else 1.0) + 1e-9  # never fast without limits
    while position(shop) < 0.99 and speed(shop) > 0:
        shop.pass_time(STEP_S)
    shop.runner.jogging.release(0)
    shop.pass_time(0.5)
    assert shop.pulses()[0] == pytest.approx(pulses, abs=150)
    if key:
        assert shop.pulses()[0] == 5000
        with pytest.raises(AlarmError, match="Soft limit axis X"):
            shop.runner.jog(lambda jog: jog.hold(0, 1))


@pytest.mark.req("MILL-SYS-IO-SOFTLIM")
def test_programs_keep_to_the_limits_whatever_the_key_says() -> None:
    shop = handy(P400_005=KEY, **LIMITS)
    shop.start(line(1, at(0.6)), end())
    assert shop.until(State.ALARM) is State.ALARM
    assert shop.pulses()[0] == 0


# --- joystick ---------------------------------------------------------------------------


def test_the_stick_has_no_effect_while_a_program_runs() -> None:
    shop = handy(P400_006=STICK)
    shop.start(line(1, at(2)), end())
    shop.pass_time(0.05)
    stick(shop, 2, True)
    shop.until(State.IDLE)
    assert shop.pulses() == (20000, 0, 0)


# --- hand wheel -------------------------------------------------------------------------


@pytest.mark.req("MILL-HW-LEAVE")
def test_leaving_the_wheel_disconnects_it_without_a_jump() -> None:
    shop = handy()
    shop.runner.turn([0])
    turn(shop, 20)
    shop.runner.turn([])
    places = []
    for _ in range(100):
        shop.controller.p[WHEEL] += 4
        shop.pass_time(STEP_S)
        places.append(position(shop))
    assert shop.pulses()[0] == 1000  # what was turned before, and it has become position
    assert max(b - a for a, b in pairwise(places)) < 10 * STEP_S
    assert not shop.runner.is_busy


@pytest.mark.req("MILL-HW-LIMITS")
def test_each_axis_of_the_wheel_ends_at_its_own_limits() -> None:
    limits = {"P200_000": 0.5, "P200_001": -0.3, "P201_000": 0.2, "P201_001": -0.7}
    limits |= {"P200_002": 0.0, "P201_002": 0.0, "P271": 3.0}
    shop = handy(P200_010=0.1, P201_010=0.1, **limits)
    shop.runner.turn([0, 1])
    found = []
    for clicks in (12, -20):
        turn(shop, clicks)
        shop.pass_time(1.5)
        found.append((position(shop, 0), position(shop, 1)))
    assert found == [(0.5, 0.2), (-0.3, -0.7)]


def test_one_hand_at_a_time() -> None:
    shop = handy()
    shop.runner.turn([0])
    with pytest.raises(UserError, match="the hand wheel is in use"):
        shop.runner.jog(lambda jog: jog.hold(1, 1))
    with pytest.raises(UserError, match="being jogged"):
        shop.start(end())
    shop.runner.stop()
    shop.pass_time(0.05)
    shop.runner.jog(lambda jog: jog.hold(1, 1))
    with pytest.raises(UserError, match="an axis is being jogged"):
        shop.runner.turn([0])


def test_a_panel_that_leaves_takes_the_wheel_along() -> None:
    shop = handy()
    shop.runner.turn([0])
    turn(shop, 3)
    shop.runner.bring_to_rest()
    shop.pass_time(0.5)
    assert not shop.runner.is_busy
    left = position(shop)
    assert 0.0 < left <= 0.0151
    turn(shop, 3)
    assert position(shop) == left


def test_abort_in_a_pause_ends_the_wheel() -> None:
    shop = handy()
    shop.start(line(1, at(5)), end())
    shop.pass_time(0.2)
    shop.runner.stop()
    shop.pass_time(0.5)
    shop.runner.turn([1])
    turn(shop, 2)
    shop.runner.abort()
    shop.until(State.IDLE)
    left = position(shop, 1)
    assert 0.0 < left < 0.05
    turn(shop, 2)
    assert position(shop, 1) == left
