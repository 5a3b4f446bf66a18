"""`openacr serve`: a card on the network, in real time."""

import asyncio
import gc
import logging
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.channels import ASCII_PORT, BINARY_PORT
from openacr.cli.guests import Allow, Insecure, admitted
from openacr.cli.serve_on_bus import Served, agreed, world_on_bus
from openacr.cli.serve_realtime import (
    RealtimeOptions,
    agreed_realtime,
    in_real_time,
    not_in_real_time,
)
from openacr.cli.signals import stop_on_signals
from openacr.errors import StoreError, UserError
from openacr.protocol.status import STATUS_PORT

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.host import CardHost
    from openacr.io.serial_port import LineSettings
    from openacr.io.server import Address, CardServer, Guests
    from openacr.plant.describe.schema import World

log = logging.getLogger(__name__)
BAD_INPUT = 2


def serve(
    project: Annotated[
        Path | None,
        typer.Argument(
            metavar="PROJECT", help="Project folder or .8k file; default: eight exact axes."
        ),
    ] = None,
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    allow: Allow = None,
    insecure: Insecure = False,
    ascii_port: Annotated[
        int, typer.Option(help="Port for terminal and packets; 0: any free.")
    ] = ASCII_PORT,
    binary_port: Annotated[
        int, typer.Option(help="Port for packets only; 0: any free.")
    ] = BINARY_PORT,
    status_port: Annotated[
        int | None,
        typer.Option(
            help="UDP port for fast status; 0: any free; default: 5003 beside 5002, else off."
        ),
    ] = None,
    serial: Annotated[str | None, typer.Option(help="Serial port to serve as well.")] = None,
    baud: Annotated[
        int | None,
        typer.Option(min=1, help="Baud rate of the serial port; default: P7013, else 38400."),
    ] = None,
    speed: Annotated[float, typer.Option(help="Ratio of card time to real time.")] = 1.0,
    data: Annotated[
        Path | None, typer.Option(help="Folder for the nonvolatile memory of the card.")
    ] = None,
    journal: Annotated[
        Path | None,
        typer.Option(help="Folder for the journal of the last minutes; default: inside --data."),
    ] = None,
    no_journal: Annotated[
        bool, typer.Option("--no-journal", help="Keep no journal of the last minutes.")
    ] = False,
    bus: Annotated[
        str | None,
        typer.Option(
            metavar="IFACE",
            help="Interface of the bus in place of that of machine.toml; emulated: the devices of"
            " machine.toml in memory; none: all is modelled.",
        ),
    ] = None,
    is_real: Annotated[
        bool,
        typer.Option("--real", help="Let real drives be enabled, outputs be sent; asks first."),
    ] = False,
    is_sure: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    is_real_time: Annotated[
        bool,
        typer.Option(
            "--realtime", help="A loop of its own keeps the servo period, whatever Python does."
        ),
    ] = False,
    core: Annotated[
        int | None, typer.Option(min=0, help="Processor core of the loop of --realtime.")
    ] = None,
    silence: Annotated[
        float | None,
        typer.Option(help="Seconds without Python after which programs pause; default 1."),
    ] = None,
    is_reported: Annotated[
        bool,
        typer.Option(
            "--report-bus",
            help="Print the state of the bus as lines of JSON; the line `reset` on standard input"
            " sets its counters to 0, the end of standard input ends the card.",
        ),
    ] = False,
) -> None:
    """Run a card in real time and serve hosts over TCP and serial lines.

    With --data saved parameters, user flash and battery-backed memory survive the process.
    The journal of the last minutes can be replayed with `openacr replay`. Drives and nodes of a bus
    in machine.toml are read; only with --real can drives be enabled and outputs be switched. A card
    with a bus, or with --realtime, keeps no journal.
    """
    guests = admitted(host, allow, is_open=insecure)
    world = world_on_bus(project, bus)
    agreed_realtime(is_on=is_real_time, core=core, silence_s=silence, speed=speed)
    if is_reported and (world is None or world.bus is None):
        raise UserError("--report-bus: the bus of the project is not opened, or it has none")
    if is_real_time and (why := not_in_real_time(world, bus)):
        raise UserError(f"--realtime: {why}; leave the option out")
    interface = agreed(world, bus, speed, is_real=is_real, is_sure=is_sure)
    card = _load(project, data, world)
    try:
        if not (no_journal or is_real_time) and world is None:
            _keep_journal(card, journal or (data / "journal" if data else None))
        ports = Ports(
            host,
            ascii_port,
            binary_port,
            serial,
            _line(card, baud),
            STATUS_PORT if status_port is None and ascii_port == ASCII_PORT else status_port,
            is_status_wanted=status_port is not None,
        )
        if is_real_time:
            options = RealtimeOptions(core, silence, world, interface, is_real, is_reported)
            with in_real_time(card, options) as live:
                asyncio.run(
                    serve_card(live.card, ports, speed, guests, live.begin, keeps_time=True)
                )
        elif world is None:
            asyncio.run(serve_card(card, ports, speed, guests))
        else:
            served = Served(card, world, interface, is_real=is_real, is_reported=is_reported)
            with closing(served):
                asyncio.run(serve_card(card, ports, speed, guests, served.begin))
    finally:
        card.close()


@dataclass(frozen=True, slots=True)
class Ports:
    """Addresses of a served card."""

    host: str = "127.0.0.1"
    ascii: int = 0
    binary: int = 0
    serial: str | None = None
    line: "LineSettings | None" = None
    status: int | None = None  # of UDP; None: no status service
    is_status_wanted: bool = True  # without it a port in use is a warning


def _line(card: "Controller", baud: int | None) -> "LineSettings":
    """The settings of the serial port: an option, else those of COM1 on the card."""
    from openacr.io.serial_port import LineSettings
    from openacr.map.numbers import P_COM1_STARTUP_MODE

    if baud is not None:
        return LineSettings(baud=baud)
    return LineSettings.of(int(card.p[P_COM1_STARTUP_MODE])) or LineSettings()


def _keep_journal(card: "Controller", folder: Path | None) -> None:
    """Keep the journal in a folder; default: one of the user's that no other card uses."""
    from openacr.cli.run.journals import ring_root
    from openacr.controller.ring import Ring, own_ring

    if folder is not None:
        card.recorder = Ring(card, folder)
        return
    try:
        card.recorder = own_ring(card, ring_root())
    except StoreError as failure:
        log.warning("no journal is kept: %s", failure)


def _load(path: Path | None, data: Path | None, world: "World | None") -> "Controller":
    """A card with a project; refused lines are printed and end it with exit code 2."""
    from openacr.controller import Controller
    from openacr.errors import SourceError
    from openacr.plant.describe.real_world import real_world
    from openacr.plant.describe.schema import exact_world
    from openacr.project import find_project

    if path is None:
        card, refused = Controller(world=exact_world(), data=data), list[SourceError]()
    else:
        card, refused = Controller.load(
            find_project(path), data=data, world=world and real_world(world)
        )
    for notice in card.nonvolatile.notices:
        typer.echo(f"warning: {notice}", err=True)
    for error in refused:
        typer.echo(f"error: {error}", err=True)
    if refused:
        card.close()
        raise typer.Exit(BAD_INPUT)
    card.is_journalled = False  # it may run for months
    return card


async def serve_card(
    card: "CardHost",
    ports: Ports,
    speed: float = 1.0,
    guests: "Guests | None" = None,
    begin: Callable[[], None] | None = None,
    *,
    keeps_time: bool = False,
) -> None:
    """Serve until SIGTERM, SIGHUP or Ctrl-C; prints one line when everything listens.

    `begin` is called last of all before the first tick. A card that `keeps_time` has a loop of its
    own for that.
    """
    from openacr.channels import StreamKind
    from openacr.io.serial_port import LineSettings
    from openacr.io.server import CardServer

    stop = asyncio.Event()
    stop_on_signals(stop.set)
    server = CardServer(card, speed=speed, allowed=guests, keeps_time=keeps_time)
    try:
        terminal = await server.listen(StreamKind.TERMINAL, ports.host, ports.ascii)
        packets = await server.listen(StreamKind.PACKETS, ports.host, ports.binary)
        status = await _listen_status(server, ports)
        if ports.serial is not None:
            server.open_serial(ports.serial, ports.line or LineSettings())
        gc.collect()
        gc.freeze()  # what is loaded now stays: later collections are short
        if begin is not None:
            begin()
    except BaseException:
        await server.close()
        raise
    _announce(terminal, packets, server.allowed, status=status, serial=ports.serial)
    await server.run(stop)
    log.info("%s", server.report())


async def _listen_status(server: "CardServer", ports: Ports) -> "Address | None":
    """Open the UDP port; the card goes on without it unless it was asked for."""
    if ports.status is None:
        return None
    try:
        return await server.listen_status(ports.host, ports.status)
    except UserError as failure:
        if ports.is_status_wanted:
            raise
        log.warning("no status over UDP: %s", failure)
        return None


def _announce(
    terminal: "Address",
    packets: "Address",
    guests: "Guests",
    *,
    status: "Address | None",
    serial: str | None,
) -> None:
    if not terminal.is_loopback:
        typer.secho(
            f"WARNING: {terminal} can be reached from other machines. The card's protocols"
            f" have no passwords and no encryption: {guests} can move axes and change"
            " programs. Use this in a trusted network only.",
            fg=typer.colors.RED,
            bold=True,
            err=True,
        )
    others = (("serial", serial), ("status", status))
    named = "".join(f" {name}={place}" for name, place in others if place is not None)
    print(f"listening ascii={terminal} binary={packets}{named}", flush=True)
