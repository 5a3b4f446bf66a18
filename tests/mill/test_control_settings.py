"""CONTROL, I/O, AXES and SPEEDS settings of the store: what each does to the machine."""

from pathlib import Path

import pytest
from tests.mill.shop import STEP_S, Shop, at, end, line
from tests.mill.test_homing import MACHINE, homing_shop

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.mill.run.lifecycle import State
from openacr.sysvar import Store


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


# --- compensation -----------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-EPSILON")
@pytest.mark.parametrize(("epsilon", "moves"), [(0.002, 6), (0.05, 5)])
def test_ends_closer_than_epsilon_are_joined(epsilon: float, moves: int) -> None:
    """Round a corner of 2 degrees the ends of the two offset lines are 0.0087 apart."""
    shop = Shop(P250_101=epsilon, P1001=0.25)
    shop.run_text("G90 F300\nG1 X0 Y-1\nG42 D1 X0 Y0\nX2\nX4 Y.07\nG40 X5 Y1\nM2\n")
    assert shop.runner.stream.moves == moves


# --- reading ahead ----------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-FWDTHR")
@pytest.mark.parametrize("ahead", [1, 10, 150])
def test_as_many_blocks_are_kept_ahead_during_motion(ahead: int) -> None:
    assert Store().read(250_117) == 10
    shop = Shop(P250_116=1, P250_117=ahead)
    counter = count_reads(shop, 1000)
    shop.pass_time(0.5)
    kept = []
    while shop.pulses()[0] < 40_000:
        shop.pass_time(STEP_S)
        kept.append(counter[0] - shop.runner.stream.tracker.sent)
    assert min(kept) >= ahead
    assert ahead > 1 or min(kept) < 150


def count_reads(shop: Shop, count: int) -> list[int]:
    """Start many moves of 10 ms each, less than may wait on the card; how many have been read."""
    read = [0]

    def entries(_host: object) -> object:
        for k in range(1, count + 1):
            read[0] += 1
            yield line(k, at(0.01 * k), 60.0)
        yield end()

    shop.runner.run(entries)  # type: ignore[arg-type]
    return read


# --- wiring -----------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-IOEXP")
@pytest.mark.parametrize(("modules", "is_there"), [(0, False), (1, False), (2, True)])
def test_expansion_modules_add_inputs_and_outputs(modules: int, is_there: bool) -> None:
    shop = Shop(P250_124=2, P400_001=325, P400_101=360)  # on the second module
    if modules < 2:
        with pytest.raises(UserError, match="P400001 Optional Stop"):
            Shop(P250_124=modules, P400_001=325)
        shop = Shop(P250_124=modules)
    assert (325 in shop.runner.io.inputs) == (360 in shop.runner.io.outputs) == is_there
    assert len(shop.runner.io.inputs) == 32 * (1 + modules)
    shop.controller.bit[325] = True
    shop.load("F600\nM12\nG1 X1\nM1\nX2\nM2\n")
    assert shop.until(State.HOLD, State.IDLE) is (State.HOLD if is_there else State.IDLE)
    assert shop.outputs((360,)) == [is_there]


# --- axes and home ----------------------------------------------------------------------


@pytest.mark.req("MILL-BEY-SPEED-MARKER")
@pytest.mark.parametrize(("marker", "speed"), [(0.0, 2.0), (0.5, 0.5)])
def test_marker_speed_replaces_that_of_the_home_tab(
    tmp_path: Path, marker: float, speed: float
) -> None:
    (tmp_path / "machine.toml").write_bytes(MACHINE.read_bytes())
    shop = homing_shop(Controller.from_project(tmp_path), P650_004=marker)
    shop.runner.home([0])
    seen = set()
    for _ in range(4000):
        if not shop.runner.is_busy:
            break
        shop.pass_time(STEP_S)
        seen.add(round(float(shop.controller.axis(0).velocity_ups), 3))
    assert shop.store.read(271) == 1
    assert {30.0, -5.0, -speed} <= seen


@pytest.mark.req("MILL-SYS-HOME-STP")
@pytest.mark.parametrize("ramp", [500.0, 60.0])
def test_homing_that_is_stopped_ramps_down_on_home_stp(tmp_path: Path, ramp: float) -> None:
    (tmp_path / "machine.toml").write_bytes(MACHINE.read_bytes())
    shop = homing_shop(Controller.from_project(tmp_path), P300_008=ramp)
    shop.runner.home([0])
    shop.pass_time(0.5)
    shop.runner.stop()
    shop.pass_time(STEP_S)
    first = shop.controller.axis(0).velocity_ups
    shop.pass_time(0.02)
    assert (first - shop.controller.axis(0).velocity_ups) / 0.02 == pytest.approx(ramp, rel=1e-3)


def test_an_axis_that_lost_its_position_counts_as_not_homed() -> None:
    shop = Shop(P200_004=0.001, P271=7)
    shop.load("F600\nG1 X5\nM2\n")
    shop.until(State.ALARM)
    assert 11 in codes(shop)
    assert shop.store.read(271) == 6


@pytest.mark.req("MILL-SYS-AXES-DACPOL")
@pytest.mark.parametrize(("polarity", "sign"), [(0, 1), (1, -1)])
def test_negative_polarity_turns_the_drive_output_round(polarity: int, sign: int) -> None:
    shop = Shop(P200_005=polarity)
    shop.start(line(1, at(1.0), 600.0), end())
    shop.pass_time(0.02)
    assert sign * shop.controller.p[axes.actual_position[0]] > 0


@pytest.mark.req("MILL-SYS-AXES-EXCESS")
@pytest.mark.parametrize(("band", "state"), [(0.0, State.IDLE), (0.01, State.ALARM)])
def test_an_error_outside_its_band_stops_the_machine(band: float, state: State) -> None:
    shop = Shop(P200_004=band, P150_000=0.0005)  # a weak loop lags
    shop.start(line(1, at(5), 1200.0), end())
    assert shop.until(State.IDLE, State.ALARM) is state
    assert codes(shop) == ([11] if state is State.ALARM else [])
    if state is State.ALARM:
        assert shop.controller.p[axes.actual_position[0]] < 50_000


@pytest.mark.req("MILL-SYS-AXES-INPOS")
@pytest.mark.parametrize(("band", "waits"), [(0.0, False), (0.0005, True)])
def test_an_exact_stop_waits_for_the_in_position_band(band: float, waits: bool) -> None:
    times = []
    for code in ("G64", "G61"):
        shop = Shop(P200_003=band, P150_000=0.0005)
        shop.load(f"F1200 {code} G1 X1\nM0\nM2")
        shop.until(State.HOLD)
        times.append(shop.controller.tick * shop.controller.period_s)
        error = abs(float(shop.controller.p[axes.following_error[0]]))
        assert code == "G64" or not waits or error <= band * 10_000
    assert (times[1] > times[0] + 0.02) == waits
