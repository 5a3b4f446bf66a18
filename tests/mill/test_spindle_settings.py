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


@pytest.mark.req(
    "MILL-WORD-S", "MILL-SPINDLE-1500", "MILL-SPINDLE-CLAMP", "MILL-SYS-SPINDLE-SCALING"
)
@pytest.mark.parametrize(
    ("rpm", "scaling", "wanted"),
    [(1500, 0.00333, 5.0), (3000, 0.00333, 10.0), (9000, 0.00333, 10.0), (1500, 0.001, 1.5),
     (1500, 0.0, 0.0)],
)  # fmt: skip
def test_the_dac_gets_rpm_times_scaling_up_to_10_volts(
    rpm: int, scaling: float, wanted: float
) -> None:
    shop = until_hold(shop_with(more={f"P{SPINDLE + SCALING}": scaling}), f"S{rpm} M3")
    assert volts(shop) == pytest.approx(wanted, abs=0.02)
    assert volts(shop) <= 10.0


@pytest.mark.req("MILL-SPINDLE-BIT0", "MILL-SYS-SPINDLE-CODE")
@pytest.mark.parametrize(
    ("code", "word", "sign"), [(0, "M3", 1), (0, "M4", 1), (1, "M3", 1), (1, "M4", -1)]
)
def test_bit_0_is_the_range_of_the_output(code: int, word: str, sign: int) -> None:
    shop = until_hold(shop_with(code), f"S1500 {word}")
    assert volts(shop) == pytest.approx(sign * 4.995, abs=0.001)


@pytest.mark.req("MILL-SYS-SPINDLE-DAC", "MILL-SPINDLE-DACINDEX")
@pytest.mark.parametrize("dac", [-1, 3, 5])
def test_the_spindle_dac_is_the_one_of_the_tab(dac: int) -> None:
    shop = until_hold(shop_with(more={f"P{SPINDLE + DAC}": dac}), "S1500 M3")
    found = {number: volts(shop, number) for number in (3, 4, 5, 6, 7)}
    assert {number for number, value in found.items() if value} == ({dac} if dac >= 0 else set())


@pytest.mark.req("MILL-SYS-SPINDLE-CWOUT", "MILL-SYS-SPINDLE-CCWOUT", "MILL-SYS-SPINDLE-OFFOUT")
def test_the_outputs_say_what_the_spindle_does() -> None:
    shop = shop_with()
    begin(shop, "S100 M3\nM0\nM4\nM0\nM5\nM0\nM2")
    for wanted in ([True, False, False], [False, True, False], [False, False, True]):
        shop.until(State.HOLD)
        assert shop.outputs(OUTPUTS) == wanted
        shop.runner.start()
    shop.until(State.IDLE)
    unset = {f"P{SPINDLE + k}": value for k, value in ((CW, -1.0), (CCW, -1.0), (OFF, 0.0))}
    shop = until_hold(shop_with(more=unset), "S100 M3\nM5\nM4")
    assert not any(shop.outputs(range(32, 64)))


@pytest.mark.req(
    "MILL-SPINDLE-BIT1", "MILL-SPINDLE-BIT2", "MILL-SPINDLE-CODE6", "MILL-SYS-SPINDLE-ATSPEED"
)
@pytest.mark.parametrize(("code", "level"), [(2, False), (6, True)])
def test_bits_1_and_2_wait_for_the_level_of_at_speed(code: int, level: bool) -> None:
    shop = shop_with(code, {f"P{SPINDLE + AT_SPEED}": 11, f"P{SPINDLE + AT_ZERO}": 10})
    shop.controller.set_input(11, not level)
    shop.controller.set_input(10, True)  # M5 is not to wait for its end
    begin(shop, "S1500 M3\nF600 G1 X1\nM5\nM0\nM2")
    shop.pass_time(0.5)
    assert (shop.runner.state, shop.runner.reason) == (State.WAIT, "spindle at speed")
    assert shop.pulses()[0] == 0
    assert volts(shop) == pytest.approx(4.995, abs=0.001)
    shop.controller.set_input(11, level)
    shop.until(State.HOLD)  # and M5 waits for nothing
    assert shop.pulses()[0] == 10_000


@pytest.mark.req("MILL-SYS-SPINDLE-ATZERO")
def test_without_an_at_zero_input_nothing_waits_for_rest() -> None:
    assert Store().read(SPINDLE + AT_ZERO) == -1.0
    shop = shop_with(8, {f"P{SPINDLE + AT_ZERO}": -1})
    begin(shop, "S1500 M3\nM5\nF600 G1 X1\nM0\nM2")
    shop.until(State.HOLD, limit_s=2.0)
    assert (volts(shop), shop.pulses()[0]) == (0.0, 10_000)


@pytest.mark.req("MILL-SPINDLE-BIT3", "MILL-SPINDLE-BIT4", "MILL-SYS-SPINDLE-ATZERO")
@pytest.mark.parametrize(("code", "level"), [(8, False), (24, True)])
def test_bits_3_and_4_wait_for_the_level_of_at_zero(code: int, level: bool) -> None:
    shop = shop_with(code, {f"P{SPINDLE + AT_SPEED}": 11, f"P{SPINDLE + AT_ZERO}": 10})
    shop.controller.set_input(11, True)  # M3 is not to wait for its end
    shop.controller.set_input(10, not level)
    begin(shop, "S1500 M3\nM5\nF600 G1 X1\nM0\nM2")
    shop.pass_time(0.5)
    assert shop.runner.state is State.WAIT
    assert volts(shop) == 0.0
    assert shop.pulses()[0] == 0
    shop.controller.set_input(10, level)
    shop.until(State.HOLD)
    assert shop.pulses()[0] == 10_000


@pytest.mark.req("MILL-SPINDLE-NOINPUT")
def test_without_inputs_nothing_is_waited_for() -> None:
    until_hold(shop_with(31), "S1500 M3\nM5\nM4\nM5")


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


@pytest.mark.req("MILL-COOL-MIST", "MILL-COOL-FLOOD", "MILL-COOL-OFF")
def test_m7_m8_and_m9_switch_the_outputs_of_the_tab() -> None:
    shop = Shop(**COOLANT)
    begin(shop, "M7\nM0\nM8\nM0\nM9\nM0\nM8\nM0\nM2")
    for wanted in ([1, 0, 0], [1, 1, 0], [0, 0, 1], [0, 1, 0]):
        shop.until(State.HOLD)
        assert [int(on) for on in shop.outputs(COOLED)] == wanted
        shop.runner.start()
    shop.until(State.IDLE)


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


@pytest.mark.req("MILL-COOL-UNSET")
def test_coolant_without_outputs_does_nothing_and_does_not_fail() -> None:
    shop = until_hold(Shop(), "M7\nM8\nM9\nM7 M8")
    assert not any(shop.outputs(range(32, 64)))


# --- tool -------------------------------------------------------------------------------


@pytest.mark.req(
    "MILL-TOOL-MANUAL-SEQ",
    "MILL-TOOL-AUTO-SEQ",
    "MILL-SYS-TOOL-CHANGEDIN",
    "MILL-SYS-TOOL-CHANGEOUT",
    "MILL-SYS-TOOL-MANUAL",
)
@pytest.mark.parametrize("is_manual", [1, 0])
def test_m6_signals_the_change_and_waits_for_its_end(is_manual: int) -> None:
    shop = Shop(**{f"P{TOOL}": 13, f"P{TOOL + 1}": 46, f"P{TOOL + 2}": is_manual})
    begin(shop, "T7\nM6\nF600 G1 X1\nM0\nM2")
    shop.pass_time(0.5)
    assert shop.runner.state is State.WAIT
    assert shop.outputs([46]) == [True]
    assert shop.runner.reason == ("load tool 7" if is_manual else "tool 7 is changed")
    shop.controller.set_input(13, True)
    shop.pass_time(0.1)
    shop.controller.set_input(13, False)
    shop.until(State.HOLD)
    assert shop.outputs([46]) == [False]
    assert shop.pulses()[0] == 10_000
    assert shop.store.read(235) == 7


@pytest.mark.req("MILL-TOOL-ABORT")
def test_abort_in_a_change_leaves_the_old_tool() -> None:
    shop = Shop(**{f"P{TOOL}": 13, f"P{TOOL + 1}": 46, "P235": 3})
    begin(shop, "T7\nM6\nM2")
    shop.pass_time(0.5)
    assert shop.runner.state is State.WAIT
    shop.runner.abort()
    shop.until(State.IDLE)
    assert shop.outputs([46]) == [False]
    assert shop.store.read(235) == 3
