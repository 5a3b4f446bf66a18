"""The port of a web server, and the server that leaves signals to its caller."""

import socket
from collections.abc import Iterator
from contextlib import contextmanager

import uvicorn

from openacr.io.listening import bound_socket


class QuietServer(uvicorn.Server):
    """A web server that leaves signals to the caller."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle no signals: uvicorn would raise them again after its end."""
        yield


def bound(address: str, port: int, option: str) -> socket.socket:
    """A socket that listens; 0 takes a free port. UserError says why it cannot."""
    listening = bound_socket(address, port, socket.SOCK_STREAM, option)
    # Connections inherit it. Head and body of an answer are two writes: without it the second
    # one waits for the acknowledgement of the first, up to 40 ms.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listening
