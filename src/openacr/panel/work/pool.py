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


def _begin() -> None:
    """The server ends this process: Ctrl-C at its terminal is not for it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(AttributeError, OSError):
        os.nice(NICER)


class Pool:
    """One process; it is started by its first work, and again after it was killed."""

    def __init__(self) -> None:
        self._executor: ProcessPoolExecutor | None = None
        self._process: Future[int] | None = None

    async def run(self, work: Callable[..., T], *args: Any) -> T:
        """Run a function in the process; UserError where it was killed."""
        loop = asyncio.get_running_loop()
        try:
            return await loop.run_in_executor(self._ready(), work, *args)
        except BrokenProcessPool:
            self.close()
            raise UserError(
                "the program is too big for the memory of this computer, or its reading was killed"
            ) from None

    def _ready(self) -> ProcessPoolExecutor:
        if self._executor is None:
            context = multiprocessing.get_context("spawn")
            self._executor = ProcessPoolExecutor(1, mp_context=context, initializer=_begin)
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
