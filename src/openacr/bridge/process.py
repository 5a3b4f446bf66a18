"""The bridge of a panel: its systems in a process of their own, started again where it ends.

The interpreter of a panel passes the time of a virtual card, which systems must not delay.
"""

import asyncio
import logging
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from openacr.bridge.feed import Feed
from openacr.bridge.life import Life
from openacr.bridge.load import secrets_of
from openacr.bridge.publisher import Publisher
from openacr.bridge.settings import BridgeFile
from openacr.errors import UserError

log = logging.getLogger(__name__)
PAUSES_S = (1.0, 30.0)  # shortest and longest time from an end to the next start
CALM_S = 60.0  # a process that has lived longer is started again after the shortest pause
STOP_S = 30.0  # longest end


class BridgeProcess(Publisher):
    """Keeps a process with the systems of a file running, and feeds it."""

    def __init__(
        self,
        file: BridgeFile,
        folder: Path,
        feed: Feed,
        say: Callable[[str], None] = lambda _text: None,
    ) -> None:
        secrets_of(file, folder)  # what is missing is known before anything is started
        super().__init__(file, feed)
        self._folder, self._say = folder, say

    def _close_s(self) -> float:
        return STOP_S  # a process that does not end is killed

    # --- in the thread ----------------------------------------------------------------

    async def _work(self, over: asyncio.Event) -> None:
        """Keep a process running until the end; the first one has to begin at once."""
        clock = asyncio.get_running_loop().time
        pause_s = PAUSES_S[0]
        while not over.is_set():
            began_s = clock()
            why = await Life(self._file, self._folder, self._feed).run(over, self._open)
            if over.is_set():
                return
            if not self._is_up.is_set():
                raise UserError(why)
            if clock() - began_s > CALM_S:
                pause_s = PAUSES_S[0]
            self._tell(f"{why}; it is started again in {pause_s:g} s")
            with suppress(TimeoutError):
                async with asyncio.timeout(pause_s):
                    await over.wait()
            pause_s = min(2.0 * pause_s, PAUSES_S[1])

    def _open(self, places: tuple[str, ...]) -> None:
        """A process has begun."""
        self.places = list(places)
        if self._is_up.is_set():
            self._tell(f"the bridge publishes again: {', '.join(places)}")
        self._is_up.set()

    def _tell(self, text: str) -> None:
        log.warning("%s", text)
        self._say(text)
