"""The parts of the library as shapes: what stays, what is taken out, where holes are."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry

Values = Mapping[int, float]
ROUND = 180  # segments per quarter of a circle


@dataclass(frozen=True)
class Model:
    """What a part makes of the material."""

    keeps: Callable[[Values], BaseGeometry] | None = None  # nothing of this is cut
    clears: Callable[[Values], BaseGeometry] | None = None  # all of this is, and no more
    covers: Callable[[Values], BaseGeometry] | None = None  # all of this is cleared
    rim: Callable[[Values], BaseGeometry] | None = None  # what is touched; else the whole edge
    holes: Callable[[Values], list[tuple[float, float]]] | None = None
    changes: tuple[dict[int, float], ...] = ({},)  # sizes to try
    is_metric: bool = False


def disc(diameter: float, x: float = 0.0, y: float = 0.0) -> BaseGeometry:
    return Point(x, y).buffer(diameter / 2, ROUND)


def rectangle(p: Values) -> BaseGeometry:
    whole = box(0, 0, p[200], p[201])
    if not p[202]:
        return whole
    return box(p[202], p[202], p[200] - p[202], p[201] - p[202]).buffer(p[202], ROUND)


def polygon(p: Values) -> BaseGeometry:
    n = round(p[201])
    angles = [math.pi - (k + 0.5) * 2 * math.pi / n for k in range(n)]
    return Polygon([(p[200] / 2 * math.cos(a), p[200] / 2 * math.sin(a)) for a in angles])


def star(p: Values) -> BaseGeometry:
    n = round(p[202])
    corners = []
    for k in range(2 * n):
        r = (p[201] if k % 2 else p[200]) / 2
        corners.append((r * math.cos(k * math.pi / n), r * math.sin(k * math.pi / n)))
    return Polygon(corners)


def trapezoid(p: Values) -> BaseGeometry:
    base, top, height = p[200], p[201], p[202]
    return Polygon([(0, 0), (base, 0), ((base + top) / 2, height), ((base - top) / 2, height)])


def gusset(p: Values) -> BaseGeometry:
    x, y, cut = p[200], p[201], p[202]
    return Polygon([(0, 0), (x, 0), (x, cut), (cut, y), (0, y)])


def l_bracket(p: Values) -> BaseGeometry:
    return box(0, 0, p[200], p[202]).union(box(0, 0, p[202], p[201]))


def t_bracket(p: Values) -> BaseGeometry:
    middle = p[200] / 2
    leg = box(middle - p[202] / 2, -p[201], middle + p[202] / 2, 0)
    return box(0, -p[202], p[200], 0).union(leg)


def u_bracket(p: Values) -> BaseGeometry:
    return box(0, 0, p[200], p[201]).difference(box(p[202], p[202], p[200] - p[202], p[201] + 1))


def cross(p: Values) -> BaseGeometry:
    long, wide = p[200] / 2, p[201] / 2
    return box(-long, -wide, long, wide).union(box(-wide, -long, wide, long))


def d_shape(p: Values) -> BaseGeometry:
    return disc(p[200]).intersection(box(-p[201], -p[200], p[200], p[200]))


def ellipse(p: Values) -> BaseGeometry:
    n = round(p[202])
    angles = [2 * math.pi * k / n for k in range(n)]
    return Polygon([(-p[200] / 2 * math.cos(a), p[201] / 2 * math.sin(a)) for a in angles])


def triangle(p: Values) -> BaseGeometry:
    x = p[233] + p[224] + 0.01  # the part begins that far beside the start
    whole = Polygon([(x, 0), (x + p[200], 0), (x, p[201])])
    return whole.difference(disc(2 * p[202], x, p[202]))


def ring(outside: float, bore: float) -> BaseGeometry:
    return disc(outside).difference(disc(bore))


def frame(p: Values) -> BaseGeometry:
    t = p[202]
    return box(0, 0, p[200], p[201]).difference(box(t, t, p[200] - t, p[201] - t))


def bore(p: Values) -> BaseGeometry:
    return disc(p[200]).boundary


def capsule(p: Values) -> BaseGeometry:
    return LineString([(0, 0), (p[200], 0)]).buffer(p[201] / 2, ROUND)


def arc_slot(p: Values) -> BaseGeometry:
    angles = [math.radians(p[202] + p[204] * k / 400) for k in range(401)]
    middle = LineString([(p[200] * math.cos(a), p[200] * math.sin(a)) for a in angles])
    return middle.buffer(p[201] / 2, ROUND)


def circle_of_holes(diameter: float, count: float, first: float = 0.0) -> list[tuple[float, float]]:
    angles = [math.radians(first + 360 * k / count) for k in range(round(count))]
    return [(diameter / 2 * math.cos(a), diameter / 2 * math.sin(a)) for a in angles]


def grid(p: Values) -> list[tuple[float, float]]:
    columns, rows = round(p[202]), round(p[203])
    return [(x * p[200], y * p[201]) for y in range(rows) for x in range(columns)]


def row(p: Values) -> list[tuple[float, float]]:
    a = math.radians(p[202])
    steps = [k * p[200] for k in range(round(p[201]))]
    return [(s * math.cos(a), s * math.sin(a)) for s in steps]


MODELS = {
    "RECTANGLE": Model(keeps=rectangle, changes=({}, {202: 0}, {200: 1, 201: 3, 202: 0.5})),
    "CIRCLE": Model(keeps=lambda p: disc(p[200]), changes=({}, {200: 0.5})),
    "CAPSULE": Model(keeps=capsule, changes=({}, {200: 0.2, 201: 2})),
    "POLYGON": Model(keeps=polygon, changes=({}, {201: 3}, {201: 7, 200: 5})),
    "STAR": Model(keeps=star, changes=({}, {202: 8, 201: 3})),
    "TRAPEZOID": Model(keeps=trapezoid, changes=({}, {201: 4}, {201: 0.05, 202: 4})),
    "GUSSET": Model(keeps=gusset, changes=({}, {200: 1, 201: 4, 202: 0.5})),
    "LBRACKET": Model(keeps=l_bracket, changes=({}, {200: 2, 201: 5, 202: 0.5})),
    "TBRACKET": Model(keeps=t_bracket, changes=({}, {200: 3, 201: 4, 202: 0.6})),
    "UBRACKET": Model(keeps=u_bracket, changes=({}, {200: 3, 201: 2, 202: 0.5})),
    "CROSS": Model(keeps=cross, changes=({}, {201: 0.5})),
    "DSHAPE": Model(keeps=d_shape, changes=({}, {201: 0.2})),
    "ELLIPSE": Model(keeps=ellipse, changes=({}, {200: 2, 201: 3, 202: 40})),
    "TRIANGLE": Model(keeps=triangle, changes=({}, {200: 6, 201: 4, 202: 1})),
    "WASHER": Model(keeps=lambda p: ring(p[200], p[201]), changes=({}, {201: 2.5})),
    "FLANGE": Model(
        keeps=lambda p: ring(p[200], p[201]),
        holes=lambda p: circle_of_holes(p[202], p[203]),
        changes=({}, {203: 1}, {203: 5}),
    ),
    "GEARBLNK": Model(
        keeps=lambda p: ring(p[200] * (p[201] + 2), p[202]),
        changes=({}, {200: 3, 202: 40}),
        is_metric=True,
    ),
    "FRAME": Model(keeps=frame, changes=({}, {200: 3, 201: 3, 202: 0.25})),
    "POCKET": Model(clears=lambda p: disc(p[200]), changes=({}, {200: 0.75, 203: 0.05}, {207: 3})),
    "RPOCKET": Model(
        clears=lambda p: box(0, 0, p[200], p[201]),
        changes=({}, {200: 0.8, 201: 0.8, 203: 0.05}, {207: 5}),
    ),
    "SLOT": Model(clears=capsule, changes=({}, {201: 2}, {200: 0.5, 201: 1}, {207: 2})),
    "ARCSLOT": Model(
        clears=arc_slot, changes=({}, {202: 200, 204: 300}, {200: 3, 201: 1.5, 204: 60}, {207: 1})
    ),
    "HELIBORE": Model(keeps=lambda p: disc(p[200] + 4).difference(disc(p[200])), rim=bore),
    "FACE": Model(covers=lambda p: box(0, 0, p[200], p[201]), changes=({}, {203: 0.7}, {201: 0.3})),
    "BOLTCIRC": Model(
        holes=lambda p: circle_of_holes(p[200], p[201], p[202]), changes=({}, {201: 1}, {202: 30})
    ),
    "HOLEGRID": Model(holes=grid, changes=({}, {202: 1}, {203: 1}, {202: 3, 203: 4, 201: 0.5})),
    "HOLEROW": Model(holes=row, changes=({}, {202: 45}, {201: 1})),
}
