"""Spindle, coolant, tools, waits, reference points and probing in a run."""

import pytest
from tests.mill.shop import Shop, at, end, line, src

from openacr.cnc import canonical as c
from openacr.mill.run.lifecycle import State

CW, CCW, SPINDLE_DAC = 40, 41, 3
SPINDLE = {
    "P800_001": 0.00333, "P800_002": SPINDLE_DAC, "P800_005": CW, "P800_006": CCW,
    "P800_003": 10, "P800_004": 11,
}  # fmt: skip
DAC_VALUE = 6400 + 16 * SPINDLE_DAC


def spindle(spin: c.Spin, rpm: float = 1500.0) -> c.Spindle:
    return c.Spindle(src(1), spin, rpm)


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def test_a_spindle_that_never_gets_there_is_an_alarm() -> None:
    shop = Shop(P800_000=6, P800_015=2.0, **SPINDLE)
    shop.start(spindle(c.Spin.CLOCKWISE), line(2, at(1)), end())
    assert shop.until(State.ALARM) is State.ALARM
    assert codes(shop) == [42]
    assert shop.controller.p[DAC_VALUE] == 0.0


def test_a_new_speed_acts_without_handshake() -> None:
    shop = Shop(P800_000=6, **SPINDLE)
    shop.controller.set_input(11, True)
    shop.start(
        spindle(c.Spin.CLOCKWISE), c.Spindle(src(2), c.Spin.CLOCKWISE, 900.0, is_awaited=False),
        c.Stop(src(3), c.Pause.STOP), end(),
    )  # fmt: skip
    shop.until(State.HOLD)
    assert shop.controller.p[DAC_VALUE] == pytest.approx(2.997)


def test_a_manual_tool_change_waits_for_the_signal() -> None:
    shop = Shop(P900_000=14, P900_001=42)
    shop.store.write(235, 1)
    shop.start(c.Tool(src(1), 7), line(2, at(1)), end())
    shop.pass_time(0.5)
    assert shop.runner.reason == "load tool 7"
    assert shop.outputs((42,)) == [True]
    assert [shop.controller.p[n] for n in (90, 91)] == [7, 1]
    shop.controller.set_input(14, True)
    shop.pass_time(0.5)
    assert shop.outputs((42,)) == [False]
    assert shop.pulses() == (0, 0, 0)  # until the signal has gone
    shop.controller.set_input(14, False)
    shop.until(State.IDLE)
    assert shop.store.read(235) == 7
    assert shop.controller.p[91] == 7


def test_outputs_transfers_and_waits_happen_at_rest_and_in_order() -> None:
    shop = Shop()
    shop.start(
        line(1, at(1)), c.Output(src(2), 45, is_on=True), c.Transfer(src(3), 3, 55555.0),
        c.WaitBit(src(4), 150, True, "relay 22"), line(5, at(2)), end(),
    )  # fmt: skip
    shop.pass_time(0.1)
    assert shop.outputs((45,)) == [False]
    shop.until(State.WAIT)
    assert shop.outputs((45,)) == [True]
    assert shop.controller.p[3] == 55555.0
    assert shop.runner.reason == "relay 22"
    shop.controller.bit[150] = True
    shop.until(State.IDLE)
    assert shop.pulses() == (20000, 0, 0)


@pytest.mark.parametrize(("inputs", "is_software"), [((24, 25, 26), 0), ((24,), 0), ((16,), 1)])
def test_a_probe_that_trips_stops_and_comes_back_to_the_point(
    inputs: tuple[int, ...], is_software: int
) -> None:
    shop = Shop(P600_000=inputs[0], P600_002=is_software)
    shop.start(c.Probe(src(1), at(5, 2.5), c.Pace(60.0)), c.Sync(src(1)), end())
    shop.pass_time(0.5)
    assert shop.runner.reason == "probing"
    x_trip = shop.place()[0]
    for number in inputs:
        shop.controller.set_input(number, True)
    shop.pass_time(0.05)
    for number in inputs:
        shop.controller.set_input(number, False)
    shop.until(State.IDLE)
    point = shop.runner.stream.host.tripped()
    assert point is not None
    assert point[0] == pytest.approx(x_trip, abs=0.01)
    assert point[1] == pytest.approx(point[0] / 2, abs=3e-3)
    assert shop.place() == pytest.approx(point[:3], abs=1.01e-4)


def test_a_probe_that_is_tripped_at_the_start_does_not_move() -> None:
    shop = Shop(P600_000=16)
    shop.controller.set_input(16, True)
    shop.start(c.Probe(src(1), at(1), c.Pace(600.0)), c.Sync(src(1)), end())
    shop.until(State.ALARM)
    assert codes(shop) == [35]
    assert shop.pulses() == (0, 0, 0)


def test_a_variable_the_card_does_not_have_ends_the_program_with_its_name() -> None:
    shop = Shop()
    shop.load("P150=7\nG1 F600 X1\nT P150\nX2\nM2\n")
    shop.until(State.ALARM)
    (alarm,) = shop.runner.alarms.active
    assert alarm.text == "Program error: line 3: T P150: the card has no P150; DIM P creates it"
    assert shop.pulses()[0] == 10000


def test_a_tool_changed_signal_that_stays_on_holds_the_program_for_two_seconds() -> None:
    shop = Shop(P900_000=14, P900_001=42)
    shop.store.write(235, 1)
    shop.start(c.Tool(src(1), 7), line(2, at(1)), end())
    shop.pass_time(0.2)
    shop.controller.set_input(14, True)
    shop.pass_time(1.9)
    assert (shop.runner.state, shop.runner.reason) == (State.WAIT, "tool-changed signal off")
    assert (shop.controller.p[91], shop.pulses()) == (1, (0, 0, 0))
    shop.pass_time(0.3)
    assert shop.controller.p[91] == 7
    assert shop.until(State.IDLE) is State.IDLE
    assert (shop.pulses()[0], codes(shop)) == (10_000, [])


def test_a_tool_changed_signal_that_is_on_before_the_change_confirms_nothing() -> None:
    shop = Shop(P900_000=14, P900_001=42, P900_003=1.0)
    shop.store.write(235, 1)
    shop.controller.set_input(14, True)
    shop.start(c.Tool(src(1), 7), line(2, at(1)), end())
    assert shop.until(State.ALARM) is State.ALARM
    assert (codes(shop), shop.store.read(235)) == ([51], 1)
    assert shop.outputs((42,)) == [False]


def test_a_wait_for_an_edge_needs_the_other_state_first() -> None:
    shop = Shop()
    shop.controller.set_input(11, True)
    shop.start(c.WaitBit(src(1), 11, True, "input 11 on", is_edge=True), line(2, at(1)), end())
    shop.pass_time(1.0)
    assert (shop.runner.state, shop.runner.reason) == (State.WAIT, "input 11 on")
    shop.controller.set_input(11, False)
    shop.pass_time(1.0)
    assert shop.runner.state is State.WAIT
    shop.controller.set_input(11, True)
    shop.until(State.IDLE)
    assert shop.pulses() == (10000, 0, 0)


def test_a_wait_with_a_limit_ends_without_an_alarm() -> None:
    shop = Shop()
    shop.start(c.WaitBit(src(1), 11, True, "input 11 on", limit_s=2.0), line(2, at(1)), end())
    shop.pass_time(1.5)
    assert (shop.runner.state, shop.runner.reason) == (State.WAIT, "input 11 on")
    shop.until(State.IDLE)
    assert shop.pulses() == (10000, 0, 0)
    assert codes(shop) == []
