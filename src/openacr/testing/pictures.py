"""The last moments of a machine: sparklines for terminals, a picture where it can be drawn."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from tempfile import gettempdir

import numpy as np

from openacr.controller.trace import Reals
from openacr.testing.machine import Machine

LAST_S = 2.0
WIDTH = 60
BARS = "▁▂▃▄▅▆▇█"
MOST_PRINTED = 400  # characters


def last_moments(machine: Machine, folder: Path | None, name: str) -> str:
    """State, what was printed last, curves as text, and the path of a picture."""
    parts = [machine.state()]
    if machine.printed:
        parts.append(f"printed: {machine.printed[-MOST_PRINTED:]!r}")
    curves = list(_curves(machine))
    parts += [f"{label:<24} {sparkline(values)} {_range(values)}" for label, _, values in curves]
    if curves and (path := _picture(curves, folder, name)):
        parts.append(f"picture: {path}")
    return "\n".join(parts)


def _curves(machine: Machine) -> Iterator[tuple[str, Reals, Reals]]:
    """Position and following error of each axis that moved, over the last seconds."""
    traces = machine.recorded()
    time_s = np.concatenate([trace.time_s for trace in traces])
    if not len(time_s):
        return
    recent = time_s >= time_s[-1] - LAST_S
    for number in range(len(traces[-1].axes)):
        for label, key in (("position", "commanded_u"), ("following error", "following_error_u")):
            values = np.concatenate([getattr(trace.axes[number], key) for trace in traces])
            if np.ptp(values):
                yield f"axis {number} {label}", time_s[recent], values[recent]


def sparkline(values: Reals, width: int = WIDTH) -> str:
    """A curve as one line of text."""
    if not len(values):
        return ""
    chosen = values[np.linspace(0, len(values) - 1, min(width, len(values))).astype(int)]
    low, high = float(chosen.min()), float(chosen.max())
    scale = (len(BARS) - 1) / (high - low) if high > low else 0.0
    return "".join(BARS[round((float(value) - low) * scale)] for value in chosen)


def _range(values: Reals) -> str:
    return f"{values.min():.6g} to {values.max():.6g}"


def _picture(curves: list[tuple[str, Reals, Reals]], folder: Path | None, name: str) -> Path | None:
    """A PNG of the curves; None without matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return None
    where = folder or Path(gettempdir(), "openacr-pictures")
    where.mkdir(parents=True, exist_ok=True)
    path = where / f"{re.sub(r'[^A-Za-z0-9_.-]+', '_', name)}.png"
    figure = Figure(figsize=(9, 1.6 * len(curves) + 0.6), layout="constrained")
    axes = figure.subplots(len(curves), 1, sharex=True, squeeze=False)
    for plot, (label, time_s, values) in zip(axes[:, 0], curves, strict=True):
        plot.plot(time_s, values)
        plot.set_ylabel(label, fontsize=7)
        plot.grid(True)
    axes[-1, 0].set_xlabel("time [s]")
    figure.savefig(path, dpi=100)
    return path
