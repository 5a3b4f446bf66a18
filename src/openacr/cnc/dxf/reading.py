"""What is in a DXF file: pieces of path, points and circles, and what could not be used."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from openacr.cnc.dxf.chains import Piece
from openacr.cnc.dxf.segments import FULL_TURN, Point, Segment, bulged, polyline
from openacr.errors import UserError

if TYPE_CHECKING:
    from ezdxf.document import Drawing

SURVEY_FOOT_IN = 1200.0 / 3937.0 / 0.0254  # of the United States, by its definition in metres
# $INSUNITS: unit of the drawing, whether it is metric, and what one of it is in inches or
# millimetres. Gigametres and what is longer (17 to 20) are of no machine.
UNITS: dict[int, tuple[bool, float]] = {
    1: (False, 1.0),
    2: (False, 12.0),  # feet
    3: (False, 63360.0),  # miles
    4: (True, 1.0),
    5: (True, 10.0),
    6: (True, 1000.0),
    7: (True, 1e6),  # km
    8: (False, 1e-6),  # microinches
    9: (False, 1e-3),  # mils
    10: (False, 36.0),  # yards
    11: (True, 1e-7),  # angstroms
    12: (True, 1e-6),  # nm
    13: (True, 1e-3),  # microns
    14: (True, 100.0),  # dm
    15: (True, 1e4),  # dam
    16: (True, 1e5),  # hm
    21: (False, SURVEY_FOOT_IN),
    22: (False, SURVEY_FOOT_IN / 12.0),
    23: (False, SURVEY_FOOT_IN * 3.0),
    24: (False, SURVEY_FOOT_IN * 5280.0),
}
DEEPEST = 16  # blocks within blocks
MOST = 2_000_000  # entities of a drawing with its blocks expanded
SPLINE_FRAME = 16  # flag of a polyline vertex that is not on the curve


@dataclass
class Drawing2D:
    """A drawing, flat, in inches or millimetres."""

    is_metric: bool
    pieces: list[Piece] = field(default_factory=list)
    points: list[Point] = field(default_factory=list)
    circles: list[Point] = field(default_factory=list)  # their centres
    used: Counter[str] = field(default_factory=Counter)
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)


def read(path: Path, *, layer: str, is_metric: bool, chord: Callable[[bool], float]) -> Drawing2D:
    """The drawing in a file; `chord` tells how high chords of curves may be in its unit."""
    document, is_recovered = _opened(path)
    try:
        drawing = _Reader(document, layer, is_metric, chord).drawing()
        if is_recovered:
            drawing.notes.insert(0, "the file is damaged: what could be recovered is here")
        return drawing
    except UserError:
        raise
    except Exception as error:  # what a broken file makes the DXF reader stumble over
        raise _broken(path, error) from None


def layers_of(path: Path) -> list[str]:
    """The names of the layers of a drawing; UserError if it cannot be read."""
    document, _ = _opened(path)
    return sorted(each.dxf.name for each in document.layers)


def _opened(path: Path) -> tuple["Drawing", bool]:
    """A text or binary file, and whether it had to be recovered."""
    try:
        from ezdxf.filemanagement import readfile
    except ModuleNotFoundError:
        raise UserError("DXF files need ezdxf: pip install 'openacr[dxf]'") from None
    try:
        return readfile(path), False
    except OSError as error:
        # The reader, too, tells by an OSError that a file is no DXF at all.
        raise UserError(f"{path}: cannot be read: {error.strerror or error}") from None
    except Exception as error:
        return _recovered(path, error), True


def _recovered(path: Path, fault: Exception) -> "Drawing":
    """What can be saved of a damaged file; the error it has where that is nothing."""
    from ezdxf import recover

    try:
        document, _ = recover.readfile(path)
    except Exception:
        raise _broken(path, fault) from None
    if not len(document.modelspace()):
        raise _broken(path, fault)
    return document


def _broken(path: Path, error: Exception) -> UserError:
    words = " ".join(str(error).split())
    return UserError(f"{path}: this DXF file is damaged: {words or type(error).__name__}")


class _Reader:
    """One pass over the model space."""

    def __init__(
        self, document: "Drawing", layer: str, is_metric: bool, chord: Callable[[bool], float]
    ) -> None:
        self._document = document
        self._named = layer
        self._layer = layer.casefold()
        unit = int(document.header.get("$INSUNITS", 0))
        metric, self._scale = UNITS.get(unit, (is_metric, 1.0))
        self._drawing = Drawing2D(metric)
        if unit not in UNITS:
            name = "mm" if metric else "inch"
            said = "states no unit" if unit == 0 else f"has unit {unit}, which is not known here"
            self._drawing.notes.append(f"the drawing {said}: taken as {name}")
        self._cnt = 0
        self._chord = chord(metric) / self._scale
        self._frozen = {each.dxf.name.casefold() for each in document.layers if each.is_frozen()}

    def drawing(self) -> Drawing2D:
        _require_few(self._count(self._document.modelspace(), 0, {}))
        seen = False
        for entity, layer in self._flat(self._document.modelspace(), None, 0):
            seen = True
            if self._is_wanted(layer):
                self._take(entity)
        if self._layer and not self._has_layer():
            names = ", ".join(sorted(each.dxf.name for each in self._document.layers))
            raise UserError(f"the drawing has no layer {self._named} (it has {names})")
        if not seen:
            raise UserError("the drawing is empty")
        return self._drawing

    def _has_layer(self) -> bool:
        return any(each.dxf.name.casefold() == self._layer for each in self._document.layers) or (
            bool(self._drawing.used)
        )

    def _is_wanted(self, layer: str) -> bool:
        name = layer.casefold()
        return name not in self._frozen and (not self._layer or name == self._layer)

    def _count(self, entities: Iterable[Any], depth: int, known: dict[tuple[str, int], int]) -> int:
        """How many entities `_flat` meets, blocks within blocks by multiplication.

        Inside a block layer 0 is the layer of an insertion that is not frozen.
        """
        total = 0
        for entity in entities:
            total += 1
            if entity.dxftype() != "INSERT" or depth >= DEEPEST:
                continue
            layer = str(entity.dxf.get("layer", "0"))
            if layer.casefold() in self._frozen and not (depth and layer == "0"):
                continue
            key = entity.dxf.name.casefold(), depth + 1
            if key not in known:
                known[key] = self._count(entity.block() or (), depth + 1, known)
            total += entity.mcount * known[key]
        return total

    def _flat(
        self, entities: Iterable[Any], inherited: str | None, depth: int
    ) -> Iterator[tuple[Any, str]]:
        """All entities with their layers; those of blocks instead of the block."""
        for entity in entities:
            self._cnt += 1
            _require_few(self._cnt)
            layer = str(entity.dxf.get("layer", "0"))
            if inherited is not None and layer == "0":
                layer = inherited  # layer 0 inside a block is the layer of the insertion
            if entity.dxftype() != "INSERT":
                yield entity, layer
            elif layer.casefold() in self._frozen:
                continue
            elif depth >= DEEPEST:
                self._drawing.unused[f"block nested deeper than {DEEPEST}"] += 1
            else:
                for single in entity.multi_insert() if entity.mcount > 1 else (entity,):
                    yield from self._flat(single.virtual_entities(), layer, depth + 1)

    def _take(self, entity: Any) -> None:
        kind = entity.dxftype()
        reader = _KINDS.get(kind)
        pieces = reader(entity, self._chord) if reader else None
        if kind == "POINT":
            self._drawing.points.append(self._scaled(_flat_point(entity.dxf.location)))
        elif pieces is None:
            self._drawing.unused[kind] += 1
            return
        self._drawing.used[kind] += 1
        if kind == "CIRCLE":
            self._drawing.circles.append(self._scaled(_wcs(entity, entity.dxf.center)))
        for piece in pieces or ():
            lengthy = tuple(self._sized(each) for each in piece if each.length > 0.0)
            if lengthy:
                self._drawing.pieces.append(lengthy)

    def _scaled(self, point: Point) -> Point:
        if not (math.isfinite(point[0]) and math.isfinite(point[1])):
            raise ValueError("a coordinate is not a number")
        return (point[0] * self._scale, point[1] * self._scale)

    def _sized(self, segment: Segment) -> Segment:
        centre = None if segment.centre is None else self._scaled(segment.centre)
        start, end = self._scaled(segment.start), self._scaled(segment.end)
        return Segment(start, end, centre, segment.sweep_rad)


def _require_few(count: int) -> None:
    if count > MOST:
        raise UserError(f"the drawing has more than {MOST:,} entities in its blocks")


# --- entities ---------------------------------------------------------------------------


def _flat_point(vector: Any) -> Point:
    return (float(vector[0]), float(vector[1]))


def _wcs(entity: Any, point: Any) -> Point:
    """A point of the entity's own system (its extrusion) in the drawing."""
    return _flat_point(entity.ocs().to_wcs(point))


def _is_mirrored(entity: Any) -> bool:
    return bool(entity.dxf.extrusion.z < 0)


def _is_flat(entity: Any) -> bool:
    return bool(abs(abs(entity.dxf.extrusion.normalize().z) - 1.0) < 1e-9)


def _line(entity: Any, _: float) -> list[Piece]:
    return [(Segment(_flat_point(entity.dxf.start), _flat_point(entity.dxf.end)),)]


def _arc(entity: Any, chord: float) -> list[Piece]:
    if not _is_flat(entity):
        return [_chords(entity, chord)]
    sweep = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0) or FULL_TURN
    start, end = _flat_point(entity.start_point), _flat_point(entity.end_point)
    turn = -sweep if _is_mirrored(entity) else sweep
    return [(Segment(start, end, _wcs(entity, entity.dxf.center), turn),)]


def _circle(entity: Any, chord: float) -> list[Piece]:
    if not _is_flat(entity):
        return [_chords(entity, chord)]
    x, y = _wcs(entity, entity.dxf.center)
    start = (x + abs(entity.dxf.radius), y)
    return [(Segment(start, start, (x, y), FULL_TURN),)]


def _chords(entity: Any, chord: float) -> Piece:
    return polyline([_flat_point(point) for point in entity.flattening(chord)])


def _curve(entity: Any, chord: float) -> list[Piece]:
    return [_chords(entity, chord)]


def _bulges(corners: list[tuple[Point, float]], is_closed: bool, is_mirrored: bool) -> Piece:
    """The segments of a polyline from its corners with their bulges."""
    if is_closed and corners:
        corners = [*corners, corners[0]]
    sign = -1.0 if is_mirrored else 1.0
    return tuple(bulged(a, b, sign * bulge) for (a, bulge), (b, _) in pairwise(corners) if a != b)


def _light_polyline(entity: Any, _: float) -> list[Piece]:
    height = entity.dxf.elevation
    corners = [
        (_wcs(entity, (x, y, height)), float(bulge)) for x, y, bulge in entity.get_points("xyb")
    ]
    return [_bulges(corners, bool(entity.closed), _is_mirrored(entity))]


def _heavy_polyline(entity: Any, _: float) -> list[Piece] | None:
    if entity.is_polygon_mesh or entity.is_poly_face_mesh:
        return None
    on_curve = [each for each in entity.vertices if not each.dxf.flags & SPLINE_FRAME]
    if entity.is_3d_polyline:
        corners = [(_flat_point(each.dxf.location), 0.0) for each in on_curve]
        return [_bulges(corners, bool(entity.is_closed), False)]
    corners = [(_wcs(entity, each.dxf.location), float(each.dxf.bulge)) for each in on_curve]
    return [_bulges(corners, bool(entity.is_closed), _is_mirrored(entity))]


def _nothing(entity: Any, _: float) -> list[Piece]:
    return []


_KINDS: dict[str, Callable[[Any, float], list[Piece] | None]] = {
    "LINE": _line,
    "ARC": _arc,
    "CIRCLE": _circle,
    "LWPOLYLINE": _light_polyline,
    "POLYLINE": _heavy_polyline,
    "SPLINE": _curve,
    "ELLIPSE": _curve,
    "POINT": _nothing,
}
