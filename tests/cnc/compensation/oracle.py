"""Random contours, and what shapely says about the path of a tool beside them."""

import random
from collections.abc import Callable, Iterable
from itertools import pairwise
from math import atan2, ceil, cos, hypot, pi, sin

import numpy as np
import shapely
from msgspec.structs import replace
from tests.cnc.compensation.tools import Path

from openacr.cnc.geometry.elements import Element

STEP_RAD = 0.02  # of the chords shapely sees


def points(element: Element, step: float = STEP_RAD) -> np.ndarray:
    """Points along an element, both ends included."""
    first, second = element.plane.first, element.plane.second
    start = np.array([element.start[first], element.start[second]])
    end = np.array([element.end[first], element.end[second]])
    if element.centre is None:
        return np.array([start, end])
    centre = np.array(element.centre)
    count = max(2, ceil(abs(element.sweep_rad) / step))
    u = np.linspace(0.0, 1.0, count + 1)
    angle = atan2(*(start - centre)[::-1]) + u * element.sweep_rad
    radius = np.hypot(*(start - centre)) * (1 - u) + np.hypot(*(end - centre)) * u
    inner = np.column_stack(
        [centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)]
    )
    inner[0], inner[-1] = start, end
    return inner


def line_of(elements: Iterable[Element], step: float = STEP_RAD) -> shapely.LineString:
    return shapely.LineString(np.vstack([points(each, step) for each in elements]))


def sagitta(elements: Iterable[Element], step: float = STEP_RAD) -> float:
    """How far chords may be off their arcs."""
    radii = [
        hypot(e.start[0] - e.centre[0], e.start[1] - e.centre[1]) for e in elements if e.centre
    ]
    return max(radii, default=0.0) * (1 - cos(step / 2))


def least_distance(
    paths: list[Element], contour: list[Element], radius: float
) -> tuple[float, float]:
    """How near the tool comes to the contour, and by how much that may be wrong."""
    near = uncertain = 0.0
    for step in (0.2, 0.01):
        chords = line_of(contour, step)
        shapely.prepare(chords)
        near = shapely.distance(chords, line_of(paths, step))
        uncertain = sagitta(paths, step) + sagitta(contour, step)
        if near < radius - uncertain:
            break
    return near, uncertain


def is_beside(path: Element, element: Element, radius: float, close: float) -> bool:
    """Whether a move keeps the radius from an element, taken as a whole line or circle."""
    x, y = points(path, 0.2).T
    if element.centre is None:
        dx, dy = np.subtract(element.end[:2], element.start[:2])
        away = ((x - element.start[0]) * dy - (y - element.start[1]) * dx) / hypot(dx, dy)
    else:
        cx, cy = element.centre
        away = np.hypot(x - cx, y - cy) - hypot(element.start[0] - cx, element.start[1] - cy)
    return bool((np.abs(np.abs(away) - radius) <= close).all())


def contour(rnd: random.Random, count: int, *, arcs: float, turn: float) -> Path:
    """An open contour of lines and arcs that turns at random, with lead-in and lead-out."""
    heading = rnd.uniform(-pi, pi)
    lead = rnd.uniform(0.3, 3.0)
    path = Path(-lead * cos(heading), -lead * sin(heading)).to(0.0, 0.0)
    x = y = 0.0
    for _ in range(count):
        heading += rnd.choice((0.0, rnd.uniform(-turn, turn)))
        length = rnd.choice((1.0, rnd.uniform(0.01, 0.3), rnd.uniform(0.5, 4.0)))
        if rnd.random() < arcs:
            sweep = rnd.choice((-1, 1)) * rnd.choice((pi / 2, pi, rnd.uniform(0.02, 6.2)))
            side = 1 if sweep > 0 else -1
            cx, cy = x - side * length * sin(heading), y + side * length * cos(heading)
            angle = atan2(y - cy, x - cx) + sweep
            x, y = cx + length * cos(angle), cy + length * sin(angle)
            path.arc(x, y, cx, cy, side)
            heading += sweep
        else:
            x, y = x + length * cos(heading), y + length * sin(heading)
            path.to(x, y)
    return path.to(x + 2.0 * cos(heading), y + 2.0 * sin(heading))


def star(rnd: random.Random, count: int, *, arcs: float) -> Path:
    """A closed contour around 0, counter-clockwise, convex or not; its sides may be bulged.

    It begins and ends in the middle of a straight side.
    """
    slots = sorted(rnd.sample(range(2 * count), count))
    angles = [(slot + rnd.uniform(0.1, 0.9)) * pi / count for slot in slots]
    ring = [(r * cos(a), r * sin(a)) for a, r in ((a, rnd.uniform(2, 5)) for a in angles)]
    (ax, ay), (bx, by) = ring[0], ring[1]
    seam = ((ax + bx) / 2, (ay + by) / 2)
    path = Path(2 * seam[0], 2 * seam[1]).to(*seam).to(bx, by)
    for (ax, ay), (bx, by) in pairwise([*ring[1:], ring[0]]):
        if rnd.random() < arcs:
            bulge = rnd.choice((-1, 1)) * rnd.uniform(0.05, 0.4)
            h = 0.25 * (1 / bulge - bulge)
            cx, cy = (ax + bx) / 2 - h * (by - ay), (ay + by) / 2 + h * (bx - ax)
            path.arc(bx, by, cx, cy, 1 if bulge > 0 else -1)
        else:
            path.to(bx, by)
    return path.to(*seam).to(2 * seam[0], 2 * seam[1])


def rotated(elements: list[Element], angle: float) -> list[Element]:
    """The same contour, turned about the origin."""
    c, s = cos(angle), sin(angle)
    return _mapped(elements, lambda x, y: (c * x - s * y, s * x + c * y), 1)


def mirrored(elements: list[Element]) -> list[Element]:
    """The same contour in the mirror."""
    return _mapped(elements, lambda x, y: (x, -y), -1)


def _mapped(
    elements: list[Element], to: Callable[[float, float], tuple[float, float]], turn: int
) -> list[Element]:
    return [
        replace(
            each,
            start=(*to(*each.start[:2]), *each.start[2:]),
            end=(*to(*each.end[:2]), *each.end[2:]),
            centre=None if each.centre is None else to(*each.centre),
            sweep_rad=turn * each.sweep_rad,
        )
        for each in elements
    ]
