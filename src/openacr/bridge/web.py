"""Web servers of a bridge: a password for other computers, nothing but reading."""

import asyncio
import base64
import binascii
import hmac
import logging
import time
from contextlib import suppress
from math import ceil

import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp, Receive, Scope, Send

from openacr.bridge.library_logs import limit
from openacr.bridge.settings import Listening, port_key
from openacr.panel.server.delays import Delays
from openacr.panel.server.guard import Guard
from openacr.panel.server.port import QuietServer, bound

log = logging.getLogger(__name__)
GRACE_S = 1
KEPT_S = 10  # a connection that asks nothing
MOST_CONNECTIONS = 100
SERVER_LOG = "uvicorn.error"


class Locked:
    """Asks for user and password (HTTP Basic) where a password is set; wrong ones are slowed."""

    def __init__(self, app: ASGIApp, user: str, secret: str | None) -> None:
        self._app = app
        self._wanted = None if secret is None else f"{user}:{secret}".encode()
        self._delays = Delays()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or ask for the password."""
        if scope["type"] == "http" and (answer := self._refusal(scope)) is not None:
            await answer(scope, receive, send)
            return
        await self._app(scope, receive, send)

    def _refusal(self, scope: Scope) -> Response | None:
        """Why a request is not admitted; None if it is."""
        if self._wanted is None:
            return None
        address, now_s = (scope.get("client") or ("?",))[0], clock_s()
        if (wait_s := self._delays.wait_s(address, now_s)) > 0.0:
            text = f"too many wrong passwords: wait {ceil(wait_s)} s\n"
            return PlainTextResponse(text, 429, {"Retry-After": str(ceil(wait_s))})
        given = _given(Headers(scope=scope))
        if given is not None and hmac.compare_digest(given, self._wanted):
            self._delays.forget(address)
            return None
        if given is not None:
            tries = self._delays.note_failure(address, now_s)
            log.warning("wrong password from %s (%d)", address, tries)
        asking = {"WWW-Authenticate": 'Basic realm="openacr", charset="UTF-8"'}
        return PlainTextResponse("a password is needed\n", 401, asking)


def clock_s() -> float:
    """The clock of the delays."""
    return time.monotonic()


def _given(headers: Headers) -> bytes | None:
    """User and password of a request; None where it has none that can be read."""
    scheme, _, given = headers.get("authorization", "").partition(" ")
    if scheme.lower() != "basic":
        return None
    try:
        return base64.b64decode(given, validate=True)
    except (binascii.Error, ValueError):
        return None


class WebServer:
    """One web server in the loop of the bridge."""

    def __init__(
        self, system: str, settings: Listening, secret: str | None, routes: list[Route]
    ) -> None:
        self._system, self._settings = system, settings
        app = Locked(Starlette(routes=routes), settings.user, secret)
        self._app = Guard(app, [settings.address])
        self._server: QuietServer | None = None
        self._task: asyncio.Task[None] | None = None
        self.is_ending = asyncio.Event()  # answers that have no end end with it

    async def open(self) -> str:
        """Listen; the address of the server."""
        settings = self._settings
        socket = bound(settings.address, settings.port, port_key(self._system))
        limit(SERVER_LOG)  # a line for each connection that is refused
        config = uvicorn.Config(
            self._app,
            log_config=None,
            access_log=False,
            lifespan="off",
            server_header=False,
            ws="none",  # nothing here is a WebSocket, and its library is not needed
            timeout_keep_alive=KEPT_S,
            timeout_graceful_shutdown=GRACE_S,
            limit_concurrency=MOST_CONNECTIONS,
        )
        self._server = QuietServer(config)
        self._task = asyncio.create_task(self._server.serve(sockets=[socket]))
        while not self._server.started and not self._task.done():
            await asyncio.sleep(0.01)
        host, port = socket.getsockname()[:2]
        return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"

    async def close(self) -> None:
        """End the server and its connections."""
        self.is_ending.set()
        if self._server is None or self._task is None:
            return
        self._server.end()
        with suppress(asyncio.CancelledError):
            await self._task
