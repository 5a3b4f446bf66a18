"""CONTROL, I/O, PROBE and SPEEDS settings of the store: what each does to the machine."""

import math
from pathlib import Path

import pytest
from tests.mill.shop import STEP_S, Shop
from tests.mill.test_homing import MACHINE, homing_shop

from openacr.cnc.canonical import Arc
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.mill.run.lifecycle import Options, State
from openacr.sysvar import Store

VECTOR_VELOCITY = 8193
CORNERED = "G90 F{feed} G62\nG1 X2\nX{x:.6f} Y{y:.6f}\nM2\n"


def codes(shop: Shop) -> list[int]:
    return [alarm.kind.code for alarm in shop.runner.alarms.active]


def slowest_at_corner(turn_deg: float, feed: float = 300.0, **cells: float) -> float:
    """The lowest path speed, units per minute, near a corner at X2 in G62."""
    shop = Shop(P650_008=50.0, **cells)
    x, y = 2 + 2 * math.cos(math.radians(turn_deg)), 2 * math.sin(math.radians(turn_deg))
    shop.load(CORNERED.format(feed=feed, x=x, y=y))
    slowest = math.inf
    while shop.runner.is_busy:
        shop.controller.advance(seconds=0.001)
        shop.runner.step()
        px, py, _ = shop.place()
        if math.hypot(px - 2, py) < 0.1:
            slowest = min(slowest, 60 * float(shop.controller.p[VECTOR_VELOCITY]))
    return slowest


# --- corners ----------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-ACUTE1", "MILL-SYS-CTL-ACUTE2", "MILL-SYS-SPEED-MINCORNER")
@pytest.mark.parametrize(
    ("turn", "first", "second", "corner", "speed"),
    [
        (30, 0, 0, 40, 300),  # rule off
        (30, 40, 120, 40, 300),  # below the first angle
        (80, 40, 120, 40, 170),  # in the middle: 300 - 260 / 2
        (80, 40, 120, 100, 200),
        (150, 40, 120, 40, 0),  # complete stop
    ],
)
def test_corners_slow_between_the_two_angles(
    turn: float, first: float, second: float, corner: float, speed: float
) -> None:
    cells = {"P250_010": first, "P250_011": second, "P650_003": corner}
    assert slowest_at_corner(turn, **cells) == pytest.approx(speed, rel=0.02, abs=6.0)


# --- compensation -----------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-EPSILON")
@pytest.mark.parametrize(("epsilon", "moves"), [(0.002, 6), (0.05, 5)])
def test_ends_closer_than_epsilon_are_joined(epsilon: float, moves: int) -> None:
    """Round a corner of 2 degrees the ends of the two offset lines are 0.0087 apart."""
    shop = Shop(P250_101=epsilon, P1001=0.25)
    shop.run_text("G90 F300\nG1 X0 Y-1\nG42 D1 X0 Y0\nX2\nX4 Y.07\nG40 X5 Y1\nM2\n")
    assert shop.runner.stream.moves == moves


@pytest.mark.req("MILL-SYS-CTL-SWEEPEPS")
@pytest.mark.parametrize(("epsilon", "arcs"), [(0.01, 1), (0.1, 0)])
def test_an_arc_with_a_smaller_sweep_is_a_line(epsilon: float, arcs: int) -> None:
    shop = Shop(P250_102=epsilon, P1001=0.25)
    x, y = 10 * math.sin(0.05), 10 - 10 * math.cos(0.05)
    text = f"G90 F300\nG41 D1 G1 X-1 Y0\nX0\nG3 X{x:.6f} Y{y:.6f} I0 J10\nG1 X3 Y3\nG40 X4 Y4\nM2\n"
    program = load(text, shop.store)
    run = Interpreter(program, shop.store, shop.runner.stream.host)
    found = [entry for entry in run.entries() if isinstance(entry, Arc) and not entry.is_inserted]
    assert len(found) == arcs


# --- tangential axis --------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-TANGAXIS", "MILL-BEY-PERPEPS")
@pytest.mark.parametrize(("epsilon", "turns_apart"), [(0.0, True), (45.0, False)])
def test_the_tangential_axis_turns_at_corners_or_along_small_ones(
    epsilon: float, turns_apart: bool
) -> None:
    shop = Shop(P250_112=3, P250_113=epsilon, P203_012=1, P203_007=0, P203_006=1000)
    shop.load("G90 F300\nM595\nG1 X1\nX2 Y.577350\nM596\nM2\n")
    apart = 0.0
    while shop.runner.is_busy:
        shop.pass_time(STEP_S)
        x, y, _ = shop.place()
        if abs(x - 1.0) < 1e-9 and y == 0.0:
            apart = max(apart, float(shop.controller.p[12288 + 3 * 256]) / 1000)
    assert float(shop.controller.p[12288 + 3 * 256]) / 1000 == pytest.approx(30.0, abs=0.01)
    assert (apart > 29.9) == turns_apart


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
        from tests.mill.shop import at, end, line

        for n in range(1, count + 1):
            read[0] += 1
            yield line(n, at(0.01 * n), 60.0)
        yield end()

    shop.runner.run(entries)  # type: ignore[arg-type]
    return read


@pytest.mark.req("MILL-SYS-CTL-REPEAT")
@pytest.mark.parametrize("is_forever", [0, 1])
def test_repeat_forever_runs_the_part_in_a_loop(is_forever: int) -> None:
    shop = Shop(P250_013=is_forever)
    shop.load("G90 F600\nG1 X1\nX0\nM2\n")
    shop.pass_time(3.0)
    assert shop.runner.is_busy == bool(is_forever)
    assert (shop.runner.passes > 3) == bool(is_forever)


@pytest.mark.req("MILL-FLOW-REPEAT")
@pytest.mark.parametrize("is_forever", [0, 1])
def test_the_shape_of_the_guide_without_its_if_is_repeated_for_ever_or_run_once(
    is_forever: int,
) -> None:
    """Each pass goes on from where the one before has ended: G91."""
    shop = Shop(P250_013=is_forever)
    shop.load("G91\nF1000\nP5=0\nN100\nP5=5\nX1\nY1\nM2\n")
    for passes in range(1, 21) if is_forever else (1,):
        while shop.runner.is_busy and shop.pulses()[1] < passes * 10_000:
            shop.pass_time(STEP_S)
        assert shop.pulses()[1] == passes * 10_000
    if is_forever:
        shop.runner.stop()
        shop.pass_time(0.5)
        shop.runner.abort()
    assert shop.until(State.IDLE) is State.IDLE
    assert is_forever or shop.pulses() == (10_000, 10_000, 0)


@pytest.mark.req("MILL-G4")
@pytest.mark.parametrize("seconds", [0.1, 2.5])
def test_a_dwell_lasts_as_many_seconds_of_the_card(seconds: float) -> None:
    assert Shop().run_text(f"G4 F{seconds}\nM2\n") == pytest.approx(seconds, abs=0.011)


@pytest.mark.req("MILL-SYS-CTL-GOTOSTART")
@pytest.mark.parametrize(("returns", "x"), [(1, 5000), (0, 20000)])
def test_a_dry_run_ends_at_its_start_where_the_store_says_so(returns: int, x: int) -> None:
    shop = Shop(P250_006=returns)
    shop.run_text("F600 G1 X.5\nM2\n")
    shop.run_text("G0 Z.1\nF600 G1 X2\nM2\n", Options(is_dry=True))
    assert shop.pulses()[0] == x


@pytest.mark.req("MILL-SYS-SPEED-TRIAL")
@pytest.mark.parametrize("trial", [60.0, 180.0])
def test_a_dry_run_moves_at_trial_speed(trial: float) -> None:
    shop = Shop(P650_001=trial)
    shop.load("F6\nG1 X5\nM2\n", Options(is_dry=True))
    shop.pass_time(0.5)
    assert shop.controller.axis(0).velocity_ups == pytest.approx(trial / 60)


# --- wiring -----------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-CTL-INPOL")
@pytest.mark.parametrize("is_inverted", [0, 1])
def test_an_inverted_input_is_active_when_it_is_off(is_inverted: int) -> None:
    shop = Shop(P400_001=9, P251_009=is_inverted)  # optional stop
    shop.load("F600\nG1 X1\nM1\nX2\nM2\n")
    assert shop.until(State.HOLD, State.IDLE) is (State.HOLD if is_inverted else State.IDLE)


@pytest.mark.req("MILL-SYS-CTL-OUTPOL")
@pytest.mark.parametrize("is_inverted", [0, 1])
def test_an_inverted_output_is_switched_off_to_act(is_inverted: int) -> None:
    shop = Shop(P400_101=40, P252_040=is_inverted)
    shop.load("M12\nM0\nM25\nM0\nM2\n")
    seen = []
    for _ in range(2):
        shop.until(State.HOLD)
        seen += shop.outputs((40,))
        shop.runner.start()
        shop.pass_time(0.05)
    assert seen == ([False, True] if is_inverted else [True, False])


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


@pytest.mark.req("MILL-SYS-IO-BLKSKIP")
@pytest.mark.parametrize(("number", "is_skipped"), [(9, True), (10, False), (-1, False)])
def test_block_skip_is_the_input_of_the_tab(number: int, is_skipped: bool) -> None:
    shop = Shop(P400_000=number)
    shop.controller.set_input(9, True)
    shop.pass_time(0.02)
    shop.run_text("F600\nG1 X1\n/X2\nM2\n")
    assert shop.pulses()[0] == (10000 if is_skipped else 20000)


@pytest.mark.req("MILL-SYS-IO-OPTSTOP")
@pytest.mark.parametrize(("number", "stops"), [(9, True), (10, False), (-1, False)])
def test_optional_stop_is_the_input_of_the_tab(number: int, stops: bool) -> None:
    shop = Shop(P400_001=number)
    shop.controller.set_input(9, True)
    shop.load("F600\nG1 X1\nM1\nX2\nM2\n")
    assert shop.until(State.HOLD, State.IDLE) is (State.HOLD if stops else State.IDLE)


@pytest.mark.req("MILL-SYS-IO-LUBE")
@pytest.mark.parametrize(("number", "is_alarm"), [(8, True), (-1, False)])
def test_the_lubrication_contact_holds_the_program(number: int, is_alarm: bool) -> None:
    shop = Shop(P400_012=number)
    shop.load("F60\nG1 X5\nM2\n")
    shop.pass_time(0.2)
    shop.controller.set_input(8, True)
    shop.pass_time(0.3)
    assert codes(shop) == ([43] if is_alarm else [])
    assert shop.runner.state is (State.PAUSED if is_alarm else State.RUN)


@pytest.mark.req("MILL-SYS-IO-G27IN", "MILL-SYS-IO-G27OUT")
@pytest.mark.parametrize("answers", [True, False])
def test_g27_switches_its_output_and_asks_its_input(answers: bool) -> None:
    shop = Shop(P400_010=15, P400_011=46, P600_005=0.5, P271=7)
    shop.load("G90 G27 X1 Y1\nM2\n")
    shop.until(State.WAIT)
    while shop.runner.reason != "reference input":
        shop.pass_time(STEP_S)
    assert shop.outputs((46,)) == [True]
    shop.controller.set_input(15, answers)
    shop.until(State.IDLE, State.ALARM)
    assert codes(shop) == ([] if answers else [31])
    assert shop.pulses()[0] == (10000 if answers else 0)


# --- probe ------------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-PROBE-INPUT", "MILL-SYS-PROBE-EDGE")
@pytest.mark.parametrize(("number", "is_trailing"), [(16, 0), (16, 1), (20, 0)])
def test_the_probe_trips_with_the_input_and_edge_of_the_tab(number: int, is_trailing: int) -> None:
    shop = Shop(P600_000=number, P600_001=is_trailing, P600_002=1)
    shop.controller.set_input(number, bool(is_trailing))
    shop.pass_time(0.02)
    shop.load("G90 F60\nG31 X5\nM2\n")
    shop.pass_time(1.0)
    other = 20 if number == 16 else 16
    shop.controller.set_input(other, True)
    shop.pass_time(1.0)
    assert shop.runner.reason == "probing"
    shop.controller.set_input(number, not is_trailing)
    shop.until(State.IDLE)
    assert shop.place()[0] == pytest.approx(1.95, abs=0.1)


@pytest.mark.req("MILL-SYS-PROBE-NONE")
def test_g31_without_a_probe_is_an_error() -> None:
    shop = Shop()
    shop.load("G90 F60\nG1 X1\nG31 X5\nM2\n")
    assert shop.until(State.ALARM) is State.ALARM
    assert "E243" in shop.runner.alarms.active[0].text
    assert shop.pulses()[0] == 10000


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


def test_corner_angles_in_the_wrong_order_are_refused() -> None:
    with pytest.raises(UserError, match="Acute Angle2"):
        Shop(P250_010=50.0, P250_011=20.0).run_text("G1 X1 F60\nM2\n")
