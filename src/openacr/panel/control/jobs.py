"""Work beside the control thread whose result it takes over: loading, reading a long program."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any


class Jobs:
    """Runs work in a thread; `poll` hands the results over, in the control thread."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "panel job")
        self._open: list[tuple[Future[Any], Callable[[Future[Any]], None]]] = []

    def begin(self, work: Callable[[], Any], done: Callable[[Future[Any]], None]) -> None:
        """Begin a piece of work; `done` gets its finished future in the control thread."""
        self._open.append((self._pool.submit(work), done))

    @property
    def are_open(self) -> bool:
        """Whether work is under way."""
        return bool(self._open)

    def poll(self) -> None:
        """Hand over what is finished."""
        for each in [one for one in self._open if one[0].done()]:
            self._open.remove(each)
            each[1](each[0])

    def close(self) -> None:
        """Forget what is under way."""
        self._pool.shutdown(wait=False, cancel_futures=True)
