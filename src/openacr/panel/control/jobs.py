"""Work beside the control thread whose result it takes over: loading, reading a long program."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from openacr.panel.work.processes import process

T = TypeVar("T")
KILLED = "the process that computed this was ended from outside, or lacked memory: try again"


class Jobs:
    """Runs work in a thread or a process; `poll` hands the results over, in the control thread."""

    def __init__(self) -> None:
        self._threads = ThreadPoolExecutor(1, "panel job")
        self._waiting = ThreadPoolExecutor(1, "panel computation")  # for the process
        self._process = process(killed=KILLED)
        self._open: list[tuple[Future[Any], Callable[[Future[Any]], None]]] = []

    def begin(self, work: Callable[[], T], done: "Callable[[Future[T]], None]") -> None:
        """Begin a piece of work; `done` gets its finished future in the control thread."""
        self._open.append((self._threads.submit(work), done))

    def compute(
        self, done: "Callable[[Future[T]], None]", work: Callable[..., T], *args: Any
    ) -> None:
        """Begin a function in another process: what computes for long would delay the card.

        Its future has a UserError where the process was killed, or ended with the panel.
        """

        def result() -> T:
            return self._process.submit(work, *args).result()  # starting it takes a while, too

        self._open.append((self._waiting.submit(result), done))

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
        """End what is under way: nothing of it is handed over."""
        self._process.end()
        for threads in (self._threads, self._waiting):
            threads.shutdown(wait=False, cancel_futures=True)
