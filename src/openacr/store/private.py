"""Files readable only by their owner, since a card's data includes programs and a password."""

import os
from pathlib import Path
from typing import BinaryIO

OWNER_ONLY = 0o600


def create(path: Path) -> None:
    """Create a file if absent; the permissions of an existing one are kept."""
    os.close(os.open(path, os.O_RDWR | os.O_CREAT, OWNER_ONLY))


def open_to_write(path: Path) -> BinaryIO:
    """Open an empty file for unbuffered writing."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, flags, OWNER_ONLY), "wb", buffering=0)


class Replacement:
    """A new file for a path, written beside it until it takes its place.

    Until then the file at the path is as it was. It is unbuffered, as those of `open_to_write`.
    """

    def __init__(self, path: Path) -> None:
        """Open the new file; OSError where the folder cannot be written."""
        self._path = path.resolve()  # a link stays one
        self._partial = self._path.with_name(self._path.name + ".part")
        self._file = open_to_write(self._partial)
        self.is_in_place = False

    def write(self, data: bytes) -> int:
        """Write; how many bytes were taken."""
        return self._file.write(data)

    def truncate(self, size: int) -> int:
        """Leave out what comes after this size."""
        return self._file.truncate(size)

    def take_place(self) -> None:
        """Replace the file at the path, once; OSError where that is impossible."""
        if self.is_in_place:
            return
        self._file.close()  # Windows renames no open file
        try:
            os.replace(self._partial, self._path)
            self.is_in_place = True
        finally:
            self._file = (self._path if self.is_in_place else self._partial).open("ab", buffering=0)

    def close(self) -> None:
        """Close it; it is removed unless it has taken its place."""
        self._file.close()
        if not self.is_in_place:
            self._partial.unlink()
