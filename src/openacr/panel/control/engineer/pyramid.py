"""Long records of samples in files: any part is shown with as many columns as a screen has.

Sixteen samples become an entry of the first level (lowest, highest, sum, sum of squares, count),
sixteen of these one of the second, and so on. A part of any length is read from the level that has
about as many entries as there are columns, so that an hour costs no more than a second.

The samples and each level have a file without a name, which ends with the process. It is written as
a ring: of a record that is longer than its bound, the oldest part is dropped.
"""

import tempfile
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import IO, TypeAlias
from weakref import finalize

import numpy as np
from numpy.typing import NDArray

from openacr.errors import UserError

FACTOR = 16  # entries of a level in one of the next
LEVELS = 4
UNITS = [FACTOR**level for level in range(LEVELS + 1)]  # samples of an entry of each level
ALIGNED: int = UNITS[LEVELS]
LOW, HIGH, SUM, SQUARES, COUNT = range(5)
NOTHING = (np.inf, -np.inf, 0.0, 0.0, 0.0)  # an entry without samples
VALUE_BYTES = 8

Values: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Columns:
    """A part of a record, column by column; without samples a column is NaN."""

    first: int  # sample of the first column
    width: int  # samples of a column
    low: Values  # shape (channels, columns)
    high: Values


@dataclass(frozen=True, slots=True)
class Summary:
    """Measures of a channel over a part of a record, in its unit; NaN without samples."""

    count: int
    min: float
    max: float
    mean: float
    rms: float


class Pyramid:
    """Samples of some channels, numbered from 0; any thread may read while one appends."""

    def __init__(self, channels: int, most_bytes: int, folder: Path | None = None) -> None:
        """Keep at most `most_bytes` in files of a folder, by default that for temporary files."""
        of_entry = len(NOTHING) / (FACTOR - 1)  # values of all levels for each sample
        most = most_bytes / (channels * VALUE_BYTES * (1.0 + of_entry))
        self.channels = channels
        self.room = max(2, int(most) // ALIGNED) * ALIGNED  # samples
        self.next = 0
        self._lock = Lock()
        self._files: list[IO[bytes]] = [
            tempfile.TemporaryFile(dir=folder) for _ in range(LEVELS + 1)
        ]
        self._end = finalize(self, _close, self._files)
        self._rests = [self._shaped(level, np.empty(0)) for level in range(LEVELS)]

    @property
    def first(self) -> int:
        """The oldest sample that is kept."""
        return max(0, -(-(self.next - self.room) // ALIGNED) * ALIGNED)

    @property
    def size_bytes(self) -> int:
        """What the files hold."""
        kept = min(self.next, self.room)
        parts = [VALUE_BYTES * self._width(k) * (kept // UNITS[k]) for k in range(LEVELS + 1)]
        return sum(parts)

    def close(self) -> None:
        """Give the files up."""
        with self._lock:
            self._end()

    # --- writing ----------------------------------------------------------------------

    def append(self, block: Values) -> None:
        """Add the samples that follow, shape (channels, samples); NaN is a missing one."""
        for begin in range(0, block.shape[1], ALIGNED):
            with self._lock:
                self._append(np.ascontiguousarray(block[:, begin : begin + ALIGNED].T))

    def _append(self, entries: Values) -> None:
        size = len(entries)
        for level in range(LEVELS + 1):
            self._write(level, self.next // UNITS[level], entries)
            if level == LEVELS:
                break
            known = np.concatenate((self._rests[level], entries))
            whole = len(known) // FACTOR * FACTOR
            self._rests[level] = known[whole:]
            entries = _joined(_entries(level, known[:whole]), FACTOR)
        self.next += size

    def _write(self, level: int, place: int, entries: Values) -> None:
        room, width = self.room // UNITS[level], VALUE_BYTES * self._width(level)
        file, at = self._files[level], place % room
        for begin, part in ((at, entries[: room - at]), (0, entries[room - at :])):
            if len(part):
                file.seek(begin * width)
                file.write(part.tobytes())

    # --- reading ----------------------------------------------------------------------

    def samples(self, first: int, last: int) -> Values:
        """Samples from `first` to before `last`, by channel; UserError if not kept."""
        with self._lock:
            self._require(first, last)
            return self._read(0, first, last).T

    def columns(self, first: int, last: int, most: int) -> Columns:
        """A part in at most `most` columns, whose widths and places depend on its length alone.

        UserError where a part of it is not kept.
        """
        with self._lock:
            self._require(first, last)
            width = max(1, -(-(last - first) // max(1, most - 1)))
            level = next(k for k in range(LEVELS, -1, -1) if UNITS[k] <= width)
            unit = UNITS[level]
            width = -(-width // unit) * unit
            begin = max(self.first, first // width * width)
            found = self._parts(begin, last, level)
        each = width // unit
        lacking = -len(found) % each
        filled = np.concatenate((found, np.broadcast_to(NOTHING, (lacking, *found.shape[1:]))))
        joined = _joined(filled, each)
        low, high = joined[..., LOW].T.copy(), joined[..., HIGH].T.copy()
        is_empty = low > high
        low[is_empty] = high[is_empty] = np.nan
        return Columns(begin, width, low, high)

    def summaries(self, first: int, last: int) -> list[Summary]:
        """Measures of every channel over a part; UserError where a part of it is not kept."""
        with self._lock:
            self._require(first, last)
            joined = _joined(self._parts(first, last, LEVELS), 0)[0]
        return [_summary(each) for each in joined.tolist()]

    def _require(self, first: int, last: int) -> None:
        if not self._end.alive:
            raise UserError("this record was dropped: another one was begun")
        if not self.first <= first < last <= self.next:
            raise UserError(
                f"samples {first} to {last}: of this record {self.first} to {self.next} are kept"
            )

    def _parts(self, first: int, last: int, most: int) -> Values:
        """Entries of a level that have the samples of a part, what is left at its end as one more.

        Before them are those of lower levels, where the part begins within an entry.
        """
        heads: list[Values] = []
        tails: list[Values] = []
        for level in range(most + 1):
            up, down = -(-first // FACTOR), last // FACTOR
            if level == most or up > down:
                heads.append(_entries(level, self._read(level, first, last)))
                break
            heads.append(_entries(level, self._read(level, first, up * FACTOR)))
            tails.append(_entries(level, self._read(level, down * FACTOR, last)))
            first, last = up, down
        rest = np.concatenate(tails[::-1]) if tails else heads[0][:0]
        return np.concatenate((*heads, _joined(rest, 0))) if len(rest) else np.concatenate(heads)

    def _read(self, level: int, first: int, last: int) -> Values:
        room, width = self.room // UNITS[level], VALUE_BYTES * self._width(level)
        file, at, size = self._files[level], first % room, last - first
        parts = []
        for begin, count in ((at, min(size, room - at)), (0, size - (room - at))):
            if count > 0:
                file.seek(begin * width)
                parts.append(file.read(count * width))
        return self._shaped(level, np.frombuffer(b"".join(parts)))

    def _width(self, level: int) -> int:
        """Values of an entry of a level, all channels together."""
        return self.channels * (len(NOTHING) if level else 1)

    def _shaped(self, level: int, values: Values) -> Values:
        return values.reshape(-1, self.channels, *((len(NOTHING),) if level else ()))


def _close(files: list[IO[bytes]]) -> None:
    for file in files:
        file.close()


def _entries(level: int, found: Values) -> Values:
    """What a level holds as entries: of each sample one."""
    if level:
        return found
    is_there = ~np.isnan(found)
    zeroed = np.where(is_there, found, 0.0)
    low = np.where(is_there, found, np.inf)
    high = np.where(is_there, found, -np.inf)
    return np.stack((low, high, zeroed, zeroed * zeroed, is_there), axis=-1)


def _joined(entries: Values, each: int) -> Values:
    """Every `each` entries as one; 0: all of them."""
    parts = entries.reshape(-1, each or max(1, len(entries)), *entries.shape[1:])
    low, high = parts[..., LOW].min(axis=1), parts[..., HIGH].max(axis=1)
    sums = parts[..., SUM:].sum(axis=1)
    return np.concatenate((low[..., None], high[..., None], sums), axis=-1)


def _summary(entry: list[float]) -> Summary:
    count = entry[COUNT]
    if not count:
        return Summary(0, np.nan, np.nan, np.nan, np.nan)
    mean, rms = entry[SUM] / count, (entry[SQUARES] / count) ** 0.5
    return Summary(int(count), entry[LOW], entry[HIGH], mean, rms)
