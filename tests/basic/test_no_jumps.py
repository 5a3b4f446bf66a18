"""Whatever is typed while axes move, no setpoint jumps and the parts add up to it."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.basic.motion_bench import PERIOD_S, Bench
from tests.search import search

from openacr.map.rows import axes

# axis Y jogs and leads gear and cam of X
LEADER_CPS = 1 / PERIOD_S  # of 1000; as whole counts: one in a period at most
FASTEST_CPS = 2000 + 1500 + 2 * LEADER_CPS + LEADER_CPS  # move at twice its feed, jog, gear, cam
ROWS = [
    axes.position_cnt[0],
    axes.gear_cnt[0],
    axes.jog_cnt[0],
    axes.cam_cnt[0],
    axes.kinematics_cnt[0],
]
PSP, SSP = axes.psp_cnt[0], axes.ssp_cnt[0]
LINES = (
    "X400", "X0", "X/150", "X-300", "JOG FWD X", "JOG REV X", "JOG OFF X", "JOG ABS X50",
    "JOG INC X-80", "JOG VEL X1500", "JOG VEL X20", "GEAR ON X", "GEAR OFF X", "GEAR RATIO X2",
    "GEAR RATIO X-0.5", "CAM ON X", "CAM OFF X", "FOV 0", "FOV 0.4", "FOV 1", "FOV 2", "SET 520",
    "SET 521", "HALT", "SET 522", "SET 8467", "CLR 8467 : CLR 522", "JOG FWD Y", "JOG OFF Y",
    "JRK 20000", "JRK 0", "STP 0", "STP 4000", "JOG JRK X40000", "JOG JRK X0", "JOG REN X50",
    "JOG RES X-30", "GEAR RES X20", "CAM RES X15",
)  # fmt: skip
KILLS = ("HALT", "SET 522", "SET 8467", "STP 0")


def sequence(seed: int) -> list[tuple[str, int]]:
    """Lines and the ticks after each; kills are rare, so that much moves meanwhile."""
    chance = random.Random(seed)
    lines = [line for line in LINES if line not in KILLS]
    steps = []
    for _ in range(25):
        line = chance.choice(KILLS if chance.random() < 0.05 else lines)
        steps.append((line, chance.choice((0, 1, 3, 50, 400))))
    return steps


STEPS = st.integers(0, 10**9).map(sequence)


def bench() -> Bench:
    """Two axes; a cam of slope 1 at most and a gear that follow Y."""
    made = Bench("X", "Y").all("ACC 4000 DEC 6000 STP 4000 VEL 1000", "MBUF ON", "DIM LA(1)")
    made.all("DIM LA0(5)", "LA0(1)=100 : LA0(2)=200 : LA0(3)=100")
    made.all("JOG ACC X5000 Y5000 : JOG DEC X5000 Y5000 : JOG VEL X1500 Y1000")
    made.all("AXIS0 HLDEC 20000 : AXIS1 HLDEC 20000")
    made.all("GEAR SRC X P12550", "GEAR ACC X5", "GEAR DEC X5", "GEAR RATIO X1")
    return made.all("CAM DIM X1", "CAM SEG X(0,400,LA0)", "CAM SRC X P12550")


def step(made: Bench, before: float, parts_before: list[float]) -> tuple[float, list[float]]:
    """One tick: the setpoint is the sum of its parts and has not jumped."""
    made.ticks(1)
    F = made.memory.F
    parts = [F[row] for row in ROWS]
    assert F[PSP] == pytest.approx(math.fsum(parts), abs=1e-6)
    assert F[SSP] == F[PSP]
    largest = FASTEST_CPS * PERIOD_S * 1.02
    assert abs(F[PSP] - before) <= largest, (before, F[PSP], parts_before, parts)
    return F[PSP], parts


@search(150, derandomize=True, database=None)
@given(STEPS)
def test_no_sequence_of_commands_makes_a_setpoint_jump(steps: list[tuple[str, int]]) -> None:
    made = bench()
    made.ticks(1)
    place, parts = made.memory.F[PSP], [made.memory.F[row] for row in ROWS]
    for line, wait in steps:
        if not made.is_waiting:
            made.type(line)
        for _ in range(wait):
            place, parts = step(made, place, parts)
    for _ in range(200):
        place, parts = step(made, place, parts)


@search(60, derandomize=True, database=None)
@given(STEPS)
def test_after_everything_a_move_still_ends_on_its_target(steps: list[tuple[str, int]]) -> None:
    made = bench()
    for line, wait in steps:
        if not made.is_waiting:
            made.type(line)
        made.ticks(wait)
    made.ticks(2000)
    for line in ("HALT ALL", "CLR 8467 : CLR 8499 : CLR 522", "JOG OFF X Y", "GEAR OFF X",
                 "CAM OFF X", "FOV 1", "SET 521", "JRK 0", "STP 4000", "JOG JRK X0"):  # fmt: skip
        if made.is_waiting:
            made.session.typed(27)
        made.type(line)
        made.ticks(1000)
    assert made.type("X123") == ""
    made.ticks(6000)
    assert made.memory.F[ROWS[0]] == 123.0
