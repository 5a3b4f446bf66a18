"""An arc as lead-in: from where the tool is to beside the end of the programmed arc.

LinuxCNC begins compensation with arcs like this: the tool starts from where it is, on an arc
that ends beside the end of the programmed one, with the same tangent there.
"""

from math import atan2, copysign, dist, pi

from openacr.cnc.compensation.moves import moved
from openacr.cnc.geometry.elements import Element


def entry_arc(element: Element, away: float, start: tuple[float, float]) -> Element | None:
    """The arc beside which the tool leads in; None if no such arc exists.

    `start` is where the tool is, `away` the signed radius, left positive. What is returned is
    the contour of the tool's arc: the tool touches it everywhere, and its end is that of
    `element`. There is none for a tool that does not come to the end from the side of the
    arc, or that is nearer to the end than its radius.
    """
    if element.centre is None:
        return None
    first, second = element.plane.first, element.plane.second
    x1, y1 = element.end[first], element.end[second]
    radius = dist((x1, y1), element.centre)
    if radius == 0.0:
        return None
    turn = copysign(1.0, element.sweep_rad)
    ux, uy = (element.centre[0] - x1) / radius, (element.centre[1] - y1) / radius
    bx, by = x1 + turn * away * ux, y1 + turn * away * uy  # where the tool arrives
    dx, dy = bx - start[0], by - start[1]
    inward = -(dx * ux + dy * uy)
    if inward <= 0.0:
        return None
    tool_radius = (dx * dx + dy * dy) / (2.0 * inward)
    contour_radius = tool_radius + turn * away
    if contour_radius <= 0.0:
        return None
    cx, cy = bx + tool_radius * ux, by + tool_radius * uy
    sweep = turn * (atan2(by - cy, bx - cx) - atan2(start[1] - cy, start[0] - cx)) % (2.0 * pi)
    factor = contour_radius / tool_radius
    begin = cx + factor * (start[0] - cx), cy + factor * (start[1] - cy)
    return Element(
        element.source,
        element.plane,
        moved(element.start, element.plane, *begin),
        element.end,
        element.pace,
        (cx, cy),
        turn * sweep,
    )
