"""Programs written as text, run on the virtual machine: what the operator sees of them."""

import math
from itertools import pairwise

import pytest
from tests.mill.shop import STEP_S, Shop

from openacr.mill.run.lifecycle import State

DAC_VALUE = 6400 + 16 * 3
SPINDLE = {"P800_001": 0.00333, "P800_002": 3.0, "P800_005": 40.0, "P800_006": 41.0}


def volts(shop: Shop) -> float:
    shop.pass_time(0.05)
    return float(shop.controller.p[DAC_VALUE])


@pytest.mark.req("MILL-RUN-RESUME-OFFPATH", "MILL-SYS-CTL-LEADIN")
def test_a_tool_moved_aside_in_a_pause_comes_back_with_the_lead_in_radius() -> None:
    shop = Shop(P250_005=0.5)
    shop.load("G90 F600\nG41 D0 G1 X1\nX10\nG40 Y5\nM2\n")
    shop.pass_time(0.4)
    shop.runner.stop()
    shop.pass_time(0.5)
    left = shop.place()[0]
    assert left > 1.0
    shop.runner.jog(lambda jog: jog.move(1, 2.0, fast=True))
    shop.runner.jog(lambda jog: jog.move(2, 0.5, fast=True))
    shop.pass_time(3.0)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    on_arc = [p for p in shop.path if p[0] < left - 1e-3 and 1e-3 < p[1] < 0.499 and p[2] < 1e-4]
    assert len(on_arc) > 5
    assert all(math.hypot(x - left, y - 0.5) == pytest.approx(0.5, abs=5e-4) for x, y, _ in on_arc)
    assert shop.pulses()[0] == 100000


@pytest.mark.req("MILL-RUN-NOGAP", "MILL-LOOK-TANGENT")
def test_tangent_moves_run_into_each_other_at_the_feed() -> None:
    shop = Shop()
    points = [(5 * math.sin(n / 100), 5 - 5 * math.cos(n / 100)) for n in range(1, 315)]
    text = "G90 F300\n" + "".join(f"G1 X{x:.6f} Y{y:.6f}\n" for x, y in points) + "M2\n"
    speeds: list[float] = []
    shop.load(text)
    while shop.runner.state is State.RUN:
        shop.pass_time(0.005)
        axes = [shop.controller.axis(n).velocity_ups for n in (0, 1)]
        speeds.append(math.hypot(*axes))
    moving = speeds[30:-40]
    assert min(moving) > 0.95 * 5
    assert max(moving) < 1.01 * 5


@pytest.mark.req("MILL-SPINDLE-EXCEPTION", "MILL-SYS-SPINDLE-EXCEPT")
@pytest.mark.parametrize("before", ["S1500 M3", "S1500 M3\nM5", ""])
def test_a_spindle_fault_holds_ends_the_program_and_gives_an_alarm(before: str) -> None:
    """Also while the spindle runs down or is off: the guide has no condition."""
    shop = Shop(P800_008=12, **SPINDLE)
    shop.load(f"{before}\nF60 G1 X5\nM2")
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


@pytest.mark.req("MILL-SYS-SPINDLE-EXCEPT")
def test_without_an_exception_input_no_input_is_a_spindle_fault() -> None:
    shop = Shop(**SPINDLE)
    for number in range(32):
        shop.controller.set_input(number, True)
    shop.run_text("S1500 M3\nF600 G1 X1\nM2")
    assert (shop.pulses()[0], shop.runner.alarms.active) == (10_000, [])


FINE_BORING = "F600 G90 G0 Z1\nM3 S500\nG76 X1 Y0 Z-.5 R.1 Q.1\nG80\nM2\n$I CYCLES.TXT\n"


@pytest.mark.req("MILL-SPINDLE-ORIENT")
def test_fine_boring_orients_the_spindle_and_checks_that_it_is_there() -> None:
    shop = Shop(P800_012=46, P800_013=12, P250_142=0, **SPINDLE)
    shop.load(FINE_BORING)
    shop.until(State.WAIT)
    shop.pass_time(0.5)
    assert shop.runner.reason == "spindle oriented"
    assert shop.outputs((46, 40)) == [True, False]
    assert volts(shop) == 0.0
    assert shop.pulses() == (10000, 0, -5000)  # no shift before it is there
    shop.controller.set_input(12, True)
    shop.until(State.IDLE)
    assert shop.outputs((46,)) == [False]
    assert shop.pulses() == (10000, 0, 10000)


@pytest.mark.req("MILL-SPINDLE-ORIENT", "MILL-G76-ORIENT")
@pytest.mark.parametrize(("code", "level"), [(8, False), (24, True)])
def test_a_spindle_is_at_rest_before_it_is_oriented(code: int, level: bool) -> None:
    """The guide: it is stopped and goes through an orientation cycle."""
    shop = Shop(P800_000=code, P800_003=10, P800_012=46, P800_013=12, **SPINDLE)
    shop.controller.set_input(10, not level)
    shop.load(FINE_BORING)
    shop.until(State.WAIT)
    shop.pass_time(0.5)
    assert shop.runner.reason == "spindle at rest"
    assert shop.outputs((46, 40)) == [False, False]
    assert volts(shop) == 0.0
    shop.controller.set_input(10, level)
    shop.pass_time(0.1)
    assert shop.runner.reason == "spindle oriented"
    assert shop.outputs((46, 40)) == [True, False]
    shop.controller.set_input(12, True)
    shop.until(State.IDLE)
    assert shop.pulses() == (10000, 0, 10000)


@pytest.mark.req("MILL-SPINDLE-ORIENT")
def test_a_spindle_that_is_never_oriented_is_an_alarm_in_the_hole() -> None:
    shop = Shop(P800_012=46, P800_013=12, P800_015=2.0, **SPINDLE)
    shop.load(FINE_BORING)
    shop.until(State.WAIT)
    shop.pass_time(1.9)
    assert shop.runner.state is State.WAIT
    shop.until(State.ALARM, limit_s=0.3)
    assert [alarm.kind.code for alarm in shop.runner.alarms.active] == [42]
    assert shop.pulses() == (10000, 0, -5000)


@pytest.mark.req("MILL-SPINDLE-ORIENT")
@pytest.mark.parametrize("orient_s", [0.4, 1.2])
def test_without_an_oriented_input_the_orientation_has_its_time(orient_s: float) -> None:
    shop = Shop(P800_012=46, P800_014=orient_s, **SPINDLE)
    shop.load(FINE_BORING)
    while not shop.controller.bit[46]:
        shop.pass_time(STEP_S)
    elapsed_s = 0.0
    while shop.pulses() == (10000, 0, -5000):
        shop.pass_time(STEP_S)
        elapsed_s += STEP_S
    assert elapsed_s == pytest.approx(orient_s, abs=0.02)


@pytest.mark.req("MILL-LOOK-ACCEL")
def test_no_axis_exceeds_the_acceleration_of_the_machine_within_moves() -> None:
    shop = Shop(P250_010=1.0, P250_011=90.0, P650_003=12.0, P650_008=40.0)
    shop.load("G90 F300 G62\nG1 X1\nG2 X2 Y-1 I1 J-1\nG3 X3 Y-2 I3 J-1\nX4 Y-2.2\nM2\n")
    speeds = []
    while shop.runner.is_busy:
        shop.pass_time(0.005)
        speeds.append((shop.controller.axis(0).velocity_ups, shop.controller.axis(1).velocity_ups))
    steps = [
        max(abs(a - b) for a, b in zip(now, before, strict=True)) / 0.005
        for before, now in pairwise(speeds)
    ]
    steps.sort()
    assert steps[int(0.97 * len(steps))] <= 40.0 * 1.02  # the junctions are the rest
