"""`openacr lsp`: the language server for editors."""

import gc
import logging
import sys
from pathlib import Path
from socket import SOCK_STREAM as STREAM
from typing import Annotated

import typer

from openacr.cli.imports import imports
from openacr.cli.mill.check import AtStore, Dialect
from openacr.errors import UserError, reason
from openacr.io.listening import bound_socket

HOST = "127.0.0.1"
LAST_PORT = 65535
TURN_S = 0.0005  # a check gives way to a question after this time
MOST_OBJECTS = 2_000_000  # until a collection, which answers wait for
MISSING = "the language server needs pygls: pip install 'openacr[lsp]'"


def lsp(
    tcp: Annotated[
        int | None,
        typer.Option(metavar="PORT", help="Serve one client on this port of this computer."),
    ] = None,
    store: AtStore = None,
    dialect: Dialect = None,
    log: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write what goes wrong into this file.")
    ] = None,
) -> None:
    """Serve an editor: findings, proposals, names and more for controller files and part programs.

    The Language Server Protocol over standard input and output. --store and --dialect say for
    which machine and in which dialect part programs are read, as for `openacr mill check`.
    """
    if tcp is not None and not 0 < tcp <= LAST_PORT:
        raise UserError(f"--tcp {tcp}: a port is a number from 1 to {LAST_PORT}")
    _log_to(log)
    try:
        import pygls  # noqa: F401
    except ImportError:
        raise UserError(MISSING) from None
    with imports():
        from openacr.language_server.features import serve
        from openacr.language_server.server import Server
    server = Server(store, dialect)
    gc.set_threshold(MOST_OBJECTS)
    sys.setswitchinterval(TURN_S)
    if tcp is None:
        serve(server)
        return
    with bound_socket(HOST, tcp, STREAM, "--tcp PORT", takes_zero=False) as listener:
        typer.echo(f"listening lsp={HOST}:{tcp}", err=True)
        serve(server, listener)


def _log_to(path: Path | None) -> None:
    """Messages go into a file or nowhere: standard output is the protocol."""
    if path is None:
        logging.getLogger().addHandler(logging.NullHandler())
        return
    try:
        handler = logging.FileHandler(path)
    except OSError as error:
        raise UserError(f"{path}: {reason(error)}") from None
    logging.basicConfig(level=logging.WARNING, handlers=[handler])
