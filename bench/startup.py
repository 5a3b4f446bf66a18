"""Whole commands: `openacr --help`, a minute of the gantry, the check of a short part program."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from bench.cards import GANTRY
from bench.figures import at_most, command_s, value_only

RUNS = 5
OPENACR = [sys.executable, "-c", "from openacr.cli.main import main; main()"]
TEN = """%
G21 G90 G94 G17 G40
G91.1
T1 M6
S8000 M3
G0 X0 Y0 Z5
G1 Z-1 F200
G3 X10 Y10 I5 J5 F800
M30
%
"""


def _wall_s(*arguments: str) -> float:
    """The least wall-clock time of a command."""
    found = []
    for _ in range(RUNS):
        began = time.perf_counter()
        subprocess.run([*OPENACR, *arguments], check=True, capture_output=True)
        found.append(time.perf_counter() - began)
    return min(found)


def main() -> None:
    at_most("openacr --help", _wall_s("--help"), 0.25, "s")
    value_only("openacr --help, CPU time", command_s([*OPENACR, "--help"]), "s")
    gantry = ["run", str(GANTRY), "--for", "60", "--quiet"]
    at_most("openacr run examples/gantry --for 60", _wall_s(*gantry), 3.0, "s")
    value_only(
        "openacr run examples/gantry --for 60, CPU time", command_s([*OPENACR, *gantry]), "s"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "TEN.NGC")
        path.write_text(TEN)
        seconds = command_s([*OPENACR, "mill", "check", str(path)])
    at_most("openacr mill check of ten lines, CPU time", seconds, 0.15, "s")


if __name__ == "__main__":
    main()
