"""Axes of a machine, as its paths have them: which carry the feed, and what a degree counts as."""

import math
from collections.abc import Sequence

from openacr.cnc.canonical import AXES
from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings

Direction = tuple[float, ...]  # a unit tangent, a number for each linear axis
Point = Sequence[float]  # machine position, one value per axis 0..7
RADIUS_MM = 60.0  # a degree counts as much as it turns a point at about this radius
MM_PER_INCH = 25.4


def linear_axes(settings: Settings) -> list[int]:
    """The axes along which the feed counts; tangents have a component for each."""
    return [one.index for one in settings.axes if one.is_linear]


def per_degree(settings: Settings, axis: AxisSettings) -> float:
    """The length that a degree of a rotary axis counts as [units of the machine].

    It is the arc at the radius that the axis has in the store. Without one it is 1 mm or 1/32 inch:
    a power of two, so that scaling and scaling back are exact.
    """
    if axis.tolerance_radius_u > 0.0:
        return math.radians(axis.tolerance_radius_u)
    radius_u = RADIUS_MM if settings.is_metric else RADIUS_MM / MM_PER_INCH
    return 2.0 ** math.floor(math.log2(math.radians(radius_u)))


def weights(settings: Settings) -> tuple[float, ...]:
    """What a unit or degree of each axis 0..7 counts as, where all axes make up one distance."""
    turns = {one.index: per_degree(settings, one) for one in settings.axes if not one.is_linear}
    return tuple(turns.get(axis, 1.0) for axis in range(AXES))
