"""A counter shared by all processes of a store: unchanged while nothing is written.

A file of 8 bytes next to the store, mapped into memory. A process that commits makes it odd
before and even afterwards (a sequence lock), so that

* an even number that has not changed means that nothing was written, at the cost of
  one memory read;
* an odd number - a commit is in progress, or its process died - means that the database
  itself has to be asked.

The counter only saves time. Without it (no permission to write there) every read asks the
database. Changes that were not counted - by other programs, or by a process that died
between commit and count - are seen after `POLL_S` of the store at the latest.
"""

import mmap
import struct
from pathlib import Path

SIZE = 8
SUFFIX = "-seq"
_FORM = struct.Struct("<Q")
_WRAP = 1 << 64


ASK = b"\1" + bytes(SIZE - 1)  # odd: ask the database


class Counter:
    """The shared counter of a store file; without a path one that never changes."""

    def __init__(self, path: Path | None) -> None:
        self._map: mmap.mmap | None = None
        self.memory: mmap.mmap | bytes = bytes(SIZE)  # the first bytes to compare with
        if path is None:
            return
        try:
            self.memory = self._map = _mapped(path.with_name(path.name + SUFFIX))
        except (OSError, ValueError):
            self.memory = ASK

    @property
    def has_counted(self) -> bool:
        """Whether anything was ever committed."""
        return self._map is not None and self._number() > 0

    def begin(self) -> None:
        """Mark the start of a commit."""
        self._set(self._number() | 1)

    def end(self) -> None:
        """Mark the end of a commit, done or abandoned."""
        self._set((self._number() | 1) + 1)

    def close(self) -> None:
        """Close the file; it is not deleted, because other processes may use it."""
        self.memory = ASK
        if self._map is not None:
            self._map.close()
            self._map = None

    def _number(self) -> int:
        return int(_FORM.unpack(self.memory[:SIZE])[0])

    def _set(self, number: int) -> None:
        if self._map is not None:
            self._map[:SIZE] = _FORM.pack(number % _WRAP)


def is_settled(stamp: bytes) -> bool:
    """Whether no commit was in progress when these bytes were read."""
    return not stamp[0] & 1


def _mapped(path: Path) -> mmap.mmap:
    with path.open("a+b", buffering=0) as file:
        if (size := file.seek(0, 2)) < SIZE:
            # Written, not extended: a hole that a full disk cannot fill kills who writes into it.
            file.write(bytes(SIZE - size))
        return mmap.mmap(file.fileno(), SIZE)
