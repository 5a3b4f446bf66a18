"""Runs of plain lines, read from the text many at a time.

Where nothing but the position depends on a line - straight feed moves without scaling,
rotation, compensation, macros, single block - the compiled scanner reads the bytes and
the moves come out as one `Polyline`. The result is that of the lines one by one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from openacr.cnc.canonical import AXES, Polyline, Source
from openacr.cnc.codes.gcodes.motion import MOTIONS
from openacr.cnc.loading.skimming import MOST_ROWS, Tables
from openacr.cnc.program.labels import Place
from openacr.cnc.program.program import Part
from openacr.cnc.reading import scan_cy as scan
from openacr.cnc.reading.text import decoded
from openacr.cnc.state.modal import PER_MINUTE
from openacr.compiled import pick
from openacr.views import F64

if TYPE_CHECKING:
    from openacr.cnc.interpreter.interpreter import Interpreter

LEAST_ROWS = 16  # fewer lines are read one by one
_scan_lines = pick(scan.scan_lines)


class Scanner:
    """Reads runs of plain lines for an interpreter."""

    def __init__(self, run: Interpreter) -> None:
        self._run = run
        self._tables = Tables(run.planner.axes)
        self._ends = np.zeros(MOST_ROWS * AXES)
        self._lines = np.zeros(MOST_ROWS, np.int32)

    @property
    def is_free(self) -> bool:
        """Whether a line changes nothing but the position."""
        run = self._run
        modal, path = run.modal, run.path
        return (
            modal.motion == 1
            and run.macro is None
            and path.elements is None
            and path.shape is None
            and modal.feed_mode == PER_MINUTE
            and modal.cycle == 80
            and path.coordinates.is_plain
            and run.motions is MOTIONS
            and not run.is_replaying
        )

    def read_moves(self, start: Place) -> tuple[Polyline | None, Place]:
        """The moves of the lines from a position on, and the position after them.

        Nothing is taken where there are only a few.
        """
        run, part, offset, line = self._run, start.part, start.offset, start.line
        modal, path, text = run.modal, run.path, part.text
        if offset >= text.end:
            return None, start
        data, place = self._tables.bytes(text, offset)
        stop = min(len(data), text.end - offset + place)
        W, K = self._tables.W, self._tables.K
        W[scan.W_POSITION : scan.W_POSITION + AXES] = path.program
        W[scan.W_TIMES], W[scan.W_PER], W[scan.W_PRESENT] = path.times, path.per, modal.feed
        K[scan.K_IS_INCREMENTAL] = modal.distance == 91
        rows = _scan_lines(
            data, place, stop, self._tables.w, self._tables.k,
            cast(F64, self._ends.data), self._lines.data, MOST_ROWS,
        )  # fmt: skip
        if rows < LEAST_ROWS:
            return None, start
        behind = Place(part, offset + int(K[scan.K_NEXT]) - place, line + int(K[scan.K_LINES]))
        if K[scan.K_NEW_FEED]:
            modal.feed, modal.has_feed = float(W[scan.W_PRESENT]), True
            path.change_pace()
        return self._polyline(rows, part, line, offset), behind

    def _polyline(self, rows: int, part: Part, line: int, offset: int) -> Polyline | None:
        """The rows as machine positions; lines that do not move leave none."""
        if not rows:
            return None
        path = self._run.path
        program = tuple(self._tables.W[scan.W_POSITION : scan.W_POSITION + AXES].tolist())
        ends = self._ends[: rows * AXES].reshape(rows, AXES) + path.coordinates.shift
        lines = self._lines[:rows].astype(np.int64) + line
        before = np.empty_like(ends)
        before[0], before[1:] = path.target, ends[:-1]
        moves = (ends != before).any(axis=1)
        if not moves.all():
            ends, lines = ends[moves], lines[moves]
        path.jump(program)
        if not len(ends):
            return None
        source = Source(part.text.name, int(lines[0]), self._text(part, offset, lines[0] - line))
        return Polyline(source, ends, lines, path.plain_pace())

    def _text(self, part: Part, offset: int, skipped: int) -> str:
        for _ in range(int(skipped) + 1):
            found = part.text.line(offset)
            if found is None:
                return ""
            raw, offset = found
        return decoded(raw)
