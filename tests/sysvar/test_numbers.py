"""Cells are named, not numbered, outside `openacr.sysvar`."""

import io
import tokenize
from pathlib import Path

import openacr
from openacr.sysvar.lookup import parameter
from openacr.sysvar.schema import FIRST_SYSTEM

SOURCES = Path(openacr.__file__).parent
READERS = ("cnc", "mill", "cli", "source_check", "store")
# Counts and sizes that happen to be numbers of cells, too.
COUNTS = {
    "cnc/rows/runs.py": {100_000},
    "cnc/interpreter/by_block/loops.py": {500_000},
    "cnc/loading/targets.py": {1_000_000},
    "mill/card/ballscrew.py": {1_000_000},
    "cli/run/session.py": {400_000},
}


def _cells_in(file: Path) -> set[int]:
    tokens = tokenize.generate_tokens(io.StringIO(file.read_text(encoding="utf-8")).readline)
    numbers = {
        int(token.string.replace("_", ""))
        for token in tokens
        if token.type == tokenize.NUMBER and token.string.replace("_", "").isdecimal()
    }
    return {n for n in numbers if n >= FIRST_SYSTEM and parameter(n) is not None}


def test_no_module_that_reads_the_store_writes_the_number_of_a_system_parameter() -> None:
    found = {}
    for folder in READERS:
        for file in sorted((SOURCES / folder).rglob("*.py")):
            name = file.relative_to(SOURCES).as_posix()
            if cells := _cells_in(file):
                found[name] = cells
    assert found == COUNTS
