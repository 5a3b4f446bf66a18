"""Programs drawn by a number: lines, arcs, helices and rapids of every size, turn and feed."""

import math

import numpy as np
from numpy.typing import NDArray
from tests.trajectory.programs import Segments

from openacr.trajectory import Arc, Segment

Reals = NDArray[np.float64]
SLOW = [100.0, 100.0, 100.0, 30.0, 5.0]


def program(seed: int) -> tuple[Segments, int, float]:
    """Segments, their axes and tolerance; every fourth seed has legs of hundredths of a unit."""
    chance = np.random.default_rng(seed)
    axes, tolerance = int(chance.choice([2, 3, 4])), float(chance.choice([0.003, 0.01, 0.05, 0.2]))
    length = float(chance.choice([0.05, 0.4, 2.0, 15.0]))
    turn = float(chance.choice([2.0, 15.0, 24.0, 60.0, 170.0]))
    angle, at, found = 0.0, np.zeros(axes), []
    for n in range(int(chance.integers(3, 25))):
        feed = float(chance.choice(SLOW)) if chance.random() < 0.3 else 100.0
        kind = chance.random()
        angle += math.radians(chance.uniform(-turn, turn))
        reach, end, arc = length * chance.uniform(0.2, 2.0), at.copy(), None
        if kind < 0.25:
            radius = reach * chance.uniform(0.5, 2.0)
            sweep = float(chance.uniform(0.2, 5.0) * chance.choice([-1, 1]))
            arc = _arc(at, angle, radius, sweep)
            end[:2] = _turned(at[:2], np.array(arc.centre), sweep)
            angle += sweep
            if axes > 2 and chance.random() < 0.4:
                end[2] += reach * chance.uniform(-0.3, 0.3)
        else:
            end[:2] += reach * np.array([math.cos(angle), math.sin(angle)])
            if axes > 2:
                end[2] += reach * chance.uniform(-0.2, 0.2)
            if axes > 3:
                end[3] += chance.uniform(-0.5, 0.5)
        is_rapid = bool(kind > 0.97)
        found.append(Segment(n, tuple(map(float, end)), feed, tolerance, is_rapid, arc))
        at = end
    return found, axes, tolerance


def _arc(at: Reals, angle: float, radius: float, sweep: float) -> Arc:
    side = math.copysign(radius, sweep)
    centre = at[:2] + side * np.array([-math.sin(angle), math.cos(angle)])
    return Arc(0, 1, (float(centre[0]), float(centre[1])), sweep)


def _turned(point: Reals, centre: Reals, sweep: float) -> Reals:
    (a, b), cos, sin = point - centre, math.cos(sweep), math.sin(sweep)
    turned: Reals = centre + np.array([a * cos - b * sin, a * sin + b * cos])
    return turned
