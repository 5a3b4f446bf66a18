"""What an editor shows beside a text: entries of an outline, and lines that fold together."""

from dataclasses import dataclass, field
from typing import NamedTuple

from openacr.editing.marks import Kind

COMMENT, REGION = "comment", "region"  # of folds


class Fold(NamedTuple):
    """Lines that fold to the first one of them."""

    first: int
    last: int
    kind: str = ""


@dataclass(slots=True)
class Entry:
    """An entry of an outline: a name, its lines, and what is in it."""

    name: str
    detail: str
    kind: Kind | None  # None: a program or PLC
    first: int
    last: int
    parts: list["Entry"] = field(default_factory=list)
