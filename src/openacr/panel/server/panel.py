"""The panel as a whole: control thread, browsers, web server."""

import asyncio
import logging
import socket
from collections.abc import AsyncIterator, Awaitable, Callable, Collection
from contextlib import asynccontextmanager, suppress
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from openacr.errors import UserError
from openacr.panel.commands.all import carry_out
from openacr.panel.control.installation import Installation
from openacr.panel.control.people import Person
from openacr.panel.control.station import Station
from openacr.panel.control.thread import ControlThread
from openacr.panel.roles import Role
from openacr.panel.server import calls as _calls  # noqa: F401 - fills the table
from openacr.panel.server.accounts import Accounts, file_of
from openacr.panel.server.api import routes
from openacr.panel.server.guard import Guard
from openacr.panel.server.hello import hello
from openacr.panel.server.paths import Paths
from openacr.panel.server.socket import Connection, serve_socket
from openacr.panel.server.static import static_file
from openacr.panel.wire.hub import Hub
from openacr.panel.work.pool import Pool

if TYPE_CHECKING:
    from uvicorn.server import Server

log = logging.getLogger(__name__)
PING_S = 5.0
MOST_TEXT = 64 << 10
GRACE_S = 3


class Panel:
    """One machine on the screens of browsers."""

    def __init__(
        self,
        installation: Installation,
        *,
        names: Collection[str] = (),
        control: Callable[[Station], ControlThread] = ControlThread,
    ) -> None:
        self.installation = installation
        self.station = Station(installation, carry_out)
        self.control = control(self.station)
        self.hub = Hub(self.station, self.control.now_s)
        self.accounts = Accounts(file_of(installation.store.path), installation.store)
        self.checks = Pool()
        self.paths = Paths(self)
        self.connections: set[Connection] = set()
        self.cookie = "openacr"
        self._tasks: set[asyncio.Future[None]] = set()
        self._names = names
        self._unsubscribe: Callable[[], None] | None = None

    def hello(self, person: Person) -> dict[str, Any]:
        """The first words to a browser."""
        return hello(self, person, version("openacr"))

    # --- the web server ---------------------------------------------------------------

    def app(self) -> ASGIApp:
        """The web application; the control thread runs as long as it."""

        async def socket_of(websocket: WebSocket) -> None:
            await serve_socket(self, websocket)

        async def page(request: Request) -> Response:
            return await self._page(request)

        table = [
            *routes(self),
            WebSocketRoute("/ws", socket_of),
            Route("/{path:path}", page, methods=["GET", "HEAD"]),
        ]
        return Guard(Starlette(routes=table, lifespan=self._lifespan), self._names)

    async def _page(self, request: Request) -> Response:
        path = request.path_params["path"]
        is_page = path.strip("/") in ("", "bench")
        if is_page and self.accounts.role_of(request.cookies.get(self.cookie)) is None:
            return RedirectResponse("/login", status_code=303)
        return await run_in_threadpool(static_file, request)

    @asynccontextmanager
    async def _lifespan(self, _app: Starlette) -> AsyncIterator[None]:
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
            await run_in_threadpool(self.control.stop)
            for task in self._tasks:
                task.cancel()
            self.paths.close()
            self.checks.close()
            self.installation.close()

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
        self.station.note_stored(cells)

    async def end(self) -> None:
        """Say goodbye to all browsers."""
        self.hub.broadcast({"event": "bye", "text": "the server ends"})
        await asyncio.sleep(0.05)
        for connection in list(self.connections):
            connection.drop(1012, "the server ends")


class PanelServer:
    """A panel on a port."""

    def __init__(self, panel: Panel, address: str = "127.0.0.1", port: int = 0) -> None:
        self.panel = panel
        self.socket = _bound(address, port)
        self.address, self.port = self.socket.getsockname()[:2]
        panel.cookie = f"openacr_{self.port}"
        config = uvicorn.Config(
            panel.app(),
            log_config=None,
            access_log=False,
            lifespan="on",
            ws_max_size=MOST_TEXT,
            ws_ping_interval=PING_S,
            ws_ping_timeout=PING_S,
            ws_per_message_deflate=False,
            server_header=False,
            timeout_graceful_shutdown=GRACE_S,
        )
        self.server: Server = uvicorn.Server(config)

    @property
    def url(self) -> str:
        """Where browsers find it."""
        host = f"[{self.address}]" if ":" in self.address else self.address
        return f"http://{host}:{self.port}/"

    async def serve(self, started: Callable[[], Awaitable[None]] | None = None) -> None:
        """Serve until `stop`."""
        task = asyncio.create_task(self.server.serve(sockets=[self.socket]))
        while not self.server.started and not task.done():
            await asyncio.sleep(0.01)
        if started is not None and not task.done():
            await started()
        await task

    def stop(self) -> None:
        """End the server; call it in its loop."""
        task = asyncio.ensure_future(self.panel.end())
        task.add_done_callback(lambda _task: setattr(self.server, "should_exit", True))


def require_password(panel: Panel, address: str, *, is_loopback: bool) -> None:
    """Refuse an address that others reach while no password is set."""
    if not is_loopback and not panel.accounts.are_asked:
        raise UserError(
            f"--address {address}: other computers can reach it, and no password is set;"
            f" `openacr panel --set-password {Role.OPERATE.word}` sets one"
        )


def _bound(address: str, port: int) -> socket.socket:
    if not 0 <= port <= 0xFFFF:
        raise UserError(f"port {port} is not in 0..65535")
    try:
        found = socket.getaddrinfo(address, port, type=socket.SOCK_STREAM)
        family, *_, place = found[0]
        return socket.create_server((str(place[0]), port), family=family)
    except OSError as error:
        hint = "; --port 0 takes a free one" if error.errno == 98 else ""
        raise UserError(
            f"cannot listen on {address}:{port}: {(error.strerror or str(error)).lower()}{hint}"
        ) from None
