"""Draw a tool path as a PNG or SVG picture.

A large view from the right, the front and above, with the box of the extents and its
sizes; beside it the views from above and, where the tool also moves up and down, from the
front. The views are parallel projections, so that all lengths along an axis stay alike.
"""

from math import cos, radians, sin
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from openacr.cli.plots.motion_colors import add_bar, draw_motion, unknown_handle
from openacr.cli.plots.saved import save
from openacr.cli.plots.toolpath import CONTOUR, LineStyle, Scene, bands_of, shade, style_of
from openacr.mill.plan.pictures.tool_path import Array, thinned

WIDTH_INCHES, HEIGHT_INCHES, DPI = 13.0, 7.6, 120
PIXELS = 1600  # more than any view is wide, so that thinning cannot be seen
AZIMUTH_DEG, ELEVATION_DEG = -60.0, 30.0
FLAT = 1e-9
BOX, QUIET = "#B0B0B0", "#666666"
STYLE: Any = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#888888",
    "axes.formatter.useoffset": False,
    "axes.labelcolor": "#333333",
    "axes.titlesize": 10,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "svg.fonttype": "none",
}


def write_image(scene: Scene, path: Path) -> None:
    """Draw a scene into a PNG or SVG file."""
    with mpl.rc_context(STYLE):
        save(build_figure(scene), path, dpi=DPI)


def build_figure(scene: Scene) -> Figure:
    """Lay the views out and fill them."""
    size = np.abs((scene.drawing.high - scene.drawing.low) @ scene.view.matrix)
    figure = Figure(figsize=(WIDTH_INCHES, HEIGHT_INCHES), layout="constrained")
    if size[2] > FLAT:
        panels = figure.subplot_mosaic(
            [["space", "top"], ["space", "front"]],
            width_ratios=[1.7, 1.0],
            height_ratios=_heights(size),
        )
        _flat_view(panels["front"], scene, (0, 2), "from the front")
    else:
        panels = figure.subplot_mosaic([["space", "top"]], width_ratios=[1.2, 1.0])
    _space_view(panels["space"], scene)
    if scene.motion is not None:
        add_bar(figure, panels["space"], scene.motion, scene.unit)
    _flat_view(panels["top"], scene, (0, 1), "from above")
    _headline(figure, scene)
    return figure


def _heights(size: Array) -> list[float]:
    """The view that needs more height gets more, within limits."""
    share = size[1] / max(size[1] + size[2], FLAT)
    return [min(0.75, max(0.4, float(share))), 1.0 - min(0.75, max(0.4, float(share)))]


def _headline(figure: Figure, scene: Scene) -> None:
    figure.suptitle(
        scene.title + ("   (with errors: up to the first, or past gouges)" * scene.has_errors),
        fontsize=13,
        parse_math=False,  # a name may have dollar signs
        x=0.012,
        ha="left",
        color="#B00020" if scene.has_errors else "black",
    )
    if scene.motion is None:
        handles = [_handle(look) for _, _, look in _looks(scene)]
    else:
        handles = [unknown_handle()] if scene.motion.unknown.any() else []
    if scene.has_contours:
        handles.append(Line2D([], [], color=CONTOUR, linewidth=0.8, label="programmed contour"))
    handles.append(
        Line2D([], [], color="black", marker="o", fillstyle="none", linestyle="", label="start")
    )
    handles.append(Line2D([], [], color="black", marker="s", linestyle="", label="end"))
    figure.legend(
        handles=handles, loc="outside lower left", ncols=min(len(handles), 9), frameon=False
    )


def _handle(look: LineStyle) -> Line2D:
    return Line2D([], [], color=look.color, linewidth=2, linestyle=_dashes(look), label=look.label)


def _dashes(look: LineStyle) -> Any:
    return (0, look.dashes) if look.dashes else "-"


def _looks(scene: Scene) -> list[tuple[Any, int, LineStyle]]:
    return [(kind, tool, style_of(kind, tool, scene.view)) for kind, tool in scene.drawing.styles()]


# --- views --------------------------------------------------------------------------------


def _draw(panel: Axes, scene: Scene, to: npt.NDArray[np.float64], scale: float) -> None:
    """All moves in a projection: screen = points @ to."""
    drawing = scene.drawing
    low, high = (drawing.points @ to).min(axis=0), (drawing.points @ to).max(axis=0)
    step = max(float((high - low).max()) / PIXELS, FLAT)
    for contour in drawing.contours:
        seen = thinned(contour @ to, step)
        panel.plot(*seen.T, color=CONTOUR, linewidth=0.8 * scale)
    if scene.motion is None:
        _draw_kinds(panel, scene, to, step, scale)
    else:
        draw_motion(panel, scene.motion, to, step, scale)
    start, end = drawing.points[0] @ to, drawing.points[-1] @ to
    panel.plot(*start, "o", color="black", markersize=8, fillstyle="none")
    panel.plot(*end, "s", color="black", markersize=4)
    panel.set_aspect("equal", adjustable="datalim")


def _draw_kinds(
    panel: Axes, scene: Scene, to: npt.NDArray[np.float64], step: float, scale: float
) -> None:
    """All moves in the colours and dashes of their kinds and tools."""
    bands = bands_of(scene.drawing)
    for kind, tool, look in _looks(scene):
        for band in range(bands):
            seen = thinned(scene.drawing.strokes(kind, tool, band, bands) @ to, step)
            panel.plot(
                *seen.T,
                color=shade(look.color, band, bands),
                linewidth=look.width * scale * (0.5 if bands > 1 else 1.0),
                linestyle=_dashes(look),
                solid_capstyle="round",
            )


def _flat_view(panel: Axes, scene: Scene, directions: tuple[int, int], title: str) -> None:
    """Two directions of the screen; the numbers along a flipped axis are reversed."""
    (across, across_flips), (up, up_flips) = map(scene.view.axis_on, directions)
    to = np.zeros((3, 2))
    to[across, 0] = to[up, 1] = 1.0
    _draw(panel, scene, to, 0.8)
    panel.xaxis.set_inverted(across_flips)
    panel.yaxis.set_inverted(up_flips)
    panel.grid(visible=True)
    panel.set_xlabel(f"{_name(scene, across)} [{scene.unit}]")
    panel.set_ylabel(f"{_name(scene, up)} [{scene.unit}]")
    panel.set_title(title, loc="left", color=QUIET)


def _name(scene: Scene, axis: int) -> str:
    return (*scene.names, "", "", "")[axis]


def projection(azimuth_deg: float, elevation_deg: float) -> npt.NDArray[np.float64]:
    """From space to screen, seen from an azimuth (from +X towards +Y) and a height."""
    a, e = radians(azimuth_deg), radians(elevation_deg)
    return np.array([[-sin(a), -sin(e) * cos(a)], [cos(a), -sin(e) * sin(a)], [0.0, cos(e)]])


def _space_view(panel: Axes, scene: Scene) -> None:
    to = scene.view.matrix @ projection(AZIMUTH_DEG, ELEVATION_DEG)
    panel.set_axis_off()
    panel.margins(0.02)
    _box(panel, scene, to)
    _draw(panel, scene, to, 1.0)


def _box(panel: Axes, scene: Scene, to: npt.NDArray[np.float64]) -> None:
    """The extents: a box whose three edges in front carry their axis, from and to."""
    corners = np.array([_corner(scene, bits) for bits in range(8)])
    for one in range(8):
        for direction in range(3):
            if not one >> direction & 1:
                seen = corners[[one, one | 1 << direction]] @ to
                panel.plot(*seen.T, color=BOX, linewidth=0.7, zorder=0)
    # Edges at the outline: along the front, along the right side, up at the left.
    for direction, corner, across, side in ((0, 0, "top", "right"), (1, 1, "top", "left")):
        edge = corners[[corner, corner | 1 << direction]] @ to
        _size(panel, scene, direction, edge, (across, side))
    if scene.high[2] - scene.low[2] > FLAT:
        _size(panel, scene, 2, corners[[0, 4]] @ to, ("center", "right"))


def _corner(scene: Scene, bits: int) -> list[float]:
    """A corner of the extents; bits say where it lies along the directions of the screen."""
    corner = [0.0, 0.0, 0.0]
    for direction in range(3):
        axis, is_flipped = scene.view.axis_on(direction)
        is_far = bool(bits >> direction & 1) != is_flipped
        corner[axis] = (scene.high if is_far else scene.low)[axis]
    return corner


def _size(panel: Axes, scene: Scene, direction: int, edge: Array, place: tuple[str, str]) -> None:
    axis, _ = scene.view.axis_on(direction)
    x, y = edge.mean(axis=0)
    panel.annotate(
        f"{_name(scene, axis)}  {scene.low[axis]:.4g} … {scene.high[axis]:.4g} {scene.unit}",
        (x, y),
        xytext=(-8 if place[1] == "right" else 8, -6 if place[0] == "top" else 0),
        textcoords="offset points",
        ha=place[1],
        va=place[0],
        color=QUIET,
        fontsize=9,
    )
