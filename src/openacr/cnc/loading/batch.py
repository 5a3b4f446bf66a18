"""Batch files: the programs of a shift, one after the other.

    ; plates of the morning
    PLATE.TXT  L3      three times
    "LONG NAME.TXT"

One program per line, relative to the batch file; `Ln` after the name repeats it; `;`
begins a comment, and blank lines are ignored.
"""

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from openacr.cnc.reading.findings import Finding
from openacr.errors import UserError

MOST_REPEATS = 9999
_LINE = re.compile(r'\s*(?:"([^"]*)"|(.*?))(?:\s+[Ll]\s*(\d+))?\s*')
_BYTES_READ = 1 << 20  # a larger file is not a batch file


@dataclass(frozen=True, slots=True)
class Entry:
    """One line: a program, and how often it runs."""

    path: Path
    repeat_cnt: int
    line: int


class BatchError(UserError):
    """A batch that cannot be run; none of it was started."""

    def __init__(self, findings: tuple[Finding, ...]) -> None:
        self.findings = findings
        super().__init__("\n".join(map(str, findings)))


@dataclass(frozen=True, slots=True)
class Batch:
    """The programs of a batch file, in their order."""

    path: Path
    entries: tuple[Entry, ...]

    @property
    def programs(self) -> tuple[Path, ...]:
        """Every program once, to be checked before the first one starts."""
        return tuple(dict.fromkeys(entry.path for entry in self.entries))

    def runs(self) -> Iterator[Entry]:
        """The runs in their order, with repetitions."""
        for entry in self.entries:
            for _ in range(entry.repeat_cnt):
                yield entry


def read_batch(path: Path) -> Batch:
    """The batch in a file; BatchError with all findings if a program is not there."""
    entries: list[Entry] = []
    findings: list[Finding] = []
    for number, line in enumerate(_text(path).splitlines(), 1):
        text = _without_remark(line)
        if not text.strip():
            continue
        entry = _entry(path, text, number)
        fault = _fault(path, entry)
        if fault:
            findings.append(Finding(*fault, str(path), number, block=line))
        entries.append(entry)
    if not entries:
        findings.append(Finding("E262", "no program is named in this batch", str(path), 1))
    if findings:
        raise BatchError(tuple(findings))
    return Batch(path, tuple(entries))


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(_BYTES_READ + 1)
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {error.strerror}") from None
    if len(data) > _BYTES_READ or b"\0" in data:
        raise UserError(f"{path}: this is no batch file")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _without_remark(line: str) -> str:
    """The line up to the first `;` outside quotes."""
    is_quoted = False
    for column, letter in enumerate(line):
        if letter == '"':
            is_quoted = not is_quoted
        elif letter == ";" and not is_quoted:
            return line[:column]
    return line


def _entry(batch: Path, text: str, number: int) -> Entry:
    found = _LINE.fullmatch(text)
    quoted, bare, repeats = found.groups() if found else (None, text, None)
    name = bare if quoted is None else quoted
    return Entry(batch.parent / name.strip(), 1 if repeats is None else int(repeats), number)


def _fault(batch: Path, entry: Entry) -> tuple[str, str] | None:
    """Code and text of what is wrong with an entry."""
    if not 1 <= entry.repeat_cnt <= MOST_REPEATS:
        return "E222", f"value out of range: L{entry.repeat_cnt} (1 to {MOST_REPEATS})"
    if not os.path.isfile(entry.path):  # false for impossible names, too
        return "E262", f"missing file: {entry.path}"
    if entry.path.samefile(batch):
        return "E262", "a batch cannot run itself"
    return None
