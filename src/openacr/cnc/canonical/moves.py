"""Canonical moves: rapid, line, arc, many lines, probe."""

from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.cnc.canonical.common import Pace, Plane, Point, Source

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Rapid(Struct, frozen=True):
    """A straight line of all axes at rapid speed, from rest to rest.

    `is_confirmed` adds the wait until all axes are in position (G9, G61).
    """

    source: Source
    end: Point
    is_inserted: bool = False
    is_confirmed: bool = False


class Line(Struct, frozen=True):
    """A straight line at feed."""

    source: Source
    end: Point
    pace: Pace
    is_inserted: bool = False
    is_compensated: bool = False


class Arc(Struct, frozen=True):
    """An arc or spiral in a plane; other axes go along linearly.

    `centre` lies on the first and second axis of the plane; `sweep_rad` is positive
    counter-clockwise, seen from the positive end of the drill axis, and up to a full turn.
    The radius changes linearly from `start_radius` to `end_radius` over the sweep.
    """

    source: Source
    end: Point
    plane: Plane
    centre: tuple[float, float]
    sweep_rad: float
    start_radius: float
    end_radius: float
    pace: Pace
    is_inserted: bool = False
    is_compensated: bool = False


class Polyline(Struct, frozen=True):
    """Many plain lines at once, for long programs: `ends` is n x 8, `lines` n numbers of lines.

    All of them have the same pace; the text of each block can be read again from the file.
    Each line is a block of its own: no BlockEnd says so.
    """

    source: Source  # of the first one
    ends: "NDArray[np.float64]"
    lines: "NDArray[np.int64]"
    pace: Pace


class Probe(Struct, frozen=True):
    """G31: a line at feed that ends where the probe trips; a Sync follows.

    `is_away`: it starts with the probe tripped and ends where that is over.
    """

    source: Source
    end: Point
    pace: Pace
    is_away: bool = False
