"""Skip plain lines at load: their count, their labels, and the last motion in them."""

from __future__ import annotations

from typing import cast

import numpy as np

from openacr.cnc.canonical import ROTARY
from openacr.cnc.program.labels import Rows
from openacr.cnc.reading import scan_cy as scan
from openacr.cnc.reading.text import Text
from openacr.compiled import pick
from openacr.views import F64, I32

MOST_ROWS = 8192
_skim_lines = pick(scan.skim_lines)


class Tables:
    """The arrays the scanner works on."""

    def __init__(self, axes: dict[str, int]) -> None:
        self.W = np.zeros(scan.W_SIZE)
        self.K = np.zeros(scan.K_SIZE, np.int32)
        self.K[:26] = -1
        for letter, axis in axes.items():
            self.K[ord(letter) - ord("A")] = axis
            if letter in ROTARY:
                self.K[scan.K_ROTARY] |= 1 << axis
        self.w = cast(F64, self.W.data)
        self.k: I32 = self.K.data
        self._window = b""
        self._bytes = memoryview(bytearray(1))

    def bytes(self, text: Text, offset: int) -> tuple[memoryview, int]:
        """Whole lines around an offset of the text, and the position of the offset in them."""
        window, place = text.window(offset)
        if window is not self._window:
            self._window = window
            self._bytes = memoryview(bytearray(window or b"\n"))
        return self._bytes, place


class Skimmer:
    """Skips the plain lines of a text at load."""

    def __init__(self, axes: dict[str, int]) -> None:
        self._tables = Tables(axes)
        self._labels = np.zeros(3 * MOST_ROWS, np.int32)
        self.motion = -1  # the last of G0 and G1 in these lines, -1 none
        self.labels: Rows = np.zeros((0, 3), np.int64)  # label, line from 0, offset from here

    def skim(self, text: Text, offset: int) -> tuple[int, int]:
        """Skip the plain lines at an offset; returns their count and the offset after them."""
        if offset >= text.end:
            return 0, offset
        data, place = self._tables.bytes(text, offset)
        stop = len(data) if len(data) < text.end - offset + place else text.end - offset + place
        count = _skim_lines(
            data, place, stop, self._tables.w, self._tables.k, self._labels.data, MOST_ROWS
        )
        K = self._tables.K
        self.motion = int(K[scan.K_MOTION])
        found = self._labels[: 3 * int(K[scan.K_LABELS])].reshape(-1, 3)
        self.labels = found.astype(np.int64) - (0, 0, place)
        return count, offset + int(K[scan.K_NEXT]) - place
