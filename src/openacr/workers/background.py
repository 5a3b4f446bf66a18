"""A process that computes beside a server, of low priority: its answers do not wait for it.

It is started by its first work, ends with its server, and another one takes its place when it dies
or is closed.
"""

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
ENDED = "the computation was ended: another took its place, or the server ends"

_share: Any = None  # in the process: how far its present work is, 0 to 1


def _begin(share: Any, nicer: int) -> None:
    global _share
    _share = share
    follow_parent()
    with suppress(AttributeError, OSError):
        os.nice(nicer)
    with suppress(OSError):  # a server may speak a protocol there
        os.dup2(2, 1)


def report(share: float) -> None:
    """Note how far the present work of this process is, 0 to 1."""
    if _share is not None:
        _share.value = share


def _starts(preload: str) -> Any:
    """How processes are started: on Linux forked from one that has imported `preload`, if any."""
    if not preload or sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    context: Any = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([preload])
    return context


class _Context(BaseContext):
    """Starts processes and notes them: an executor does not say which are its own."""

    def __init__(self, preload: str) -> None:
        super().__init__()
        self._starts = _starts(preload)
        self._name = self._starts.get_start_method()
        self.started: list[BaseProcess] = []

    def Process(self, *args: Any, **options: Any) -> BaseProcess:
        process: BaseProcess = self._starts.Process(*args, **options)
        self.started.append(process)
        return process


class _Worker:
    """One process from its start to its end."""

    def __init__(self, context: _Context, share: Any, nicer: int) -> None:
        self._context = context
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
            process.kill()  # also one that is stopped, which does not heed a request to end


class Background:
    """One process; it is started by its first work, and again after it was killed."""

    def __init__(self, killed: str, nicer: int = NICER, preload: str = "") -> None:
        """`killed`: the error of work whose process dies; `nicer`: how much lower its priority is.

        `preload`: a module that takes long to import; on Linux every process is forked from one
        that has imported it, so that the second one starts soon.
        """
        self._nicer, self._killed, self._preload = nicer, killed, preload
        self._share = _Context(preload).Value("d", 0.0, lock=False)
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
            self._worker = _Worker(_Context(self._preload), self._share, self._nicer)
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
