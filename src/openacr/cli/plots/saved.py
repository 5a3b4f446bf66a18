"""Save a figure: names of files, axes and programs cannot spoil it."""

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.text import Text

from openacr.lang.characters import shown

COMPRESSION = {"compress_level": 4}  # half the time of the usual 6, and files a fiftieth longer


def save(figure: Figure, path: Path, dpi: int) -> None:
    """Write a PNG or SVG file; XML and fonts have no control characters, so they are shown."""
    for text in figure.findobj(Text):
        text.set_text(shown(text.get_text()))
    if path.suffix.lower() != ".png":
        figure.savefig(path, dpi=dpi)
        return
    figure.set_dpi(dpi)
    if figure.axes and (engine := figure.get_layout_engine()) is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)  # else all is drawn once more to lay it out
    figure.savefig(path, dpi=dpi, pil_kwargs=COMPRESSION)
