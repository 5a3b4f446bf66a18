"""Declare hidden rows: state of the card that has no parameter number.

A hidden block is a family of `count` equal records. Its float64 fields lie in one run of
the map (view F), its int32 fields in another (view I); `python -m openacr.map.generate`
gives every field its places, in the module of its family in `openacr.map.rows`, and names for
their parts in `openacr.map.numbers`:

    HiddenBlock(
        prefix="TH", family="threads", count=32, doubles=("clock_s", ("stack", 16)), ints=("pc",)
    )

    F[threads.stack[n] + 3]     is  F[THF_BASE + n * THF_STRIDE + THF_STACK + 3]
    I[threads.pc[n]]            is  I[THI_BASE + n * THI_STRIDE + THI_PC]
    threads.COUNT == TH_COUNT == 32          threads.STACK_SIZE == THF_STACK_SIZE == 16
"""

from collections.abc import Collection, Iterator, Mapping
from enum import Enum, auto
from math import inf

from msgspec import Struct, field

Field = str | tuple[str, int]
Range = tuple[float, float]  # lowest and highest value of a row


class Merge(Enum):
    """How a row is merged that a handler has changed while the loop went on."""

    VALUE = auto()  # becomes what the handler has written
    BITS = auto()  # the bits that the handler has changed; the others are the loop's
    SHIFT = auto()  # moves by what the handler has added
    LOOP = auto()  # stays what it is: only the loop, or a call of the kernel, changes it
    ORDER = auto()  # a request to the engine, taken over at once


FINITE: Range = (-1e300, 1e300)
ANY_NUMBER: Range = (-inf, inf)  # infinities and NaN included
SWITCH: Range = (0, 1)
# Bounds for places of rows in the views I and F: below the end of the memory, above all rows.
ROWS_I, ROWS_F = 700_000, 350_000


class HiddenBlock(Struct, frozen=True, kw_only=True):
    """`count` records of named numbers; a field `(name, size)` is an array.

    `ranges` belong to every row that the card uses as an index, a size or a divisor without asking:
    a snapshot from a file is refused where a row is outside. `usual` is the range of all other
    doubles; other ints may have any value. Further blocks of a `family` are not `is_whole`: their
    records are parts of its objects, in a run of their own. `merged` are rows by what becomes
    of them where handlers have changed them beside the loop; the others are `merged_usually`.
    """

    prefix: str
    family: str
    count: int
    doubles: tuple[Field, ...] = ()
    ints: tuple[Field, ...] = ()
    ranges: Mapping[str, Range] = field(default_factory=dict)
    usual: Range = ANY_NUMBER
    is_whole: bool = True
    merged: Mapping[Merge, Collection[str]] = field(default_factory=dict)
    merged_usually: Merge = Merge.VALUE

    def merge(self, row: str) -> Merge:
        """How a row is merged."""
        for rule, rows in self.merged.items():
            if row in rows:
                return rule
        return self.merged_usually

    @property
    def doubles_stride(self) -> int:
        """Float64 numbers in one record."""
        return sum(size for _, _, size in places(self.doubles))

    @property
    def ints_stride(self) -> int:
        """Int32 numbers in one record."""
        return sum(size for _, _, size in places(self.ints))


def places(fields: tuple[Field, ...]) -> Iterator[tuple[str, int, int]]:
    """Name, offset in the record and size of each field."""
    offset = 0
    for each in fields:
        name, size = each if isinstance(each, tuple) else (each, 1)
        yield name, offset, size
        offset += size
