"""`openacr debug`: the debugger for editors (Debug Adapter Protocol)."""

import socket
import sys
from secrets import token_urlsafe
from typing import IO, Annotated, cast

import typer

from openacr.cli.signals import deaf, terminations_as_interrupts


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
    """Debug the programs of a card from an editor; those of a virtual card backwards, too.

    Speaks the Debug Adapter Protocol on standard input and output. A launch names a project
    ("program"), a journal of `openacr run` or `openacr serve` ("journal"), a part program
    ("partProgram") or the address of a card ("host"). A program that can reach the port could
    run the code of any project: with --port a launch has to bring the printed "secret".
    """
    from openacr.debugger.server import serve

    if port is None:
        # Unbuffered: a thread that waits in a buffer would hold its lock at the end.
        raw = open(sys.stdin.fileno(), "rb", buffering=0, closefd=False)
        messages, sys.stdout = sys.stdout.buffer, sys.stderr  # only messages go there
        with terminations_as_interrupts():
            serve(raw, messages, ending=deaf)
        return
    from openacr.io.listening import bound_socket

    with bound_socket("127.0.0.1", port, socket.SOCK_STREAM, "--port") as listener:
        secret = token_urlsafe(16)
        place = f"127.0.0.1:{listener.getsockname()[1]}"
        typer.echo(f'launch with "secret": "{secret}"')
        typer.echo(f"waiting for a debugger client at {place}")
        connection, _ = listener.accept()  # the first client; no other gets in
    # Unbuffered, as above: to close a buffer in which a thread waits would wait for the client.
    stream = cast("IO[bytes]", connection.makefile("rwb", buffering=0))
    with connection, terminations_as_interrupts():
        serve(stream, stream, ending=deaf, secret=secret)
