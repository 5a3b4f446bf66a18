"""Which language a part program is written in: said by an option, the file, or the store."""

import re
from itertools import islice
from pathlib import Path

from openacr.cnc import dialects as _registered  # noqa: F401 - fills the table
from openacr.cnc.codes import DIALECTS
from openacr.cnc.hosts import Cells
from openacr.errors import UserError

CHOICE_CELL = 700_005
BY_NUMBER = ("acromill", "rs274ngc")
HEAD_LINES = 10
_MARK = re.compile(r"\s*[;(]\s*dialect\s+(\w+)", re.IGNORECASE)


def dialect_of(file: Path | None, cells: Cells, wanted: str | None = None) -> str:
    """The dialect of a file: `wanted`, a `;dialect NAME` in its first lines, or P700005."""
    name = wanted or (_named_in(file) if file else None) or BY_NUMBER[int(cells.read(CHOICE_CELL))]
    if name.lower() not in DIALECTS:
        raise UserError(f"dialect {name}: known are {', '.join(DIALECTS)}")
    return name.lower()


def _named_in(file: Path) -> str | None:
    with file.open(encoding="latin-1") as text:
        marks = (_MARK.match(line[:256]) for line in islice(text, HEAD_LINES))
        return next((mark[1] for mark in marks if mark), None)
