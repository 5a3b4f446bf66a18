"""One program checked as a machine would run it: language, limits, time, tools, stock."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from openacr.cnc.interpreter.survey import Survey
from openacr.cnc.program.program import Program
from openacr.cnc.reading.findings import Finding, placed
from openacr.cnc.state.cells import LAST_RADIUS, RADII
from openacr.errors import OpenacrError, UserError
from openacr.mill.plan.estimate.checking import TooLongError, checked, opened
from openacr.sysvar import Store
from openacr.sysvar.location import open_to_read
from openacr.workers import Done, Pool


class Status(StrEnum):
    """What was found in a program."""

    OK = "ok"
    WARNINGS = "warnings"
    ERRORS = "errors"
    TOO_LONG = "too long"
    UNREADABLE = "unreadable"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class Task:
    """A program to be checked."""

    file: Path
    store: Path | None = None
    dialect: str | None = None
    has_stock: bool = False
    limit_s: float = math.inf


@dataclass(frozen=True, slots=True)
class Note:
    """A finding: `file` is the program or a file it includes."""

    is_error: bool
    code: str
    text: str
    file: str
    line: int
    column: int = 1
    hint: str = ""

    def __str__(self) -> str:
        text = f"{self.code} {self.text}" if self.code else self.text
        return placed(self.file, self.line, self.column, text, self.hint)


@dataclass(frozen=True, slots=True)
class Verdict:
    """What was found in a program; lengths in the unit of its words."""

    file: Path
    status: Status
    notes: tuple[Note, ...] = ()
    reason: str = ""  # of a program that could not be checked
    dialect: str = ""
    lines: int = 0
    time_s: float | None = None
    unit: str = ""
    extents: dict[str, tuple[float, float]] = field(default_factory=dict)
    tools: tuple[int, ...] = ()
    without_radius: tuple[int, ...] = ()  # tools whose radius the store does not have
    removed: float | None = None  # of the stock, cubic units of the store

    @property
    def is_good(self) -> bool:
        """Whether the machine can run the program."""
        return self.status in (Status.OK, Status.WARNINGS)

    @property
    def errors(self) -> list[Note]:
        """Why it cannot."""
        return [note for note in self.notes if note.is_error]

    @property
    def warnings(self) -> list[Note]:
        """What is doubtful."""
        return [note for note in self.notes if not note.is_error]

    def data(self) -> dict[str, Any]:
        """The verdict as JSON data."""
        return asdict(self) | {"file": str(self.file), "status": str(self.status)}


def check(task: Task) -> Verdict:
    """Check one program; a file that cannot be read is a verdict, too."""
    try:
        with open_to_read(task.store) as cells:
            return _checked(task, cells)
    except TooLongError as error:
        return Verdict(task.file, Status.TOO_LONG, reason=str(error))
    except OpenacrError as error:
        return Verdict(task.file, Status.UNREADABLE, reason=str(error))


def check_all(tasks: Iterable[Task], pool: Pool) -> Iterator[Verdict]:
    """Check programs on many processes, as they come; one whose process dies is `lost`."""
    for each in pool.results(check, tasks):
        if isinstance(each, Done):
            yield each.result
        else:
            yield Verdict(each.task.file, Status.LOST, reason=each.reason)


def _checked(task: Task, cells: Store) -> Verdict:
    program, choice = opened(task.file, cells, task.dialect)
    survey, prediction = checked(program, cells, choice.name, limit_s=task.limit_s)
    notes = [_note(finding, task.file) for finding in survey.findings]
    removed = None
    if task.has_stock and not survey.errors:
        removed, found = _cut(program, cells, choice.name, task.file)
        notes += found
    is_wrong = any(note.is_error for note in notes)
    status = Status.ERRORS if is_wrong else Status.WARNINGS if notes else Status.OK
    return Verdict(
        task.file,
        status,
        tuple(notes),
        dialect=choice.name,
        lines=survey.line_cnt,
        time_s=None if survey.errors else prediction.time_s,
        unit=survey.unit,
        extents=dict(_extents(survey)),
        tools=tuple(dict.fromkeys(survey.tools)),
        without_radius=tuple(_without_radius(survey, cells)),
        removed=removed,
    )


def _note(finding: Finding, file: Path) -> Note:
    path = file.parent / finding.file
    place = str(path) if finding.file == file.name or path.exists() else finding.file
    return Note(
        finding.is_error, finding.code, finding.text, place, finding.line, finding.column,
        finding.hint,
    )  # fmt: skip


def _extents(survey: Survey) -> Iterator[tuple[str, tuple[float, float]]]:
    for letter, axis in survey.letters.items():
        low, high = (survey.shown(letter, ends[axis]) for ends in (survey.low, survey.high))
        if low < high:
            yield letter, (low, high)


def _without_radius(survey: Survey, cells: Store) -> Iterator[int]:
    for tool in sorted({tool for tool in survey.tools if tool}):
        if tool > LAST_RADIUS or cells.read(RADII + tool) == 0.0:
            yield tool


def _cut(
    program: Program, cells: Store, dialect: str, file: Path
) -> tuple[float | None, list[Note]]:
    """What the program takes from the blank of the store, and lines that should not touch it."""
    from openacr.mill.plan.pictures.removal import removal  # loads numpy

    try:
        found = removal(program, cells, dialect)
    except UserError as error:  # nothing is cut, or a tool has no radius
        return None, [Note(False, "", f"stock not checked: {error}", str(file), 1)]
    notes = [
        Note(True, "", "a rapid goes through material", str(file), line)
        for line in found.rapid_lines
    ]
    notes += [
        Note(False, "", "the cut goes below the blank", str(file), line)
        for line in found.below_lines
    ]
    return float(found.stock.removed), notes
