"""Worker processes of a Dask cluster, which does a task again when its process dies."""

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

from openacr.closing import Closing
from openacr.errors import UserError
from openacr.workers.calls import Call, Done, Lost, Result, Task

AHEAD = 3  # tasks handed out for each thread of the cluster
PATIENCE_S = 10
DIED = "the worker processes died"


class ClusterPool(Closing):
    """The workers of a Dask scheduler; they need the same version of openacr."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise UserError(
                "--scheduler needs Dask: pip install 'openacr[sweep]'; without it the cores of"
                " this computer are used"
            ) from None
        library: Any = distributed
        self._library = library
        try:
            self._client: Any = library.Client(address, timeout=PATIENCE_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise UserError(
                f"--scheduler {address}: no Dask scheduler answers ({_brief(error)}); write"
                " HOST:PORT, as `dask scheduler` shows it"
            ) from None
        self._seen: set[str] = set()
        self.deaths = 0

    @property
    def size(self) -> int:
        """How many tasks are done at the same time."""
        workers = self._client.scheduler_info(n_workers=-1)["workers"]
        self.deaths += len(self._seen - set(workers))
        self._seen = set(workers)
        return sum(each["nthreads"] for each in workers.values())

    def close(self) -> None:
        """Leave the cluster; its workers go on for others."""
        self._client.close()

    def results(
        self, call: Call[Task, Result], tasks: Iterable[Task]
    ) -> Iterator[Done[Task, Result] | Lost[Task]]:
        """The results of all tasks, each once, as they come; `tasks` is read as needed."""
        waiting = iter(tasks)
        given: dict[str, Task] = {}
        coming = self._library.as_completed(loop=self._client.loop)

        def hand_out(count: int) -> None:
            for task in islice(waiting, count):
                future = self._client.submit(call, task, pure=False)
                given[future.key] = task
                coming.add(future)

        hand_out(AHEAD * max(self.size, 1))
        for future in coming:
            yield self._result(given.pop(future.key), future)
            hand_out(max(1, AHEAD * self.size - len(given)))

    def _result(self, task: Task, future: Any) -> Done[Task, Result] | Lost[Task]:
        if future.cancelled():
            raise UserError("the Dask scheduler is gone; what was done so far is kept")
        error = future.exception()
        if error is None:
            return Done(task, future.result())
        if isinstance(error, self._library.KilledWorker):
            return Lost(task, DIED)
        return Lost(task, f"{type(error).__name__}: {error}")


def _brief(error: Exception) -> str:
    return str(error).partition("\n")[0][:200] or type(error).__name__
