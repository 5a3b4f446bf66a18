"""One process at a time owns a folder; the lock ends with the process, however that ends."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

from openacr.errors import StoreError, reason

FILE_NAME = "lock"


class FolderInUseError(StoreError):
    """Another process owns the folder."""


class FolderLock:
    """The ownership of a folder, until `release`; FolderInUseError if another process has it."""

    def __init__(self, folder: Path) -> None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            # A database locks its file on every system, and nothing stays locked by a kill.
            self._connection = sqlite3.connect(
                folder / FILE_NAME, isolation_level=None, timeout=0.0, check_same_thread=False
            )
        except (OSError, sqlite3.Error) as failure:
            raise StoreError(f"{folder} cannot be used: {reason(failure)}") from None
        try:
            self._connection.execute("BEGIN EXCLUSIVE")
        except sqlite3.Error as failure:
            self._connection.close()
            if failure.sqlite_errorcode & 0xFF == sqlite3.SQLITE_BUSY:
                raise FolderInUseError(f"{folder} is in use by another card") from None
            raise StoreError(f"{folder} cannot be used: {failure}") from None

    def release(self) -> None:
        """Let others have the folder."""
        with closing(self._connection):
            self._connection.rollback()
