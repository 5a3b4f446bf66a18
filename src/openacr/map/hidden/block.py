"""Declare hidden rows: state of the card that has no parameter number.

A hidden block is a family of `count` equal records. Its float64 fields lie in one run of
the map (view F), its int32 fields in another (view I); `python -m openacr.map.generate`
gives every field its place and a name in `openacr.map.numbers`:

    HiddenBlock(prefix="TH", count=32, doubles=("clock_s", ("stack", 16)), ints=("pc",))

    F[THF_BASE + n * THF_STRIDE + THF_CLOCK_S]       THF_STACK_SIZE == 16
    I[THI_BASE + n * THI_STRIDE + THI_PC]            TH_COUNT == 32
"""

from collections.abc import Iterator
from dataclasses import dataclass

Field = str | tuple[str, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class HiddenBlock:
    """`count` records of named numbers; a field `(name, size)` is an array."""

    prefix: str
    count: int
    doubles: tuple[Field, ...] = ()
    ints: tuple[Field, ...] = ()

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
    for field in fields:
        name, size = field if isinstance(field, tuple) else (field, 1)
        yield name, offset, size
        offset += size
