"""`openacr panel`: AcroMill's screens in a browser."""

import asyncio
import socket
import sys
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.bridge import begin
from openacr.cli.imports import imports
from openacr.cli.signals import stop_on_signals
from openacr.errors import OpenacrError, UserError

if TYPE_CHECKING:
    from openacr.bridge.process import BridgeProcess
    from openacr.panel.control.machine.installation import Installation
    from openacr.panel.machine.project import OnBus
    from openacr.panel.server.panel import Panel
    from openacr.panel.server.web import PanelServer

PORT = 5080
LOOK_S = 30.0  # for what differs from the project, at the end
MISSING = "the panel needs more packages: pip install 'openacr[panel]'"


def panel(
    machine: Annotated[
        str | None,
        typer.Argument(
            metavar="[PROJECT | HOST[:PORT] | SERIAL]",
            help="A project folder, or a card; else a virtual mill.",
        ),
    ] = None,
    port: Annotated[int, typer.Option(help="Port of the web server; 0: any free.")] = PORT,
    address: Annotated[
        str, typer.Option(help="Address to listen on; others than this computer need a password.")
    ] = "127.0.0.1",
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Open no browser.")] = False,
    store: Annotated[
        Path | None,
        typer.Option(
            metavar="PATH",
            help="File of the store (else that of the virtual mill, else as `openacr mill`).",
        ),
    ] = None,
    programs: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Folder of part programs.")
    ] = None,
    is_agreed: Annotated[
        bool,
        typer.Option("--set-up", help="Set a card up for AcroMill at the start, as SET UP does."),
    ] = False,
    names: Annotated[
        list[str] | None,
        typer.Option("--name", metavar="HOST", help="A name by which browsers reach this server."),
    ] = None,
    bridge: Annotated[
        Path | None,
        typer.Option("--bridge", metavar="FILE", help="Bridge file: values for other systems."),
    ] = None,
    bus: Annotated[
        str | None,
        typer.Option(
            metavar="IFACE",
            help="Open the bus of the project at this interface; emulated: in memory.",
        ),
    ] = None,
    is_real: Annotated[
        bool,
        typer.Option("--real", help="Open the bus and let its drives be enabled; asks first."),
    ] = False,
    is_sure: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    set_password: Annotated[
        str | None,
        typer.Option(
            "--set-password",
            metavar="ROLE",
            help="Set the password of view, operate, setup or service, and end.",
        ),
    ] = None,
) -> None:
    """Open AcroMill's screens in a browser, on a virtual mill or on a card.

    The machine stays under the control of this process: closing the browser stops keys that
    are held, not a program. Ctrl-C brings the machine to rest and ends the server.
    """
    _require_packages()
    opened = _bus(machine, bus, is_real=is_real, is_sure=is_sure)
    _require_places(machine, programs)
    if set_password is None:
        print("starting the panel ...", file=sys.stderr, flush=True)
    with imports():
        import openacr.panel.machine
        import openacr.panel.server.web  # noqa: F401
    installation = _installation(machine, store, programs, opened)
    installation.is_agreed |= is_agreed
    try:
        if set_password is not None:
            _set_password(installation, set_password)
            return
        panel, server = _server(installation, address, port, names or [])
        with server.socket:
            bridging = None if bridge is None else _bridge(panel, bridge)
            asyncio.run(_serve(panel, server, bridging, is_shown=not no_browser))
    finally:
        installation.close()


def _require_packages() -> None:
    try:
        import starlette  # noqa: F401
        import uvicorn  # noqa: F401
    except ImportError:
        raise UserError(MISSING) from None


def _bus(machine: str | None, bus: str | None, *, is_real: bool, is_sure: bool) -> "OnBus | None":
    """The bus that is opened, once the operator has agreed to real drives."""
    if bus is None and not is_real:
        return None
    from openacr.cli.serve_on_bus import agreed, world_on_bus
    from openacr.cli.serve_realtime import missing_for_real_time
    from openacr.panel.machine.project import OnBus

    if machine is None or not Path(machine).is_dir():
        raise UserError("--bus and --real need a project: its machine.toml describes the bus")
    world = world_on_bus(Path(machine), bus)
    if not agreed(world, bus, 1.0, is_real=is_real, is_sure=is_sure) or world is None:
        return None
    why = missing_for_real_time(world, bus)
    if why:
        typer.echo(f"the bus is not served in real time: {why}", err=True)
    return OnBus(bus, is_real, is_real_time=not why)


def _require_places(machine: str | None, programs: Path | None) -> None:
    """Refuse mistyped places before anything that takes long."""
    if machine is None:
        return  # the virtual mill makes its folders
    if programs is not None and not programs.is_dir():
        raise UserError(f"--programs {programs}: there is no such folder")
    if not Path(machine).is_dir():
        _require_link(machine)


def _installation(
    machine: str | None, store: Path | None, programs: Path | None, bus: "OnBus | None" = None
) -> "Installation":
    import platformdirs

    from openacr.client.links import wire_to
    from openacr.panel.control.machine.installation import Installation
    from openacr.panel.machine import embedded
    from openacr.panel.machine.project import of_project
    from openacr.starter.folders import ensure
    from openacr.sysvar.location import open_to_write

    data = platformdirs.user_data_path("openacr") / "panel"
    if machine is None:
        return embedded(store.parent if store else data, store=store, programs=programs)
    folder = programs or data / "programs"
    if not Path(machine).is_dir():
        wire_to(machine)  # what is no address is refused before anything is opened
        ensure(folder)
        return Installation.at(machine, open_to_write(store), folder)
    return of_project(Path(machine), store=store, programs=programs, otherwise=folder, bus=bus)


def _require_link(machine: str) -> None:
    """Refuse a mistyped path of a project; a port that is not plugged in yet is waited for."""
    place = Path(machine)
    if place.is_file():
        raise UserError(
            f"{machine} is a file: a project is a folder (--programs for part programs)"
        )
    is_port = place.exists() or machine.startswith("/dev/")
    if "/" in machine and not is_port:
        raise UserError(f"{machine}: there is no such folder, nor such a serial port")
    if machine.isidentifier() and not machine.upper().startswith("COM") and not _is_host(machine):
        raise UserError(f"{machine}: there is no such folder, and no host has this name")


def _is_host(name: str) -> bool:
    try:
        socket.getaddrinfo(name, None)
    except OSError:
        return False
    return True


def _set_password(installation: "Installation", word: str) -> None:
    from openacr.panel.roles import Role
    from openacr.panel.server.accounts import Accounts, file_of

    try:
        role = Role.of(word)
    except ValueError as error:
        raise UserError(f"--set-password: {error}") from None
    secret = typer.prompt(
        f"New password of the role {role.word} (empty: none)",
        hide_input=True,
        confirmation_prompt=True,
        default="",
        show_default=False,
    )
    Accounts(file_of(installation.store.path), installation.store).set_password(role, secret)
    typer.echo(f"the password of the role {role.word} was {'set' if secret else 'removed'}")


def _server(
    installation: "Installation", address: str, port: int, names: list[str]
) -> "tuple[Panel, PanelServer]":
    from openacr.cli.run.journals import ring_root
    from openacr.io.server import is_loopback
    from openacr.panel.server.panel import Panel, require_password
    from openacr.panel.server.web import PanelServer

    panel = Panel(installation, journals=ring_root())
    require_password(panel, address, is_loopback=is_loopback(address))
    return panel, PanelServer(panel, address, port, names=[*names, address])


def _bridge(panel: "Panel", file: Path) -> "BridgeProcess":
    from openacr.bridge.load import load_bridge
    from openacr.bridge.process import BridgeProcess
    from openacr.bridge.station_feed import StationFeed

    def say(text: str) -> None:
        panel.control.call(lambda station: station.screens.say(text))

    return BridgeProcess(load_bridge(file), file.parent, StationFeed(panel.control), say)


async def _serve(
    panel: "Panel", server: "PanelServer", bridging: "BridgeProcess | None", *, is_shown: bool
) -> None:
    panel.station.link.on_change = lambda why: _report_link(panel.installation.name, why)
    failed: list[UserError] = []

    async def started() -> None:
        print(f"panel {server.url}", flush=True)
        if bridging is not None:
            try:
                await asyncio.to_thread(begin, bridging)
            except UserError as error:
                failed.append(error)
                server.stop()
                return
        if is_shown and sys.stdout is not None:
            await asyncio.to_thread(webbrowser.open, server.url)

    stop_on_signals(server.stop, _Leaving(panel, server).interrupted)
    try:
        await server.serve(started)
    finally:
        if bridging is not None:
            await asyncio.to_thread(bridging.stop)
    if failed:
        raise failed[0]


class _Leaving:
    """Ctrl-C: of programs that differ from the project it says what is lost, and asks once."""

    def __init__(self, panel: "Panel", server: "PanelServer") -> None:
        self._panel, self._server = panel, server
        self._asking: asyncio.Task[None] | None = None

    def interrupted(self) -> None:
        """Look for what would be lost; a second Ctrl-C ends the panel in any case."""
        if self._asking is not None:
            self._server.stop()
            return
        self._asking = asyncio.create_task(self._ask())

    async def _ask(self) -> None:
        from openacr.panel.server.calls.project import differences

        try:
            lost = await asyncio.wait_for(differences(self._panel), LOOK_S)
        except (OpenacrError, TimeoutError):  # the card is not there, or the past is looked at
            lost = []
        is_asked = bool(lost) and sys.stdin is not None and sys.stdin.isatty()
        if lost:
            name = self._panel.installation.name
            what = "differs" if len(lost) == 1 else "differ"
            print(
                f"{', '.join(lost)} of the card {what} from the project {name}:"
                " SAVE INTO PROJECT in the Editor of /bench keeps a program",
                file=sys.stderr,
                flush=True,
            )
        if is_asked:
            print("Ctrl-C again ends the panel without it", file=sys.stderr, flush=True)
        else:
            self._server.stop()


def _report_link(name: str, why: str) -> None:
    """Say in the terminal why the machine cannot be used, and when it can again."""
    text = f"{name}: {why}; it is tried again" if why else f"{name}: connected"
    print(text, file=sys.stderr, flush=True)
