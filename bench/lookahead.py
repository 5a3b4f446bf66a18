"""Look-ahead: how fast it plans, and how near its cycle times come to the optimum.

Exact paths take their corners by the law of LOOK; the optimum on them is the closed form
of every ramp. With a tolerance the optimum is computed on the same rounded path, finely
sampled, with the whole acceleration limit in every direction.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bench.cards import many_axes, type_lines
from bench.figures import at_least, at_most, best_s, value_only
from openacr.compiled import pick
from openacr.controller import Controller
from openacr.kernel.path import plan_cy
from openacr.map.rows import axes, masters, profiles
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target

FEED_UPS, ACCEL_UPS2, JERK_UPS3 = 100.0, 1000.0, 20_000.0
TOLERANCE_U = 0.01
ROUND_U = 0.5  # enough to be quicker than exact corners under jerk
FINE_U = 0.0005
DEPTH = 250
LAW_TO_DEG = 90.0
IN_MOTION = 516
FURTHEST_TICKS = 200_000
PPU = 10_000.0
Point = tuple[float, float]
Reals = NDArray[np.float64]

_plan = pick(plan_cy.master_plan)


def _polygon(radius: float, chord: float) -> list[Point]:
    count = round(2 * math.pi * radius / chord)
    turns = [2 * math.pi * n / count for n in range(1, count + 1)]
    return [(radius * math.sin(t), radius * (1 - math.cos(t))) for t in turns]


def _pocket() -> list[Point]:
    points = [(0.0, 0.0)]
    for inset in range(0, 20, 2):
        x, y = 60.0 - inset, 40.0 - inset
        points += [(x, inset), (x, y), (inset, y), (inset, inset + 2.0)]
    return points[1:]


PROGRAMS: dict[str, list[Point]] = {
    "corner": [(50.0, 0.0), (50.0, 50.0)],
    "pocket": _pocket(),
    "circle": _polygon(8.0, 0.2),
    "surface": [(x, 3 * math.sin(x / 4)) for x in np.arange(0.2, 100, 0.2)],
}


def _card(tolerance: float, jerk: float) -> Controller:
    card = many_axes(2, FEED_UPS)
    type_lines(
        card, "PPU X10000 Y10000", f"DIM MBUF({DEPTH})", "MBUF ON", "LOOK ON",
        f"ACC {ACCEL_UPS2} DEC {ACCEL_UPS2} STP {ACCEL_UPS2} JRK {jerk} VEL {FEED_UPS}",
        f"LOOK TOL {tolerance}",
    )  # fmt: skip
    return card


def _feed(card: Controller, waiting: list[Point]) -> None:
    while waiting and moves.has_room(card.card, 0):
        x, y = waiting.pop()
        moves.issue(card.card, 0, [Target(0, x), Target(1, y)])


def _run(points: Sequence[Point], tolerance: float, jerk: float) -> tuple[float, Reals, Reals]:
    """Time of the path, its places tick by tick and its speeds."""
    card = _card(tolerance, jerk)
    waiting, places, speeds = list(points)[::-1], [], []
    rows = [axes.psp_cnt[n] for n in (0, 1)]
    F = card.memory.F
    _feed(card, waiting)
    while card.bit[IN_MOTION]:
        card.advance(1)
        _feed(card, waiting)
        places.append([F[row] / PPU for row in rows])
        speeds.append(F[profiles.velocity[0]])
        if len(speeds) > FURTHEST_TICKS:
            raise RuntimeError("the path does not end")
    return len(speeds) * card.period_s, np.array(places), np.array(speeds)


def _optimum_exact_s(points: Sequence[Point]) -> float:
    """Closed form: corners by the law, every line as fast as its ends allow."""
    places = [(0.0, 0.0), *points]
    ways = [np.subtract(b, a) for a, b in pairwise(places)]
    lengths = [float(np.hypot(*way)) for way in ways]
    caps = [0.0]
    for a, b in pairwise(ways):
        turn = abs(math.degrees(math.atan2(a[0] * b[1] - a[1] * b[0], float(a @ b))))
        caps.append(FEED_UPS * max(1.0 - turn / LAW_TO_DEG, 0.0))
    caps.append(0.0)
    for order in (range(len(lengths)), range(len(lengths) - 1, -1, -1)):
        for k in order:
            near, far = (k, k + 1) if order.step > 0 else (k + 1, k)
            reached = math.sqrt(caps[near] ** 2 + 2 * ACCEL_UPS2 * lengths[k])
            caps[far] = min(caps[far], reached)
    return sum(_line_s(*ends, length) for ends, length in zip(pairwise(caps), lengths, strict=True))


def _line_s(v0: float, v1: float, length: float) -> float:
    peak = min(FEED_UPS, math.sqrt(ACCEL_UPS2 * length + (v0**2 + v1**2) / 2))
    ramps = (2 * peak**2 - v0**2 - v1**2) / (2 * ACCEL_UPS2)
    return (2 * peak - v0 - v1) / ACCEL_UPS2 + (length - ramps) / peak


def _rounded(points: Sequence[Point]) -> tuple[Reals, Reals, float]:
    """First and second derivative of the rounded path by its distance, and the step."""
    places = np.array([(0.0, 0.0), *points])
    ways = np.diff(places, axis=0)
    lengths = np.linalg.norm(ways, axis=1)
    units = ways / lengths[:, None]
    ends = np.cumsum(lengths)
    s = np.arange(0.0, ends[-1], FINE_U)
    first = units[np.minimum(np.searchsorted(ends, s, side="right"), len(units) - 1)].copy()
    second = np.zeros_like(first)
    for k in range(len(units) - 1):
        turn = units[k + 1] - units[k]
        size = float(np.hypot(*turn))
        if size < 1e-7:
            continue
        reach = min(4 * TOLERANCE_U / size, 0.5 * min(lengths[k], lengths[k + 1]))
        a, b = np.searchsorted(s, [ends[k] - reach, ends[k] + reach])
        x = s[a:b] - ends[k] + reach
        first[a:b] = units[k] + turn * (x / (2 * reach))[:, None]
        second[a:b] = turn / (2 * reach)
    return first, second, FINE_U


def _optimum_rounded_s(points: Sequence[Point]) -> float:
    """Brute force in the phase plane: backward and forward sweep over a fine grid."""
    first, second, step = _rounded(points)
    f2 = np.einsum("ij,ij->i", first, first).tolist()
    cross = np.einsum("ij,ij->i", first, second).tolist()
    s2 = np.einsum("ij,ij->i", second, second).tolist()
    top = [min(FEED_UPS**2, ACCEL_UPS2 / math.sqrt(c) if c > 0 else 1e30) for c in s2]
    top[0] = top[-1] = 0.0
    for order in (1, -1):
        ks = range(len(top) - 1) if order > 0 else range(len(top) - 1, 0, -1)
        for k in ks:
            w = top[k]
            b = order * w * cross[k]
            root = b * b - f2[k] * (w * w * s2[k] - ACCEL_UPS2**2)
            a = (-b + math.sqrt(max(root, 0.0))) / f2[k]
            top[k + order] = min(top[k + order], w + 2 * step * max(a, 0.0))
    v = np.sqrt(np.array(top))
    return float(np.sum(2 * step / np.maximum(v[1:] + v[:-1], 1e-9)))


def _derivative(places: Reals, order: int, period_s: float = 0.0005) -> float:
    """The largest vector acceleration (2) or jerk (3) of a path from rest to rest."""
    still = np.vstack([[[0.0, 0.0]] * order, places, [places[-1]] * order])
    return float(np.linalg.norm(np.diff(still, n=order, axis=0), axis=1).max() / period_s**order)


def _planning() -> None:
    """One pass over a full buffer, and what a segment costs altogether."""
    for name, tolerance in (("exact", 0.0), ("rounded", TOLERANCE_U)):
        card = _card(tolerance, 0.0)
        _feed(card, PROGRAMS["surface"][: DEPTH + 1][::-1])
        card.advance(2)
        memory = card.memory
        queued = memory.I[masters.queued[0]]
        seconds = best_s(lambda m=memory: [_plan(m.F, m.I, m.S, 0) for _ in range(2000)]) / 2000
        at_least(f"{name} path: segments planned in a full buffer", queued / seconds, 1e6, "1/s")


def main() -> None:
    _planning()
    times = {}
    for name, points in PROGRAMS.items():
        took, _, speeds = _run(points, 0.0, 0.0)
        times[name] = took
        at_most(f"{name}, exact: time by optimum", took / _optimum_exact_s(points), 1.02, "")
        ramp = float(np.abs(np.diff([0.0, *speeds])).max()) / 0.0005
        at_most(f"{name}, exact: largest ramp", ramp / ACCEL_UPS2, 1.0001, "of ACC")
        took, places, speeds = _run(points, TOLERANCE_U, 0.0)
        best = _optimum_rounded_s(points)
        at_most(f"{name}, 0.01 tolerance: time by optimum", took / best, 1.03, "")
        accel = _derivative(places, 2) / ACCEL_UPS2
        at_most(f"{name}, 0.01 tolerance: largest acceleration", accel, 1.0001, "of ACC")
        at_most(f"{name}, 0.01 tolerance: highest speed", speeds.max() / FEED_UPS, 1.0001, "of F")
    took, _, speeds = _run(PROGRAMS["surface"], 0.0, JERK_UPS3)
    at_most("surface, JRK 20 000 by its time without", took / times["surface"], 2.3, "")
    ramps = np.diff([0.0, 0.0, *speeds, 0.0], n=2) / 0.0005**2
    at_most("surface, JRK 20 000: largest jerk", np.abs(ramps).max() / JERK_UPS3, 1.001, "of JRK")
    value_only("surface, JRK 20 000: cycle time", took, "s")
    _jerk_and_tolerance(took)


def _jerk_and_tolerance(exact_s: float) -> None:
    """With both, all limits are kept: long lines gain by it, chains of short ones are slow.

    Without a tolerance the law of LOOK passes corners at a speed, whatever the axes do there.
    """
    took, places, _ = _run(PROGRAMS["surface"], TOLERANCE_U, JERK_UPS3)
    text = "surface, JRK 20 000, 0.01 tolerance:"
    at_most(f"{text} time by exact", took / exact_s, 6.7, "")
    _axis_limits(text, places)
    for name in ("corner", "pocket"):
        exact, _, _ = _run(PROGRAMS[name], 0.0, JERK_UPS3)
        took, places, _ = _run(PROGRAMS[name], ROUND_U, JERK_UPS3)
        text = f"{name}, JRK 20 000, 0.5 tolerance:"
        at_most(f"{text} time by exact", took / exact, 1.0, "")
        _axis_limits(text, places)


def _axis_limits(text: str, places: Reals) -> None:
    accel, jerk = _derivative(places, 2) / ACCEL_UPS2, _derivative(places, 3) / JERK_UPS3
    at_most(f"{text} largest acceleration", accel, 1.001, "of ACC")
    at_most(f"{text} largest jerk", jerk, 1.001, "of JRK")


if __name__ == "__main__":
    main()
