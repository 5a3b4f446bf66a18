"""Four diamonds from one set of coordinates, shifted by jogs."""

from dataclasses import dataclass
from math import sqrt

import pytest
from tests.examples.observe import Observation, load, observe
from tests.examples.watches import DIAMONDS

MOTION, X_JOGS, Y_JOGS = 516, 792, 824
PPU = 40000
SHAPE = [(-2, 1), (0, 2), (2, 1), (0, 0)]
MOVE_S = 4 / 20 + sqrt(5) / 4  # sqrt(5) units at 4 units/s, ramps of 20 units/s2


@dataclass(frozen=True, slots=True)
class Corner:
    """Where X and Y were, in pulses, in a tick in which the master stood for a moment."""

    moves: tuple[int, int]
    jogs: tuple[int, int]
    setpoints: tuple[int, int]


@pytest.fixture(scope="module")
def corners() -> list[Corner]:
    """The ends of all sixteen moves."""
    card = load("diamonds")
    card.send("PROG0\rRUN\r")

    def row(offset: int) -> tuple[int, int]:
        return int(card.p[12288 + offset]), int(card.p[12544 + offset])

    found = []
    ends = {(x * PPU, y * PPU) for x, y in SHAPE}
    before = row(0)
    while card.tick < 30_000:
        card.advance(1)
        now = row(0)
        if now in ends and before not in ends:
            found.append(Corner(now, row(9), row(6)))
        before = now
    return found


def shifted(corners: list[Corner], shape: int) -> list[tuple[float, float]]:
    four = corners[4 * shape : 4 * shape + 4]
    return [(x / PPU, y / PPU) for x, y in (corner.setpoints for corner in four)]


@pytest.mark.req("ACR-SUM-03")
def test_the_first_shape_has_the_programmed_points(corners: list[Corner]) -> None:
    assert shifted(corners, 0) == SHAPE


@pytest.mark.req("ACR-SUM-04")
def test_the_second_shape_lies_3_units_higher(corners: list[Corner]) -> None:
    assert shifted(corners, 1) == [(-2, 4), (0, 5), (2, 4), (0, 3)]


@pytest.mark.req("ACR-SUM-05")
def test_the_third_shape_lies_5_units_to_the_right_too(corners: list[Corner]) -> None:
    assert shifted(corners, 2) == [(3, 4), (5, 5), (7, 4), (5, 3)]


@pytest.mark.req("ACR-SUM-06")
def test_the_fourth_shape_is_down_again(corners: list[Corner]) -> None:
    assert shifted(corners, 3) == [(3, 1), (5, 2), (7, 1), (5, 0)]


@pytest.mark.req("ACR-SUM-07", "ACR-SUM-08")
def test_the_moves_repeat_and_the_jogs_stay(corners: list[Corner]) -> None:
    assert [corner.moves for corner in corners] == [(x * PPU, y * PPU) for x, y in SHAPE] * 4
    shifts = [(0, 0), (0, 3), (5, 3), (5, 0)]
    jogs = [(x * PPU, y * PPU) for x, y in shifts for _ in SHAPE]
    assert [corner.jogs for corner in corners] == jogs


def test_shapes_and_jogs_take_their_time() -> None:
    run: Observation = observe(DIAMONDS)
    # four moves one after the other, each ending in a whole tick
    assert run.spans_s(MOTION) == pytest.approx([4 * MOVE_S] * 4, abs=0.002)
    # 10 units/s with ramps of 50 units/s2: 0.2 s + 3/10 and 5/10 s
    assert run.spans_s(Y_JOGS) == pytest.approx([0.5, 0.5], abs=0.0006)
    assert run.spans_s(X_JOGS) == pytest.approx([0.7], abs=0.0006)
