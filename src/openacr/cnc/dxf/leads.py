"""Leads into and out of closed chains for a tool with a radius.

The contour is entered and left by quarters of a circle that touch it in the middle of a
segment. With the tool on side s (+1 left), the direction t there and n its left normal,

    centre C = P + s L n,   first point C - L t,   last point C + L t,

and compensation goes on and off on the straight pieces between C and these points. All that
the tool cuts between them lies inside the circle of radius L about C, so there is room for it
where no edge is nearer to C than L.
"""

import math
from dataclasses import dataclass

from openacr.cnc.dxf.chains import Chain
from openacr.cnc.dxf.nesting import Edges
from openacr.cnc.dxf.segments import Point, Segment

CANDIDATES = 12
SHRINK_R = 0.9
LEAST_R = 1.05  # of the tool: its centre must not go around a circle of no radius
LEAST_OF_LEAD = 0.01  # where the tool has no radius
TOLERANCE_R = 1e-3  # arcs of other edges are chords here


@dataclass(frozen=True, slots=True)
class Led:
    """A chain that begins where it is led into, and its lead circle."""

    chain: Chain
    is_left: bool  # the side of the tool
    centre: Point
    first: Point
    last: Point


def led(chain: Chain, edges: Edges, *, is_hole: bool, radius: float, lead: float) -> Led | None:
    """The best lead-in for a tool of a radius; None where there is no room.

    `lead` is the radius of the circle where it fits, else a smaller one.
    """
    is_left = (chain.area > 0.0) == is_hole
    places = sorted(chain.segments, key=lambda segment: -segment.length)[:CANDIDATES]
    size = max(lead, 2.0 * LEAST_R * radius)
    while size >= LEAST_R * radius:
        for segment in places:
            found = _at(chain, segment, is_left, size)
            if edges.has_room(found.centre, size * (1.0 - TOLERANCE_R)):
                return found
        if size < LEAST_OF_LEAD * lead:
            break
        size *= SHRINK_R
    return None


def _at(chain: Chain, segment: Segment, is_left: bool, size: float) -> Led:
    """The lead circle at the middle of a segment."""
    contact = segment.at(0.5)
    t = segment.tangent(contact)
    side = size if is_left else -size
    centre = (contact[0] - side * t[1], contact[1] + side * t[0])
    first = (centre[0] - size * t[0], centre[1] - size * t[1])
    last = (centre[0] + size * t[0], centre[1] + size * t[1])
    return Led(_begun(chain, segment, contact), is_left, centre, first, last)


def _begun(chain: Chain, segment: Segment, contact: Point) -> Chain:
    """The closed chain from the middle of a segment on."""
    place = next(k for k, each in enumerate(chain.segments) if each is segment)
    half = segment.sweep_rad / 2.0
    before = Segment(segment.start, contact, segment.centre, half)
    after = Segment(contact, segment.end, segment.centre, half)
    others = (*chain.segments[place + 1 :], *chain.segments[:place])
    return Chain((after, *others, before), is_closed=True)


def quarter(start: Point, end: Point, centre: Point, is_left: bool) -> Segment:
    """A quarter of the lead circle."""
    return Segment(start, end, centre, math.pi / 2.0 if is_left else -math.pi / 2.0)
