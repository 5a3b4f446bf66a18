"""FOV, ROV and SOV: sixteen percentages, chosen by a switch on four inputs."""

import pytest
from tests.mill.shop import Shop, at, end, line, rapid
from tests.mill.test_spindle_settings import begin, shop_with, volts

from openacr.mill.run.lifecycle import State

FOV, ROV, SOV = 450_000, 500_000, 550_000
FIRST_INPUT = 16
UPDATE_S = 0.15  # read every 50 ms, and the ramp after it


def turn(shop: Shop, click: int) -> None:
    """Turn the switch: its inputs are the click in binary."""
    for bit in range(4):
        shop.controller.set_input(FIRST_INPUT + bit, bool(click >> bit & 1))
    shop.pass_time(UPDATE_S)


def speed(shop: Shop) -> float:
    return float(shop.controller.axis(0).velocity_ups)


@pytest.mark.req("MILL-SYS-FOV-LIVE", "MILL-SYS-ROV-LIVE")
@pytest.mark.parametrize(("tab", "is_rapid"), [(FOV, False), (ROV, True)])
def test_a_click_scales_its_own_kind_of_move(tab: int, is_rapid: bool) -> None:
    other = ROV if tab == FOV else FOV
    cells = {f"P{tab + 16}": float(FIRST_INPUT), "P650000": 120.0}
    shop = Shop(**cells)
    turn(shop, 10 if tab == FOV else 15)
    shop.start(rapid(1, at(50)) if is_rapid else line(1, at(50), 120.0), end())
    shop.pass_time(UPDATE_S)
    assert speed(shop) == pytest.approx(2.0)
    for click in (5, 8, 2):
        turn(shop, click)
        assert speed(shop) == pytest.approx(2.0 * shop.store.read(tab + click) / 100, rel=1e-3)
    assert shop.store.read(other + 5) != shop.store.read(tab + 5)


@pytest.mark.req("MILL-SYS-FOV-ZERO", "MILL-SYS-ROV-ZERO")
@pytest.mark.parametrize(("tab", "is_rapid"), [(FOV, False), (ROV, True)])
def test_0_percent_stops_and_the_next_click_goes_on(tab: int, is_rapid: bool) -> None:
    shop = Shop(**{f"P{tab + 16}": float(FIRST_INPUT), "P650000": 600.0})
    turn(shop, 10)
    shop.start(rapid(1, at(10)) if is_rapid else line(1, at(10), 600.0), end())
    shop.pass_time(UPDATE_S)
    turn(shop, 0)
    assert speed(shop) == 0.0
    place = shop.pulses()[0]
    shop.pass_time(0.5)
    assert shop.pulses()[0] == place
    turn(shop, 1)
    assert speed(shop) > 0.0
    turn(shop, 10)
    shop.until(State.IDLE)
    assert shop.pulses()[0] == 100_000


@pytest.mark.req("MILL-SYS-SOV-16")
def test_each_of_16_clicks_of_the_spindle_switch_has_its_own_percentage() -> None:
    percent = [3 + 7 * click + click * click / 10 for click in range(16)]
    entries = {f"P{SOV + click}": each for click, each in enumerate(percent)}
    shop = shop_with(0, {f"P{SOV + 16}": float(FIRST_INPUT)} | entries)
    turn(shop, 0)
    begin(shop, "S1500 M3\nF10 G1 X5\nM2")
    found = []
    for click in range(16):
        turn(shop, click)
        found.append(volts(shop))
    assert found == pytest.approx([4.995 * each / 100 for each in percent])


@pytest.mark.req("MILL-SYS-SOV-LIVE", "MILL-SYS-SOV-ZERO")
def test_a_click_scales_the_spindle_and_0_percent_stops_it() -> None:
    shop = shop_with(0, {f"P{SOV + 16}": float(FIRST_INPUT), f"P{SOV}": 0.0})
    turn(shop, 10)
    begin(shop, "S1500 M3\nF10 G1 X5\nM2")
    shop.pass_time(UPDATE_S)
    assert volts(shop) == pytest.approx(4.995)
    for click in (5, 15, 0, 1):
        turn(shop, click)
        assert volts(shop) == pytest.approx(4.995 * shop.store.read(SOV + click) / 100)
    assert shop.store.read(SOV) == 0.0
