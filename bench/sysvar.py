"""The store of the CNC side: reading cells again and again, writing through, hearing of others."""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from bench.figures import at_most
from openacr.sysvar import Store

READS, WRITES = 200_000, 1_000
CELL = 2001


def _us(work: Callable[[], object], times: int) -> float:
    """Microseconds of one call, the best of three rounds."""
    best = float("inf")
    for _ in range(3):
        begin = time.perf_counter()
        for _ in range(times):
            work()
        best = min(best, (time.perf_counter() - begin) / times)
    return best * 1e6


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.db"
        with Store(path) as store, Store(path) as other:
            store.write(CELL, 1.5)

            def write() -> None:
                store.write(CELL, store.read(CELL) + 1.0)

            def hear() -> None:
                write()
                if other.read(CELL) != store.read(CELL):
                    raise SystemExit("a value another one wrote was not seen")

            read_us = _us(lambda: store.read(CELL), READS)
            write_us, hear_us = _us(write, WRITES), _us(hear, WRITES)
    at_most("store, a cell read again", read_us, 1.0, "us")
    at_most("store, a cell written through", write_us, 1000.0, "us")
    at_most("store, written here and read there", hear_us, 1000.0, "us")


if __name__ == "__main__":
    main()
