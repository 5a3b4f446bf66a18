"""The file of the store: SQLite in WAL mode, shared by any number of processes.

Table `cell`: number, value (REAL, TEXT, or NULL for the default) and `changed`, which
counts transactions: rows with a higher count than the one last seen have changed. A reader
sees all of a transaction or nothing of it, whatever happens to the writer.
"""

import sqlite3
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from openacr.errors import StoreError

FORMAT = 1
APPLICATION_ID = 0x41435256  # identifies the file as a store: "ACRV"
BUSY_S = 5.0
RETRY_S = 0.01
PAGE = 512  # bytes, the smallest size of a database

Row = tuple[int, float | str | None, int]
_Result = TypeVar("_Result")
_TABLE = "CREATE TABLE cell (number INTEGER PRIMARY KEY, value, changed INTEGER NOT NULL)"
_INDEX = "CREATE INDEX cell_changed ON cell (changed)"
_WAL_REFUSED = (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM)
_HINT = "move it away and import an export of it"


class Database:
    """The cells in a SQLite file, or in memory without a path."""

    def __init__(self, path: Path | None, *, is_used: bool = False) -> None:
        self.path = path
        self.is_read_only = False
        self._is_durable = True
        if path is not None:
            self._refuse_emptied(path, is_used)
        self._connection = self._open()

    # --- opening ----------------------------------------------------------------------

    def _refuse_emptied(self, path: Path, is_used: bool) -> None:
        """Refuse a used store whose file is now empty: it would be taken for a new one."""
        try:
            size = path.stat().st_size if path.is_file() else PAGE
        except OSError as failure:
            raise StoreError(f"{path} cannot be opened: {failure.strerror}") from None
        if 0 < size < PAGE:
            raise _damaged(path)
        if size == 0 and is_used:
            raise StoreError(f"{path} is empty although settings were stored in it ({_HINT})")

    def _open(self) -> sqlite3.Connection:
        if self.path is None:
            return self._connected(":memory:")
        with suppress(OSError):  # opening reports what is wrong
            self.path.parent.mkdir(parents=True, exist_ok=True)
        try:
            return self._connected(self.path.absolute().as_uri())
        except sqlite3.Error as failure:
            if _code(failure) in _WAL_REFUSED and self.path.is_file():
                return self._open_to_read()
            raise _explained(self.path, failure) from None

    def _open_to_read(self) -> sqlite3.Connection:
        """Open a read-only file, with the log of a writer if there is one."""
        self.is_read_only = True
        place = str(self.path.absolute().as_uri()) if self.path else ""
        try:
            return self._connected(f"{place}?mode=ro")
        except sqlite3.Error:
            try:
                return self._connected(f"{place}?immutable=1")
            except sqlite3.Error as failure:
                raise _explained(self.path, failure) from None

    def _connected(self, place: str) -> sqlite3.Connection:
        connection = sqlite3.connect(
            place, uri=True, isolation_level=None, timeout=BUSY_S, check_same_thread=False
        )
        try:
            _patiently(lambda: self._prepare(connection))
        except BaseException:
            connection.close()
            raise
        return connection

    def _prepare(self, connection: sqlite3.Connection) -> None:
        run = connection.execute
        if not self.is_read_only:
            if self.path is not None:
                run("PRAGMA journal_mode = WAL")
            run("PRAGMA synchronous = FULL")
            self._create(connection)
        marks = tuple(run(f"PRAGMA {name}").fetchone()[0] for name in _MARKS)
        if marks != (APPLICATION_ID, FORMAT):
            raise StoreError(f"{self.path} belongs to another program or a newer version")
        (state,) = run("PRAGMA quick_check(1)").fetchone()
        if state != "ok":
            raise _damaged(self.path)

    def _create(self, connection: sqlite3.Connection) -> None:
        """Create the table in a new file, unless another process has just done so."""
        run = connection.execute
        if run("PRAGMA application_id").fetchone()[0]:
            return
        run("BEGIN IMMEDIATE")
        try:
            if not run("SELECT count(*) FROM sqlite_schema").fetchone()[0]:
                run(f"PRAGMA application_id = {APPLICATION_ID}")
                run(f"PRAGMA user_version = {FORMAT}")
                run(_TABLE)
                run(_INDEX)
            run("COMMIT")
        except BaseException:
            with suppress(sqlite3.Error):
                run("ROLLBACK")
            raise

    # --- reading ----------------------------------------------------------------------

    def version(self) -> int:
        """A number that changes when another connection has committed."""
        return int(self._do("PRAGMA data_version").fetchone()[0])

    def since(self, token: int) -> list[Row]:
        """The cells changed by transactions after `token`, oldest first."""
        query = "SELECT number, value, changed FROM cell WHERE changed > ? ORDER BY changed, number"
        return self._do(query, (token,)).fetchall()

    # --- writing ----------------------------------------------------------------------

    def begin(self, *, is_durable: bool) -> None:
        """Start a transaction, after that of another process has ended."""
        if self.is_read_only:
            raise StoreError(f"{self.path} is read-only: nothing can be stored")
        if is_durable != self._is_durable:
            self._do(f"PRAGMA synchronous = {'FULL' if is_durable else 'NORMAL'}")
            self._is_durable = is_durable
        self._do("BEGIN IMMEDIATE")

    def write_rows(self, rows: Iterable[Row]) -> None:
        """Write cells inside a transaction."""
        try:
            self._connection.executemany("INSERT OR REPLACE INTO cell VALUES (?, ?, ?)", rows)
        except sqlite3.Error as failure:
            raise _explained(self.path, failure) from None

    def commit(self) -> None:
        """End a transaction and store all of it."""
        self._do("COMMIT")

    def rollback(self) -> None:
        """End a transaction and store nothing of it."""
        with suppress(sqlite3.Error):
            if self._connection.in_transaction:
                self._connection.execute("ROLLBACK")

    def flush(self) -> None:
        """Write everything committed to the disk."""
        self._do("PRAGMA wal_checkpoint(PASSIVE)")

    def close(self) -> None:
        """Close the file."""
        with suppress(sqlite3.Error):
            self._connection.close()

    def _do(self, statement: str, values: tuple[object, ...] = ()) -> sqlite3.Cursor:
        try:
            return self._connection.execute(statement, values)
        except sqlite3.Error as failure:
            raise _explained(self.path, failure) from None


_MARKS = ("application_id", "user_version")


def _patiently(work: Callable[[], _Result]) -> _Result:
    """Repeat while another process is opening the same file."""
    until = time.monotonic() + BUSY_S
    while True:
        try:
            return work()
        except sqlite3.OperationalError as failure:
            if _code(failure) not in _BUSY or time.monotonic() > until:
                raise
            time.sleep(RETRY_S)


_BUSY = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)
_WORDS = {
    sqlite3.SQLITE_BUSY: f"is in use by another program for more than {BUSY_S:g} s; try again",
    sqlite3.SQLITE_LOCKED: f"is in use by another program for more than {BUSY_S:g} s; try again",
    sqlite3.SQLITE_FULL: "cannot be written: the disk is full; nothing of this was stored",
    sqlite3.SQLITE_READONLY: "is read-only: nothing can be stored",
    sqlite3.SQLITE_CANTOPEN: "cannot be opened: does its folder exist, and may you write to it?",
}


_NO_INDEX = "cannot be read or written: the disk is full (the index of its log needs 32 KiB)"


def _code(failure: sqlite3.Error) -> int:
    return getattr(failure, "sqlite_errorcode", 0) & 0xFF


def _damaged(path: Path | None) -> StoreError:
    return StoreError(f"{path} is damaged and cannot be read ({_HINT})")


def _explained(path: Path | None, failure: sqlite3.Error) -> StoreError:
    code = _code(failure)
    if code in (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT):
        return _damaged(path)
    if getattr(failure, "sqlite_errorcode", 0) == sqlite3.SQLITE_IOERR_SHMSIZE:
        return StoreError(f"{path} {_NO_INDEX}")
    return StoreError(f"{path} {_WORDS.get(code) or f'cannot be read or written: {failure}'}")
