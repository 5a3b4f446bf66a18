"""Elements: straight and circular moves in program coordinates.

Between the blocks of a program and its canonical moves stands one form of move: from a
start to an end, after scaling and rotation, before work offsets. The cutter radius
compensation takes elements and gives elements; what is behind it only shifts them.
"""

from dataclasses import dataclass

from openacr.cnc.canonical import Pace, Plane, Point, Source


@dataclass(frozen=True, slots=True)
class Element:
    """A straight line, or with a centre an arc of `sweep_rad` (+ counter-clockwise).

    `pace` is None for moves at rapid speed. `centre` lies on the first and second axis of
    the plane. Axes outside the plane move linearly over the element.
    """

    source: Source
    plane: Plane
    start: Point
    end: Point
    pace: Pace | None
    centre: tuple[float, float] | None = None
    sweep_rad: float = 0.0
    is_inserted: bool = False
    is_compensated: bool = False
