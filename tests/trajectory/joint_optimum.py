"""The joint optimum: path and time together, by linear programmes over control points in time.

Unknown are the control points c of a uniform cubic B-spline in time, n of them. Given for every
corner is the knot at which it is passed; then the tolerance is a strip along one leg for every
knot, and with velocity and acceleration of every axis, the feed (a polygon of 16 sides around
the circle) and

    |third difference| <= gamma J D^3        minimise gamma

everything is linear. gamma <= 1: the motion is possible in n periods. Corners are shifted
knot by knot while gamma falls, and n is reduced while gamma <= 1. What is found is possible;
something faster, with corners passed at quite other times, is not excluded.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.optimize import linprog

from openacr.trajectory.setpoints import Reals

SIDES = [(math.cos(a), math.sin(a)) for a in np.arange(16) * math.pi / 8]
FEED, ACCELERATION, JERK = 100.0, 1000.0, 20_000.0


def stretched(
    vertices: Reals, tolerance: float, count: int, corners: Sequence[int], period_s: float
) -> tuple[float, Reals]:
    """The least gamma, and its control points; infinite where there is none."""
    once, twice, thrice = (_differences(count, n) for n in (1, 2, 3))
    knots = sp.diags([1 / 6, 4 / 6, 1 / 6], [0, 1, 2], shape=(count - 2, count))
    rows, sides = [], []

    def add(x: sp.spmatrix, y: sp.spmatrix, most: float, share: float = 0.0) -> None:
        rows.append(sp.hstack([x, y, sp.csr_matrix(np.full((x.shape[0], 1), -share))]))
        sides.append(np.full(x.shape[0], most))

    for a, b in SIDES:
        add(a * once, b * once, FEED * period_s)
    for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        add(a * twice, b * twice, ACCELERATION * period_s**2)
        add(a * thrice, b * thrice, 0.0, JERK * period_s**3)
    passed = [0, *(k - 1 for k in corners), count - 3]
    for leg, (start, end) in enumerate(pairwise(vertices)):
        along = (end - start) / np.linalg.norm(end - start)
        across = np.array([-along[1], along[0]])
        part = knots.tocsr()[passed[leg] : passed[leg + 1] + 1]
        for (a, b), most in ((across, across @ start), (-across, -across @ start),
                             (along, along @ end), (-along, -along @ start)):  # fmt: skip
            add(a * part, b * part, tolerance + most)
        if leg + 2 < len(vertices):
            for a, b in SIDES:
                at = knots.tocsr()[passed[leg + 1]]
                add(a * at, b * at, tolerance + a * end[0] + b * end[1])
    low, high = np.full(2 * count + 1, -np.inf), np.full(2 * count + 1, np.inf)
    low[-1] = 0.0
    for axis in (0, 1):
        for ends, vertex in ((slice(0, 3), vertices[0]), (slice(count - 3, count), vertices[-1])):
            fixed = slice(axis * count + ends.start, axis * count + ends.stop)
            low[fixed] = high[fixed] = vertex[axis]
    cost = np.append(np.zeros(2 * count), 1.0)
    found = linprog(cost, A_ub=sp.vstack(rows).tocsr(), b_ub=np.concatenate(sides),
                    bounds=np.stack([low, high], axis=1), method="highs")  # fmt: skip
    if found.x is None:
        return math.inf, np.empty((0, 2))
    return float(found.x[-1]), np.stack([found.x[:count], found.x[count:-1]], axis=1)


def fewest(vertices: Reals, tolerance: float, plan: Reals, period_s: float) -> int:
    """The least count of control points that is found, from a plan that is possible."""
    at = (plan[:-2] + 4.0 * plan[1:-1] + plan[2:]) / 6.0
    corners = [1 + int(np.argmin(np.linalg.norm(at - vertex, axis=1))) for vertex in vertices[1:-1]]
    count, best = len(plan), len(plan) + 1
    while True:
        gamma, corners = _shifted(vertices, tolerance, count, corners, period_s)
        if gamma > 1.0 + 1e-7:
            return best
        best = count
        fewer = max(1, int(0.25 * count * (1.0 - gamma ** (1 / 3))))
        corners = [round(k * (count - fewer) / count) for k in corners]
        count -= fewer


def _shifted(
    vertices: Reals, tolerance: float, count: int, corners: list[int], period_s: float
) -> tuple[float, list[int]]:
    """Shift corners knot by knot until the motion is possible, or gamma falls no more."""
    gamma = stretched(vertices, tolerance, count, corners, period_s)[0]
    is_better = True
    while gamma > 1.0 and is_better:
        is_better = False
        for n in range(len(corners)):
            for shift in (-1, 1):
                other = [k + shift * (i == n) for i, k in enumerate(corners)]
                least = stretched(vertices, tolerance, count, other, period_s)[0]
                if least < gamma - 1e-4:
                    gamma, corners, is_better = least, other, True
                    break
    return gamma, corners


def _differences(count: int, order: int) -> sp.csr_matrix:
    """The matrix of differences of an order."""
    signs = [(-1.0) ** (order - k) * math.comb(order, k) for k in range(order + 1)]
    return sp.diags(signs, list(range(order + 1)), shape=(count - order, count)).tocsr()
