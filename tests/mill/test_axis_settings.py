"""AXES settings of the store: limits, bands and homing of each axis, in programs."""

import pytest
from tests.mill.shop import Shop, at, end, line
from tests.mill.test_spindle_settings import begin

from openacr.map import numbers as n
from openacr.mill.run.lifecycle import State
from openacr.sysvar import Store

AXES, SERVO, HOMED = 200_000, 150_000, 271
PLUS, MINUS, IS_OFF, IN_POSITION, EXCESS = range(5)
HOME_REQUIRED, MULTIPLIER = 7, 11
DEFAULT_UNITS = 250_001


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def limited(is_off: int = 0) -> Shop:
    cells = {PLUS: 2.0, MINUS: -1.0, IS_OFF: float(is_off)}
    return Shop(**{f"P{AXES + k}": value for k, value in cells.items()}, **{f"P{HOMED}": 7})


@pytest.mark.req("MILL-SYS-AXES-SOFTPLUS", "MILL-SYS-AXES-SOFTMINUS")
@pytest.mark.parametrize(("good", "bad"), [(2.0, 2.01), (-1.0, -1.01)])
def test_a_program_stops_in_front_of_a_soft_limit(good: float, bad: float) -> None:
    shop = limited()
    begin(shop, f"F600 G1 X{good}\nX{bad}\nM2")
    assert shop.until(State.ALARM) is State.ALARM
    assert codes(shop) == [21]
    assert shop.pulses()[0] == good * 10_000


@pytest.mark.req("MILL-SYS-AXES-DISABLELIM")
def test_disable_limit_switches_the_soft_limits_of_an_axis_off() -> None:
    shop = limited(is_off=1)
    begin(shop, "F600 G1 X2.5\nX-1.5\nM2")
    shop.until(State.IDLE)
    assert shop.pulses()[0] == -15_000
    assert Shop().store.read(AXES + IS_OFF) == 1.0  # the default


@pytest.mark.req("MILL-SYS-AXES-HOMEREQD")
@pytest.mark.parametrize(
    ("required", "homed", "state"),
    [(1, 0, State.ALARM), (1, 1, State.IDLE), (0, 0, State.IDLE)],
)
def test_home_reqd_bars_an_axis_until_it_is_homed(required: int, homed: int, state: State) -> None:
    shop = Shop(**{f"P{AXES + HOME_REQUIRED}": required, f"P{HOMED}": homed})
    shop.start(line(1, at(1)), end())
    assert shop.until(State.IDLE, State.ALARM) is state
    assert shop.pulses()[0] == (0 if state is State.ALARM else 10_000)
    assert codes(shop) == ([33] if state is State.ALARM else [])


@pytest.mark.req("MILL-SYS-AXES-EXCESS")
@pytest.mark.parametrize(("band", "state"), [(0.0, State.IDLE), (0.01, State.ALARM)])
def test_an_error_outside_its_band_stops_the_machine(band: float, state: State) -> None:
    shop = Shop(**{f"P{AXES + EXCESS}": band, f"P{SERVO}": 0.0005})  # a weak loop lags
    shop.start(line(1, at(5), 1200.0), end())
    assert shop.until(State.IDLE, State.ALARM) is state
    assert codes(shop) == ([11] if state is State.ALARM else [])
    if state is State.ALARM:
        place = float(shop.controller.p[n.AX_BASE + n.AX_ACTUAL_POSITION])
        assert place < 50_000


@pytest.mark.req("MILL-SYS-AXES-INPOS")
def test_the_in_position_band_is_0_by_default_and_in_the_unit_of_the_machine() -> None:
    store = Store()
    bands = [AXES + 1000 * axis + IN_POSITION for axis in range(8)]
    assert [store.read(band) for band in bands] == [0.0] * 8
    store.write(bands[2], 0.001)
    store.write(DEFAULT_UNITS, 1.0)
    assert store.read(bands[2]) == pytest.approx(0.0254)
    shop = Shop(**{f"P{AXES + IN_POSITION}": 0.001})
    assert shop.card.command("AXIS0 IPB", program=0) == ["0.001,-0.001"]


@pytest.mark.req("MILL-SYS-AXES-INPOS")
@pytest.mark.parametrize(("band", "waits"), [(0.0, False), (0.0005, True)])
def test_an_exact_stop_waits_for_the_in_position_band(band: float, waits: bool) -> None:
    times = []
    for code in ("G64", "G61"):
        shop = Shop(**{f"P{AXES + IN_POSITION}": band, f"P{SERVO}": 0.0005})
        before = shop.controller.tick
        begin(shop, f"F1200 {code} G1 X1\nM0\nM2")
        shop.until(State.HOLD)
        times.append((shop.controller.tick - before) * shop.controller.period_s)
        error = abs(float(shop.controller.p[n.AX_BASE + n.AX_FOLLOWING_ERROR]))
        assert code == "G64" or not waits or error <= band * 10_000
    assert (times[1] > times[0] + 0.02) == waits
