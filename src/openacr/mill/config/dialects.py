"""Choice of the part-program language: by option, by the file, by the store, or by its features."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

from openacr.cnc.codes import dialects as _registered  # noqa: F401 - fills the table
from openacr.cnc.codes.table import DIALECTS
from openacr.cnc.loading.likely import ACROMILL, RS274NGC, Likely, likely
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
HEAD_BYTES = 1 << 18  # searched for features of a dialect
_MARK = re.compile(r"\s*[;(]\s*dialect\s+(\w+)", re.IGNORECASE)


@dataclass(frozen=True)
class Choice:
    """The dialect of a program, what chose it, and why it is likely.

    The features of the file are searched when they are asked for: a chosen dialect of a program
    without errors needs none.
    """

    name: str
    by: str  # "option", "file", "store" or "signs"
    search: Callable[[], Likely] = Likely

    @cached_property
    def found(self) -> Likely:
        """The features of the file."""
        return self.search()

    @property
    def reasons(self) -> tuple[str, ...]:
        """The features of the likely dialect."""
        return tuple(self.found.reasons)

    @property
    def likely(self) -> str:
        """The dialect of most features."""
        return self.found.dialect

    @property
    def doubts(self) -> tuple[str, ...]:
        """The features of another dialect than the likely one; they decide nothing if it is set."""
        return tuple(self.found.doubts) if self.by == "signs" else ()

    @property
    def circle(self) -> str:
        """What a whole circle is, and would be in the other dialect, where no feature decides."""
        is_open = self.by == "signs" and self.name == ACROMILL and not self.reasons
        return self.found.circle if is_open else ""

    @property
    def is_doubtful(self) -> bool:
        """Whether the features of the file point to another dialect."""
        return self.likely != self.name and bool(self.reasons)

    @property
    def is_worth_reporting(self) -> bool:
        """Whether to report the choice: unusual, or from the store and contradicted by the file."""
        if self.by == "signs":
            return self.name != ACROMILL or bool(self.doubts) or bool(self.circle)
        return self.by == "store" and self.is_doubtful

    @property
    def text(self) -> str:
        """The choice, its reason, and how to choose otherwise, as one line."""
        why = ", ".join(self.reasons)
        if self.by == "signs":
            return self._by_features(why)
        chosen = f"dialect {self.name}, set by {BY_WORDS[self.by]}"
        if not self.is_doubtful:
            return chosen
        return f"{chosen}, but it looks like {self.likely}: {why} (--dialect {self.likely})"

    def _by_features(self, why: str) -> str:
        other = next(name for name in DIALECTS if name != self.name)
        doubts = ", ".join(self.doubts)
        if why and doubts:
            return (
                f"dialect {self.name} by its features: {why}; features of {other}: {doubts}"
                f" (--dialect {other})"
            )
        if why:
            return f"dialect {self.name} by its features: {why} (--dialect chooses another)"
        if doubts or self.circle:
            features = f"; features of {other}: {doubts}" if doubts else ""
            circle = f"; {self.circle}" if self.circle else ""
            return (
                f"dialect {self.name}, as no feature decides{features}{circle} (--dialect {other})"
            )
        return f"dialect {self.name}: nothing in the file points to another one"


def choose(file: Path | None, cells: Cells, wanted: str | None = None) -> Choice:
    """Choose the dialect: `wanted`, a `;dialect NAME` near the top, P700005, or the likely one.

    `wanted` "auto" ignores the store. Without a file the dialect is `acromill`.
    """
    return choose_for(_beginning(file) if file else b"", cells, wanted)


def choose_for(data: bytes, cells: Cells, wanted: str | None = None) -> Choice:
    """The same for the program that these bytes are, or begin."""
    lines = _head(data)
    search = partial(likely, lines, int(cells.read(CONTROL.ij_inversion)))
    if wanted and wanted.lower() != AUTO:
        return Choice(_known(wanted), "option", search)
    marks = (_MARK.match(line[:256]) for line in lines[:HEAD_LINES])
    named = next((mark[1] for mark in marks if mark), None)
    if named and named.lower() != AUTO:
        return Choice(_known(named), "file", search)
    stored = BY_NUMBER[int(cells.read(COMPATIBILITY.dialect))]
    if stored != AUTO and not wanted:
        return Choice(stored, "store", search)
    found = search()
    return Choice(found.dialect, "signs", lambda: found)


def dialect_of(file: Path | None, cells: Cells, wanted: str | None = None) -> str:
    """The name of the dialect."""
    return choose(file, cells, wanted).name


def _known(name: str) -> str:
    if name.lower() not in DIALECTS:
        raise UserError(f"unknown dialect {name}: choose one of {', '.join(DIALECTS)} or {AUTO}")
    return name.lower()


def _beginning(file: Path) -> bytes:
    with file.open("rb") as opened:
        return opened.read(HEAD_BYTES)


def _head(data: bytes) -> list[str]:
    """The complete lines at the start of a file."""
    lines = data[:HEAD_BYTES].decode("latin-1").splitlines()
    return lines if len(data) < HEAD_BYTES else lines[:-1]
