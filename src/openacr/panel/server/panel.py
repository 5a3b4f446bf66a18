"""The panel as a whole: control thread, browsers, what is computed for them."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any, Protocol, TypeVar

from starlette.concurrency import run_in_threadpool

from openacr.errors import UserError
from openacr.panel.commands.all import carry_out
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.people import Person
from openacr.panel.control.station import Station
from openacr.panel.control.thread import ControlThread
from openacr.panel.roles import Role
from openacr.panel.server.accounts import Accounts, file_of
from openacr.panel.server.hello import hello
from openacr.panel.server.paths import Paths
from openacr.panel.server.receptions import Receptions
from openacr.panel.server.stocks import Stocks
from openacr.panel.wire.hub import Hub
from openacr.panel.work.processes import process

ENDS = "the server ends"
T = TypeVar("T")


class Connected(Protocol):
    """A browser that is connected."""

    @property
    def token(self) -> str:
        """The log-in it came with."""

    def drop(self, code: int, why: str) -> None:
        """End the connection."""


class Panel:
    """One machine on the screens of browsers."""

    def __init__(
        self,
        installation: Installation,
        *,
        control: Callable[[Station], ControlThread] = ControlThread,
        journals: Path | None = None,
    ) -> None:
        self.installation = installation
        self.journals = journals  # the folder of those that served cards leave
        self.station = Station(installation, carry_out)
        self.control = control(self.station)
        self.hub = Hub(self.station, self.control.now_s)
        self.accounts = Accounts(file_of(installation.store.path), installation.store)
        self.checks, self.histories = process(), process()
        self.texts = process(nicer=0)  # short answers while a text is typed
        self.paths = Paths(installation, self.control)
        self.stocks = Stocks(installation)
        self.receptions = Receptions()
        self.connections: set[Connected] = set()
        self.cookie = "openacr"
        self._tasks: set[asyncio.Future[None]] = set()
        self._unsubscribe: Callable[[], None] | None = None

    async def ask(self, work: Callable[[Station], T]) -> T:
        """Run a function in the control thread; its result, or its error."""
        return await asyncio.wrap_future(self.control.call(work))

    def hello(self, person: Person) -> dict[str, Any]:
        """The first words to a browser."""
        return hello(self.installation, person, has_log_in=self.accounts.are_asked)

    @asynccontextmanager
    async def opened(self) -> AsyncIterator[None]:
        """The control thread and what it needs run as long as this."""
        self.hub.attach()
        self._unsubscribe = self.installation.store.subscribe(self._stored)
        self.control.start()
        loop = asyncio.get_running_loop()
        self.station.part.changed = lambda: self._soon(loop)
        self.control.call(lambda station: station.load_sample())
        beat = asyncio.create_task(self.hub.beat())
        try:
            yield
        finally:
            beat.cancel()
            with suppress(asyncio.CancelledError):
                await beat
            if self._unsubscribe is not None:
                self._unsubscribe()
            await self.receptions.close()
            await run_in_threadpool(self.control.stop)
            for task in self._tasks:
                task.cancel()
            self._end_work()
            self.installation.close()

    def _end_work(self) -> None:
        """End what is computed for browsers: calls that wait for it are refused."""
        self.paths.close()
        self.stocks.close()
        for pool in (self.checks, self.texts, self.histories):
            pool.end()

    def _soon(self, loop: asyncio.AbstractEventLoop) -> None:
        """Another program is loaded: its path is computed."""
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(self._show_path)

    def _show_path(self) -> None:
        task = asyncio.ensure_future(self.paths.show())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _stored(self, cells: frozenset[int]) -> None:
        """Cells were stored, here or by another process; called from any thread."""
        self.station.settings.note_stored(cells)

    async def end(self) -> None:
        """Say goodbye to all browsers, and end what is computed for them."""
        self.control.end_soon()
        self._end_work()
        if not self.connections:
            return
        self.hub.broadcast({"event": "bye", "text": ENDS})
        await asyncio.sleep(0.05)
        for connection in list(self.connections):
            connection.drop(1012, ENDS)


def require_password(panel: Panel, address: str, *, is_loopback: bool) -> None:
    """Refuse an address that others reach while no password is set."""
    if not is_loopback and not panel.accounts.are_asked:
        raise UserError(
            f"--address {address}: other computers can reach it, and no password is set;"
            f" `openacr panel --set-password {Role.OPERATE.word}` sets one"
        )
