"""An error found in a `machine.toml`."""

from dataclasses import dataclass

from openacr.plant.describe.locate import Path

__all__ = ["Complaint", "Path"]


@dataclass(frozen=True, slots=True)
class Complaint:
    """An error: its path in the file, its text, and a hint how to correct it."""

    path: Path
    text: str
    hint: str = ""
