"""Write the records of a journal file in order, some of which a thread computes.

Records after an unfinished one wait for it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import suppress
from typing import Any, Protocol, TypeVar

from openacr.journal.entries import MAGIC

T = TypeVar("T")
MOST_WORKED_OUT = 8  # records that are being computed; each holds a copy of the state (3 MB)
TOGETHER_BYTES = 1 << 16


class Output(Protocol):
    """What records are written to: a file without a buffer."""

    def write(self, data: bytes, /) -> int:
        """Write; how many bytes were taken."""

    def truncate(self, size: int, /) -> int:
        """Leave out what comes after this size."""

    def close(self) -> None:
        """Close it."""


class _Worker:
    """The thread of all journals of this process, with at most MOST_WORKED_OUT records to compute.

    Each of them holds copies of the state: a card that runs faster than the thread would take all
    memory.
    """

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="journal")
        self._open: deque[Future[Any]] = deque()

    @property
    def is_full(self) -> bool:
        while self._open and self._open[0].done():
            self._open.popleft()
        return len(self._open) >= MOST_WORKED_OUT

    def submit(self, do: Callable[[], T]) -> Future[T]:
        """Have something done after all that was submitted before; waits while `is_full`."""
        while self.is_full:
            wait([self._open[0]])
        future = self._pool.submit(do)
        self._open.append(future)
        return future


WORKER = _Worker()


class Records:
    """A journal file that is written: its records in order, some still being computed.

    When the disk is full the file ends with its last complete record: `failure` is why, and
    `on_failure` is called with it once.
    """

    def __init__(
        self, file: Output, on_failure: Callable[[OSError], None], head: bytes = b""
    ) -> None:
        """Begin the file, with the first record if it is known; OSError if that is impossible."""
        self.failure: OSError | None = None
        self.size_bytes = 0
        self._file = file
        self._on_failure = on_failure
        self._waiting: deque[bytes | Future[bytes]] = deque()
        self._waiting_bytes = 0
        self._write(MAGIC + head)

    def put(self, record: bytes) -> None:
        """Append one record."""
        self._waiting.append(record)
        self._waiting_bytes += len(record)
        if self._waiting_bytes > TOGETHER_BYTES:
            self.flush()

    def work_out(self, record: Callable[[], bytes]) -> None:
        """Append a record that a thread computes; waits while the thread has too many."""
        self._waiting.append(WORKER.submit(record))

    def flush(self, *, waits: bool = False) -> None:
        """Write the records that are ready; with `waits`, all of them."""
        ready = bytearray()
        while self._waiting and (waits or _is_ready(self._waiting[0])):
            record = self._waiting.popleft()
            ready += record if isinstance(record, bytes) else record.result()
        self._waiting_bytes = 0
        if not ready or self.failure is not None:
            return
        try:
            self._write(bytes(ready))
        except OSError as failure:
            self.failure = failure
            self._on_failure(failure)

    def _write(self, data: bytes) -> None:
        rest = data
        try:
            while rest:  # a disk that gets full takes a part
                rest = rest[self._file.write(rest) :]
        except OSError:
            whole = data.rfind(b"\n", 0, len(data) - len(rest)) + 1
            with suppress(OSError):
                self._file.truncate(self.size_bytes + whole)
            raise
        self.size_bytes += len(data)

    def end(self) -> None:
        """Close the file as soon as everything is written, without waiting for it."""
        self.flush()
        WORKER.submit(self.close)

    def close(self) -> None:
        """Write everything and close the file."""
        self.flush(waits=True)
        self._file.close()


def _is_ready(record: bytes | Future[bytes]) -> bool:
    return isinstance(record, bytes) or record.done()
