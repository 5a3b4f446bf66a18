"""INVK: joints computed by a program."""

from itertools import pairwise

import numpy as np
import pytest
from tests.basic.motion_bench import Bench

from openacr.basic.execute.language_state import put_back, take
from openacr.basic.language.registry import Level
from openacr.map.rows import axes

IN_MOTION = 516
PPU = 2000
CIRCLE = ("P12361=SIN(P12360)", "P12617=COS(P12360)")
ARM = (  # two links of length 1: X is the shoulder, Y the elbow, both in degrees
    "DV0=(P12360*P12360+P12616*P12616-2)/2", "DV1=ACOS(DV0)",
    "DV2=ATAN(P12616/P12360)-DV1/2", "P12361=DV2", "P12617=DV1",
)  # fmt: skip


def bench(*program: str, number: int = 7) -> Bench:
    """X and Y with a program of kinematics."""
    made = Bench("X", "Y")
    made.at(Level.SYS).type("HALT ALL")
    made.all("DIM P(20)", f"DIM PROG{number}(4000)").at(Level.PROG, 0)
    made.all(f"PPU X{PPU} Y{PPU}", "ACC 1000 DEC 1000 STP 1000 VEL 100")
    made.at(Level.PROG, number).all("DIM DV(3)", "PROGRAM", *program, "ENDP")
    return made.at(Level.PROG, 0).all(f"INVK PROG{number}")


def trace(made: Bench, *lines: str) -> np.ndarray:
    """Joints in units, tick by tick, until they rest."""
    found = []
    for line in lines:
        assert made.type(line) == "", line
        while made.is_waiting:
            found.append(_joints(made.ticks(1)))
    while made.bit(IN_MOTION):
        found.append(_joints(made.ticks(1)))
    found.append(_joints(made.ticks(1)))
    return np.array(found)


def _joints(made: Bench) -> list[float]:
    return [made.psp(axis) / PPU for axis in range(2)]


@pytest.mark.req("ACR-INVK-03")
def test_input_and_output_stand_in_the_parameters_of_each_axis() -> None:
    made = bench("P12617=P12616*2").all("INVK ON")
    trace(made, "X3 Y2")
    assert (axes.invk_input[0], axes.invk_output[0]) == (
        12360,
        12361,
    )
    assert [made.p(n) for n in (12360, 12361, 12616, 12617)] == [3, 3, 2, 4]
    assert _joints(made) == [3, 4]  # X has not been written: as it is
    assert (made.p(12288), made.p(12544)) == (3 * PPU, 2 * PPU)


def test_a_tool_on_two_links_draws_a_straight_line() -> None:
    made = bench(*ARM)
    trace(made, "X-60 Y120")
    made.all("INVK ON", f"P12288={0.5 * PPU:.0f}", f"P12544={-0.5 * 3**0.5 * PPU:.0f}")
    trace(made, "X1 Y0.5")
    path = trace(made, "X1.5 Y1")
    shoulder, elbow = np.radians(path[:, 0]), np.radians(path[:, 0] + path[:, 1])
    x, y = np.cos(shoulder) + np.cos(elbow), np.sin(shoulder) + np.sin(elbow)
    assert y - x == pytest.approx(-0.5, abs=1e-5)
    assert (x[0], x[-1]) == pytest.approx((1, 1.5), abs=1e-3)


def test_nothing_moves_when_it_is_switched() -> None:
    made = bench(*CIRCLE)
    trace(made, "X3 Y4")
    for line in ("INVK ON", "INVK OFF"):
        made.all(line).ticks(5)
        assert _joints(made) == [3, 4]


def test_a_written_position_says_where_the_tool_is() -> None:
    made = bench("P12361=P12360-10").all("INVK ON", f"P12288={10 * PPU}").ticks(2)
    assert _joints(made) == [0, 0]
    path = trace(made, "X12")
    assert path[-1].tolist() == [2, 0]
    assert np.all(np.abs(np.diff(path[:, 0])) < 0.06)


def test_an_error_kills_the_moves_and_is_reported() -> None:
    made = bench("P12361=1/P10").all("P10=0", "INVK ON")
    made.all("X5").ticks(5)
    assert made.bit(522)
    assert not made.bit(IN_MOTION)
    assert made.type("INVK") == "PROG7 OFF"
    assert _joints(made)[0] < 1


def test_a_program_without_end_holds_the_joints() -> None:
    made = bench("_LOOP", "GOTO LOOP").all("INVK ON", "X1")
    made.ticks(300)
    assert _joints(made) == [0, 0]
    made.all("SET 522").ticks(2).all("CLR 522", "INVK OFF")


def test_queries_and_refusals() -> None:
    made = Bench("X")
    assert made.type("INVK") == "OFF"
    assert made.type("INVK ON") == "Invalid argument"
    assert made.type("INVK PROG16") == "Invalid argument"
    made.all("INVK PROG3")
    assert made.type("INVK") == "PROG3 OFF"
    assert made.type("INVK ON") == "Invalid argument"  # no text
    made = bench(*CIRCLE).all("X100")
    assert made.type("INVK ON") == "Not valid while in motion"


def test_a_snapshot_in_the_middle_ends_the_same() -> None:
    made = bench(*CIRCLE).all("INVK ON", "X90").ticks(200)
    kept, state = made.memory.snapshot(), take(made.system, made.executor)
    first = trace(made)
    made.memory.restore(kept)
    put_back(made.system, made.executor, state)
    assert np.array_equal(trace(made), first)
    assert all(a != b for a, b in pairwise(first[:50, 0]))
