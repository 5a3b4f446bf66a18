"""Tool path of a part program for drawing: every move as points in space, with its kind.

Canonical entries come in one by one (`ToolPath.add`); arcs become chords that follow them
closely. Three axes are drawn, X, Y and Z where they are configured; others are not shown.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from openacr.cnc.canonical import (
    Arc,
    Entry,
    Line,
    Moves,
    Plane,
    Point,
    Polyline,
    Probe,
    Rapid,
    Tool,
)
from openacr.cnc.geometry.elements import Element

if TYPE_CHECKING:
    from openacr.cnc.compensation.many import Many

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

DRAWN_CNT = 3
MOST_POINTS = 2_000_000  # of one picture, about 100 MB; later moves are left out
AT_ONCE = 4096  # points collected before they are put into an array
FINEST_RAD, COARSEST_RAD = math.radians(1.0), math.radians(5.0)


class Kind(IntEnum):
    """Kind of a move in a drawing."""

    RAPID = 0
    FEED = 1
    COMPENSATED = 2
    INSERTED = 3


@dataclass(slots=True)
class ToolPath:
    """The path of the tool, and the contours it was compensated from.

    `tolerance` is how far chords may be off their arcs, in units of length; very large and
    very small arcs get chords of 1 to 5 degrees. Without `has_tools` tools are not
    distinguished.
    """

    axes: tuple[int, ...]
    tolerance: float
    has_tools: bool = True
    start: Point = (0.0,) * 8
    contours: list[list[Point]] = field(default_factory=list)
    _at: Point = (0.0,) * 8
    _tool: int = 0
    _parts: list[tuple[Array, int, int, npt.NDArray[np.int64]]] = field(default_factory=list)
    _ends: list[Point] = field(default_factory=list)
    _lines: list[int] = field(default_factory=list)
    _kind: Kind = Kind.RAPID
    _cnt: int = 0  # of points, with those of contours
    _move_cnt: int = 0

    # --- input -------------------------------------------------------------------

    def add(self, entry: Entry) -> None:
        """Add the next entry of a program; ignored when the picture is full."""
        if self.is_full:
            return
        match entry:
            case Line() | Probe():
                self._move(_kind_of(entry), entry.source.line, [entry.end])
            case Rapid():
                kind = Kind.INSERTED if entry.is_inserted else Kind.RAPID
                self._move(kind, entry.source.line, [entry.end])
            case Arc():
                self._move(_kind_of(entry), entry.source.line, self._arc(entry))
            case Moves():
                for one in entry.entries():
                    self.add(one)
            case Polyline():
                self._close()
                self._cnt += len(entry.ends)
                self._move_cnt += len(entry.ends)
                drawn = self._drawn(entry.ends)
                self._parts.append((drawn, Kind.FEED, self._tool, entry.lines))
                self._at = tuple(entry.ends[-1].tolist())
            case Tool():
                self._close()
                self._tool = entry.number

    def _move(self, kind: Kind, line: int, points: list[Point]) -> None:
        if kind != self._kind:
            self._close()
            self._kind = kind
        self._ends += points
        self._lines += [line] * len(points)
        self._cnt += len(points)
        self._move_cnt += len(points)
        self._at = points[-1]
        if len(self._ends) >= AT_ONCE:
            self._close()

    @property
    def move_cnt(self) -> int:
        """The moves so far; contours do not count."""
        return self._move_cnt

    @property
    def is_full(self) -> bool:
        """Whether later moves are left out."""
        return self._cnt >= MOST_POINTS

    def _close(self) -> None:
        """Store the collected moves of one kind and tool."""
        if self._ends:
            lines = np.array(self._lines, dtype=np.int64)
            drawn = self._drawn(np.array(self._ends))
            self._parts.append((drawn, self._kind, self._tool, lines))
            self._ends, self._lines = [], []

    def _arc(self, arc: Arc) -> list[Point]:
        return chords(self._at, arc.end, arc.plane, arc.centre, arc.sweep_rad, self.tolerance)

    # --- observer of the compensation -----------------------------------------------------

    def contour(self, element: Element) -> None:
        """Add an element of a programmed contour; ignored when the picture is full."""
        if self.is_full:
            return
        self._cnt += 1
        last = self.contours[-1] if self.contours else []
        if not last or last[-1] != element.start:
            last = [element.start]
            self.contours.append(last)
        if element.centre is None:
            last.append(element.end)
        else:
            last += chords(
                element.start,
                element.end,
                element.plane,
                element.centre,
                element.sweep_rad,
                self.tolerance,
            )

    def centre_path(self, element: Element, radius: float) -> None:
        """Ignored: the path of the tool is taken from the canonical entries."""

    def elements(self, many: "Many") -> None:
        """Add elements of a programmed contour."""
        for element in many.elements():
            self.contour(element)

    def tool_moves(self, moves: Moves, extra: Sequence[float]) -> None:
        """Ignored, as one move."""

    def end(self) -> None:
        """Ignored: a contour that does not continue the last one starts a new one."""

    # --- output -------------------------------------------------------------------

    def finished(self) -> "Drawing":
        """Return the whole path as arrays."""
        self._close()
        parts = self._parts
        ends = [drawn for drawn, _, _, _ in parts]
        sizes = [len(each) for each in ends]
        tools = [tool if self.has_tools else 0 for _, _, tool, _ in parts]
        return Drawing(
            np.vstack([self._drawn(np.array([self.start])), *ends]),
            np.repeat(np.array([kind for _, kind, _, _ in parts], dtype=np.uint8), sizes),
            np.repeat(np.array(tools, dtype=np.int64), sizes),
            np.concatenate([lines for _, _, _, lines in parts] or [np.zeros(0, dtype=np.int64)]),
            [self._drawn(np.array(points)) for points in self.contours],
        )

    def _drawn(self, points: Array) -> Array:
        """Select the drawn axes; a machine without Z is drawn at height 0."""
        flat = np.zeros((len(points), DRAWN_CNT))
        flat[:, : len(self.axes)] = points[:, list(self.axes)]
        return flat


def _kind_of(entry: Line | Probe | Arc) -> Kind:
    if isinstance(entry, Probe):
        return Kind.FEED
    if entry.is_inserted:
        return Kind.INSERTED
    return Kind.COMPENSATED if entry.is_compensated else Kind.FEED


def chords(
    start: Point,
    end: Point,
    plane: Plane,
    centre: tuple[float, float],
    sweep_rad: float,
    tolerance: float,
) -> list[Point]:
    """Points along an arc, spiral or helix, after its start, up to its end.

    A chord over the angle s keeps within R (1 - cos s/2) of its arc.
    """
    first, second = plane.first, plane.second
    x, y = start[first] - centre[0], start[second] - centre[1]
    r0 = math.hypot(x, y)
    r1 = math.hypot(end[first] - centre[0], end[second] - centre[1])
    flat = min(1.0, tolerance / max(r0, r1, tolerance))
    step = min(COARSEST_RAD, max(FINEST_RAD, 2.0 * math.acos(1.0 - flat)))
    count = max(1, math.ceil(abs(sweep_rad) / step))
    angle = math.atan2(y, x)
    points = []
    for k in range(1, count):
        u = k / count
        point = [a + (b - a) * u for a, b in zip(start, end, strict=True)]
        radius = r0 + (r1 - r0) * u
        point[first] = centre[0] + radius * math.cos(angle + u * sweep_rad)
        point[second] = centre[1] + radius * math.sin(angle + u * sweep_rad)
        points.append(tuple(point))
    return [*points, end]


@dataclass(frozen=True, slots=True)
class Drawing:
    """Moves as arrays: `points` has the start and the end of every move."""

    points: Array
    kinds: npt.NDArray[np.uint8]
    tools: npt.NDArray[np.int64]
    lines: npt.NDArray[np.int64]
    contours: list[Array]

    @property
    def low(self) -> Array:
        """The lowest corner of the extents."""
        return np.asarray(self.points.min(axis=0))

    @property
    def high(self) -> Array:
        """The highest corner of the extents."""
        return np.asarray(self.points.max(axis=0))

    def styles(self) -> list[tuple[Kind, int]]:
        """Kinds and tools that occur; rapid and inserted moves belong to no tool."""
        pairs = np.unique(self._pairs(), axis=0)
        return [(Kind(kind), int(tool)) for kind, tool in pairs.tolist()]

    def style_numbers(self) -> Index:
        """For every move, the index of its style."""
        numbers = np.unique(self._pairs(), axis=0, return_inverse=True)[1]
        return np.asarray(numbers, dtype=np.intp).ravel()

    def _pairs(self) -> npt.NDArray[np.int64]:
        has_tool = (self.kinds == Kind.FEED) | (self.kinds == Kind.COMPENSATED)
        return np.column_stack([self.kinds, np.where(has_tool, self.tools, 0)])

    def strokes(self, kind: Kind, tool: int, band: int = 0, bands: int = 1) -> Array:
        """All moves of a style, one after the other, with NaN where the pen is lifted.

        With `bands` > 1, only moves whose middle is in range `band` of that many equal heights.
        """
        pairs = self._pairs()
        chosen = (pairs[:, 0] == kind) & (pairs[:, 1] == tool)
        if bands > 1:
            chosen &= self._bands(bands) == band
        return strokes_of(self.points, chosen)

    def _bands(self, bands: int) -> Index:
        heights = 0.5 * (self.points[:-1, 2] + self.points[1:, 2])
        cuts = heights[self.kinds != Kind.RAPID]
        low, high = float(cuts.min(initial=0.0)), float(cuts.max(initial=0.0))
        share = (heights - low) / max(high - low, 1e-12)
        return np.clip((share * bands).astype(np.intp), 0, bands - 1)


def strokes_of(points: Array, chosen: npt.NDArray[np.bool_]) -> Array:
    """The chosen of the moves between successive points, with NaN where the pen is lifted."""
    at = np.flatnonzero(chosen)
    if not len(at):
        return np.empty((0, points.shape[1]))
    begins = np.flatnonzero(np.diff(at, prepend=-2) != 1)
    lifted = np.full((2 * len(begins), points.shape[1]), np.nan)
    lifted[1::2] = points[at[begins]]
    return np.insert(points[at + 1], np.repeat(begins, 2), lifted, axis=0)


def thinned(points: Array, step: float) -> Array:
    """Drop points of strokes that fall into the same cell as the previous point.

    The rest draws the same picture as long as a cell is smaller than a pixel.
    """
    if len(points) < DRAWN_CNT:
        return points
    is_gap = np.isnan(points[:, 0])
    cells: Array = np.floor(np.where(is_gap[:, None], 0.0, points) / step)
    is_new = np.ones(len(points), dtype=np.bool_)
    is_new[1:] = (np.diff(cells, axis=0) != 0).any(axis=1)
    last = np.append(is_gap[1:], True)  # ends of strokes stay
    return np.asarray(points[is_new | is_gap | last | np.roll(is_gap, 1)])
