"""Plasma hi/lo and height sensing, switched by how the tool moves."""

import pytest
from tests.mill.shop import STEP_S, Shop

from openacr.mill.run.lifecycle import Options, State

PLASMA, SENSING = 50, 51


def watched(
    shop: Shop, text: str, number: int, options: Options | None = None
) -> list[tuple[bool, float, float, float]]:
    """At every look of a run: state of an output, speed of X, place of X and Y."""
    found = []
    shop.load(text, options)
    while shop.runner.is_busy:
        shop.pass_time(STEP_S)
        speed = abs(float(shop.controller.axis(0).velocity_ups))
        found.append((bool(shop.controller.bit[number]), speed, *shop.place()[:2]))
    return found


@pytest.mark.req("MILL-BEY-SPEED-PLASMA")
@pytest.mark.parametrize("percent", [50.0, 90.0])
def test_the_plasma_output_follows_the_speed_as_percent_of_the_feed(percent: float) -> None:
    shop = Shop(P650_017=PLASMA, P650_005=percent, P650_008=10.0)
    found = watched(shop, "G90 F240\nG1 X4\nG0 X0\nM2\n", PLASMA)
    last = max(n for n, (_, _, x, _) in enumerate(found) if x < 3.99 and n < len(found) // 2)
    cut = [(on, speed) for on, speed, x, _ in found[:last] if x > 0.01]
    edge = 4.0 * percent / 100.0
    assert all(on for on, speed in cut if edge + 0.11 < speed < 4.01)
    assert not any(on for on, speed in cut if speed < edge - 0.11)
    assert not any(on for on, speed, _, _ in found if speed > 4.1)  # the rapid
    assert found[-1][0] is False


@pytest.mark.req("MILL-SYS-CTL-UNDERBURN")
@pytest.mark.parametrize("distance", [0.5, 1.5])
def test_height_sensing_goes_off_a_distance_before_the_end_of_a_cut(distance: float) -> None:
    shop = Shop(P250_012=distance, P250_014=SENSING)
    found = watched(shop, "G90 F240\nG1 X2\nY1\nG0 X0\nM2\n", SENSING)
    for on, _, x, y in found:
        left = (2.0 - x) + (1.0 - y)
        if x > 1e-3 and y < 0.999 and abs(left - distance) > 0.05:
            assert on == (left > distance)
    back = [on for on, _, x, y in found if y == 1.0 and x < 1.99]
    assert back
    assert not any(back)


def test_height_sensing_is_on_again_in_the_next_cut_and_never_in_a_dry_run() -> None:
    text = "G90 F240\nG1 X2\nG0 Y1\nG1 X0\nM2\n"
    cells = {"P250_012": 0.5, "P250_014": SENSING, "P650_017": PLASMA}
    found = watched(Shop(**cells), text, SENSING)
    assert any(on for on, _, x, y in found if y == 1.0 and 0.6 < x < 1.9)
    assert not any(on for on, *_ in watched(Shop(**cells), text, SENSING, Options(is_dry=True)))
    assert not any(on for on, *_ in watched(Shop(**cells), text, PLASMA, Options(is_dry=True)))


def test_a_hold_switches_the_plasma_low_and_an_end_everything_off() -> None:
    shop = Shop(P650_017=PLASMA, P650_005=80.0, P250_012=0.5, P250_014=SENSING)
    shop.load("G90 F240\nG1 X9\nM2\n")
    shop.pass_time(0.5)
    assert shop.outputs((PLASMA, SENSING)) == [True, True]
    shop.runner.stop()
    shop.pass_time(0.3)
    assert shop.outputs((PLASMA, SENSING)) == [False, True]
    shop.runner.abort()
    assert shop.until(State.IDLE) is State.IDLE
    shop.pass_time(0.05)
    assert shop.outputs((PLASMA, SENSING)) == [False, False]
