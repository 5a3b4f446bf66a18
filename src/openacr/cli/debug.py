"""`openacr debug`: the debugger for editors (Debug Adapter Protocol)."""

import socket
import sys
from typing import Annotated

import typer

from openacr.errors import UserError


def debug(
    port: Annotated[
        int | None,
        typer.Option(
            min=0,
            max=65535,
            help="Wait for one client on this TCP port of this computer (0: any free) instead of"
            " standard input and output.",
        ),
    ] = None,
) -> None:
    """Debug the programs of a virtual card from an editor, forwards and backwards.

    Speaks the Debug Adapter Protocol on standard input and output. A launch names a project
    ("program") or a journal of `openacr run` or `openacr serve` ("journal").
    """
    from openacr.debugger.server import serve

    if port is None:
        # Unbuffered: a thread that waits in a buffer would hold its lock at the end.
        raw = open(sys.stdin.fileno(), "rb", buffering=0, closefd=False)
        messages, sys.stdout = sys.stdout.buffer, sys.stderr  # only messages go there
        serve(raw, messages)
        return
    try:
        listener = socket.create_server(("127.0.0.1", port))
    except OSError as failure:
        raise UserError(f"port {port} cannot be opened: {failure.strerror}") from None
    with listener:
        typer.echo(f"waiting for a debugger client at 127.0.0.1:{listener.getsockname()[1]}")
        connection, _ = listener.accept()
        with (
            connection,
            connection.makefile("rb") as incoming,
            connection.makefile("wb") as outgoing,
        ):
            serve(incoming, outgoing)
