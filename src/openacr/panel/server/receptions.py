"""The part program that is received over a serial line (LINK): one at a time, in a thread."""

import asyncio
import threading
from collections.abc import Awaitable, Callable
from typing import Any, Literal

from openacr.errors import OpenacrError, UserError
from openacr.mill.config.communications import Line
from openacr.mill.run.receiving import Patience, Reception

PATIENCE = Patience(first_s=300.0)  # the sender is started after the reception
State = Literal["", "receiving", "kept", "cancelled", "failed"]
Keep = Callable[[bytes], Awaitable[object]]


class Receptions:
    """The reception under way, or the last one."""

    def __init__(self) -> None:
        self._reception: Reception | None = None
        self._task: asyncio.Task[None] | None = None
        self._is_cancelled = threading.Event()
        self._state: State = ""
        self._path = self._text = ""

    def data(self) -> dict[str, Any]:
        """State, file, port, what has arrived, and why it has failed."""
        reception = self._reception
        return {
            "state": self._state,
            "path": self._path,
            "port": reception.port if reception else "",
            "bytes": reception.text.bytes_cnt if reception else 0,
            "lines": reception.text.lines_cnt if reception else 0,
            "text": self._text,
        }

    async def begin(self, line: Line, path: str, keep: Keep) -> None:
        """Open the port and receive; `keep` gets the whole program. UserError if it cannot."""
        if self._state == "receiving":
            raise UserError("a program is being received: cancel it first")
        before, self._state = self._state, "receiving"  # the port is opened in a thread
        try:
            reception = await asyncio.to_thread(Reception, line, PATIENCE)
        except BaseException:
            self._state = before
            raise
        self._reception, self._path, self._text = reception, path, ""
        self._is_cancelled = threading.Event()
        self._task = asyncio.create_task(self._receive(reception, keep))

    async def _receive(self, reception: Reception, keep: Keep) -> None:
        try:
            program = await asyncio.to_thread(reception.run, self._is_cancelled.is_set)
            if program is not None:
                await keep(program)
            self._state = "kept" if program is not None else "cancelled"
        except OpenacrError as error:
            self._state, self._text = "failed", f"{error}: nothing was kept"
        except BaseException:
            self._state, self._text = "failed", "the server has failed: nothing was kept"
            raise

    async def cancel(self) -> None:
        """End the reception; nothing is kept unless it was complete already."""
        if self._task is None or self._task.done():
            raise UserError("nothing is being received")
        await self.close()

    async def close(self) -> None:
        """Close the port."""
        self._is_cancelled.set()
        if self._task is not None:
            await asyncio.wait((self._task,))
