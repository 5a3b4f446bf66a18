"""One process at a time owns what a file stands for, as long as that process lives."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

from openacr.errors import StoreError, reason

ASKED_S = 0.1  # longer than another process takes to ask whether it is taken


class InUseError(StoreError):
    """Another process is the owner."""


class FileLock:
    """The ownership of what a file stands for, until `release`; InUseError if another has it.

    The file is empty and is not removed. `taken` is the error when another process is the owner.
    """

    def __init__(self, path: Path, taken: str) -> None:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            # A database locks its file on every system, and nothing stays locked by a kill.
            self._connection = sqlite3.connect(
                path, isolation_level=None, timeout=ASKED_S, check_same_thread=False
            )
        except (OSError, sqlite3.Error) as failure:
            raise StoreError(f"{path.parent} cannot be used: {reason(failure)}") from None
        try:
            self._connection.execute("BEGIN EXCLUSIVE")
        except sqlite3.Error as failure:
            self._connection.close()
            if failure.sqlite_errorcode & 0xFF == sqlite3.SQLITE_BUSY:
                raise InUseError(taken) from None
            raise StoreError(f"{path.parent} cannot be used: {failure}") from None

    def release(self) -> None:
        """Let others have it."""
        with closing(self._connection):
            self._connection.rollback()


def is_taken(path: Path) -> bool:
    """Whether a process, be it this one, holds the FileLock of this file."""
    if not path.exists():
        return False
    try:
        with closing(sqlite3.connect(path, isolation_level=None, timeout=0.0)) as connection:
            connection.execute("SELECT count(*) FROM sqlite_schema")
    except sqlite3.Error as failure:
        return failure.sqlite_errorcode & 0xFF == sqlite3.SQLITE_BUSY
    return False
