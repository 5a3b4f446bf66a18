"""Absolute and incremental moves and jogs."""

from collections.abc import Sequence

import pytest
from tests.examples.observe import load, observe
from tests.examples.watches import BASIC_MOTION

from openacr.controller import Controller

MOTION, JOGS, RUNS = 516, 792, 1024
CURRENT, JOG_OFFSET = 12288, 12297
PPU = 800


def seconds(distances: Sequence[int]) -> float:
    """Time for moves or jogs from rest to rest at 200 units/s with ramps of 1000 units/s2."""
    return sum(0.2 + abs(distance) / 200 for distance in distances)


ABSOLUTE = [100, 100, 100, 100]  # the first one, X0, has no length
INCREMENTAL = [-800, 500, 200, 100]
COMBINED = [-400, 200, 50, 150]
JOG_ABSOLUTE = [-400, 100, 100, 100, 100]
JOG_COMBINED = [-400, 200, 50, 150]
PARTS = [ABSOLUTE, INCREMENTAL, COMBINED, JOG_ABSOLUTE, INCREMENTAL, JOG_COMBINED]


@pytest.fixture
def card() -> Controller:
    card = load("basic_motion")
    card.send("PROG0\r")
    return card


def places(card: Controller, row: int, parts: Sequence[int]) -> list[float]:
    """Where a part of the program comes to rest, move by move, in units."""
    found = []
    for distance in parts:
        card.advance(seconds=seconds([distance]))
        found.append(round(card.p[row] / PPU, 1))
    return found


@pytest.mark.req("ACR-APP-BASIC-01")
def test_the_program_ends_after_the_sum_of_all_moves() -> None:
    run = observe(BASIC_MOTION)
    (begin,), (end,) = run.rises(MOTION), run.falls(RUNS)
    assert end.time_s - begin.time_s == pytest.approx(sum(map(seconds, PARTS)), abs=0.01)
    assert sum(map(seconds, PARTS)) == pytest.approx(35.0)
    assert run.card.axis(0).commanded_cnt == 400 * PPU
    travelled = run.card.statistics(0).distance_u
    assert travelled == pytest.approx(sum(abs(delta) for part in PARTS for delta in part))


@pytest.mark.req("ACR-APP-BASIC-02", "ACR-APP-BASIC-03", "ACR-APP-BASIC-04")
def test_each_part_of_moves_ends_at_400(card: Controller) -> None:
    card.send("RUN\r")
    card.until(MOTION)
    assert places(card, CURRENT, ABSOLUTE) == [100, 200, 300, 400]
    assert places(card, CURRENT, INCREMENTAL) == [-400, 100, 300, 400]
    assert places(card, CURRENT, COMBINED) == [0, 200, 250, 400]


@pytest.mark.req("ACR-APP-BASIC-05", "ACR-APP-BASIC-06", "ACR-APP-BASIC-07")
def test_each_part_of_jogs_ends_at_offset_0(card: Controller) -> None:
    card.send("RUN\r")
    card.until(JOGS)
    assert places(card, JOG_OFFSET, JOG_ABSOLUTE) == [-400, -300, -200, -100, 0]
    assert places(card, JOG_OFFSET, INCREMENTAL) == [-800, -300, -100, 0]
    assert places(card, JOG_OFFSET, JOG_COMBINED) == [-400, -200, -150, 0]
    assert card.p[CURRENT] == 400 * PPU


@pytest.mark.parametrize(
    "moves",
    [
        pytest.param(
            ("X0", "X100", "X200", "X300", "X400"), marks=pytest.mark.req("ACR-MOT-10"), id="abs"
        ),
        pytest.param(
            ("X0", "X/-400", "X/500", "X/200", "X/100"),
            marks=pytest.mark.req("ACR-MOT-11"),
            id="inc",
        ),
        pytest.param(
            ("x/-400", "x200", "x/50", "x400"), marks=pytest.mark.req("ACR-MOT-12"), id="mixed"
        ),
    ],
)
def test_moves_typed_one_per_line_end_at_400(card: Controller, moves: tuple[str, ...]) -> None:
    for move in moves:
        card.send(f"{move}\r")
        card.until(MOTION, is_=False)
    assert card.axis(0).commanded_cnt == 400 * PPU


def test_the_program_may_start_anywhere(card: Controller) -> None:
    card.send("X-150\r")
    card.until(MOTION, is_=False)
    card.send("RUN\r")
    card.advance(5)
    assert card.until(RUNS, is_=False)
    assert card.axis(0).commanded_cnt == 400 * PPU
