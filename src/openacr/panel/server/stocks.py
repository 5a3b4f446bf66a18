"""The stock that browsers show: computed in a process of its own, one program at a time."""

import asyncio
from dataclasses import dataclass
from pathlib import Path

from openacr.errors import UserError
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.loaded import version_of
from openacr.panel.server.paths import stamp
from openacr.panel.work.processes import process
from openacr.panel.work.stock import stock_of
from openacr.sysvar.tabs import TOOL
from openacr.workers.background import result_of


@dataclass(slots=True)
class Share:
    """How far a stock is computed, 0 to 1."""

    done: float


class Stocks:
    """The stock of the last program that was asked for."""

    def __init__(self, installation: Installation) -> None:
        self._installation = installation
        self._pool = process()
        self._tag = ""
        self._task: asyncio.Task[bytes] | None = None

    async def of(self, file: Path, dialect: str = "") -> tuple[str, bytes | Share]:
        """The tag of a file's stock, and the stock or how far it is computed.

        Another program, or other settings, end the computation of the one before.
        """
        version = await asyncio.to_thread(version_of, file)
        tag = f"{version}-{stamp(self._installation.store, tuple(TOOL.tip))}-{dialect}"
        if tag != self._tag or self._task is None:
            self.stop()
            self._tag, self._task = tag, asyncio.create_task(self._computed(file, dialect))
        task = self._task
        await asyncio.wait((task,), timeout=0.05)
        if not task.done():
            return tag, Share(self._pool.share)
        try:
            return tag, result_of(task)
        except BaseException:
            self._task = None
            raise

    async def _computed(self, file: Path, dialect: str) -> bytes:
        store = self._installation.store.path
        if store is None:
            raise UserError("the store is in memory: no stock can be computed")
        return await self._pool.run(stock_of, file, store, dialect)

    def stop(self) -> None:
        """End what is being computed, with its process."""
        task, self._task = self._task, None
        if task is not None and not task.done():
            task.cancel()
            self._pool.close()

    def close(self) -> None:
        """End the process."""
        self.stop()
        self._pool.end()
