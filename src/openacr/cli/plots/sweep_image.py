"""Draw the measures of a sweep: one row for each measure, one column for each quantity."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from openacr.cli.plots.image import ACTUAL, ERROR
from openacr.cli.plots.saved import save
from openacr.sweep.results import Row
from openacr.sweep.run import OK
from openacr.sweep.schema import Scale
from openacr.sweep.study import Study

PANEL_INCHES = (3.2, 2.4)
_STYLE: Any = {"font.size": 8, "axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True}


def write_scatter(study: Study, rows: list[Row], title: str, path: Path) -> None:
    """Draw every measure against every quantity; failed runs are red."""
    with mpl.rc_context(_STYLE):
        save(build_figure(study, rows, title), path, dpi=110)


def build_figure(study: Study, rows: list[Row], title: str) -> Figure:
    """One panel for each pair."""
    wide, high = len(study.quantities), len(study.measures)
    width, height = PANEL_INCHES
    figure = Figure(figsize=(width * wide + 0.5, height * high + 0.5), layout="constrained")
    figure.suptitle(title, parse_math=False, x=0.01, ha="left")
    panels = figure.subplots(high, wide, squeeze=False, sharex="col")
    colors = [ACTUAL if row.outcome.status == OK else ERROR for row in rows]
    for column, (quantity, given) in enumerate(study.quantities.items()):
        for line, measure in enumerate(study.measures):
            panel = panels[line, column]
            x = [row.point[column] for row in rows]
            panel.scatter(x, [row.outcome.measures[line] for row in rows], s=8, c=colors)
            if given.scale is Scale.LOG:
                panel.set_xscale("log")
            panel.set_xlabel(quantity)
            panel.set_ylabel(measure)
    return figure
