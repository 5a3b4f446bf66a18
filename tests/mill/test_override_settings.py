"""FOV, ROV and SOV: sixteen percentages, chosen by a switch on four inputs."""

import pytest
from tests.mill.shop import Shop
from tests.mill.test_spindle_settings import begin, shop_with, volts

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
