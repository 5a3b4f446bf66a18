"""Elements: straight and circular moves, the input and output of cutter radius compensation.

Scaling and rotation are already applied. Offsets only shift, so the compensation works the
same before them and, as the interpreter uses it, in machine coordinates.
"""

from msgspec import Struct

from openacr.cnc.canonical import Pace, Plane, Point, Source


class Element(Struct, frozen=True):
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
