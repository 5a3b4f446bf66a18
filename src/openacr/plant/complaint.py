"""Something wrong in a `machine.toml`."""

from dataclasses import dataclass

from openacr.plant.locate import Path

__all__ = ["Complaint", "Path"]


@dataclass(frozen=True, slots=True)
class Complaint:
    """Something wrong: where in the file, in words, and how to mend it."""

    path: Path
    text: str
    hint: str = ""
