"""The text of a part program that is still arriving.

A line can be read when the one behind it has begun to be known, so that calls know where
they come back to; the block that ends the program is read at once. Where nothing can be
read yet, `NotYetError` is raised: the interpreter goes on from there when more has come.
"""

from __future__ import annotations

import re

from openacr.cnc.program.labels import Labels, Place
from openacr.cnc.program.program import Part
from openacr.cnc.reading.text import CONTROL_Z, Kept, Text, decoded

_LABEL = re.compile(r"\s*/?\d?\s*N\s*(\d{1,6})", re.IGNORECASE)
_ENDS = re.compile(r"(?<![A-Z0-9.])M0*2(?![0-9.])|^\s*%", re.IGNORECASE)
_LINE_END = re.compile(rb"\r\n|\n|\r(?=.)", re.DOTALL)


class NotYetError(Exception):
    """The line that comes next has not arrived."""


class ArrivingText(Text):
    """Lines by their offset, as far as they have arrived."""

    def __init__(self, name: str, labels: Labels) -> None:
        super().__init__(name, Kept(b""))
        self._data = bytearray()
        self._labels = labels
        self._part: Part | None = None
        self._known = 0  # behind the last whole line
        self._line_cnt = 0
        self._percents = 0
        self._held: tuple[int, Place] | None = None  # label of a line that may not be read yet
        self.read_to = 0  # as far as anybody has looked
        self.is_complete = False

    def of_part(self, part: Part) -> None:
        """Labels lead into this part."""
        self._part = part

    @property
    def unread(self) -> int:
        """Bytes that have arrived and that nobody has looked at."""
        return len(self._data) - self.read_to

    def add(self, data: bytes) -> None:
        """More has come; Ctrl-Z or the second % is the end of it."""
        if self.is_complete:
            return
        text, mark, _ = data.partition(CONTROL_Z)
        self._data += text
        while not self.is_complete and (found := _LINE_END.search(self._data, self._known)):
            self._take(found.start(), found.end())
        if mark:
            self.complete()

    def complete(self) -> None:
        """Nothing more will come."""
        if not self.is_complete:
            self.is_complete = True
            self.end = len(self._data)
            self._free_label()

    def _take(self, stop: int, after: int) -> None:
        """A line is whole: the one before it may be read, or this one if it ends all."""
        line = decoded(bytes(self._data[self._known : stop]))
        self._line_cnt += 1
        self._free_label()
        label = _LABEL.match(line)
        if label and self._part is not None:
            self._held = int(label[1]), Place(self._part, self._known, self._line_cnt)
        is_percent = line.lstrip().startswith("%")
        self._percents += is_percent
        self.end = after if _ENDS.search(line) and not is_percent else self._known
        if self._percents == 2:
            del self._data[self._known :]
            self.complete()
        self._known = after

    def _free_label(self) -> None:
        """What can be read, can be jumped to."""
        if self._held is not None:
            self._labels.add(*self._held)
            self._held = None

    def window(self, offset: int) -> tuple[bytes, int]:
        """All whole lines from a place on."""
        self.read_to = max(self.read_to, self.end)
        return bytes(self._data[offset : self.end]), 0

    def line(self, offset: int) -> tuple[bytes, int] | None:
        """The line at a place; None behind the last one of a complete text."""
        if offset >= self.end:
            if self.is_complete:
                return None
            raise NotYetError
        found = _LINE_END.search(self._data, offset, self.end)
        stop, after = (found.start(), found.end()) if found else (self.end, self.end)
        self.read_to = max(self.read_to, after)
        return bytes(self._data[offset:stop]).rstrip(b"\r"), after
