"""Write the curves of a run as one self-contained HTML page: zoom, cross-hair, readings."""

from pathlib import Path
from typing import Any

import numpy as np

from openacr.cli.plots.curves import Array, AxisCurves, Curves, ValueCurve, edges, envelope
from openacr.cli.plots.template import filled

# A page can be zoomed into, so it keeps more than a picture does.
PAGE_BUCKETS = 5000


def write_page(curves: Curves, path: Path) -> None:
    """Write the page; it refers to nothing outside itself."""
    path.write_text(build_page(curves), encoding="utf-8")


def build_page(curves: Curves) -> str:
    """Put the data of the curves into the page."""
    title = curves.title or "openacr run"
    return filled("run.html", title, page_data(curves), "vendor/uplot.css")


def page_data(curves: Curves) -> dict[str, Any]:
    """Collect what the script of the page draws."""
    time_s = curves.time_s
    span = [min(0.0, float(time_s[0])), float(time_s[-1])] if time_s.size else [0.0, 1.0]
    plane = curves.plane
    return {
        "title": curves.title or "openacr run",
        "span": span,
        "axes": [_axis(axis, time_s) for axis in curves.moved],
        "path": _path(*plane, time_s) if plane else None,
        "bits": [{"title": b.title, "on": edges(b, time_s)} for b in curves.strips],
        "events": [{"t": event.time_s, "text": event.text} for event in curves.events],
        "numbers": [_number(one, time_s) for one in curves.numbers],
    }


def _axis(axis: AxisCurves, time_s: Array) -> dict[str, Any]:
    columns = {
        "commanded": axis.commanded_u,
        "actual": axis.actual_u,
        "velocity": axis.velocity_ups,
        "error": axis.following_error_u,
    }
    kept = envelope(*columns.values(), buckets=PAGE_BUCKETS)
    data: dict[str, Any] = {name: _short(values[kept]) for name, values in columns.items()}
    return {"title": axis.title, "unit": axis.unit, "t": _short(time_s[kept]), **data}


def _number(curve: ValueCurve, time_s: Array) -> dict[str, Any]:
    kept = envelope(curve.values, buckets=PAGE_BUCKETS)
    return {
        "title": curve.watched.title,
        "unit": curve.watched.unit,
        "t": _short(time_s[kept]),
        "actual": _short(curve.values[kept]),
    }


def _path(first: AxisCurves, second: AxisCurves, time_s: Array) -> dict[str, Any]:
    columns = (first.commanded_u, second.commanded_u, first.actual_u, second.actual_u)
    kept = envelope(*columns, buckets=PAGE_BUCKETS)
    names = ("cx", "cy", "ax", "ay")
    data = {name: _short(values[kept]) for name, values in zip(names, columns, strict=True)}
    return {
        "title": f"path, master {first.master}",
        "labels": [f"{axis.title} [{axis.unit}]" for axis in (first, second)],
        "t": _short(time_s[kept]),
        **data,
    }


def _short(values: Array) -> list[float]:
    """Round to eight digits: finer than any screen, and half the size of the page."""
    largest = float(np.abs(values).max(initial=0.0))
    digits = 8 - int(np.ceil(np.log10(largest))) if largest > 0.0 else 8
    return [float(value) for value in np.round(values, digits)]
