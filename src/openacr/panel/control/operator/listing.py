"""Lines of a part program by their number, in files of any size."""

from pathlib import Path
from threading import Lock

import numpy as np

from openacr.cnc.reading.text import Text, decoded

STEP = 64  # lines between two known offsets
CHUNK = 1 << 20
LF = 10
LONGEST = 400  # characters of a line as it is listed


class Listing:
    """A text whose lines can be read from any number on; the file is kept open as it is now."""

    def __init__(self, path: Path) -> None:
        self._text = Text.file(path)
        self._lock = Lock()  # its window is shared by all who read
        self._offsets = self._known(path)
        self.total = self._count()

    def _known(self, path: Path) -> list[int]:
        """Offsets of line 1, 1 + STEP, 1 + 2 STEP ..."""
        data = path.read_bytes() if path.stat().st_size < CHUNK else None
        if data is not None and _has_odd_ends(data):
            return self._walked()
        offsets, lines, at = [self._text.begin], 0, 0
        with path.open("rb") as file:
            while chunk := file.read(CHUNK):
                if data is None and _has_odd_ends(chunk):
                    return self._walked()
                ends = np.flatnonzero(np.frombuffer(chunk, np.uint8) == LF)
                chosen = ends[(STEP - 1 - lines) % STEP :: STEP]
                offsets += [int(at + end + 1) for end in chosen]
                lines += len(ends)
                at += len(chunk)
        return offsets

    def _walked(self) -> list[int]:
        """The same for lines that end in CR alone, line by line."""
        offsets, at, number = [], self._text.begin, 0
        while (found := self._text.line(at)) is not None:
            if number % STEP == 0:
                offsets.append(at)
            at, number = found[1], number + 1
        return offsets or [self._text.begin]

    def _count(self) -> int:
        at, count = self._offsets[-1], STEP * (len(self._offsets) - 1)
        while (found := self._text.line(at)) is not None:
            at, count = found[1], count + 1
        return count

    def lines(self, first: int, count: int) -> list[str]:
        """`count` lines from line `first` (1 and up) on; fewer at the end."""
        with self._lock:
            return self._lines(max(1, first), count)

    def _lines(self, first: int, count: int) -> list[str]:
        place = min((first - 1) // STEP, len(self._offsets) - 1)
        at, number = self._offsets[place], STEP * place + 1
        found: list[str] = []
        while len(found) < count and (line := self._text.line(at)) is not None:
            if number >= first:
                found.append(decoded(line[0])[:LONGEST])
            at, number = line[1], number + 1
        return found


def _has_odd_ends(data: bytes) -> bool:
    """Whether a line ends in CR alone, or Ctrl-Z ends the text."""
    return data.count(b"\r") != data.count(b"\r\n") or b"\x1a" in data
