"""A part program of 100 MB, a mixed shop file: lines per second and the memory it takes."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from bench.figures import at_least, at_most, value_only
from bench.interpret import mixed
from openacr.cnc.canonical import Moves
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.sysvar import Store

SIZE_MB = 100
DIALECT = "rs274ngc"
LINES_OF_A_PIECE = 100_000
STATUS = Path("/proc/self/status")


def written(path: Path) -> int:
    """Write the program; how many lines it has."""
    rows = mixed(LINES_OF_A_PIECE).splitlines()[:-1]
    piece = "\n".join(rows).encode() + b"\n"
    pieces = SIZE_MB * 1_000_000 // len(piece) + 1
    with path.open("wb") as file:
        for _ in range(pieces):
            file.write(piece)
        file.write(b"M2\n")
    return pieces * len(rows) + 1


def own_memory_mb() -> float:
    """Memory of this process that is not a view of a file."""
    for line in STATUS.read_text(encoding="ascii").splitlines():
        if line.startswith("RssAnon"):
            return int(line.split()[1]) / 1000
    return 0.0


def measure() -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "BIG.NC")
        line_cnt = written(path)
        cells = Shadow(Store())
        before_mb = own_memory_mb() if STATUS.exists() else 0.0
        began = time.process_time()
        program = load(path, cells, DIALECT)
        most_mb, moves = 0.0, 0
        options = Options(has_batches=True)
        for entry in Interpreter(program, cells, VirtualMachine(), DIALECT, options).entries():
            moves += len(entry) if isinstance(entry, Moves) else 1
            if STATUS.exists():
                most_mb = max(most_mb, own_memory_mb())
        seconds = time.process_time() - began
    value_only(f"moves of a file of {SIZE_MB} MB", moves, "moves")
    at_least("lines of it loaded and interpreted per second", line_cnt / seconds, 300_000, "1/s")
    if STATUS.exists():
        at_most("memory it takes beside the file", most_mb - before_mb, 32.0, "MB")


def main() -> None:
    """In a process of its own, whose memory nothing else has used before."""
    subprocess.run([sys.executable, "-m", "bench.big_file"], check=True)


if __name__ == "__main__":
    measure()
