"""Whole commands: `openacr --help`, a minute of the gantry, the check of a short part program.

The start of the panel is the time to the line with its address, less that in which it waited for a
core (Linux counts it), so that other work on the computer disturbs little; then the address has to
answer.
"""

import subprocess
import sys
import tempfile
import time
import urllib.request
from pathlib import Path
from typing import IO, cast

from bench.cards import GANTRY
from bench.figures import as_installed, at_most, command_s, value_only

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


def _panel_s() -> float:
    """From the start of a panel to the address on the screen."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["panel", "--no-browser", "--port", "0", "--store", str(Path(folder, "sysvar.db"))]
        environment = as_installed() | {"XDG_DATA_HOME": folder}
        began = time.perf_counter()
        with subprocess.Popen(
            [*OPENACR, *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment
        ) as process:
            said = cast("IO[bytes]", process.stdout).readline().decode().split()
            took_s = time.perf_counter() - began - _queued_s(process.pid)
            with urllib.request.urlopen(said[-1], timeout=30.0) as page:
                page.read()
            process.terminate()
    return took_s


def _queued_s(process: int) -> float:
    """How long the first thread of a process has waited for a core; 0 where nothing counts it."""
    counted = Path(f"/proc/{process}/task/{process}/schedstat")
    return int(counted.read_text().split()[1]) / 1e9 if counted.exists() else 0.0


def main() -> None:
    at_most("openacr --help", _wall_s("--help"), 0.25, "s")
    value_only("openacr --help, CPU time", command_s([*OPENACR, "--help"]), "s")
    address_s = min(_panel_s() for _ in range(RUNS))
    at_most("openacr panel: the address is on the screen", address_s, 1.5, "s")
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
