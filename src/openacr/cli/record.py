"""`openacr record`: a session of hosts with a card, recorded between them."""

import asyncio
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from openacr.channels import ASCII_PORT, BINARY_PORT, StreamKind
from openacr.cli.guests import Allow, Insecure, admitted
from openacr.cli.signals import stop_on_signals, terminations_as_interrupts
from openacr.errors import UserError, unwritable

if TYPE_CHECKING:
    from openacr.client.links import SerialLink, TcpLink
    from openacr.io.proxy import Proxy
    from openacr.io.recorded_session import SessionRecorder
    from openacr.io.server import Guests


class Session(NamedTuple):
    """A card whose hosts are recorded until `record` is ended."""

    card: str
    kind: StreamKind
    record: "Callable[[SessionRecorder], None]"


def record(
    target: Annotated[
        str, typer.Argument(metavar="CARD", help="Card: HOST, HOST:PORT or a serial port.")
    ],
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Recording: a new file.")],
    address: Annotated[
        str, typer.Option("--listen", metavar="ADDRESS", help="Address to listen on.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port for hosts; 0: any free.")] = ASCII_PORT,
    allow: Allow = None,
    insecure: Insecure = False,
    is_forced: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
    host_port: Annotated[
        str | None,
        typer.Option(metavar="SERIAL", help="Serial port to the host, if the card has one, too."),
    ] = None,
    baud: Annotated[int, typer.Option(min=1, help="Speed of both serial ports.")] = 38400,
) -> None:
    """Record what hosts and a card send each other, with times; hosts connect to this computer.

    A serial line is recorded between two ports of this computer, CARD and --host-port.
    `openacr replay FILE` gives the recording to a virtual card and reports the first answer that
    differs. The file may hold passwords; it is readable by its owner alone. Ctrl-C ends it.
    """
    from openacr.client.links import SerialLink, wire_to

    link = wire_to(target, baud)
    if file.exists() and not is_forced:
        raise UserError(f"{file} is there already (--force replaces it)")
    if file.exists() and not file.is_file():
        raise UserError(f"{file} is not a file that could be replaced")
    if isinstance(link, SerialLink):
        if host_port is None:
            raise UserError(f"{target} is recorded between two serial ports: give --host-port")
        recording = _line(link, host_port)
    elif host_port is not None:
        raise UserError(f"--host-port is for a card on a serial port, not for {target}")
    else:
        guests = admitted(address, allow, is_open=insecure)
        recording = _network(link, guests, address, port)
    with recording as session:
        _record(file, session)


def _record(file: Path, session: Session) -> None:
    """Record a session; a file that is there is kept until the session has its first bytes."""
    from openacr.io.recorded_session import SessionRecorder
    from openacr.store.private import Replacement

    try:
        new = Replacement(file)
    except OSError as failure:
        raise unwritable(file, failure) from None
    with closing(new):
        try:
            recorder = SessionRecorder(new, session.card, session.kind, new.take_place)
            if not file.exists():
                new.take_place()
        except OSError as failure:
            raise unwritable(file, failure) from None
        session.record(recorder)
        if new.is_in_place:
            typer.echo(f"{file}: {recorder.events} events", err=True)
    if recorder.failure is not None:
        raise unwritable(file, recorder.failure)
    if not new.is_in_place:
        typer.echo(f"{file}: nothing was sent; the file is as it was", err=True)


@contextmanager
def _network(link: "TcpLink", guests: "Guests", address: str, port: int) -> Iterator[Session]:
    """A card that hosts reach through this computer; refused before a file is made."""
    from openacr.io.proxy import Proxy

    def record(recorder: "SessionRecorder") -> None:
        proxy = Proxy(link.address, recorder, guests)
        asyncio.run(_serve(proxy, link.name, address, port))

    kind = StreamKind.PACKETS if link.address[1] == BINARY_PORT else StreamKind.TERMINAL
    _require_card(link)
    yield Session(link.name, kind, record)


@contextmanager
def _line(link: "SerialLink", host_port: str) -> Iterator[Session]:
    """A serial line through this computer; its ports are open before a file is made."""
    from openacr.io.serial_port import LineSettings
    from openacr.io.serial_tap import SerialTap

    def record(recorder: "SessionRecorder") -> None:
        with suppress(KeyboardInterrupt), terminations_as_interrupts():
            tap.start(recorder)
            print(f"joined {host_port} card={link.name}", flush=True)
            tap.wait()
        tap.close()
        if tap.has_failed:
            raise UserError(f"the line between {host_port} and {link.name} has failed")

    tap = SerialTap(host_port, link.name, LineSettings(baud=link.baud))
    try:
        yield Session(link.name, StreamKind.SERIAL, record)
    finally:
        tap.close()


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
