"""Save a figure: names of files, axes and programs cannot spoil it."""

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.text import Text

from openacr.lang.characters import shown


def save(figure: Figure, path: Path, dpi: int) -> None:
    """Write a PNG or SVG file; XML and fonts have no control characters, so they are shown."""
    for text in figure.findobj(Text):
        text.set_text(shown(text.get_text()))
    figure.savefig(path, dpi=dpi)
