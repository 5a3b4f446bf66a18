"""Arcs whose start and end radius differ: cut as spirals, doubted, or refused.

Rounded numbers of a CAM system differ by little. A large difference is a spiral, which the
`acromill` dialect has, or a centre that is read differently than it was written: then another
reading of I, J and K gives equal radii.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.cnc.geometry import arc_cy
from openacr.cnc.geometry.arcs import centre_by_words
from openacr.cnc.state.cells import SPIRALS
from openacr.compiled import pick

if TYPE_CHECKING:
    from openacr.cnc.canonical import Plane, Point
    from openacr.cnc.codes.run import Run
    from openacr.cnc.geometry.arcs import ArcGeometry
    from openacr.cnc.program.block_context import BlockContext

NEAR_INCH = 0.0005  # radii are equal within it, or within a share of the larger one
_are_near = pick(arc_cy.arc_is_near)
FAR_SHARE = 0.25  # of the larger radius: more is not taken for a spiral
READINGS = {
    0: "counted from the centre to the start of the arc",
    1: "counted from the start of the arc",
    2: "read as a position",
}


class Words(Struct, frozen=True):
    """What an arc block says: its ends, and the words I J K R in default units."""

    plane: Plane
    start: Point
    end: Point
    lengths: dict[str, float]


def check_radii(run: Run, b: BlockContext, arc: ArcGeometry, words: Words) -> None:
    """Accept equal radii; else W230, or E230 where it is hardly a spiral that was meant.

    The store allows any spiral with Spirals Allowed (P250131): then W230 only says that
    another reading of I, J and K fits.
    """
    if _is_near(run, arc.start_radius, arc.end_radius):
        return
    fits = _reading_that_fits(run, b, words)
    letter = next((each for each in "IJK" if each in words.lengths), "")
    detail = f"{run.path.shown(arc.start_radius):.5g} and {run.path.shown(arc.end_radius):.5g}"
    hint = _hint(run, fits)
    larger = max(arc.start_radius, arc.end_radius)
    is_far = abs(arc.end_radius - arc.start_radius) > FAR_SHARE * larger
    is_allowed = run.dialect.has_spirals and run.cells.read(SPIRALS) != 0.0
    if not run.dialect.has_spirals or ((is_far or fits is not None) and not is_allowed):
        raise b.fault("E230", letter, detail, hint)
    if fits is not None or not is_allowed:
        run.warn(b, "W230", letter, detail, hint)


def _is_near(run: Run, one: float, other: float) -> bool:
    return _are_near(one, other, run.path.inches(NEAR_INCH))


def _reading_that_fits(run: Run, b: BlockContext, words: Words) -> int | None:
    """The other reading of I, J and K that gives equal radii."""
    first, second = words.plane.first, words.plane.second
    start, end = ((point[first], point[second]) for point in (words.start, words.end))
    for reading in (1, 2, 0):
        if reading == run.modal.centres:
            continue
        centre = centre_by_words(b, words.plane, start, reading, words.lengths)
        radii = math.dist(start, centre), math.dist(end, centre)
        if min(radii) > run.path.inches(NEAR_INCH) and _is_near(run, *radii):
            return reading
    return None


def _hint(run: Run, fits: int | None) -> str:
    if fits is None:
        return "the end is not on the circle about this centre"
    how = run.dialect.centre_codes.get(fits)
    return f"I, J, K {READINGS[fits]} fit: {how}" if how else f"I, J, K {READINGS[fits]} fit"
