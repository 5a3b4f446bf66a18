"""One figure: its name, the measured value, the target and how far it is met.

CPU time of this process is measured where possible (best of several runs), so that other
work on the machine disturbs little.
"""

import os
import resource
import subprocess
import time
from collections.abc import Callable, Sequence

from openacr.compiled import is_compiled

RUNS = 5


def best_s(work: Callable[[], object], runs: int = RUNS) -> float:
    """The least CPU time of several runs."""
    times = []
    for _ in range(runs):
        began = time.process_time()
        work()
        times.append(time.process_time() - began)
    return max(min(times), 1e-9)


def command_s(command: Sequence[str], runs: int = RUNS) -> float:
    """The least CPU time of several runs of a command."""
    times, environment = [], as_installed()
    for _ in range(runs):
        began = children_s()
        subprocess.run(command, check=True, capture_output=True, env=environment)
        times.append(children_s() - began)
    return max(min(times), 1e-9)


def as_installed() -> dict[str, str]:
    """The environment for commands: Python keeps byte code, as where it is installed."""
    return {n: value for n, value in os.environ.items() if n != "PYTHONDONTWRITEBYTECODE"}


def children_s() -> float:
    """CPU time of all processes of this one that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def percentile(values: Sequence[float], part: float) -> float:
    """The value below which this part of the values lies."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))]


def print_head() -> None:
    """Say what is measured and how to read it."""
    core = "compiled core" if is_compiled else "plain Python: targets are for the compiled core"
    print(f"{core}; ratio above 1: better than the target")
    print(f"{'figure':<52}{'value':>14} {'unit':<8}{'target':>12}{'ratio':>8}")


def at_least(name: str, value: float, target: float, unit: str) -> None:
    """Print a figure that is to be large."""
    _line(name, value, unit, f">= {target:g}", value / target)


def at_most(name: str, value: float, target: float, unit: str) -> None:
    """Print a figure that is to be small."""
    _line(name, value, unit, f"<= {target:g}", target / value if value > 0 else float("inf"))


def value_only(name: str, value: float, unit: str) -> None:
    """Print a figure without a target."""
    _line(name, value, unit, "", None)


def _line(name: str, value: float, unit: str, target: str, ratio: float | None) -> None:
    mark = "" if ratio is None else f"{ratio:8.2f}" + ("" if ratio >= 1.0 else "  missed")
    print(f"{name:<52}{_short(value):>14} {unit:<8}{target:>12}{mark}", flush=True)


def _short(value: float) -> str:
    return f"{value:,.0f}" if value >= 1000 else f"{value:.4g}"
