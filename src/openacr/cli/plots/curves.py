"""What a picture shows: the curves of the axes that moved and of the outputs that changed."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from openacr.cli.results import Event, Watched

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

# More buckets than a picture has pixels across, so that decimation cannot be seen.
BUCKETS = 2000


@dataclass(frozen=True, slots=True)
class AxisCurves:
    """One axis over time, in units of that axis."""

    number: int
    commanded_u: Array
    actual_u: Array
    velocity_ups: Array
    following_error_u: Array
    name: str = ""
    unit: str = "units"
    master: int | None = None

    @property
    def title(self) -> str:
        """The axis as its user calls it."""
        return f"{self.name} (axis {self.number})" if self.name else f"axis {self.number}"

    @property
    def has_moved(self) -> bool:
        """Whether there is anything to see."""
        return bool(np.ptp(self.commanded_u) > 0.0 or np.ptp(self.actual_u) > 0.0)


@dataclass(frozen=True, slots=True)
class BitCurve:
    """One flag over time."""

    number: int
    is_on: npt.NDArray[np.bool_]
    name: str = ""

    @property
    def title(self) -> str:
        """The flag as the manual numbers it."""
        return f"{self.name} (BIT{self.number})" if self.name else f"BIT{self.number}"


@dataclass(frozen=True, slots=True)
class ValueCurve:
    """A parameter or flag over time that was chosen to be recorded."""

    watched: Watched
    values: Array

    @property
    def as_bit(self) -> BitCurve:
        """A flag as the strip of a picture."""
        return BitCurve(self.watched.number, self.values > 0.5, self.watched.title)


@dataclass(frozen=True, slots=True)
class Curves:
    """Everything recorded of a run that a picture can show."""

    time_s: Array
    axes: tuple[AxisCurves, ...]
    bits: tuple[BitCurve, ...] = ()
    title: str = ""
    watched: tuple[ValueCurve, ...] = ()
    events: tuple[Event, ...] = ()
    moved: tuple[AxisCurves, ...] = field(init=False)

    def __post_init__(self) -> None:
        moved = tuple(axis for axis in self.axes if self.time_s.size and axis.has_moved)
        object.__setattr__(self, "moved", moved)

    @property
    def used(self) -> tuple[AxisCurves, ...]:
        """The axes that have a master or have moved."""
        moved = {axis.number for axis in self.moved}
        return tuple(a for a in self.axes if a.master is not None or a.number in moved)

    @property
    def strips(self) -> tuple[BitCurve, ...]:
        """The outputs that were both on and off, then every flag that was chosen."""
        chosen = tuple(one.as_bit for one in self.watched if one.watched.is_flag)
        numbers = {bit.number for bit in chosen}
        changed = (bit for bit in self.bits if bit.is_on.any() and not bit.is_on.all())
        return (*(bit for bit in changed if bit.number not in numbers), *chosen)

    @property
    def numbers(self) -> tuple[ValueCurve, ...]:
        """The parameters that were chosen."""
        return tuple(one for one in self.watched if not one.watched.is_flag)

    @property
    def plane(self) -> tuple[AxisCurves, AxisCurves] | None:
        """The first two moving axes of one master: the plane of the path."""
        for first in self.moved:
            for second in self.moved:
                same = first.master is not None and first.master == second.master
                if same and first.number < second.number:
                    return first, second
        return None


def envelope(*values: Array, buckets: int = BUCKETS) -> Index:
    """Choose the samples that draw the same picture as all of them.

    The samples are cut into equal buckets; each keeps its first and last sample and, of
    every curve, its lowest and highest. A peak of one sample therefore stays, in its place.
    """
    size = values[0].size
    length = -(-size // buckets)
    if length <= 2 * len(values) + 2:
        return np.arange(size)
    whole = size - size % length
    starts = np.arange(0, whole, length)
    kept = [starts, starts + length - 1, np.arange(whole, size)]
    for curve in values:
        rows = curve[:whole].reshape(-1, length)
        kept += [starts + rows.argmin(axis=1), starts + rows.argmax(axis=1)]
    return np.unique(np.concatenate(kept))


@dataclass(frozen=True, slots=True)
class Mark:
    """Events so near to each other that one mark stands for all of them."""

    time_s: float  # of the first
    first: int  # number of the first and last, from 1
    last: int

    @property
    def label(self) -> str:
        """The numbers as they are written at the mark."""
        return f"{self.first}" if self.first == self.last else f"{self.first}\u2013{self.last}"


def marks(events: Sequence[Event], apart_s: float) -> list[Mark]:
    """Where to mark events, which are in the order of time; nearer than `apart_s` is one mark."""
    found: list[Mark] = []
    for number, event in enumerate(events, 1):
        if found and event.time_s - found[-1].time_s < apart_s:
            found[-1] = Mark(found[-1].time_s, found[-1].first, number)
        else:
            found.append(Mark(event.time_s, number, number))
    return found


def edges(bit: BitCurve, time_s: Array) -> list[tuple[float, float]]:
    """List the times between which a flag was on."""
    padded = np.concatenate([[False], bit.is_on, [False]]).astype(np.int8)
    change = np.diff(padded)
    starts, ends = np.flatnonzero(change == 1), np.flatnonzero(change == -1)
    last = time_s.size - 1
    return [
        (float(time_s[start]), float(time_s[min(end, last)]))
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
    ]
