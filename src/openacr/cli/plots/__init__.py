"""Pictures of a run: `draw(curves, path)` writes a PNG, SVG or HTML file."""

from openacr.cli.plots.curves import AxisCurves, BitCurve, Curves, ValueCurve
from openacr.cli.plots.formats import FORMATS, IMAGES, draw, require

__all__ = [
    "FORMATS",
    "IMAGES",
    "AxisCurves",
    "BitCurve",
    "Curves",
    "ValueCurve",
    "draw",
    "require",
]
