"""What hosts have sent to the card and the card to them, for the lanes of the history."""

from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from openacr.controller.changes import Integers
from openacr.journal.entries import JournalEntry

PACKET = "\0"  # the first byte of a binary packet
MOST = 200_000  # writes of the card that are kept of a branch, 20 bytes each; then half of them


class Traffic(NamedTuple):
    """What passed in one direction on a stream in a part of the history."""

    stream: int
    spans: list[tuple[int, int]]
    packets: int
    lines: int
    size_bytes: int


class Writes(NamedTuple):
    """Writes in the order of time: tick, stream, bytes, and lines (-1: a packet)."""

    ticks: Integers
    streams: Integers
    sizes: Integers
    lines: Integers


def arrived(entries: Sequence[JournalEntry]) -> Writes:
    """The bytes that arrived."""
    lines = [-1 if each.text.startswith(PACKET) else each.text.count("\r") for each in entries]
    ticks, streams = [each.tick for each in entries], [each.number for each in entries]
    columns: Any = [ticks, streams, [len(each.text) for each in entries], lines]
    return Writes(*(np.array(column, np.int64) for column in columns))


def traffic(writes: Writes, near: int) -> list[Traffic]:
    """When something passed on each stream, with packets, lines and bytes; near ones together."""
    found = []
    for stream in np.unique(writes.streams).tolist():
        own = writes.streams == stream
        ticks, lines = writes.ticks[own], writes.lines[own]
        apart = np.diff(ticks) > near
        starts = ticks[np.concatenate(([True], apart))]
        ends = ticks[np.concatenate((apart, [True]))] + 1
        spans = list(zip(starts.tolist(), ends.tolist(), strict=True))
        packets, size = int((lines < 0).sum()), int(writes.sizes[own].sum())
        found.append(Traffic(stream, spans, packets, int(lines[lines > 0].sum()), size))
    return found


@dataclass(slots=True)
class _Kept:
    """The writes of a branch."""

    ticks: "array[int]" = field(default_factory=lambda: array("q"))
    streams: "array[int]" = field(default_factory=lambda: array("i"))
    sizes: "array[int]" = field(default_factory=lambda: array("i"))
    lines: "array[int]" = field(default_factory=lambda: array("i"))

    @property
    def columns(self) -> tuple["array[int]", ...]:
        return self.ticks, self.streams, self.sizes, self.lines

    def part(self, first: int, last: int) -> Writes:
        ticks = np.frombuffer(self.ticks, np.int64)
        begin, end = np.searchsorted(ticks, first), np.searchsorted(ticks, last, "right")
        return Writes(*(np.array(column[begin:end], np.int64) for column in self.columns))


class Sent:
    """What the card has sent to its hosts, on each branch of its history."""

    def __init__(self) -> None:
        self._of: dict[int, _Kept] = {}

    def note(self, branch: int, tick: int, stream: int, data: bytes, is_packet: bool) -> None:
        """The card has written something."""
        kept = self._of.setdefault(branch, _Kept())
        values = tick, stream, len(data), -1 if is_packet else data.count(b"\n")
        for column, value in zip(kept.columns, values, strict=True):
            column.append(value)
        if len(kept.ticks) > MOST:
            for column in kept.columns:
                del column[: MOST // 2]

    def between(self, branch: int, first_tk: int, last_tk: int) -> Writes:
        """The writes of a part of a branch, both ends included."""
        return self._of.get(branch, _Kept()).part(first_tk, last_tk)

    def fork(self, parent: int, branch: int, tick: int) -> None:
        """Another branch has begun: it shares what was before."""
        shared = self.between(parent, 0, tick)
        types = (column.typecode for column in _Kept().columns)
        self._of[branch] = _Kept(*map(array, types, (column.tolist() for column in shared)))

    def forget(self, branch: int) -> None:
        """Forget a branch."""
        self._of.pop(branch, None)

    @property
    def size_bytes(self) -> int:
        """What is kept in memory."""
        columns = (column for kept in self._of.values() for column in kept.columns)
        return sum(column.itemsize * len(column) for column in columns)
