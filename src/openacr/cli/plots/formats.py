"""Choose the form of a picture by the name of its file."""

from importlib.util import find_spec
from pathlib import Path

from openacr.cli.plots.curves import Curves
from openacr.errors import UserError

IMAGES = (".png", ".svg")
FORMATS = (*IMAGES, ".html")


def require(path: Path, of: str = "", formats: tuple[str, ...] = FORMATS) -> None:
    """Refuse a picture (`of` what, in messages) that could not be drawn, before anything runs."""
    suffix = path.suffix.lower()
    if suffix not in formats:
        what = f"pictures {of}".rstrip()
        raise UserError(f"{path}: {what} end in {', '.join(formats[:-1])} or {formats[-1]}")
    if suffix in IMAGES and find_spec("matplotlib") is None:
        other = "; an .html picture needs nothing" if ".html" in formats else ""
        raise UserError(
            f"{path}: {suffix} pictures need matplotlib: pip install 'openacr[plot]'{other}"
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
