"""JOG, HOME and SPEEDS settings of the store, as the machine moves by them."""

import itertools
import shutil
from pathlib import Path

import pytest
from tests.mill.shop import Shop
from tests.mill.test_homing import MACHINE, homing_shop

from openacr.controller import Controller
from openacr.map import numbers as n
from openacr.map.rows import axes, motors
from openacr.mill.run.lifecycle import State

JOG, HOME = 350_000, 300_000


def speeds(shop: Shop, seconds: float) -> list[float]:
    """Commanded speed of axis 0, tick by tick, units per second."""
    found = []
    for tick in range(round(seconds / shop.controller.period_s)):
        shop.controller.advance(seconds=shop.controller.period_s)
        if tick % 10 == 0:
            shop.runner.step()
        found.append(shop.controller.axis(0).velocity_ups)
    return found


def ramp(found: list[float], period_s: float, *, is_up: bool) -> float:
    """The largest change of speed per second in one direction."""
    changes = [(b - a) / period_s for a, b in itertools.pairwise(found)]
    return max(changes) if is_up else -min(changes)


# --- jog --------------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-JOG-ACC", "MILL-SYS-JOG-DEC")
@pytest.mark.parametrize(
    ("cells", "up", "down"),
    [({}, 150.0, 10.0), ({f"P{JOG + 2}": 40, f"P{JOG + 3}": 25}, 40.0, 25.0)],
)
def test_a_jog_ramps_as_the_tab_says(cells: dict[str, float], up: float, down: float) -> None:
    shop = Shop(**cells)
    period_s = shop.controller.period_s
    shop.runner.jog(lambda jog: jog.hold(0, 1, fast=True))
    assert ramp(speeds(shop, 0.2), period_s, is_up=True) == pytest.approx(up, rel=0.01)
    shop.runner.jogging.release(0)
    found = speeds(shop, 0.5)
    assert ramp(found, period_s, is_up=False) == pytest.approx(down, rel=0.01)
    assert found[-1] == 0.0


@pytest.mark.req("MILL-JOG-INC", "MILL-SYS-JOG-INC1", "MILL-SYS-JOG-INC2", "MILL-SYS-JOG-INC3")
@pytest.mark.req("MILL-SYS-JOG-INC4", "MILL-SYS-JOG-INC5")
@pytest.mark.parametrize(("preset", "pulses"), [(1, 10_000), (2, 1000), (3, 100), (4, 10), (5, 1)])
def test_a_press_goes_one_increment(preset: int, pulses: int) -> None:
    fast = {f"P{JOG}": 600.0, f"P{JOG + 3}": 150.0}
    shop = Shop(**fast)
    shop.runner.jog(lambda jog: jog.increment(0, 1, preset))
    shop.pass_time(0.6)
    assert shop.pulses()[0] == pulses
    fast |= {f"P{JOG + 1000}": 600.0, f"P{JOG + 1003}": 150.0}
    shop = Shop(**fast, **{f"P{JOG + 5 + preset}": 0.25, f"P{JOG + 1005 + preset}": 0.5})
    shop.runner.jog(lambda jog: jog.increment(0, 1, preset))
    shop.pass_time(0.6)
    shop.runner.jog(lambda jog: jog.increment(1, 1, preset))
    shop.pass_time(0.6)
    assert shop.pulses()[:2] == (2500, 5000)


# --- home -------------------------------------------------------------------------------


@pytest.fixture
def world(tmp_path: Path) -> Controller:
    """Axes with switches and markers."""
    shutil.copy(MACHINE, tmp_path)
    return Controller.from_project(tmp_path)


def homing_speeds(shop: Shop) -> list[float]:
    shop.runner.home([0])
    found = []
    while shop.runner.state is State.HOMING:
        found += speeds(shop, 0.05)
    assert shop.runner.state is State.IDLE
    return found


def plateaus(found: list[float]) -> list[float]:
    """Speeds that were held for 10 ms, in their order."""
    held: list[float] = []
    for k in range(20, len(found)):
        same = all(abs(found[k] - found[j]) < 1e-6 for j in range(k - 20, k))
        if same and abs(found[k]) > 0.01 and (not held or abs(held[-1] - found[k]) > 1e-6):
            held.append(found[k])
    return held


@pytest.mark.req(
    "MILL-SYS-HOME-FAST", "MILL-SYS-HOME-SLOW", "MILL-SYS-HOME-MARKER", "MILL-SYS-HOME-DIR"
)
@pytest.mark.parametrize("scale", [1.1])
def test_homing_goes_fast_to_the_switch_slowly_off_it_and_on_to_the_marker(
    world: Controller, scale: float
) -> None:
    fast, slow, marker = 1800.0 * scale, 300.0 * scale, 120.0 * scale
    cells = {f"P{HOME + 3}": fast, f"P{HOME + 4}": slow, f"P{HOME + 5}": marker}
    found = plateaus(homing_speeds(homing_shop(world, **cells)))
    # Plus is the default direction: towards the switch, back off it, along to the marker.
    assert found[:3] == pytest.approx([fast / 60, -slow / 60, -marker / 60], rel=1e-4)


@pytest.mark.req("MILL-SYS-HOME-MARKER")
@pytest.mark.parametrize("marker", [120.0, 1800.0, 6000.0])
def test_the_zero_is_at_the_marker_however_fast_it_is_sought(
    world: Controller, marker: float
) -> None:
    shop = homing_shop(world, **{f"P{HOME + 5}": marker})
    homing_speeds(shop)
    rows = shop.controller.memory.F
    pitch_cnt = rows[n.PLF_BASE + n.PLF_MARKER_PITCH_CNT]
    past_cnt = rows[motors.position_cnt[0]] - rows[n.PLF_BASE + n.PLF_MARKER_PHASE_CNT]
    # At 100 mm/s a servo period is 40 counts; the motor rests within 3 of them.
    assert (past_cnt + pitch_cnt / 2) % pitch_cnt - pitch_cnt / 2 == pytest.approx(0, abs=4)
    assert shop.controller.axis(0).actual_cnt == pytest.approx(0, abs=3)


@pytest.mark.req("MILL-SYS-HOME-ACC", "MILL-SYS-HOME-DEC")
@pytest.mark.parametrize(("up", "down"), [(500.0, 500.0), (250.0, 800.0)])
def test_homing_ramps_as_the_tab_says(world: Controller, up: float, down: float) -> None:
    shop = homing_shop(world, **{f"P{HOME + 6}": up, f"P{HOME + 7}": down})
    found = homing_speeds(shop)
    top = found.index(max(found))
    period_s = shop.controller.period_s
    assert ramp(found[: top + 1], period_s, is_up=True) == pytest.approx(up, rel=0.01)
    slowing = found[top : top + next(k for k, speed in enumerate(found[top:]) if speed <= 0)]
    assert ramp(slowing, period_s, is_up=False) == pytest.approx(down, rel=0.01)


@pytest.mark.req("MILL-SYS-HOME-PRESET", "MILL-SYS-HOME-INPUT")
@pytest.mark.parametrize(
    ("cells", "position"), [({}, 0.0), ({f"P{HOME + 1}": -7.5}, -7.5)], ids=["default", "preset"]
)
def test_the_homed_position_reads_the_preset(
    world: Controller, cells: dict[str, float], position: float
) -> None:
    shop = homing_shop(world, **cells)
    homing_speeds(shop)
    assert shop.controller.p[axes.current_position[0]] == position * 800
    # On the input of the default nothing is wired here: there is nothing to find.
    unwired = homing_shop(world, **{f"P{HOME + 2}": 16, f"P{HOME + 9}": 1, "P200000": 5,
                                    "P200001": 0, "P200002": 0})  # fmt: skip
    unwired.runner.home([0])
    assert unwired.until(State.IDLE, State.ALARM) is State.ALARM
