"""The end of the panel's web server, whatever its connections are doing."""

import asyncio
from types import SimpleNamespace
from typing import Any

import uvicorn
from websockets.exceptions import InvalidState

from openacr.panel.server.port import QuietServer


class Connection:
    """One of a server's connections; a WebSocket that `is_closing` refuses to be shut down."""

    def __init__(self, name: str, server: QuietServer, closed: list[str], *, is_closing: bool):
        self.name, self.server, self.closed, self.is_closing = name, server, closed, is_closing
        self.transport = self

    def shutdown(self) -> None:
        if self.is_closing:
            raise InvalidState("connection is closing")
        self.close()

    def close(self) -> None:
        """Of the transport."""
        self.closed.append(self.name)
        connections: Any = self.server.server_state.connections
        connections.discard(self)


def test_a_websocket_that_is_just_closing_keeps_no_other_connection_open() -> None:
    closed: list[str] = []

    async def shutdown() -> None:
        closed.append("lifespan")

    async def ends() -> None:
        server = QuietServer(uvicorn.Config(lambda: None))
        lifespan: Any = SimpleNamespace(shutdown=shutdown)
        server.lifespan, server.servers = lifespan, []
        connections: Any = server.server_state.connections
        connections.add(Connection("closing", server, closed, is_closing=True))
        connections.add(Connection("open", server, closed, is_closing=False))
        await server.shutdown()

    asyncio.run(ends())
    assert sorted(closed) == ["closing", "lifespan", "open"]
