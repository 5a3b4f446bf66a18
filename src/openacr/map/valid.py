"""Rows that come from a file: each must be what its declaration allows.

The compiled core uses many rows as indices and sizes without asking, because only this program
writes them. A file says what its writer wanted it to say.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from openacr.errors import StoreError
from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.hidden.block import ANY_NUMBER, Field, HiddenBlock, Range, places
from openacr.map.layout import PUBLIC_COUNT, hidden_bases
from openacr.map.memory import KINDS_PER_WORD, Memory


def check_rows(memory: Memory) -> None:
    """StoreError that names the first row outside its range."""
    kinds = PUBLIC_COUNT // KINDS_PER_WORD
    if memory.I[:kinds] != Memory().I[:kinds]:
        raise StoreError("the snapshot is damaged: its kinds of parameters are others")
    doubles, ints = np.asarray(memory.F), np.asarray(memory.I)
    for block, real, whole in hidden_bases(HIDDEN_BLOCKS):
        count = block.count
        reals = doubles[real : real + count * block.doubles_stride].reshape(count, -1)
        wholes = ints[whole : whole + count * block.ints_stride].reshape(count, -1)
        _check(block, block.doubles, reals, block.usual)
        _check(block, block.ints, wholes, ANY_NUMBER)


def _check(
    block: HiddenBlock, fields: tuple[Field, ...], table: NDArray[Any], usual: Range
) -> None:
    for name, offset, size, (low, high) in _limits(block, fields, usual):
        found = table[:, offset : offset + size]
        fits = (found >= low) & (found <= high)
        if not fits.all():
            record, place = np.argwhere(~fits)[0].tolist()
            raise StoreError(
                f"the snapshot is damaged: {block.prefix} {name} of {record} is"
                f" {found[record, place]}, allowed is {low:g} to {high:g}"
            )


def _limits(
    block: HiddenBlock, fields: tuple[Field, ...], usual: Range
) -> Iterator[tuple[str, int, int, Range]]:
    for name, offset, size in places(fields):
        limit = block.ranges.get(name, usual)
        if limit != ANY_NUMBER:
            yield name, offset, size, limit
