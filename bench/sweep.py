"""Sweeps of the gantry: simulated seconds per second and core, and what a Dask cluster costs."""

import json
import os
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

from bench.cards import GANTRY
from bench.figures import at_least, at_most
from openacr.sweep.load import load_sweep
from openacr.sweep.run import Outcome, Task, perform
from openacr.workers import ClusterPool, Done, LocalPool

RUNS = int(os.environ.get("SWEEP_RUNS", "200"))
SPAN_S = 60.0
TASKS, TASK_S = 24, 1.0
WORKERS = 2
STUDY = f"""
project = {str(GANTRY)!r}
[vary.gain]
line = "AXIS0 PGAIN {{}}"
range = [0.001, 0.004]
steps = {RUNS}
[measures]
worst = "AXIS0.peak_following_error"
"""


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "study.toml")
        file.write_text(STUDY)
        study = load_sweep(file)
        tasks = [Task(n, (0.001 + 0.003 * n / RUNS,), study) for n in range(RUNS)]
        with LocalPool(WORKERS) as pool:
            list(pool.results(perform, tasks[:WORKERS]))  # processes are there, cards loaded
            found = list(pool.results(_timed, tasks))
        cpu_s = sum(each.result for each in found if isinstance(each, Done))
        at_least("sweep: gantry, x real time per core", RUNS * SPAN_S / cpu_s, 1000, "x")
        _cluster(Path(folder))


def _timed(task: Task) -> float:
    """CPU seconds of a run."""
    began_s = time.process_time()
    outcome: Outcome = perform(task)
    if outcome.error:
        raise RuntimeError(outcome.error)
    return time.process_time() - began_s


def _cluster(folder: Path) -> None:
    """The time of tasks that sleep, beside what they would take without a cluster."""
    with ExitStack() as stack:
        note = folder / "scheduler.json"

        def start(module: str, *words: str) -> None:
            command = [sys.executable, "-W", "ignore", "-m", f"distributed.cli.{module}", *words]
            quiet = subprocess.DEVNULL
            process = subprocess.Popen(command, stdout=quiet, stderr=quiet)
            stack.callback(process.wait)
            stack.callback(process.kill)

        start("dask_scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(note))
        for _ in range(WORKERS):
            start("dask_worker", "--scheduler-file", str(note), "--nthreads", "1", "--no-nanny")
        while not note.exists():
            time.sleep(0.05)
        with ClusterPool(json.loads(note.read_text())["address"]) as pool:
            while pool.size < WORKERS:
                time.sleep(0.05)
            list(pool.results(time.sleep, [0.0] * WORKERS))
            began_s = time.perf_counter()
            list(pool.results(time.sleep, [TASK_S] * TASKS))
            wall_s = time.perf_counter() - began_s
    ideal_s = TASKS * TASK_S / WORKERS
    at_most("sweep: overhead of Dask, tasks of 1 s", 100.0 * (wall_s / ideal_s - 1.0), 10, "%")


if __name__ == "__main__":
    main()
