"""Whole commands: `openacr --help`, and a minute of the gantry."""

import resource
import subprocess
import sys
import time

from bench.cards import GANTRY
from bench.figures import at_most, value_only

RUNS = 5
OPENACR = [sys.executable, "-c", "from openacr.cli.main import main; main()"]


def _run(*arguments: str) -> tuple[float, float]:
    """Least wall-clock and CPU time of a command."""
    found = []
    for _ in range(RUNS):
        began, cpu = time.perf_counter(), _children_s()
        subprocess.run([*OPENACR, *arguments], check=True, capture_output=True)
        found.append((time.perf_counter() - began, _children_s() - cpu))
    return min(wall for wall, _ in found), min(cpu for _, cpu in found)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    wall, cpu = _run("--help")
    at_most("openacr --help", wall, 0.25, "s")
    value_only("openacr --help, CPU time", cpu, "s")
    wall, cpu = _run("run", str(GANTRY), "--for", "60", "--quiet")
    at_most("openacr run examples/gantry --for 60", wall, 3.0, "s")
    value_only("openacr run examples/gantry --for 60, CPU time", cpu, "s")


if __name__ == "__main__":
    main()
