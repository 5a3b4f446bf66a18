"""Images in one SQLite file of a data folder.

The file is in WAL mode and every save is one transaction: after a power cut, or the end of
the process at any moment, a reader finds all of a save or nothing of it. One process owns
the file while it is open; the lock ends with the process.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from openacr.errors import StoreError, reason
from openacr.store import private
from openacr.store.images import Image

FILE_NAME = "card.db"
FORMAT = 1
APPLICATION_ID = 0x41435231  # identifies our files: "ACR1"
DAMAGED_SUFFIX = ".damaged"

_TABLE = """
    CREATE TABLE IF NOT EXISTS image (
        name TEXT PRIMARY KEY, version INTEGER NOT NULL, digest BLOB NOT NULL, data BLOB NOT NULL
    ) WITHOUT ROWID
"""
_SEEK = "SELECT version, digest, data FROM image WHERE name = ?"
_SCAN = "SELECT version, digest, data FROM image WHERE +name = ?"  # past rows that are damaged
_Result = TypeVar("_Result")


class Database:
    """The images of one card in a data folder, which is created if absent."""

    is_durable = True

    def __init__(self, folder: Path) -> None:
        self.path = folder / FILE_NAME
        self._flushes = True
        try:
            folder.mkdir(parents=True, exist_ok=True)
            private.create(self.path)
            self._connection = sqlite3.connect(self.path, isolation_level=None, timeout=0.0)
        except (OSError, sqlite3.Error) as failure:
            raise StoreError(
                f"the data folder {folder} cannot be used: {reason(failure)}"
            ) from None
        try:
            self._do(self._prepare)
        except StoreError:
            self._connection.close()
            raise

    @classmethod
    def open(cls, folder: Path) -> tuple[Database, str | None]:
        """Open the images of a folder; the intact ones of a damaged file go to a new file.

        The second value reports the damage and the name of the old file. A damaged file is not
        written again: a page that cannot be read would make every later save fail.
        """
        try:
            images = cls(folder)
        except _UnreadableError as damage:
            aside = _put_aside(folder / FILE_NAME)
            return cls(folder), f"{damage}; it was kept as {aside.name}, nothing is stored now"
        whole, lost = images._examined()
        if not lost:
            return images, None
        images.close()
        aside = _put_aside(images.path)
        images = cls(folder)
        images.write(whole)
        what = f"what was lost: {', '.join(lost)}"
        return images, f"{images.path} is damaged; it was kept as {aside.name}; {what}"

    def _prepare(self) -> None:
        run = self._connection.execute
        run("PRAGMA locking_mode = EXCLUSIVE")
        run("PRAGMA journal_mode = WAL")
        run("PRAGMA synchronous = FULL")
        run("BEGIN IMMEDIATE")
        owner, written = (run(f"PRAGMA {name}").fetchone()[0] for name in _MARKS)
        if (owner, written) != (APPLICATION_ID, FORMAT):
            if (owner, written) != (0, 0):
                raise StoreError(f"{self.path} belongs to another program or a newer version")
            run(f"PRAGMA application_id = {APPLICATION_ID}")
            run(f"PRAGMA user_version = {FORMAT}")
            run(_TABLE)
        run("COMMIT")

    def _examined(self) -> tuple[dict[str, Image], list[str]]:
        """All intact images, the names of the others, and any other damage of the file."""
        run, names, lost = self._connection.execute, list[str](), list[str]()
        whole: dict[str, Image] = {}
        try:
            for row in run("SELECT name FROM image"):
                names.append(str(row[0]))
        except sqlite3.Error:
            lost.append("images whose names cannot be read")
        for name in names:
            try:
                image = self._found(_SCAN, name)
            except StoreError:
                lost.append(name)
            else:
                if image is not None:
                    whole[name] = image
        try:
            is_sound = run("PRAGMA quick_check").fetchone() == ("ok",)
        except sqlite3.Error:
            is_sound = False
        if not is_sound and not lost:
            lost.append("nothing, but pages of the file")
        return whole, lost

    def names(self) -> list[str]:
        """The names of all images, including damaged ones."""
        rows = self._do(lambda: self._connection.execute("SELECT name FROM image").fetchall())
        return sorted(row[0] for row in rows)

    def read(self, name: str) -> Image | None:
        """Read one image, None if absent; StoreError if it is damaged."""
        return self._found(_SEEK, name)

    def _found(self, query: str, name: str) -> Image | None:
        row = self._do(lambda: self._connection.execute(query, (name,)).fetchone())
        if row is None:
            return None
        version, digest, data = row
        if isinstance(version, int) and isinstance(data, bytes):
            image = Image(version, data)
            if image.digest == digest:
                return image
        raise StoreError(f"the stored {name} in {self.path} is damaged")

    def write(self, changes: Mapping[str, Image | None], *, flush: bool = True) -> None:
        """Store images and delete those given as None: either all of them or none."""
        if flush != self._flushes:
            self._connection.execute(f"PRAGMA synchronous = {'FULL' if flush else 'NORMAL'}")
            self._flushes = flush
        self._do(lambda: self._write(changes))

    def _write(self, changes: Mapping[str, Image | None]) -> None:
        run = self._connection.execute
        run("BEGIN IMMEDIATE")
        for name, image in changes.items():
            if image is None:
                run("DELETE FROM image WHERE name = ?", (name,))
            else:
                row = (name, image.version, image.digest, image.data)
                run("INSERT OR REPLACE INTO image VALUES (?, ?, ?, ?)", row)
        run("COMMIT")

    def close(self) -> None:
        """Merge the log into the file and unlock it."""
        with suppress(sqlite3.Error):
            self._connection.close()

    def _do(self, work: Callable[[], _Result]) -> _Result:
        """Perform an operation on the file; a failure is rolled back and raised as StoreError."""
        try:
            return work()
        except sqlite3.Error as failure:
            self._undo()
            raise _explained(self.path, failure) from None
        except BaseException:
            self._undo()
            raise

    def _undo(self) -> None:
        if self._connection.in_transaction:
            with suppress(sqlite3.Error):
                self._connection.execute("ROLLBACK")


_MARKS = ("application_id", "user_version")


class _UnreadableError(StoreError):
    """The file as a whole is not a readable database."""


def _explained(path: Path, failure: sqlite3.Error) -> StoreError:
    code = getattr(failure, "sqlite_errorcode", 0) & 0xFF
    if code in (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT):
        return _UnreadableError(f"{path} is damaged and cannot be read")
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return StoreError(f"{path} is in use by another card; give each card its own data folder")
    return StoreError(f"{path} cannot be read or written: {failure}")


def _put_aside(path: Path) -> Path:
    """Rename a file and its companions, keeping all earlier ones."""
    number = 1
    while (aside := path.with_name(f"{path.name}{DAMAGED_SUFFIX}{number}")).exists():
        number += 1
    path.rename(aside)
    for suffix in ("-wal", "-shm"):
        with suppress(FileNotFoundError):
            path.with_name(path.name + suffix).rename(aside.with_name(aside.name + suffix))
    return aside
