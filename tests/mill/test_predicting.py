"""Predicted run times against closed forms and against runs on the virtual card."""

import math
import random

import pytest
from tests.mill.prediction import predicted
from tests.mill.shop import Shop, at, end, line, rapid, src
from tests.search import sparse

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings


def of(shop: Shop, *entries: c.Entry) -> float:
    return predicted(entries, Settings(shop.store), at()).time_s


def test_one_move_takes_its_length_and_two_ramps() -> None:
    # v = 10 units/s, a = 100 units/s2: 5/10 s and 10/100 s for both ramps together
    assert of(Shop(), line(1, at(5)), end()) == pytest.approx(0.6)


def test_a_short_move_never_reaches_its_feed() -> None:
    # 0.25 units up and down: 2 sqrt(L / a)
    assert of(Shop(), rapid(1, at(0.25)), end()) == pytest.approx(2 * math.sqrt(0.25 / 100))


def test_many_pieces_of_a_line_take_as_long_as_the_line() -> None:
    shop = Shop()
    pieces = [line(n, at(n / 200)) for n in range(1, 1001)]
    assert of(shop, *pieces, end()) == pytest.approx(of(shop, line(1, at(5)), end()), rel=1e-6)


def some_program(seed: int) -> list[c.Entry]:
    chance = random.Random(seed)
    x = y = 0.0
    entries: list[c.Entry] = []
    for number in range(1, 120):
        kind = chance.choices(("line", "short", "rapid", "arc", "dwell"), (6, 10, 1, 3, 0.5))[0]
        feed = chance.choice((60.0, 300.0, 900.0))
        if kind == "dwell":
            entries.append(c.Dwell(src(number), 0.3))
            continue
        reach = 0.02 if kind == "short" else 2.0
        end_x, end_y = x + chance.uniform(-reach, reach), y + chance.uniform(-reach, reach)
        if kind == "rapid":
            entries.append(rapid(number, at(end_x, end_y)))
        elif kind == "arc":
            middle = ((x + end_x) / 2, (y + end_y) / 2)
            radius = math.dist((x, y), middle)
            turn = chance.choice((math.pi, -math.pi))
            entries.append(
                c.Arc(
                    src(number), at(end_x, end_y), c.Plane.XY, middle, turn, radius, radius,
                    c.Pace(feed),
                )
            )  # fmt: skip
        else:
            mode = chance.choice((c.PathMode.FREE, c.PathMode.CORNER, c.PathMode.EXACT))
            entries.append(line(number, at(end_x, end_y), feed=feed, mode=mode))
        x, y = end_x, end_y
    return [*entries, end()]


@pytest.mark.parametrize("seed", sparse(range(4), 3))
def test_the_prediction_is_what_the_card_takes(seed: int) -> None:
    shop = Shop(P250_010=20.0, P250_011=120.0, P650_003=120.0)
    entries = some_program(seed)
    expected = of(shop, *entries)
    assert shop.finish(*entries) == pytest.approx(expected, rel=0.01)
