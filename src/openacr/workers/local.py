"""Worker processes on this computer.

A process that dies breaks its whole pool, and nothing says which task it had. So the tasks that
were under way are done again alone, one after the other: only one that kills its process
every time is lost.
"""

import multiprocessing
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, wait
from itertools import islice
from types import TracebackType
from typing import Any, Self

from openacr.workers.calls import Call, Done, Lost, Result, Task
from openacr.workers.parent import follow_parent

AHEAD = 2  # tasks handed out for each process
ALONE = 2  # attempts at a task during which a process died
DIED = "the worker process died"


class LocalPool:
    """Processes on this computer, by default one for each core."""

    def __init__(self, size: int | None = None) -> None:
        self._size = size or os.cpu_count() or 1
        self.deaths = 0
        self._pool: ProcessPoolExecutor | None = None

    @property
    def size(self) -> int:
        """How many tasks are done at the same time."""
        return self._size

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the processes; after an error or an interrupt at once, whatever they do."""
        if self._pool is not None:
            if kind is not None:
                _terminate(self._pool)
            self._pool.shutdown(cancel_futures=True)

    def results(
        self, call: Call[Task, Result], tasks: Iterable[Task]
    ) -> Iterator[Done[Task, Result] | Lost[Task]]:
        """The results of all tasks, each once, as they come; `tasks` is read as needed."""
        waiting = iter(tasks)
        running: dict[Future[Result], Task] = {}
        suspects: list[Task] = []
        while True:
            for task in islice(waiting, AHEAD * self._size - len(running)):
                try:
                    running[self._started().submit(call, task)] = task
                except BrokenExecutor:
                    suspects.append(task)
                    break
            if not running and not suspects:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                task = running.pop(future)
                try:
                    yield Done(task, future.result())
                except BrokenExecutor:
                    suspects.append(task)
                except Exception as error:
                    yield Lost(task, f"{type(error).__name__}: {error}")
            if suspects and not running:
                self._broken()
                for task in suspects:
                    yield self._alone(call, task)
                suspects = []

    def _alone(self, call: Call[Task, Result], task: Task) -> Done[Task, Result] | Lost[Task]:
        for _ in range(ALONE):
            try:
                return Done(task, self._started().submit(call, task).result())
            except BrokenExecutor:
                self._broken()
            except Exception as error:
                return Lost(task, f"{type(error).__name__}: {error}")
        return Lost(task, DIED)

    def _started(self) -> ProcessPoolExecutor:
        """The processes; new ones after a death. None is a copy of this one with its threads."""
        if self._pool is None:
            self._pool = ProcessPoolExecutor(
                self._size, multiprocessing.get_context("spawn"), initializer=follow_parent
            )
        return self._pool

    def _broken(self) -> None:
        self.deaths += 1
        if self._pool is not None:
            self._pool.shutdown()
            self._pool = None


def _terminate(pool: ProcessPoolExecutor) -> None:
    # They have no public name before Python 3.14.
    processes: dict[int, Any] = getattr(pool, "_processes", None) or {}
    for process in list(processes.values()):
        process.terminate()
