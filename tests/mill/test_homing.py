"""Homing on a machine with switches and markers (800 counts/mm X Y, 1600 counts/mm Z)."""

import shutil
from pathlib import Path

import pytest
from tests.mill.shop import Shop

from openacr.controller import Controller
from openacr.mill.run.lifecycle import State

MACHINE = Path(__file__).parents[2] / "examples" / "homing_xyz" / "machine.toml"
HOME = 300_000
DIRECTION, PRESET, SWITCH, FAST, SLOW, MARKER, ACC, DEC, STP, PRIORITY = range(10)


@pytest.fixture
def world(tmp_path: Path) -> Controller:
    shutil.copy(MACHINE, tmp_path)
    return Controller.from_project(tmp_path)


def homing_shop(world: Controller, **cells: float) -> Shop:
    """X homes to plus, Y and Z to minus; speeds in mm/min."""
    rows: dict[int, float] = {200_006: 800, 201_006: 800, 202_006: 1600}
    for axis in range(3):
        base = HOME + 1000 * axis
        rows |= {
            base + DIRECTION: 0 if axis == 0 else 1, base + SWITCH: 3 * axis + 2,
            base + FAST: 1800.0, base + SLOW: 300.0, base + MARKER: 120.0,
            base + ACC: 500.0, base + DEC: 500.0, base + STP: 500.0,
            150_000 + 1000 * axis: 0.002441, 150_004 + 1000 * axis: 1e-5,
        }  # fmt: skip
    named = {f"P{number}": value for number, value in rows.items()}
    return Shop.on(world, named | cells)


def home(shop: Shop, *axes: int) -> State:
    shop.runner.home(axes)
    return shop.until(State.IDLE, State.ALARM)


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


@pytest.mark.req("MILL-HOME-NOSWITCH")
def test_an_axis_that_never_finds_its_switch_is_an_alarm(world: Controller) -> None:
    shop = homing_shop(
        world, P300_000=1, P200_000=30.0, P200_001=0.0, P200_002=0, P300_002=2
    )  # away from the switch
    assert home(shop, 0) is State.ALARM
    assert 34 in codes(shop)
    assert not shop.runner.settings.is_homed(0)


def test_an_axis_that_does_not_move_is_not_waited_for(world: Controller) -> None:
    shop = homing_shop(world, P150_000=0.0, P150_004=0.0, P150_007=0.0)
    assert home(shop, 0) is State.ALARM
    assert "X: no motion" in shop.runner.alarms.active[0].text
    assert shop.runner.run_s < 5.0


def test_a_homing_axis_stops_by_itself_when_no_program_polls_any_more(world: Controller) -> None:
    shop = homing_shop(world, P300_000=1, P200_000=30.0, P200_001=0.0, P200_002=0)
    shop.runner.home([0])
    shop.pass_time(0.2)
    shop.controller.advance(200_000)
    assert abs(shop.controller.axis(0).velocity_ups) < 1e-9
    assert abs(shop.controller.axis(0).actual_cnt) / 800 < 40.0


def test_what_a_broken_off_homing_has_moved_becomes_position(world: Controller) -> None:
    shop = homing_shop(world)
    shop.runner.home([0])
    shop.pass_time(0.3)
    shop.runner.abort()
    shop.until(State.IDLE)
    at = shop.controller.p[12288]
    assert at > 100
    assert shop.controller.axis(0).actual_cnt == pytest.approx(at, abs=8)


@pytest.mark.parametrize("was_homed", [True, False])
def test_a_homing_that_is_broken_off_leaves_the_axis_not_homed(
    world: Controller, was_homed: bool
) -> None:
    shop = homing_shop(world, P271=3 if was_homed else 0)
    shop.runner.home([0])
    shop.pass_time(0.3)
    assert shop.store.read(271) == (2 if was_homed else 0)  # Y keeps what it knows
    shop.runner.stop()
    shop.until(State.ALARM)
    assert shop.store.read(271) == (2 if was_homed else 0)
    assert not shop.controller.bit[248]
    shop.runner.acknowledge()
    home(shop, 0)
    assert shop.runner.settings.is_homed(0)
