"""The text of a part program that is still arriving.

A line can be read when the next line has begun to arrive, so that calls know where to
return; the block that ends the program is read at once. `NotYetError` is raised while
nothing can be read: the interpreter continues from there when more has arrived.
"""

from __future__ import annotations

import re

from openacr.cnc.program.labels import Labels, Part, Place
from openacr.cnc.reading.text import CONTROL_Z, Kept, Text, decoded

_LABEL = re.compile(r"\s*/?\d?\s*N\s*(\d{1,6})", re.IGNORECASE)
_ENDS = re.compile(r"(?<![A-Z0-9.])M0*2(?![0-9.])|^\s*%", re.IGNORECASE)
_LINE_END = re.compile(rb"\r\n|\n|\r(?=.)", re.DOTALL)


class NotYetError(Exception):
    """The next line has not arrived yet."""


class ArrivingText(Text):
    """Lines by their offset, as far as they have arrived."""

    def __init__(self, name: str, labels: Labels) -> None:
        super().__init__(name, Kept(b""))
        self._data = bytearray()
        self._labels = labels
        self._part: Part | None = None
        self._known = 0  # offset after the last whole line
        self._line_cnt = 0
        self._percents = 0
        self._held: tuple[int, Place] | None = None  # label of a line that may not be read yet
        self.read_to = 0  # offset up to which the text was read
        self.is_complete = False

    def of_part(self, part: Part) -> None:
        """Set the part whose lines the labels name."""
        self._part = part

    @property
    def unread(self) -> int:
        """The count of bytes that have arrived and were not read."""
        return len(self._data) - self.read_to

    def add(self, data: bytes) -> None:
        """Append data that has arrived, up to Ctrl-Z or the second %."""
        if self.is_complete:
            return
        text, mark, _ = data.partition(CONTROL_Z)
        self._data += text
        while not self.is_complete and (found := _LINE_END.search(self._data, self._known)):
            self._release_line(found.start(), found.end())
        if mark:
            self.complete()

    def complete(self) -> None:
        """Mark the text as complete."""
        if not self.is_complete:
            self.is_complete = True
            self.end = len(self._data)
            self._free_label()

    def _release_line(self, stop: int, after: int) -> None:
        """Release the line before a complete one, or this one if it ends the program."""
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
        """Add the label of the released line, which may now be a target of jumps."""
        if self._held is not None:
            self._labels.add(*self._held)
            self._held = None

    def window(self, offset: int) -> tuple[bytes, int]:
        """All whole lines from an offset on."""
        self.read_to = max(self.read_to, self.end)
        return bytes(self._data[offset : self.end]), 0

    def line(self, offset: int) -> tuple[bytes, int] | None:
        """The line at an offset; None after the last line of a complete text."""
        if offset >= self.end:
            if self.is_complete:
                return None
            raise NotYetError
        found = _LINE_END.search(self._data, offset, self.end)
        stop, after = (found.start(), found.end()) if found else (self.end, self.end)
        self.read_to = max(self.read_to, after)
        return bytes(self._data[offset:stop]).rstrip(b"\r"), after
