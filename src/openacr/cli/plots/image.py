"""Draw the curves of a run as a PNG or SVG picture.

One column per axis, so that position, velocity and following error of one axis stand
below each other on one time axis; the path in the plane of one master beside them, with
equal scales; parameters that were chosen, and as strips outputs that changed and flags that were
chosen, below. Events of the run (limits, kills, programs that stopped) are numbered marks on the
time axes and a list at the foot.
"""

import math
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator

from openacr.cli.plots.curves import Array, AxisCurves, Curves, ValueCurve, edges, envelope, marks
from openacr.cli.plots.saved import save

# Okabe and Ito's palette: distinguishable with every common colour vision deficiency, and in grey.
ACTUAL = "#0072B2"
COMMANDED = "#F3BE56"  # its orange, lightened: the broad line below
VELOCITY = "#009E73"
ERROR = "#D55E00"
STRIP = "#56B4E9"
QUIET = "#666666"
EVENT = "#9A4A7C"  # its purple, darkened: numbers on it are white

COLUMNS = 4  # axes beside each other; more axes go into further blocks below
COLUMN_INCHES, PATH_INCHES, BLOCK_INCHES = 4.8, 6.2, 7.6
NUMBER_INCHES, STRIP_INCHES = 1.7, 0.26
EVENTS, EVENT_INCHES = 24, 0.17  # lines of the list of events
LINES_APART = 0.002  # of the time shown: nearer events share a line
BADGE, DIGIT = 0.03, 0.03  # width of a number, and of each of its digits
HEIGHTS = (2.4, 1.6, 1.6)  # position, velocity, following error

_STYLE: Any = {
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#888888",
    "axes.formatter.useoffset": False,
    "axes.labelcolor": "#333333",
    "axes.titlesize": 10,
    "svg.fonttype": "none",
}


def write_image(curves: Curves, path: Path) -> None:
    """Draw the curves into a PNG or SVG file."""
    with mpl.rc_context(_STYLE):
        save(build_figure(curves), path, dpi=120)


def build_figure(curves: Curves) -> Figure:
    """Lay the panels out and fill them."""
    axes = curves.moved
    if not axes and not curves.watched:
        return _nothing_moved(curves)
    columns = max(1, min(len(axes), COLUMNS))
    widths = [COLUMN_INCHES] * columns + ([PATH_INCHES] if curves.plane else [])
    heights = [height * BLOCK_INCHES / sum(HEIGHTS) for height in HEIGHTS]
    heights *= math.ceil(len(axes) / columns)
    heights += [NUMBER_INCHES] * len(curves.numbers)
    if curves.strips:
        heights.append(STRIP_INCHES * len(curves.strips) + 0.9)
    if curves.events:
        heights.append(_events_inches(curves))
    figure = Figure(
        figsize=(sum(widths), sum(heights) + 0.5),
        layout=ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.05),
    )
    grid = GridSpec(len(heights), len(widths), figure, width_ratios=widths, height_ratios=heights)
    _fill(figure, grid, curves, columns)
    _headline(figure, curves)
    return figure


def _headline(figure: Figure, curves: Curves) -> None:
    seconds = float(curves.time_s[-1]) if curves.time_s.size else 0.0
    text = f"{curves.title or 'openacr run'}   {seconds:.4g} s simulated"
    figure.suptitle(text, fontsize=12, parse_math=False, x=0.01, ha="left")


def _nothing_moved(curves: Curves) -> Figure:
    inches = 2 + (_events_inches(curves) if curves.events else 0.0)
    figure = Figure(figsize=(7, inches), layout="constrained")
    _headline(figure, curves)
    figure.text(0.5, 1.0 - 1.2 / inches, "no axis moved", ha="center", color=QUIET, fontsize=14)
    if curves.events:
        grid = GridSpec(2, 1, figure, height_ratios=[2, inches - 2])
        _event_list(figure.add_subplot(grid[1]), curves)
    return figure


def _events_inches(curves: Curves) -> float:
    return EVENT_INCHES * (min(len(curves.events), EVENTS + 1) + 1) + 0.2


def _event_list(panel: Axes, curves: Curves) -> None:
    """What the numbers of the marks mean."""
    panel.set_axis_off()
    panel.set_title("events", loc="left", fontweight="bold", pad=2)
    lines = [f"{n:>3}  {event}" for n, event in enumerate(curves.events[:EVENTS], 1)]
    if len(curves.events) > EVENTS:
        lines.append(f"     and {len(curves.events) - EVENTS} more")
    panel.text(
        0.0, 1.0, "\n".join(lines), transform=panel.transAxes, va="top", linespacing=1.35,
        parse_math=False, fontfamily="monospace", fontsize=8,
    )  # fmt: skip


def _mark_events(panel: Axes, curves: Curves, *, is_labelled: bool) -> None:
    """A line at every event; at the top panel of a column its number, too."""
    span_s = float(curves.time_s[-1]) - min(0.0, float(curves.time_s[0]))
    for mark in marks(curves.events, span_s * LINES_APART):
        panel.axvline(mark.time_s, color=EVENT, linewidth=0.9, linestyle=(0, (3, 2)), zorder=1.5)
    apart_s = span_s * (BADGE + DIGIT * len(str(len(curves.events))))
    for mark in marks(curves.events, apart_s) if is_labelled else ():
        panel.annotate(
            mark.label, (mark.time_s, 1.0), xycoords=panel.get_xaxis_transform(),
            ha="center", va="center", fontsize=7, color="white", annotation_clip=False,
            bbox={"boxstyle": "round,pad=0.2", "facecolor": EVENT, "edgecolor": "none"},
        )  # fmt: skip


def _fill(figure: Figure, grid: GridSpec, curves: Curves, columns: int) -> None:
    first: Axes | None = None
    for index, axis in enumerate(curves.moved):
        top, column = index // columns * len(HEIGHTS), index % columns
        panels = []
        for row in range(len(HEIGHTS)):
            panels.append(figure.add_subplot(grid[top + row, column], sharex=first))
            first = first or panels[0]
        _axis_column(panels, axis, curves.time_s)
        for row, panel in enumerate(panels):
            _mark_events(panel, curves, is_labelled=row == 0)
    if curves.plane:
        # The path shares the height of the first block and is as tall as it is wide.
        _path_panel(figure.add_subplot(grid[: len(HEIGHTS), columns]), *curves.plane)
    top = math.ceil(len(curves.moved) / columns) * len(HEIGHTS)
    for row, number in enumerate(curves.numbers, top):
        panel = figure.add_subplot(grid[row, :columns], sharex=first)
        first = first or panel
        _number_panel(panel, number, curves.time_s)
        _mark_events(panel, curves, is_labelled=True)
    if curves.strips:
        strips = figure.add_subplot(grid[-2 if curves.events else -1, :columns], sharex=first)
        first = first or strips
        _strip_panel(strips, curves)
        _mark_events(strips, curves, is_labelled=True)
    if curves.events:
        _event_list(figure.add_subplot(grid[-1, :]), curves)
    if first is not None:
        first.set_xlim(min(0.0, float(curves.time_s[0])), float(curves.time_s[-1]))


def _axis_column(panels: list[Axes], axis: AxisCurves, time_s: Array) -> None:
    position, velocity, error = panels
    # The commanded line is broad and light, so that the actual one is seen on top of it.
    _line(position, time_s, axis.commanded_u, COMMANDED, "commanded", 3.6)
    _line(position, time_s, axis.actual_u, ACTUAL, "actual", 1.0)
    _line(velocity, time_s, axis.velocity_ups, VELOCITY, "", 1.0)
    _line(error, time_s, axis.following_error_u, ERROR, "", 0.9)
    position.set_title(axis.title, loc="left", fontweight="bold", pad=8)
    position.legend(
        loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, borderaxespad=0.2
    )
    position.set_ylabel(f"position [{axis.unit}]")
    velocity.set_ylabel(f"velocity [{axis.unit}/s]")
    error.set_ylabel(f"following error [{axis.unit}]")
    _peak(velocity, axis.velocity_ups, f"{axis.unit}/s")
    _peak(error, axis.following_error_u, axis.unit)
    for panel in panels:
        panel.yaxis.set_major_locator(MaxNLocator(6))
    for panel in panels[:-1]:
        panel.tick_params(labelbottom=False)
    error.set_xlabel("time [s]")
    for panel in panels[1:]:
        panel.axhline(0.0, color="#aaaaaa", linewidth=0.8, zorder=1)


def _line(panel: Axes, x: Array, y: Array, color: str, label: str, width: float) -> None:
    kept = envelope(y)
    panel.plot(x[kept], y[kept], color=color, label=label or None, linewidth=width)


def _peak(panel: Axes, values: Array, unit: str) -> None:
    """Write the largest magnitude above the panel, outside of the data."""
    peak = float(values[np.abs(values).argmax()])
    panel.set_title(f"peak {peak:.4g} {unit}", loc="right", fontsize=8, color=QUIET, pad=3)


def _path_panel(panel: Axes, first: AxisCurves, second: AxisCurves) -> None:
    for x, y, color, label, width in (
        (first.commanded_u, second.commanded_u, COMMANDED, "commanded", 3.6),
        (first.actual_u, second.actual_u, ACTUAL, "actual", 1.0),
    ):
        kept = envelope(x, y)
        panel.plot(x[kept], y[kept], color=color, linewidth=width, label=label)
    start = (first.actual_u[0], second.actual_u[0])
    end = (first.actual_u[-1], second.actual_u[-1])
    panel.plot(*start, "o", color="black", markersize=9, fillstyle="none", label="start")
    panel.plot(*end, "s", color="black", markersize=5, label="end")
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_title(f"path, master {first.master}", loc="left", fontweight="bold", pad=8)
    panel.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=4,
        frameon=False,
        borderaxespad=0.2,
        columnspacing=1.2,
        handlelength=1.4,
    )
    panel.set_xlabel(f"{first.title} [{first.unit}]")
    panel.set_ylabel(f"{second.title} [{second.unit}]")


def _number_panel(panel: Axes, curve: ValueCurve, time_s: Array) -> None:
    _line(panel, time_s, curve.values, ACTUAL, "", 1.0)
    panel.set_title(curve.watched.title, loc="left", fontweight="bold", pad=6)
    panel.set_ylabel(f"[{curve.watched.unit}]" if curve.watched.unit else "")
    panel.yaxis.set_major_locator(MaxNLocator(4))
    panel.set_xlabel("time [s]")


def _strip_panel(panel: Axes, curves: Curves) -> None:
    bits = curves.strips
    for row, bit in enumerate(bits):
        spans = [(on, off - on) for on, off in edges(bit, curves.time_s)]
        panel.broken_barh(spans, (row - 0.35, 0.7), facecolors=STRIP, edgecolor=STRIP)
    panel.set_yticks(range(len(bits)), [bit.title for bit in bits])
    panel.set_ylim(len(bits) - 0.4, -0.6)
    panel.set_title("outputs and flags", loc="left", fontweight="bold", pad=6)
    panel.set_xlabel("time [s]")
    panel.tick_params(axis="y", length=0)
