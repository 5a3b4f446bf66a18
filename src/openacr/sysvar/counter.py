"""A counter that all processes of a store see: it tells whether anybody wrote.

A file of 8 bytes beside the store, mapped into memory. Whoever commits makes it odd
before and even after (a sequence lock), so that

* an even number that has not changed means nothing was written, for the price of
  looking at memory;
* an odd number - somebody is at it, or died at it - means: ask the database itself.

The counter only saves time. Without it (no right to write there) every read asks the
database; and what did not count - other programs, a process that died at the one moment -
is seen after `LOOK_S` of the store at the latest.
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
        """Something is about to be committed."""
        self._set(self._number() | 1)

    def end(self) -> None:
        """It has been committed, or given up."""
        self._set((self._number() | 1) + 1)

    def close(self) -> None:
        """Let go of the file, which stays: others may use it."""
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
    """Whether nobody was writing when this was read."""
    return not stamp[0] & 1


def _mapped(path: Path) -> mmap.mmap:
    with path.open("a+b") as file:
        file.seek(0, 2)
        if file.tell() < SIZE:
            file.truncate(SIZE)
        return mmap.mmap(file.fileno(), SIZE)
