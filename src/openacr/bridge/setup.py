"""What every system of a bridge is made of, besides its table of the file."""

from dataclasses import dataclass
from pathlib import Path

from openacr.bridge.items import Item
from openacr.bridge.writing import Writer


@dataclass(frozen=True, slots=True)
class Setup:
    """The values of a machine, its name, and what the system may do."""

    items: tuple[Item, ...]
    machine: str
    secret: str | None  # password of the system
    folder: Path  # of the bridge file, beside which its other files are
    writer: Writer
