"""Processes that read programs for the screens, of low priority."""

import asyncio
import multiprocessing
import os
import signal
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from typing import Any, TypeVar

from openacr.errors import UserError

T = TypeVar("T")
NICER = 5


_share: Any = None  # in the process: how far its present work is, 0 to 1


def _begin(share: Any) -> None:
    """The server ends this process: Ctrl-C at its terminal is not for it."""
    global _share
    _share = share
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(AttributeError, OSError):
        os.nice(NICER)


def report(share: float) -> None:
    """Note how far the present work of this process is, 0 to 1."""
    if _share is not None:
        _share.value = share


class Pool:
    """One process; it is started by its first work, and again after it was killed."""

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._share = self._context.Value("d", 0.0, lock=False)
        self._executor: ProcessPoolExecutor | None = None
        self._process: Future[int] | None = None

    async def run(self, work: Callable[..., T], *args: Any) -> T:
        """Run a function in the process; UserError where it was killed."""
        loop = asyncio.get_running_loop()
        self._share.value = 0.0
        try:
            return await loop.run_in_executor(self._ready(), work, *args)
        except BrokenProcessPool:
            self.close()
            raise UserError(
                "the program is too big for the memory of this computer, or its reading was killed"
            ) from None

    @property
    def share(self) -> float:
        """How far the present work is, as it reports it, 0 to 1."""
        return float(self._share.value)

    def _ready(self) -> ProcessPoolExecutor:
        if self._executor is None:
            self._executor = ProcessPoolExecutor(
                1, mp_context=self._context, initializer=_begin, initargs=(self._share,)
            )
            self._process = self._executor.submit(os.getpid)
        return self._executor

    def close(self) -> None:
        """End the process, whatever it does."""
        executor, self._executor = self._executor, None
        if executor is None:
            return
        executor.shutdown(wait=False, cancel_futures=True)
        if self._process is not None and self._process.done():
            with suppress(Exception):  # it has ended by itself
                os.kill(self._process.result(), signal.SIGTERM)
