"""Names of everything that has a place in the map, and their numbers.

`map/numbers.py` holds those that something reads.
"""

from collections.abc import Iterable, Iterator
from functools import cache

from openacr.map.block import FLAG_LAST, FLAG_WORD_BASE, Block
from openacr.map.flag_block import FlagBlock
from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.layout import (
    HIDDEN_BASE,
    KIND_CODES,
    PUBLIC_COUNT,
    USER_BASE,
    USER_COUNT,
    Constant,
    hidden_constants,
    slug,
)
from openacr.map.tables import BLOCKS, FLAG_BLOCKS


@cache
def every_name() -> dict[str, int]:
    """The number of every name, whether or not anything reads it."""
    return dict(constant for _, constants in chapters() for constant in constants)


def chapters() -> Iterator[tuple[str, list[Constant]]]:
    """Title of every block of the map and what is named for the first time there."""
    known: dict[str, int] = {}
    chapters: list[tuple[str, Iterable[Constant]]] = [("Layout", _layout_constants())]
    chapters += [(block.title, _block_constants(block)) for block in BLOCKS]
    chapters += [(block.title, _flag_constants(block)) for block in FLAG_BLOCKS]
    chapters.append(("Hidden rows", hidden_constants(HIDDEN_BLOCKS)))
    for title, constants in chapters:
        new = _unknown(constants, known)
        if new:
            yield title, new


def _unknown(constants: Iterable[Constant], known: dict[str, int]) -> list[Constant]:
    """Constants not met before; streams share names, which then must agree."""
    new = []
    for name, value in constants:
        if name not in known:
            known[name] = value
            new.append((name, value))
        elif known[name] != value:
            raise ValueError(f"{name} has two values, {known[name]} and {value}")
    return new


def _layout_constants() -> Iterator[Constant]:
    yield "PUBLIC_COUNT", PUBLIC_COUNT
    yield "USER_BASE", USER_BASE
    yield "USER_COUNT", USER_COUNT
    yield "HIDDEN_BASE", HIDDEN_BASE
    yield "FLAG_WORD_BASE", FLAG_WORD_BASE
    yield "FLAG_LAST", FLAG_LAST
    yield "KIND_BASE", 0
    for kind, code in KIND_CODES.items():
        yield f"KIND_{kind or 'NONE'}", code


def _block_constants(block: Block) -> Iterator[Constant]:
    """Base, stride, count and row offsets; for single objects the parameter numbers."""
    first = block.spans[0].first
    if block.prefix:
        yield f"{block.prefix}_BASE", first
        yield f"{block.prefix}_STRIDE", block.stride
        yield f"{block.prefix}_COUNT", block.count
        for span in block.spans[1:]:
            yield f"{block.prefix}_HIGH_BASE", span.first
    for row in block.rows.values():
        if row.is_reserved:
            continue
        name = slug(row.ident or row.name)
        if block.prefix:
            yield f"{block.prefix}_{name}", row.offset
        else:
            yield f"P_{name}", first + row.offset


def _flag_constants(block: FlagBlock) -> Iterator[Constant]:
    """Numbers of the flag words, masks of the flags."""
    first = block.spans[0].first
    if block.ident:
        yield f"W_{slug(block.ident)}", first
    elif block.prefix:
        yield from _word_constants(block)
    for row in block.rows.values():
        if block.prefix and not row.is_reserved and "{" not in row.name:
            yield f"{block.prefix}_{slug(row.ident or row.name)}", row.mask


def _word_constants(block: FlagBlock) -> Iterator[Constant]:
    spans = block.spans
    yield f"{block.prefix}_WORD", spans[0].first
    if len(spans) > 2:
        yield f"{block.prefix}_WORD_STRIDE", spans[1].first - spans[0].first
    else:
        yield f"{block.prefix}_WORD_HIGH", spans[-1].first - (len(spans) - 1) * spans[0].count
