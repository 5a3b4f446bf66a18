"""Workers make no difference to results: neither their number nor their deaths."""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from tests.sweep.projects import axis_project, rows_of, sweep_file
from tests.waiting import until

from openacr.errors import UserError
from openacr.sweep.campaign import Progress
from openacr.sweep.results import Row
from openacr.workers import ClusterPool, LocalPool

STUDY = """
duration_s = 0.4
[vary.gain]
line = "AXIS2 PGAIN {}"
range = [0.01, 0.05]
steps = 12
[vary.far]
define = "DISTANCE"
values = [2, 1.25]
[measures]
worst = "max(abs(AXIS2.following_error))"
counts = "at_end(P12802)"
"""
PATIENCE_S = 100.0


@dataclass(slots=True)
class Interfering(Progress):
    """Does something once, when some runs are done."""

    act: Callable[[], object] = lambda: None
    has_acted: bool = False

    def show(self) -> None:
        if self.done >= 3 and not self.has_acted:
            self.has_acted = True
            self.act()


@pytest.fixture
def file(tmp_path: Path) -> Path:
    axis_project(tmp_path / "p")
    return sweep_file(tmp_path, STUDY)


@pytest.fixture
def expected(file: Path) -> list[Row]:
    """The rows as this process finds them."""
    return rows_of(file, output=file.with_name("expected.parquet"))


def test_one_worker_and_two_write_the_same_file(file: Path, expected: list[Row]) -> None:
    assert len(expected) == 24
    written = []
    for size in (1, 2):
        output = file.with_name(f"{size}.parquet")
        assert rows_of(file, LocalPool(size), output=output) == expected
        written.append(parquet.read_table(output))
    assert written[0].equals(written[1], check_metadata=True)
    assert written[0].equals(parquet.read_table(file.with_name("expected.parquet")))


def test_a_worker_that_is_killed_changes_nothing_but_the_count_of_deaths(
    file: Path, expected: list[Row]
) -> None:
    killed = []

    def kill() -> None:
        worker = multiprocessing.active_children()[0]
        assert worker.pid is not None
        killed.append(worker.pid)
        os.kill(worker.pid, signal.SIGKILL)

    pool = LocalPool(2)
    assert rows_of(file, pool, Interfering(act=kill)) == expected
    assert (len(killed), pool.deaths) == (1, 1)


class Cluster:
    """A Dask scheduler and workers, processes of this computer."""

    def __init__(self, folder: Path, stack: ExitStack, workers: int) -> None:
        self._folder, self._stack = folder, stack
        note = folder / "scheduler.json"
        self._start(
            "dask_scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(note)
        )
        until(note.exists, limit_s=PATIENCE_S)
        self.address = json.loads(note.read_text())["address"]
        options = ("--nthreads", "1", "--no-nanny", "--no-dashboard")
        self.workers = [
            self._start("dask_worker", self.address, *options, "--name", f"w{n}")
            for n in range(workers)
        ]

    def _start(self, module: str, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-W", "ignore", "-m", f"distributed.cli.{module}", *words]
        log = self._stack.enter_context((self._folder / f"{module}.log").open("ab"))
        process = subprocess.Popen(command, cwd=self._folder, stdout=log, stderr=log)
        self._stack.callback(process.wait)
        self._stack.callback(process.kill)
        return process


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    folder = tmp_path / "cluster"
    folder.mkdir()
    with ExitStack() as stack:
        yield Cluster(folder, stack, 2)


def test_a_cluster_of_two_processes_one_of_which_is_killed_finds_the_same(
    file: Path, expected: list[Row], cluster: Cluster
) -> None:
    pool = ClusterPool(cluster.address)
    until(lambda: pool.size == 2, limit_s=PATIENCE_S)
    progress = Interfering(act=cluster.workers[0].kill)
    assert rows_of(file, pool, progress) == expected
    assert progress.has_acted
    assert pool.deaths == 1


def test_an_address_without_a_scheduler_is_refused() -> None:
    with pytest.raises(UserError, match=r"--scheduler nowhere: no Dask scheduler answers"):
        ClusterPool("nowhere")
