"""Programs of the kinds that planners are compared with, as segments."""

import math
from collections.abc import Callable

import numpy as np

from openacr.trajectory import Arc, Segment

FEED = 100.0
Segments = list[Segment]


def line(
    number: int, x: float, y: float, z: float, tolerance: float, feed: float = FEED
) -> Segment:
    """A straight move."""
    return Segment(number, (float(x), float(y), float(z)), feed, tolerance)


def square(tolerance: float, rounds: int = 3) -> Segments:
    """Rectangles: long legs and right angles."""
    points = [
        point
        for n in range(rounds)
        for point in ((100 - 10 * n, 0), (100 - 10 * n, 70), (0, 70), (0, 0))
    ]
    return [line(n, x, y, 0, tolerance) for n, (x, y) in enumerate(points, 1)]


def corners(tolerance: float, count: int = 60, seed: int = 3) -> Segments:
    """Legs of 4 to 14 mm with turns of 5 to 120 degrees."""
    chance, angle, at = np.random.default_rng(seed), 0.0, np.zeros(2)
    found = []
    for n in range(count):
        turn = float(chance.choice([5, 10, 15, 20, 30, 45, 60, 90, 120]))
        angle += math.radians(turn * float(chance.choice([-1, 1])))
        at = at + chance.uniform(4, 14) * np.array([math.cos(angle), math.sin(angle)])
        found.append(line(n, at[0], at[1], 0, tolerance))
    return found


def pocket(tolerance: float, rings: int = 8) -> Segments:
    """Rectangular rings with rounded corners."""
    found: Segments = []
    for n in range(rings):
        w, h, r, x, y = 60 - 6 * n, 40 - 4 * n, 6 - 0.5 * n, 3 * n, 2 * n
        found.append(line(len(found), x + r, y, 0, tolerance))
        for at, centre in (
            ((x + w - r, y), (x + w - r, y + r)),
            ((x + w, y + h - r), (x + w - r, y + h - r)),
            ((x + r, y + h), (x + r, y + h - r)),
            ((x, y + r), (x + r, y + r)),
        ):
            found.append(line(len(found), at[0], at[1], 0, tolerance))
            a, b = at[0] - centre[0], at[1] - centre[1]
            end = (float(centre[0] - b), float(centre[1] + a), 0.0)
            arc = Arc(0, 1, (float(centre[0]), float(centre[1])), math.pi / 2)
            found.append(Segment(len(found), end, FEED, tolerance, arc=arc))
    return found


def circles(tolerance: float, count: int = 24) -> Segments:
    """Whole circles with radii from 0.5 mm on, entered radially."""
    found: Segments = []
    for n in range(count):
        r, x = 0.5 + 0.25 * n, 12.0 * n
        found += [line(3 * n, x, 0, 0, tolerance), line(3 * n + 1, x + r, 0, 0, tolerance)]
        arc = Arc(0, 1, (x, 0.0), 2 * math.pi)
        found.append(Segment(3 * n + 2, (x + r, 0.0, 0.0), FEED, tolerance, arc=arc))
    return found


def surface(tolerance: float, rows: int = 4, width: float = 60.0, seed: int = 1) -> Segments:
    """Rows of a wavy surface in chords of 0.28 to 0.5 mm."""
    chance = np.random.default_rng(seed)
    found: Segments = []
    for row in range(rows):
        places = [0.0]
        while places[-1] < width:
            places.append(places[-1] + chance.uniform(0.28, 0.5))
        if row % 2:
            places = [places[-1] - x for x in places]
        for x in places:
            z = 1.6 * math.sin(x / 3.5 + 0.3 * row)
            found.append(line(len(found), x, 0.5 * row, z, tolerance))
    return found


KINDS: dict[str, Callable[[float], Segments]] = {
    "square": square,
    "corners": corners,
    "pocket": pocket,
    "circles": circles,
    "surface": surface,
}


def wave(tolerance: float, count: int = 24, seed: int = 1) -> Segments:
    """A wave in chords of 0.28 to 0.5 mm, in the plane X Y."""
    x = np.cumsum(np.random.default_rng(seed).uniform(0.28, 0.5, count))
    return [line(n, at, 1.6 * math.sin(at / 3.5), 0, tolerance) for n, at in enumerate(x)]


def turned(tolerance: float, radius: float, angle: float, leg: float) -> Segments:
    """A line along X, an arc that begins along X or across it, and a line along X or Y."""
    is_whole = angle >= 2.0 * math.pi
    x, y = (leg - radius, 0.0) if is_whole else (leg, radius)
    end = (leg, 0.0) if is_whole else (leg + radius, radius)
    last = (2.0 * leg, 0.0) if is_whole else (end[0], end[1] + leg)
    arc = Segment(2, (*end, 0.0), FEED, tolerance, arc=Arc(0, 1, (x, y), angle))
    return [line(1, leg, 0, 0, tolerance), arc, line(3, *last, 0, tolerance)]


PARTS: dict[str, Callable[[float], Segments]] = {
    "square": lambda e: [line(1, 8, 0, 0, e), line(2, 8, 8, 0, e)],
    "corners": lambda e: corners(e, 4),
    "pocket": lambda e: turned(e, 4.0, 0.5 * math.pi, 6.0),
    "circles": lambda e: turned(e, 1.0, 2.0 * math.pi, 5.0),
    "surface": wave,
}
"""Small parts of programs of every kind, from the origin in the plane X Y."""
