"""Which language a part program is written in: an option, the file, the store, or its signs."""

import re
from dataclasses import dataclass
from pathlib import Path

from openacr.cnc.codes import dialects as _registered  # noqa: F401 - fills the table
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.loading.likely import ACROMILL, RS274NGC, likely
from openacr.cnc.state.hosts import Cells
from openacr.errors import UserError
from openacr.sysvar.tabs import COMPATIBILITY, CONTROL

AUTO = "auto"
BY_NUMBER = {-1: AUTO, 0: ACROMILL, 1: RS274NGC}
BY_WORDS = {
    "option": "--dialect",
    "file": ";dialect in the file",
    "store": f"Dialect (P{COMPATIBILITY.dialect})",
}
HEAD_LINES = 10
HEAD_BYTES = 1 << 18  # where signs are looked for
_MARK = re.compile(r"\s*[;(]\s*dialect\s+(\w+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Choice:
    """The dialect of a program, what chose it, and why it is likely."""

    name: str
    by: str  # "option", "file", "store" or "signs"
    reasons: tuple[str, ...] = ()
    likely: str = ACROMILL

    @property
    def is_doubtful(self) -> bool:
        """Whether the signs of the file point to another dialect."""
        return self.likely != self.name and bool(self.reasons)

    @property
    def is_worth_saying(self) -> bool:
        """Whether signs chose another than the usual one, or the store another than they."""
        if self.by == "signs":
            return self.name != ACROMILL
        return self.by == "store" and self.is_doubtful

    @property
    def text(self) -> str:
        """What was chosen and why, and how to choose otherwise, as one line."""
        why = ", ".join(self.reasons)
        if self.by == "signs":
            if not why:
                return f"dialect {self.name}: nothing in the file points to another one"
            return f"dialect {self.name} by its signs: {why} (--dialect chooses another)"
        chosen = f"dialect {self.name} as {BY_WORDS[self.by]}"
        if not self.is_doubtful:
            return f"{chosen} says"
        return f"{chosen} says, but it looks like {self.likely}: {why} (--dialect {self.likely})"


def choose(file: Path | None, cells: Cells, wanted: str | None = None) -> Choice:
    """The dialect: `wanted`, a `;dialect NAME` in the first lines, P700005, or the likely one.

    `wanted` "auto" leaves the store out. Without a file nothing is likely: `acromill`.
    """
    lines = _head(file) if file else []
    found = likely(lines, int(cells.read(CONTROL.ij_inversion)))
    signs = tuple(found.reasons)
    if wanted and wanted.lower() != AUTO:
        return Choice(_known(wanted), "option", signs, found.dialect)
    marks = (_MARK.match(line[:256]) for line in lines[:HEAD_LINES])
    named = next((mark[1] for mark in marks if mark), None)
    if named and named.lower() != AUTO:
        return Choice(_known(named), "file", signs, found.dialect)
    stored = BY_NUMBER[int(cells.read(COMPATIBILITY.dialect))]
    if stored != AUTO and not wanted:
        return Choice(stored, "store", signs, found.dialect)
    return Choice(found.dialect, "signs", signs, found.dialect)


def dialect_of(file: Path | None, cells: Cells, wanted: str | None = None) -> str:
    """The name of the dialect."""
    return choose(file, cells, wanted).name


def _known(name: str) -> str:
    if name.lower() not in DIALECTS:
        raise UserError(f"dialect {name}: known are {', '.join(DIALECTS)} and {AUTO}")
    return name.lower()


def _head(file: Path) -> list[str]:
    """The first lines of a file, whole ones."""
    with file.open("rb") as opened:
        data = opened.read(HEAD_BYTES)
    lines = data.decode("latin-1").splitlines()
    return lines if len(data) < HEAD_BYTES else lines[:-1]
