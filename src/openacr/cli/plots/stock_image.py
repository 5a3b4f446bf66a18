"""Draw what stock removal leaves of a blank as a PNG or SVG picture, seen from above."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from openacr.cli.plots.saved import save
from openacr.mill.plan.pictures.removal import Removal
from openacr.mill.plan.pictures.stock import Mark

WIDTH_INCHES, HEIGHT_INCHES, DPI = 11.0, 8.0, 120
LIGHT = LightSource(azdeg=315, altdeg=50)
DEPTHS = mpl.colormaps["viridis"]
COLORS = {Mark.RAPID: "#D4151B", Mark.BELOW: "#8E24AA"}
TEXTS = {Mark.RAPID: "rapid in material", Mark.BELOW: "below the blank"}
STYLE: Any = {"font.size": 9, "axes.formatter.useoffset": False, "svg.fonttype": "none"}
LINES = 12  # that are named


def write_stock(removal: Removal, title: str, path: Path) -> None:
    """Draw a stock into a PNG or SVG file."""
    with mpl.rc_context(STYLE):
        save(build_figure(removal, title), path, dpi=DPI)


def build_figure(removal: Removal, title: str) -> Figure:
    """The heights, shaded by their slope; what is marked has colours of its own."""
    stock, unit = removal.stock, "mm" if removal.is_metric else "inch"
    (left, front, bottom), (right, back, top) = stock.blank.low, stock.blank.high
    rows, columns = stock.heights.shape
    figure = Figure(figsize=(WIDTH_INCHES, HEIGHT_INCHES), layout="constrained")
    panel = figure.add_subplot()
    extent = (left, left + columns * stock.cell, front, front + rows * stock.cell)
    norm = mpl.colors.Normalize(bottom, top)
    panel.imshow(_picture(removal, norm), origin="lower", extent=extent, interpolation="nearest")
    panel.set_xlim(left, right)
    panel.set_ylim(front, back)
    panel.set_xlabel(f"X [{unit}]")
    panel.set_ylabel(f"Y [{unit}]")
    scale = mpl.cm.ScalarMappable(norm, DEPTHS)
    figure.colorbar(scale, ax=panel, label=f"height [{unit}]", shrink=0.8)
    figure.suptitle(title, fontsize=13, parse_math=False, x=0.012, ha="left")
    handles = [
        Patch(color=COLORS[mark], label=f"{TEXTS[mark]}: {_named(lines)}")
        for mark, lines in ((Mark.RAPID, removal.rapid_lines), (Mark.BELOW, removal.below_lines))
        if lines
    ]
    if handles:
        figure.legend(handles=handles, loc="outside lower left", frameon=False)
    return figure


def _picture(removal: Removal, norm: Any) -> Any:
    stock = removal.stock
    shaded = LIGHT.shade(
        stock.heights, DEPTHS, norm=norm, blend_mode="soft", dx=stock.cell, dy=stock.cell
    )
    for mark, color in COLORS.items():
        shaded[(stock.marks & mark) != 0] = mpl.colors.to_rgba(color)
    return np.asarray(shaded)


def _named(lines: tuple[int, ...]) -> str:
    shown = ", ".join(map(str, lines[:LINES]))
    return f"line {shown}" + (" …" if len(lines) > LINES else "")
