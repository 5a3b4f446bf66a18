"""The web server of a panel: its pages, its calls, its socket, and the port they are on."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Collection
from contextlib import asynccontextmanager

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from openacr.panel.server import calls as _calls  # noqa: F401 - fills the table
from openacr.panel.server.api import routes
from openacr.panel.server.guard import Guard
from openacr.panel.server.panel import Panel
from openacr.panel.server.port import QuietServer, bound
from openacr.panel.server.socket import serve_socket
from openacr.panel.server.static import static_file

PING_S = 5.0
MOST_TEXT = 64 << 10
GRACE_S = 3
MOST_CONNECTIONS = 500  # browsers keep some six each


def app(panel: Panel, names: Collection[str] = ()) -> ASGIApp:
    """The web application of a panel, for hosts of these names; the panel runs as long as it."""

    @asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        async with panel.opened():
            yield

    async def socket_of(websocket: WebSocket) -> None:
        await serve_socket(panel, websocket)

    async def page(request: Request) -> Response:
        return await _page(panel, request)

    table = [
        *routes(panel),
        WebSocketRoute("/ws", socket_of),
        Route("/{path:path}", page, methods=["GET", "HEAD"]),
    ]
    return Guard(Starlette(routes=table, lifespan=lifespan), names)


async def _page(panel: Panel, request: Request) -> Response:
    path = request.path_params["path"]
    is_page = path.strip("/") in ("", "bench")
    if is_page and panel.accounts.role_of(request.cookies.get(panel.cookie)) is None:
        return RedirectResponse("/login", status_code=303)
    return static_file(request)


class PanelServer:
    """A panel on a port."""

    def __init__(
        self,
        panel: Panel,
        address: str = "127.0.0.1",
        port: int = 0,
        *,
        names: Collection[str] = (),
    ) -> None:
        self.panel = panel
        self.socket = bound(address, port, "--port")
        self.address, self.port = self.socket.getsockname()[:2]
        panel.cookie = f"openacr_{self.port}"
        config = uvicorn.Config(
            app(panel, names),
            log_config=None,
            access_log=False,
            lifespan="on",
            ws_max_size=MOST_TEXT,
            ws_ping_interval=PING_S,
            ws_ping_timeout=PING_S,
            ws_per_message_deflate=False,
            server_header=False,
            timeout_graceful_shutdown=GRACE_S,
            limit_concurrency=MOST_CONNECTIONS,
        )
        self.server = QuietServer(config)
        panel.station.on_end = self._end_soon
        self._loop: asyncio.AbstractEventLoop | None = None

    @property
    def url(self) -> str:
        """Where browsers find it."""
        host = f"[{self.address}]" if ":" in self.address else self.address
        return f"http://{host}:{self.port}/"

    async def serve(self, started: Callable[[], Awaitable[None]] | None = None) -> None:
        """Serve until `stop`."""
        self._loop = asyncio.get_running_loop()
        task = asyncio.create_task(self.server.serve(sockets=[self.socket]))
        while not self.server.started and not task.done():
            await asyncio.sleep(0.01)
        if started is not None and not task.done():
            await started()
        await task

    def _end_soon(self) -> None:
        """End the server; called from the control thread."""
        if self._loop is not None:
            self._loop.call_soon_threadsafe(self.stop)

    def stop(self) -> None:
        """End the server; call it in its loop."""
        task = asyncio.ensure_future(self.panel.end())
        task.add_done_callback(lambda _task: self.server.end())
