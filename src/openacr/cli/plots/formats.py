"""Choose the form of a picture by the name of its file."""

from importlib.util import find_spec
from pathlib import Path

from openacr.cli.plots.curves import Curves
from openacr.errors import UserError

FORMATS = (".png", ".svg", ".html")


def require(path: Path) -> None:
    """Refuse a picture that could not be drawn, before anything runs."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise UserError(f"{path}: pictures end in {', '.join(FORMATS[:-1])} or {FORMATS[-1]}")
    if suffix != ".html" and find_spec("matplotlib") is None:
        raise UserError(
            f"{path}: {suffix} pictures need matplotlib: pip install 'openacr[plot]'; "
            "an .html picture needs nothing"
        )


def draw(curves: Curves, path: Path) -> None:
    """Draw the curves into `path`."""
    require(path)
    if path.suffix.lower() == ".html":
        from openacr.cli.plots.page import write_page

        write_page(curves, path)
    else:
        from openacr.cli.plots.image import write_image

        write_image(curves, path)
