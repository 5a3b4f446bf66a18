"""Homing of three axes: switches, markers, the zero of the machine."""

import pytest
from tests.examples.observe import Observation, load, observe
from tests.examples.watches import HOMING, MISSING_SWITCH

from openacr.controller import Controller
from openacr.map.rows import motors
from openacr.plant.describe.counts import position_of

FOUND, FAILED, MARKER = 16134, 16135, 777
X, Y, Z = range(3)


@pytest.fixture(scope="module")
def run() -> Observation:
    return observe(HOMING)


def on_machine_u(card: Controller, axis: int) -> float:
    """Where an axis stands on the machine, whatever its counters say."""
    count = card.memory.F[motors.position_cnt[axis]]
    return position_of(card.world.axis[axis], count)


@pytest.mark.req("ACR-APP-HOMING-03")
def test_z_homes_first_and_all_end_at_the_zero_of_the_machine(run: Observation) -> None:
    (z,), (x,), (y,) = (run.rises(FOUND + 32 * axis) for axis in (Z, X, Y))
    assert z.time_s < min(run.rises(792)[0].time_s, run.rises(824)[0].time_s)
    assert max(x.time_s, y.time_s) < run.rises(516)[0].time_s
    for axis, count_u in ((X, 10 / 8000), (Y, 10 / 8000), (Z, 5 / 8000)):
        assert run.card.bit[MARKER + 32 * axis]
        assert run.card.axis(axis).commanded_cnt == 0
        # The marker is found to the count; the motor stands within three counts of its place.
        assert on_machine_u(run.card, axis) == pytest.approx(0.0, abs=4 * count_u)


@pytest.mark.req("ACR-APP-HOMING-04")
def test_the_option_flags_are_those_of_the_program(run: Observation) -> None:
    options = [[run.card.bit[16152 + 32 * axis + k] for k in range(3)] for axis in (X, Y, Z)]
    assert options == [[True, False, False], [True, False, True], [True, True, True]]


@pytest.mark.req("ACR-APP-HOMING-06")
def test_the_profiles_for_the_work_are_set_at_the_end(run: Observation) -> None:
    card = run.card
    card.send("ECHO 6\rPROG0\r")
    profile = [card.send(f"{name}\r").strip() for name in ("ACC", "VEL", "DEC", "STP", "JRK")]
    assert profile == ["750", "250", "750", "750", "2250"]
    for name, values in (("ACC", [1000, 1000, 200]), ("VEL", [300, 300, 100])):
        assert [int(value) for value in card.send(f"JOG {name} X Y Z\r").split()] == values
    assert card.send("JOG DEC X Y Z\r").split() == ["1000", "1000", "200"]


def test_the_edge_is_found_where_the_switch_is() -> None:
    card = load("homing_xyz")
    card.send("PROG0\rRUN\r")
    # the edges chosen in the program, and how far the slow approach may run past them in a tick
    for axis, edge_u, approach_ups in ((Z, 1.9, 5), (X, 92.0, 25), (Y, 52.5, 15)):
        assert card.until(FOUND + 32 * axis, timeout_s=6.0)
        zero_u = on_machine_u(card, axis) - card.axis(axis).actual_u
        assert zero_u == pytest.approx(edge_u, abs=2 * approach_ups * card.period_s)


@pytest.mark.req("ACR-APP-HOMING-05")
def test_a_missing_switch_is_reported_and_nothing_else_moves() -> None:
    run = observe(MISSING_SWITCH)
    assert run.printed.count(" Homing Failed") == 1
    assert " Z Homing Failed\r\n" in run.printed
    assert [run.card.bit[FAILED + 32 * axis] for axis in (X, Y, Z)] == [False, False, True]
    assert not run.card.bit[1024]
    assert run.card.bit[8531]
    assert [run.card.statistics(axis).distance_u for axis in (X, Y)] == [0.0, 0.0]
    # once to the negative limit switch, once to the positive one
    assert on_machine_u(run.card, Z) == pytest.approx(55.1, abs=0.1)
