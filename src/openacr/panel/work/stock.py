"""What a program leaves of its blank, as one block of bytes for browsers.

| offset | type | what |
|---|---|---|
| 0 | char[4] | `OAS1` |
| 4 | u32 | columns, cells along X |
| 8 | u32 | rows, cells along Y |
| 12 | u32 | flags: 1 = millimetres |
| 16 | f32[2] | low corner X Y |
| 24 | f32 | size of a cell |
| 28 | f32[2] | bottom and top of the blank |
| 36 | u32 | lines R whose rapids touch material |
| 40 | u32 | lines B that cut below the blank |
| 44 | u32 | 0 |
| 48 | u32[R] | these lines, at most the first 1000 |
| .. | u32[B] | these lines, at most the first 1000 |
| .. | u16[] | heights, row by row of Y: 0 is the bottom, 65535 the top |
| .. | u8[] | marks of the cells: 1 touched by a rapid, 2 cut below the bottom |

Heights are those of the tips of the tools: machine coordinates without the length of the tool.
"""

import gzip
import struct
from pathlib import Path

import numpy as np

from openacr.cnc.loading.load import load
from openacr.mill.config.dialects import choose
from openacr.mill.config.folders import folders_of
from openacr.mill.plan.pictures.removal import Removal, Report, removal
from openacr.sysvar import Store
from openacr.workers.background import report

MARK = b"OAS1"
HEAD = struct.Struct("<4sIII5fIII")
FULL = 65535
MOST_LINES = 1000
PACKED = 6  # level of gzip: a field compresses well


def stock_of(file: Path, store: Path, dialect: str, note: Report = report) -> bytes:
    """Read the program in a file and cut its blank; the block, gzip."""
    with Store(store) as cells:
        name = choose(file, cells, dialect or None).name
        program = load(file, cells, name, folders_of(cells, store.parent))
        return gzip.compress(block(removal(program, cells, name, note)), PACKED)


def block(found: Removal) -> bytes:
    """The block of bytes."""
    stock = found.stock
    rows, columns = stock.heights.shape
    (x, y, bottom), top = stock.blank.low, stock.blank.high[2]
    lines = [found.rapid_lines[:MOST_LINES], found.below_lines[:MOST_LINES]]
    head = HEAD.pack(
        MARK, columns, rows, int(found.is_metric), x, y, stock.cell, bottom, top,
        len(lines[0]), len(lines[1]), 0,
    )  # fmt: skip
    heights = np.rint((stock.heights - bottom) / (top - bottom) * FULL).astype("<u2")
    numbers = np.array([*lines[0], *lines[1]], "<u4")
    return b"".join((head, numbers.tobytes(), heights.tobytes(), stock.marks.tobytes()))
