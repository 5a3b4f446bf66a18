"""Write the generated parts of the map: the names that are read, and `image.py` (power-up state).

Run `python -m openacr.map.generate` after a change of the tables or the hidden rows, and where a
name of the map is read for the first time.
"""

import re
import sys
from collections.abc import Container, Iterator, Mapping
from hashlib import blake2b
from itertools import groupby, pairwise
from pathlib import Path

from openacr.map.block import Block, Row
from openacr.map.families import HEADER, flag_modules, row_modules
from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.layout import KIND_CODES
from openacr.map.names import chapters, every_name
from openacr.map.names_read import names_read
from openacr.map.tables import BLOCKS, FLAG_BLOCKS

FOLDER = Path(__file__).parent
ASSIGNMENT = re.compile(r"^(\w+) = .*\n", re.MULTILINE)
Run = tuple[int, int, int, int, int]


def main() -> None:
    """Write all files and delete those of no name; unchanged ones keep their time stamp."""
    files = generated_files()
    for name, text in files.items():
        path = FOLDER / name
        if not path.exists() or path.read_text() != text:
            path.write_text(text)
            sys.stdout.write(f"wrote {name}\n")
    for path in left_over(files):
        path.unlink()
        sys.stdout.write(f"deleted {path.relative_to(FOLDER)}\n")


def generated_files() -> dict[str, str]:
    """Text of every generated file by its path in this folder."""
    read = names_read()
    rows, words = row_modules(BLOCKS, HIDDEN_BLOCKS), flag_modules(FLAG_BLOCKS)
    files = {f"rows/{name}.py": text for name, text in rows}
    files |= {f"words/{name}.py": text for name, text in words}
    fingerprint = fingerprint_text(files)
    files = {name: of_names(read, Path(name).stem, text) for name, text in files.items()}
    files = {name: text for name, text in files.items() if ASSIGNMENT.search(text)}
    return files | {
        "numbers.py": numbers_text(read),
        "image.py": image_text(),
        "fingerprint.py": fingerprint,
    }


def left_over(files: Container[str]) -> list[Path]:
    """Modules of rows and words that are not generated any more."""
    modules = [*FOLDER.glob("rows/[!_]*.py"), *FOLDER.glob("words/[!_]*.py")]
    return [path for path in modules if path.relative_to(FOLDER).as_posix() not in files]


def of_names(read: Container[str], module: str, text: str) -> str:
    """A module without the names that nothing reads."""

    def kept(found: re.Match[str]) -> str:
        return found[0] if f"{module}.{found[1]}" in read else ""

    return ASSIGNMENT.sub(kept, text)


def numbers_text(read: Container[str]) -> str:
    """Names of places in the map, chapter by chapter."""
    parts = [HEADER.format("Names of places in the map.")]
    for title, constants in chapters():
        lines = [f"{name} = {value}" for name, value in constants if f"numbers.{name}" in read]
        if lines:
            parts.append("\n".join([f"# {title}", *lines, ""]))
    return "\n".join(parts)


def fingerprint_text(modules: Mapping[str, str]) -> str:
    """Fingerprints that tell whether a snapshot and the compiled core fit."""
    names = every_name()
    layout = blake2b(repr(sorted(names.items())).encode(), digest_size=8).hexdigest()
    places = blake2b(repr((names, modules)).encode(), digest_size=8).hexdigest()
    parts = [
        HEADER.format("Fingerprints of the map."),
        "# of the names of all places: snapshots fit cards with the same one",
        f'LAYOUT = "{layout}"',
        "",
        "# of all that could be read: the compiled core fits sources with the same one",
        f'PLACES = "{places}"',
        "",
    ]
    return "\n".join(parts)


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
