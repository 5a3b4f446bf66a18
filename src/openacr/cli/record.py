"""`openacr record`: a proxy that records a session of hosts with a card."""

import asyncio
import logging
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.channels import ASCII_PORT, BINARY_PORT, StreamKind
from openacr.cli.guests import Allow, Insecure, admitted
from openacr.cli.signals import stop_on_signals
from openacr.errors import UserError, unwritable

if TYPE_CHECKING:
    from openacr.client.links import TcpLink
    from openacr.io.proxy import Proxy


log = logging.getLogger(__name__)


def record(
    target: Annotated[str, typer.Argument(metavar="HOST", help="Card: HOST or HOST:PORT.")],
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Recording: a new file.")],
    address: Annotated[
        str, typer.Option("--listen", metavar="ADDRESS", help="Address to listen on.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port for hosts; 0: any free.")] = ASCII_PORT,
    allow: Allow = None,
    insecure: Insecure = False,
    is_forced: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Record what hosts and a card send each other, with times; hosts connect to this computer.

    `openacr replay FILE` gives the recording to a virtual card and reports the first answer that
    differs. The file may hold passwords; it is readable by its owner alone. Ctrl-C ends it.
    """
    from openacr.client.links import TcpLink, wire_to
    from openacr.io.proxy import Proxy
    from openacr.io.recording import Recorder
    from openacr.store.private import open_to_write

    link = wire_to(target)
    if not isinstance(link, TcpLink):
        raise UserError(f"{target}: a serial line cannot be recorded; give HOST or HOST:PORT")
    guests = admitted(address, allow, is_open=insecure)
    if file.exists() and not is_forced:
        raise UserError(f"{file} is there already (--force replaces it)")
    _require_card(link)
    kind = StreamKind.PACKETS if link.address[1] == BINARY_PORT else StreamKind.TERMINAL
    try:
        output = open_to_write(file)
    except OSError as failure:
        raise unwritable(file, failure) from None
    with output:
        try:
            proxy = Proxy(link.address, Recorder(output, link.name, kind), guests)
        except OSError as failure:
            raise unwritable(file, failure) from None
        asyncio.run(_serve(proxy, link.name, address, port))
    typer.echo(f"{file}: {proxy.events} events", err=True)


def _require_card(link: "TcpLink") -> None:
    """Refuse a card that cannot be reached, before hosts are invited."""
    from openacr.client.errors import ConnectionLostError

    try:
        link.open()
    except ConnectionLostError as lost:
        raise UserError(str(lost)) from None
    link.close()


async def _serve(proxy: "Proxy", card: str, address: str, port: int) -> None:
    stop = asyncio.Event()
    stop_on_signals(stop.set)
    try:
        place = await proxy.listen(address, port)
        print(f"listening {place} card={card}", flush=True)
        await stop.wait()
    finally:
        await proxy.close()
