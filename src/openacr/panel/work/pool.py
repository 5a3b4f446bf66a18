"""Processes that compute for the screens, of low priority: programs read, motors identified."""

import asyncio
import multiprocessing
import os
import sys
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing.context import BaseContext
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

from openacr.errors import UserError
from openacr.workers.parent import follow_parent

T = TypeVar("T")
NICER = 5
# Importing what reads programs takes half a second: on Linux each is forked from one that has.
METHOD = "forkserver" if sys.platform == "linux" else "spawn"
_starts: Any = multiprocessing.get_context(METHOD)
if METHOD == "forkserver":
    _starts.set_forkserver_preload(["openacr.panel.work.paths"])
ENDED = "the computation was ended: another took its place, or the server ends"
KILLED = "the program is too big for the memory of this computer, or its reading was killed"

_share: Any = None  # in the process: how far its present work is, 0 to 1


def _begin(share: Any, nicer: int) -> None:
    global _share
    _share = share
    follow_parent()
    with suppress(AttributeError, OSError):
        os.nice(nicer)


def report(share: float) -> None:
    """Note how far the present work of this process is, 0 to 1."""
    if _share is not None:
        _share.value = share


class _Context(BaseContext):
    """Starts processes and notes them: an executor does not say which are its own."""

    _name = METHOD

    def __init__(self) -> None:
        super().__init__()
        self.started: list[BaseProcess] = []

    def Process(self, *args: Any, **options: Any) -> BaseProcess:
        process: BaseProcess = _starts.Process(*args, **options)
        self.started.append(process)
        return process


class _Worker:
    """One process from its start to its end."""

    def __init__(self, share: Any, nicer: int) -> None:
        self._context = _Context()
        self._executor = ProcessPoolExecutor(
            1, mp_context=self._context, initializer=_begin, initargs=(share, nicer)
        )
        self._is_closed = False
        self.is_lost = False

    def submit(self, work: Callable[..., T], args: tuple[Any, ...], killed: str) -> "Future[T]":
        """Begin work; its error is a UserError where the process has ended before it."""
        answer: Future[T] = Future()

        def ended(done: "Future[T]") -> None:
            try:
                answer.set_result(done.result())
            except (BrokenProcessPool, CancelledError):
                self.is_lost = True
                answer.set_exception(UserError(ENDED if self._is_closed else killed))
            except BaseException as error:
                answer.set_exception(error)

        self._executor.submit(work, *args).add_done_callback(ended)
        return answer

    def close(self) -> None:
        """End the process, whatever it does."""
        self._is_closed = True
        self._executor.shutdown(wait=False, cancel_futures=True)
        for process in self._context.started:
            process.terminate()


class Pool:
    """One process; it is started by its first work, and again after it was killed."""

    def __init__(self, nicer: int = NICER, killed: str = KILLED) -> None:
        """`nicer`: how much lower its priority is than that of the server; `killed`: its error."""
        self._nicer, self._killed = nicer, killed
        self._share = _Context().Value("d", 0.0, lock=False)
        self._worker: _Worker | None = None
        self._takes_work = True
        self._changes = threading.Lock()  # of the two above

    async def run(self, work: Callable[..., T], *args: Any) -> T:
        """Run a function in the process; UserError where it was killed or the pool closed."""
        future = asyncio.wrap_future(self.submit(work, *args))
        future.add_done_callback(_retrieve)
        # Of work that is dropped only the waiting ends: the process carries it out.
        await asyncio.wait((future,))
        return future.result()

    def submit(self, work: Callable[..., T], *args: Any) -> "Future[T]":
        """Begin a function in the process, from any thread; errors are in the future."""
        with self._changes:
            if not self._takes_work:
                refused: Future[T] = Future()
                refused.set_exception(UserError(ENDED))
                return refused
            self._share.value = 0.0
            if self._worker is not None and not self._worker.is_lost:
                with suppress(BrokenProcessPool):  # killed while it was idle
                    return self._worker.submit(work, args, self._killed)
            self._worker = _Worker(self._share, self._nicer)
            return self._worker.submit(work, args, self._killed)

    @property
    def share(self) -> float:
        """How far the present work is, as it reports it, 0 to 1."""
        return float(self._share.value)

    def close(self) -> None:
        """End the process, whatever it does."""
        with self._changes:
            self._close()

    def _close(self) -> None:
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.close()

    def end(self) -> None:
        """End the process and take no more work."""
        with self._changes:
            self._takes_work = False
            self._close()


def result_of(work: asyncio.Future[T]) -> T:
    """The result of work that is done; UserError where it was cancelled with its pool."""
    if work.cancelled():
        raise UserError(ENDED)
    return work.result()


def _retrieve(work: asyncio.Future[Any]) -> None:
    """Keep asyncio from reporting the failure of work that was dropped."""
    if not work.cancelled():
        work.exception()
