"""Write a tool path as one self-contained HTML page: turn, zoom, step through, read lines."""

import base64
from pathlib import Path
from typing import Any

import numpy as np

from openacr.cli.plots.template import filled
from openacr.cli.plots.toolpath import CONTOUR, LineStyle, Scene, bands_of, style_of
from openacr.mill.plan.pictures.tool_path import Array


def write_page(scene: Scene, path: Path) -> None:
    """Write the page; it refers to nothing outside itself."""
    path.write_text(build_page(scene), encoding="utf-8")


def build_page(scene: Scene) -> str:
    """Put the moves into the page."""
    return filled("toolpath.html", scene.title, page_data(scene))


def page_data(scene: Scene) -> dict[str, Any]:
    """Collect what the script of the page draws: numbers as bytes, which is half the size."""
    drawing = scene.drawing
    looks = [style_of(kind, tool, scene.view) for kind, tool in drawing.styles()]
    return {
        "title": scene.title,
        "names": [*scene.names, *"   "][:3],
        "unit": scene.unit,
        "hasErrors": scene.has_errors,
        "points": _bytes(drawing.points, "<f4"),
        "style": _bytes(drawing.style_numbers(), "<u2"),
        "lines": _bytes(drawing.lines, "<i4"),
        "looks": [_look(look) for look in looks],
        "bands": bands_of(drawing),
        "contours": [_bytes(contour, "<f4") for contour in _joined(drawing.contours)],
        "contourColor": CONTOUR,
        "low": scene.low,
        "high": scene.high,
        "view": scene.view.matrix.tolist(),
        "digits": scene.digits,
    }


def _joined(contours: list[Array]) -> list[Array]:
    """All contours as one, with NaN between them."""
    if not contours:
        return []
    gap = np.full((1, 3), np.nan)
    return [np.vstack([part for contour in contours for part in (contour, gap)])]


def _look(look: LineStyle) -> dict[str, Any]:
    return {"label": look.label, "color": look.color, "width": look.width, "dashes": look.dashes}


def _bytes(values: Array | np.ndarray[Any, Any], kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()
