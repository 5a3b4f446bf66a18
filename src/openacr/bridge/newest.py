"""Values on their path to a system that takes them one by one: the newest of each, none twice."""

import asyncio
from collections.abc import Awaitable, Callable, Iterable, Sequence
from contextlib import suppress

from openacr.bridge.items import Readings

Write = Callable[[Readings, list[int]], Awaitable[None]]


class Newest:
    """Hands values over in a task of its own; what comes meanwhile replaces what waits."""

    def __init__(self, write: Write) -> None:
        self._write = write
        self._readings: Readings = ()
        self._changed: set[int] = set()
        self._news = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        """Begin to hand over."""
        self._task = asyncio.create_task(self._run())

    def put(self, readings: Readings, changed: Sequence[int]) -> None:
        """Take over new values, of which those at these places have changed."""
        self._readings = readings
        self.again(changed)

    def again(self, places: Iterable[int]) -> None:
        """Hand the values at these places over once more."""
        self._changed.update(places)
        if self._changed and self._readings:
            self._news.set()

    async def stop(self) -> None:
        """End; what waits is left out."""
        if self._task is not None:
            self._task.cancel()
            with suppress(asyncio.CancelledError):
                await self._task

    async def _run(self) -> None:
        while True:
            await self._news.wait()
            self._news.clear()
            places, self._changed = sorted(self._changed), set()
            await self._write(self._readings, places)
            await asyncio.sleep(0)
