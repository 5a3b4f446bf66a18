"""Write the generated parts of the map: the names of all places, and `image.py` (power-up state).

Run `python -m openacr.map.generate` after a change of the tables or the hidden rows.
"""

import sys
from collections.abc import Iterable, Iterator
from itertools import groupby, pairwise
from pathlib import Path

from openacr.map.block import FLAG_LAST, FLAG_WORD_BASE, Block, Row
from openacr.map.families import HEADER, flag_modules, row_modules
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

Run = tuple[int, int, int, int, int]


def main() -> None:
    """Write all files; unchanged ones keep their time stamp."""
    folder = Path(__file__).parent
    for name, text in generated_files():
        path = folder / name
        if not path.exists() or path.read_text() != text:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
            sys.stdout.write(f"wrote {name}\n")


def generated_files() -> Iterator[tuple[str, str]]:
    """Path in this folder and text of every generated file."""
    yield "numbers.py", numbers_text()
    yield "image.py", image_text()
    for name, text in row_modules(BLOCKS, HIDDEN_BLOCKS):
        yield f"rows/{name}.py", text
    for name, text in flag_modules(FLAG_BLOCKS):
        yield f"words/{name}.py", text


def numbers_text() -> str:
    """Names of everything that has a place in the map."""
    parts = [HEADER.format("Names of all places in the map.")]
    for title, constants in _chapters():
        lines = [f"{name} = {value}" for name, value in constants]
        parts.append("\n".join([f"# {title}", *lines, ""]))
    return "\n".join(parts)


def _chapters() -> Iterator[tuple[str, list[Constant]]]:
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


def image_text() -> str:
    """Kinds and power-up values of all parameters, as the memory needs them."""
    parts = [
        HEADER.format("What every parameter is and which value it has at power-up."),
        "# first number, how many in a row, kind, stride to the next object, objects",
        "KINDS = (",
        *(f"    {run}," for block in BLOCKS for run in _block_kinds(block)),
        *(
            f"    {(span.first, span.count, 1, 1, 1)},"
            for block in FLAG_BLOCKS
            for span in block.spans
        ),
        ")",
        "",
        "# first number, stride to the next object, objects, value",
        "POWER_UP = (",
        *(f"    {value}," for block in BLOCKS for value in _power_up(block)),
        ")",
        "",
    ]
    return "\n".join(parts)


def _block_kinds(block: Block) -> Iterator[Run]:
    """Runs of neighbouring rows of the same kind, for every span of objects."""
    for span in block.spans:
        for rows in _runs(list(block.rows.values())):
            first = span.first + rows[0].offset
            yield first, len(rows), KIND_CODES[rows[0].kind], block.stride or 1, span.count


def _runs(rows: list[Row]) -> Iterator[list[Row]]:
    rows = sorted(rows, key=lambda row: row.offset)
    breaks = [
        position
        for position, (before, after) in enumerate(pairwise(rows), 1)
        if after.offset != before.offset + 1 or after.kind is not before.kind
    ]
    for start, end in pairwise([0, *breaks, len(rows)]):
        yield rows[start:end]


def _power_up(block: Block) -> Iterator[tuple[int, int, int, float]]:
    """Runs of neighbouring objects with the same power-up value other than zero."""
    position, stride = 0, block.stride or 1
    for span in block.spans:
        for row in block.rows.values():
            values = [row.default_of(position + n) for n in range(span.count)]
            start = 0
            for value, run in groupby(values):
                length = len(list(run))
                if value:
                    yield span.first + row.offset + stride * start, stride, length, value
                start += length
        position += span.count


if __name__ == "__main__":
    main()
