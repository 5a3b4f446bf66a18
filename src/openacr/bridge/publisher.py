"""What a bridge and the keeper of its process share: a thread with an asyncio loop, and a feed."""

import asyncio
import logging
import threading
from abc import ABC, abstractmethod
from contextlib import suppress

from openacr.bridge.feed import Feed
from openacr.bridge.settings import BridgeFile
from openacr.errors import OpenacrError, UserError

log = logging.getLogger(__name__)


class Publisher(ABC):
    """Publishes what a feed gives, in a thread of its own, from `start` to `stop`."""

    open_s: float | None = None  # longest start; None where the work has limits of its own

    def __init__(self, file: BridgeFile, feed: Feed) -> None:
        self._file, self._feed = file, feed
        self.places: list[str] = []  # where hosts find each system
        self._failure: OpenacrError | None = None
        self._is_up = threading.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._over: asyncio.Event | None = None
        self._thread = threading.Thread(target=self._run, name=type(self).__name__, daemon=True)

    @abstractmethod
    async def _work(self, over: asyncio.Event) -> None:
        """Publish until the end; set `_is_up` after the start, which an error before it ends."""

    @abstractmethod
    def _close_s(self) -> float:
        """The longest end [s]."""

    def start(self) -> None:
        """Begin to publish; UserError where a system cannot begin."""
        numbers = dict.fromkeys(each.parameter_number for each in self._file.value)
        self._feed.start(list(numbers), self._file.rate_hz)
        self._thread.start()
        if not self._is_up.wait(self.open_s):
            self.stop()
            raise UserError(f"the bridge has not started within {self.open_s:g} s")
        if self._failure is not None:
            self.stop()
            raise self._failure

    def stop(self) -> None:
        """End all that was begun."""
        loop, over = self._loop, self._over
        if loop is not None and over is not None:
            with suppress(RuntimeError):  # the loop has ended by itself
                loop.call_soon_threadsafe(over.set)
        if self._thread.is_alive():
            self._thread.join(self._close_s())
        self._feed.stop()

    # --- in the thread ----------------------------------------------------------------

    def _run(self) -> None:
        try:
            asyncio.run(self._live())
        except OpenacrError as error:
            self._failure = error
        except Exception as error:
            log.exception("the bridge has failed")
            self._failure = UserError(f"the bridge has failed: {type(error).__name__}: {error}")
        finally:
            self._is_up.set()

    async def _live(self) -> None:
        self._loop, self._over = asyncio.get_running_loop(), asyncio.Event()
        await self._work(self._over)
