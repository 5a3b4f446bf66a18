"""The results of a sweep as a Parquet file: one row for each run, written in parts.

While a sweep runs, its results go into parts beside the file; each appears whole, by renaming. At
the end the file takes their place. Whatever ends the process, file and parts can be read, and what
they hold is not done again.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from openacr.errors import UserError, unreadable, unwritable
from openacr.locks import FileLock, InUseError
from openacr.sweep.run import LOST, Outcome
from openacr.sweep.study import Point, Study

FINGERPRINT = b"openacr.sweep"
FIXED = ("status", "end", "time_s", "error")


@dataclass(frozen=True, slots=True)
class Row:
    """A run that is done."""

    point: Point
    outcome: Outcome


class Results:
    """The rows of a sweep on disk; one process at a time has them."""

    def __init__(self, path: Path, study: Study, *, is_new: bool = False) -> None:
        """UserError for a file of another sweep, or one that another process is writing."""
        self.path = path
        self.folder = path.with_name(f"{path.name}.parts")
        self._study = study
        self._pyarrow = _pyarrow()
        self._waiting: list[Row] = []
        try:
            self.folder.mkdir(exist_ok=True)
        except OSError as error:
            raise unwritable(self.folder, error) from None
        try:
            self._lock = FileLock(self.folder / "lock", "")
        except InUseError:
            raise UserError(f"{path}: another sweep is writing it") from None
        try:
            self.rows = {} if is_new else self._read()
        except BaseException:
            self.close()
            raise
        if is_new:
            self._remove_parts()
        self._next = 1 + max((int(each.stem) for each in self._parts()), default=0)

    def close(self) -> None:
        """Let other processes have the file; a folder without parts is removed."""
        self._lock.release()
        if not self._parts():
            with suppress(OSError):
                (self.folder / "lock").unlink()
                self.folder.rmdir()

    def add(self, point: Point, outcome: Outcome) -> None:
        """Keep a result; it is on disk after `write`."""
        self.rows[point] = row = Row(point, outcome)
        self._waiting.append(row)

    @property
    def waiting(self) -> int:
        """Results that are not on disk yet."""
        return len(self._waiting)

    def write(self) -> None:
        """Write what is not on disk as another part."""
        if self._waiting:
            self._write(self.folder / f"{self._next:06}.parquet", self._waiting)
            self._next += 1
            self._waiting = []

    def finish(self, points: Iterable[Point]) -> None:
        """Write all runs as one file, those of a design first and in order; remove the parts."""
        ordered = dict.fromkeys([*points, *self.rows])
        self._write(self.path, [self.rows[point] for point in ordered])
        self._waiting = []
        self._remove_parts()

    def _parts(self) -> list[Path]:
        return sorted(self.folder.glob("[0-9]*.parquet"))

    def _remove_parts(self) -> None:
        for part in self._parts():
            part.unlink(missing_ok=True)

    def _write(self, path: Path, rows: list[Row]) -> None:
        arrow, parquet = self._pyarrow
        table = arrow.table(_columns(self._study, rows), _schema(arrow, self._study))
        partial = path.with_name(f".{path.name}.partial")
        try:
            with partial.open("wb") as file:
                parquet.write_table(table, file)
                file.flush()
                os.fsync(file.fileno())
            os.replace(partial, path)
        except OSError as error:
            with suppress(OSError):
                partial.unlink()
            raise unwritable(path, error) from None

    def _read(self) -> dict[Point, Row]:
        found: dict[Point, Row] = {}
        for path in [self.path, *self._parts()]:
            if path.exists():
                found.update((row.point, row) for row in self._rows_of(path))
        return found

    def _rows_of(self, path: Path) -> list[Row]:
        arrow, parquet = self._pyarrow
        try:
            table = parquet.ParquetFile(path).read()
        except (OSError, arrow.ArrowException) as error:
            if isinstance(error, OSError) and error.errno:
                raise unreadable(path, error) from None
            raise UserError(f"{path}: not a file of results (--new writes it anew)") from None
        if (table.schema.metadata or {}).get(FINGERPRINT) != self._study.fingerprint.encode():
            raise UserError(
                f"{path}: results of another sweep: project, targets, end or measures differ"
                " (--new begins anew, -o names another file)"
            )
        return [_row(self._study, record) for record in table.to_pylist()]


def _columns(study: Study, rows: list[Row]) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = {}
    for k, name in enumerate(study.quantities):
        columns[name] = [row.point[k] for row in rows]
    for k, name in enumerate(study.measures):
        columns[name] = [row.outcome.measures[k] for row in rows]
    for name in FIXED:
        columns[name] = [getattr(row.outcome, name) for row in rows]
    return columns


def _schema(arrow: Any, study: Study) -> Any:
    numbers = [*study.quantities, *study.measures, "time_s"]
    kinds = {name: arrow.float64() for name in numbers}
    fields = [
        (name, kinds.get(name, arrow.string()))
        for name in (*study.quantities, *study.measures, *FIXED)
    ]
    return arrow.schema(fields, metadata={FINGERPRINT: study.fingerprint.encode()})


def _row(study: Study, record: dict[str, Any]) -> Row:
    outcome = Outcome(
        tuple(record[name] for name in study.measures),
        record["status"], record["error"], record["end"], record["time_s"],
    )  # fmt: skip
    return Row(tuple(record[name] for name in study.quantities), outcome)


def is_to_be_done(row: Row | None) -> bool:
    """Whether a run is to be done: it was not, or its worker died."""
    return row is None or row.outcome.status == LOST


def _pyarrow() -> tuple[Any, Any]:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise UserError("sweeps need pyarrow: pip install 'openacr[sweep]'") from None
    return pyarrow, pyarrow.parquet
