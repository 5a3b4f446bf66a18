"""Colours of a tool path by speed, acceleration or jerk, with their colour bar."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from openacr.mill.plan.pictures.path_motion import Motion
from openacr.mill.plan.pictures.tool_path import Array, strokes_of, thinned

BANDS = 64
DARKEST, BRIGHTEST = 0.0, 0.93  # of viridis: its last yellow is hard to see on white
COLORS = ListedColormap(mpl.colormaps["viridis"](np.linspace(DARKEST, BRIGHTEST, BANDS)))
UNKNOWN = "#BBBBBB"
UNKNOWN_LABEL = "jerk not planned"
WIDTH = 1.6


def draw_motion(panel: Axes, motion: Motion, to: Array, step: float, scale: float) -> None:
    """Draw a path in a projection, a line for each colour; high values are on top."""
    share = np.where(motion.known, motion.values, 0.0) / (motion.highest or 1.0)
    bands = np.minimum((share * BANDS).astype(np.intp), BANDS - 1)
    looks: list[tuple[Any, Any]] = [(UNKNOWN, motion.unknown)]
    looks += [(COLORS(band), motion.known & (bands == band)) for band in range(BANDS)]
    for color, chosen in looks:
        if chosen.any():
            seen = thinned(strokes_of(motion.points, chosen) @ to, step)
            panel.plot(*seen.T, color=color, linewidth=WIDTH * scale, solid_capstyle="round")


def add_bar(figure: Figure, panel: Axes, motion: Motion, unit: str) -> None:
    """Put the colour bar beside a panel."""
    shown: Any = mpl.cm.ScalarMappable(Normalize(0.0, motion.highest or 1.0), COLORS)
    label = f"{motion.quantity} [{motion.quantity.unit(unit)}]"
    figure.colorbar(shown, ax=panel, label=label, shrink=0.8, location="left")


def unknown_handle() -> Line2D:
    """What moves without a value look like, for the legend."""
    return Line2D([], [], color=UNKNOWN, linewidth=2, label=UNKNOWN_LABEL)
