"""SPINDLE, coolant and TOOL settings of the store: programs on the virtual machine obey them."""

from collections.abc import Iterator
from itertools import pairwise

import pytest
from tests.mill.shop import STEP_S, Shop

from openacr.cnc.canonical import Entry
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import load
from openacr.mill.card.alarms import AlarmError
from openacr.mill.run.lifecycle import State
from openacr.mill.run.run_host import RunHost
from openacr.sysvar import Store

SPINDLE, TOOL = 800_000, 900_000
CODE, SCALING, DAC, AT_ZERO, AT_SPEED, CW, CCW, OFF, EXCEPTION, MIST, FLOOD, COOLANT_OFF = range(12)
OUTPUTS = (40, 41, 42)  # clockwise, the other way, off


def shop_with(code: int = 0, more: dict[str, float] | None = None) -> Shop:
    """A spindle at DAC 3 with three outputs, 3.33 mV per rpm; no inputs."""
    cells = {CODE: code, SCALING: 0.00333, DAC: 3, CW: 40, CCW: 41, OFF: 42}
    return Shop(**({f"P{SPINDLE + k}": float(value) for k, value in cells.items()} | (more or {})))


def begin(shop: Shop, text: str) -> None:
    """Start a program as an operator does."""
    program = load(text, shop.store)
    assert not program.errors

    def entries(host: RunHost) -> Iterator[Entry]:
        return Interpreter(program, shop.store, host).entries()

    shop.runner.run(entries)


def until_hold(shop: Shop, text: str) -> Shop:
    begin(shop, f"{text}\nM0\nM2")
    shop.until(State.HOLD)
    shop.pass_time(0.1)  # nothing else writes to what has been set
    return shop


def volts(shop: Shop, dac: int = 3) -> float:
    return float(shop.controller.p[6400 + 16 * dac])


@pytest.mark.req("MILL-SPINDLE-EXCEPTION", "MILL-SYS-SPINDLE-EXCEPT")
@pytest.mark.parametrize("before", ["S1500 M3", "S1500 M4", "S1500 M3\nM5", ""])
def test_a_spindle_fault_holds_ends_the_program_and_gives_an_alarm(before: str) -> None:
    """Also while the spindle runs down or is off: the guide has no condition."""
    assert Store().read(SPINDLE + EXCEPTION) == -1.0
    shop = shop_with(more={f"P{SPINDLE + EXCEPTION}": 12})
    begin(shop, f"{before}\nF60 G1 X5\nM2")
    shop.pass_time(1.0)
    shop.controller.set_input(12, True)
    speeds = []
    while shop.runner.state is not State.ALARM or shop.runner.is_busy:
        shop.pass_time(STEP_S)
        speeds.append(float(shop.controller.axis(0).velocity_ups))
    falls = [a - b for a, b in pairwise(speeds)]
    assert max(falls) <= 100 * STEP_S * 1.01  # the ramp of the feed: a hold, no kill
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [41]
    assert 0 < shop.pulses()[0] < 50_000
    assert volts(shop) == 0.0


@pytest.mark.req("MILL-SYS-SPINDLE-EXCEPT", "MILL-ALM-CLEAR")
def test_a_spindle_fault_stays_until_its_contact_is_open_and_it_is_acknowledged() -> None:
    shop = shop_with(more={f"P{SPINDLE + EXCEPTION}": 12})
    begin(shop, "S1500 M3\nF60 G1 X5\nM2")
    shop.pass_time(0.2)
    shop.controller.set_input(12, True)
    shop.until(State.ALARM)
    assert [alarm.kind.code for alarm in shop.runner.acknowledge()] == [41]
    with pytest.raises(AlarmError, match="Spindle exception"):
        begin(shop, "F600 G1 X1\nM2")
    shop.controller.set_input(12, False)
    shop.pass_time(0.5)
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [41]
    assert shop.runner.acknowledge() == []
    begin(shop, "F600 G1 X1\nM2")
    shop.until(State.IDLE)
    assert shop.pulses()[0] == 10_000


@pytest.mark.req("MILL-SYS-SPINDLE-EXCEPT")
def test_without_an_exception_input_no_input_is_a_spindle_fault() -> None:
    shop = shop_with()
    for number in range(32):
        shop.controller.set_input(number, True)
    begin(shop, "S1500 M3\nF600 G1 X1\nM2")
    shop.until(State.IDLE)
    assert (shop.pulses()[0], shop.runner.alarms.active) == (10_000, [])


# --- coolant ----------------------------------------------------------------------------

COOLANT = {
    f"P{SPINDLE + MIST}": 43.0,
    f"P{SPINDLE + FLOOD}": 44.0,
    f"P{SPINDLE + COOLANT_OFF}": 45.0,
}
COOLED = (43, 44, 45)


@pytest.mark.req("MILL-COOL-ABORT")
def test_abort_and_emergency_stop_switch_coolant_off() -> None:
    shop = Shop(**COOLANT)
    begin(shop, "M7 M8\nF60 G1 X5\nM2")
    shop.pass_time(0.5)
    assert shop.outputs((43, 44)) == [True, True]
    shop.runner.abort()
    shop.until(State.IDLE)
    assert shop.outputs((43, 44)) == [False, False]
    shop = Shop(**COOLANT, P400_004=9)
    begin(shop, "M7 M8\nF60 G1 X5\nM2")
    shop.pass_time(0.5)
    shop.controller.set_input(9, True)
    shop.until(State.ALARM)
    assert shop.outputs((43, 44)) == [False, False]


# --- tool -------------------------------------------------------------------------------
