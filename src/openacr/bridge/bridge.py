"""A bridge: one thread with one asyncio loop that gives the newest values to every system."""

import asyncio
import logging
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Protocol

from openacr.bridge.feed import Feed
from openacr.bridge.items import Item, Readings, items_of, read_all
from openacr.bridge.publisher import Publisher
from openacr.bridge.settings import BridgeFile

log = logging.getLogger(__name__)
OPEN_S = 120.0  # longest start of all systems
CLOSE_S = 5.0  # longest end of one system


class System(Protocol):
    """One system around the machine. All its calls come in the loop of the bridge."""

    name: str

    async def open(self) -> str:
        """Begin; where hosts find it. UserError says why it cannot."""

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        """Take over new values, of which those at these places differ from the last ones."""

    async def close(self) -> None:
        """End."""


Make = Callable[[tuple[Item, ...]], list[System]]  # the systems that publish these items


class Bridge(Publisher):
    """The systems of one machine, in a thread of their own."""

    open_s = OPEN_S

    def __init__(self, file: BridgeFile, feed: Feed, make: Make) -> None:
        super().__init__(file, feed)
        self._make = make
        self.items = items_of(feed.axes, file.value)
        self._reported: set[str] = set()

    def _close_s(self) -> float:
        return CLOSE_S * (2 + len(self.places))

    # --- in the thread ----------------------------------------------------------------

    async def _work(self, over: asyncio.Event) -> None:
        opened: list[System] = []
        try:
            for system in self._make(self.items):
                opened.append(system)
                self.places.append(f"{system.name} {await system.open()}")
            self._is_up.set()
            await self._publish(opened, over)
        finally:
            for system in reversed(opened):
                await _close(system)

    async def _publish(self, systems: list[System], over: asyncio.Event) -> None:
        """Publish until the end; a late bridge leaves values out, it does not catch up."""
        every_s, clock = 1.0 / self._file.rate_hz, asyncio.get_running_loop().time
        due_s = clock()
        last: Readings | None = None
        while not over.is_set():
            if (readings := self._read()) is not None:
                changed = _changed(last, readings)
                for system in systems:
                    self._give(system, readings, changed)
                last = readings
            due_s = max(due_s + every_s, clock())
            with suppress(TimeoutError):
                async with asyncio.timeout_at(due_s):
                    await over.wait()

    def _read(self) -> Readings | None:
        """The newest values; None, and the failure in the log, where they cannot be read."""
        try:
            return read_all(self.items, self._feed.newest())
        except Exception as error:
            self._report("the values cannot be read", error)
            return None

    def _give(self, system: System, readings: Readings, changed: list[int]) -> None:
        """Hand values to a system; one that fails takes no other one with it."""
        try:
            system.publish(readings, changed)
        except Exception as error:
            self._report(f"{system.name} cannot publish", error)

    def _report(self, what: str, error: Exception) -> None:
        """Log a failure, each text once."""
        text = f"{what}: {type(error).__name__}: {error}"
        if text not in self._reported:
            self._reported.add(text)
            log.error("%s", text, exc_info=error)


def _changed(last: Readings | None, readings: Readings) -> list[int]:
    """The places of the values that differ; all of them at first."""
    if last is None:
        return list(range(len(readings)))
    return [k for k, (a, b) in enumerate(zip(last, readings, strict=True)) if a != b]


async def _close(system: System) -> None:
    try:
        async with asyncio.timeout(CLOSE_S):
            await system.close()
    except Exception as error:
        log.warning("%s has not ended: %s", system.name, error or type(error).__name__)
