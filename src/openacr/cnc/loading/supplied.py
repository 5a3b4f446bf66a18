"""The supplied cycles, and files found without regard to the case of their names."""

import re
from pathlib import Path

from openacr.cnc.program.labels import Part, Place
from openacr.cnc.program.program import CYCLES_FILE
from openacr.cnc.reading.text import Kept, Text

CUSTOM_NAME = re.compile(r"M(\d+)\.TXT", re.IGNORECASE)
_LABEL = re.compile(rb"N(\d+)")


def cycle_part() -> Part:
    """The supplied cycles with their labels."""
    part = Part(supplied_cycles(), is_cycles=True)
    add_labels(part)
    return part


def add_labels(part: Part) -> None:
    """Add the labels of a text that is known to be free of errors and begins lines with them."""
    offset, line = part.text.begin, 0
    while (taken := part.text.line(offset)) is not None:
        line += 1
        label = _LABEL.match(taken[0])
        if label is not None:
            part.labels.add(int(label[1]), Place(part, offset, line))
        offset = taken[1]


def supplied_cycles() -> Text:
    """The canned cycles that come with the package."""
    return Text(CYCLES_FILE, Kept(Path(__file__).with_name("CYCLES.TXT").read_bytes()))


def found_in(folder: Path, name: str) -> Path | None:
    """Find a file in a folder, ignoring the case of its name."""
    path = folder / name
    if path.is_file():
        return path
    if not path.parent.is_dir():
        return None
    wanted = path.name.upper()
    return next((p for p in path.parent.iterdir() if p.name.upper() == wanted), None)


def custom_numbers(folder: Path | None) -> list[int]:
    """The numbers of the M codes that have a file `Mnnn.TXT` in a folder, ascending."""
    if folder is None or not folder.is_dir():
        return []
    names = (CUSTOM_NAME.fullmatch(path.name) for path in folder.iterdir())
    return sorted({int(name[1]) for name in names if name})
