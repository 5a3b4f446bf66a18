"""The port of a web server, and the server that leaves signals to its caller."""

import asyncio
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from itertools import count
from typing import Any

import uvicorn
from websockets.exceptions import InvalidState

from openacr.io.listening import bound_socket

TICK_S = 0.1  # uvicorn counts its housekeeping in these


class QuietServer(uvicorn.Server):
    """A web server that leaves signals to the caller, and ends at once when it is asked to."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self._ends = asyncio.Event()

    def end(self) -> None:
        """End it; call it in its loop."""
        self.should_exit = True
        self._ends.set()

    async def main_loop(self) -> None:
        """Serve until the end; uvicorn would look for it every tick alone."""
        ticks = count()
        while not await self.on_tick(next(ticks)):
            with suppress(TimeoutError):
                async with asyncio.timeout(TICK_S):
                    await self._ends.wait()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Close everything; only connections that are still open are given time."""
        if self.server_state.connections or self.server_state.tasks:
            for connection in self.server_state.connections:
                vars(connection)["shutdown"] = partial(_shut, connection, connection.shutdown)
            await super().shutdown(sockets)
            return
        for listening in (*self.servers, *(sockets or ())):
            listening.close()
        await self.lifespan.shutdown()

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle no signals: uvicorn would raise them again after its end."""
        yield


def _shut(connection: Any, shutdown: Callable[[], None]) -> None:
    """Shut a connection down; that a WebSocket is just closing is no error, as uvicorn has it."""
    try:
        shutdown()
    except InvalidState:
        connection.transport.close()


def bound(address: str, port: int, option: str) -> socket.socket:
    """A socket that listens; 0 takes a free port. UserError says why it cannot."""
    listening = bound_socket(address, port, socket.SOCK_STREAM, option)
    # Connections inherit it. Head and body of an answer are two writes: without it the second
    # one waits for the acknowledgement of the first, up to 40 ms.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listening
