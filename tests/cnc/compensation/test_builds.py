"""The geometry gives the same bits compiled and as plain Python."""

import math
import random

from openacr.cnc.compensation import curve_cy, join_cy
from openacr.cnc.compensation.curve_cy import CX, CY, SWEEP, X0, X1, Y0, Y1
from openacr.cnc.rows.chains import COLUMNS
from openacr.compiled import pick
from openacr.views import F64

ROUNDS = 2000
AWAY = 0.01


def rows() -> F64:
    return memoryview(bytearray(8 * COLUMNS * 2)).cast("d")


def numbers(rnd: random.Random) -> tuple[list[float], float, float]:
    """Two elements that meet, their sweeps, and a distance."""
    points = [round(rnd.uniform(-2, 2), rnd.choice((1, 3, 16))) for _ in range(6)]
    return points, rnd.choice((-1, 1)) * rnd.uniform(0.01, 1), rnd.choice((0, 1e-4, 0.01))


def lay(F: F64, i: int, ends: list[float], bulge: float, run: dict[str, object]) -> int:
    """A line, or an arc of a random height."""
    x0, y0, x1, y1 = ends
    if bulge == 0.0:
        centre, sweep = (0.0, 0.0), 0.0
    else:
        h = 0.5 * (1 / bulge - bulge) / 2
        centre = ((x0 + x1) / 2 - h * (y1 - y0), (y0 + y1) / 2 + h * (x1 - x0))
        sweep = 4 * math.atan(bulge)
    for column, number in ((X0, x0), (Y0, y0), (X1, x1), (Y1, y1), (SWEEP, sweep)):
        F[i + column] = number
    F[i + CX], F[i + CY] = centre
    return run["curve"](F, i, AWAY, 1e-3, 0.01)  # type: ignore[operator, no-any-return]


def test_both_builds_agree_in_every_bit() -> None:
    plain: dict[str, object] = {
        "curve": curve_cy.comp_lay,
        "place": curve_cy.comp_place,
        "fit": curve_cy.comp_fit,
        "range": curve_cy.comp_range,
        "join": join_cy.comp_join,
        "meet": join_cy.comp_meet,
    }
    fast: dict[str, object] = {name: pick(each) for name, each in plain.items()}  # type: ignore[arg-type]
    rnd = random.Random(3)
    for _ in range(ROUNDS):
        points, away, bulge = numbers(rnd)
        bulges = (rnd.choice((0.0, rnd.uniform(-3, 3))), rnd.choice((0.0, bulge, -2.0)))
        is_inside = rnd.random() < 0.1
        results = []
        for run in (plain, fast):
            F = rows()
            said = [
                lay(F, 0, points[:4], bulges[0], run),
                lay(F, COLUMNS, points[2:], bulges[1], run),
            ]
            for i in (0, COLUMNS):
                said.append(run["place"](F, i, away))  # type: ignore[operator]
            said.append(run["join"](F, 0, COLUMNS, 1e-3, 1e-4, is_inside))  # type: ignore[operator]
            said.append(run["meet"](F, 0, COLUMNS, 1e-3, 0.01, 1e-4, is_inside))  # type: ignore[operator]
            said.append(run["fit"](F, 0, 1e-3, 0.01))  # type: ignore[operator]
            said.append(run["range"](F, 0, *points[4:]))  # type: ignore[operator]
            results.append((said, bytes(F)))
        assert results[0] == results[1]
