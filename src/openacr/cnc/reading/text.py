"""The text of a part program: lines by offset, in files of any size.

Only a window of the file is in memory. Lines end in CR, LF or CR LF; NUL and DEL are
dropped; Ctrl-Z ends the text. Each line is UTF-8, or else Latin-1.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Protocol

from openacr.cnc.reading.findings import BlockError, Finding

WINDOW = 1 << 20
CONTROL_Z = b"\x1a"
MARK = b"\xef\xbb\xbf"  # byte order mark
DROPPED = {0: None, 127: None}
SHORTER = "the file has become shorter since it was opened"


class Bytes(Protocol):
    """A source of bytes that can be read at any offset."""

    size: int

    def read(self, offset: int, size: int) -> bytes:
        """Read bytes from an offset on; fewer at the end."""


class Kept:
    """Bytes in memory."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self.size = len(data)

    def read(self, offset: int, size: int) -> bytes:
        """Bytes from a place on."""
        return self._data[offset : offset + size]


class OnDisk:
    """Bytes of a file, read on demand."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("rb", buffering=0)
        self.size = os.fstat(self._file.fileno()).st_size

    def read(self, offset: int, size: int) -> bytes:
        """Bytes from a place on."""
        self._file.seek(offset)
        return self._file.read(size)

    def __del__(self) -> None:
        file = getattr(self, "_file", None)
        if file is not None:
            file.close()


class Text:
    """Lines by their offset."""

    def __init__(self, name: str, source: Bytes) -> None:
        self.name = name
        self._bytes = source
        self._window = b""
        self._start = 0
        self.end = source.size  # where the text ends: Ctrl-Z, the second %
        self.begin = len(MARK) if source.read(0, len(MARK)) == MARK else 0

    @classmethod
    def of(cls, text: str | bytes, name: str = "PROGRAM") -> Text:
        """Make a text from memory."""
        data = text.encode("utf-8", "surrogateescape") if isinstance(text, str) else text
        return cls(name, Kept(data))

    @classmethod
    def file(cls, path: Path) -> Text:
        """Make a text from a file."""
        return cls(path.name, OnDisk(path))

    def window(self, offset: int) -> tuple[bytes, int]:
        """Bytes of whole lines around an offset, and the position of the offset in them."""
        place = offset - self._start
        if not 0 <= place < len(self._window):
            self._load(offset, WINDOW)
            place = 0
        return self._window, place

    def _load(self, offset: int, size: int) -> None:
        """Load a window from an offset on, cut after its last whole line."""
        while True:
            wanted = min(size, self.end - offset)
            data = self._bytes.read(offset, wanted)
            if len(data) < wanted:
                raise BlockError(Finding("E262", SHORTER, self.name, 1))
            stop = data.find(CONTROL_Z)
            if stop >= 0:
                self.end = offset + stop
                data = data[:stop]
            if offset + len(data) < self.end:
                cut = max(data.rfind(b"\n"), data.rfind(b"\r", 0, len(data) - 1)) + 1
                if not cut:
                    size *= 2
                    continue
                data = data[:cut]
            self._window, self._start = data, offset
            return

    def line(self, offset: int) -> tuple[bytes, int] | None:
        """The bytes of the line at an offset, and the offset of the next one; None at the end."""
        if offset >= self.end:
            return None
        data, place = self.window(offset)
        if not data:
            return None
        newline = data.find(b"\n", place)
        stop = newline if newline >= 0 else len(data)
        carriage = data.find(b"\r", place, stop)
        if carriage >= 0:
            stop = carriage
            after = stop + (2 if data[stop + 1 : stop + 2] == b"\n" else 1)
        else:
            after = stop + 1 if newline >= 0 else stop
        return data[place:stop], offset + after - place


def decoded(line: bytes) -> str:
    """The characters of a line."""
    try:
        text = line.decode()
    except UnicodeDecodeError:
        text = line.decode("latin-1")
    return text.translate(DROPPED) if b"\0" in line or b"\x7f" in line else text
