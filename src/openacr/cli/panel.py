"""`openacr panel`: AcroMill's screens in a browser."""

import asyncio
import logging
import sys
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.signals import stop_on_signals
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.panel.control.installation import Installation

log = logging.getLogger(__name__)
PORT = 5080
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
    names: Annotated[
        list[str] | None,
        typer.Option("--name", metavar="HOST", help="A name by which browsers reach this server."),
    ] = None,
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
    installation = _installation(machine, store, programs)
    try:
        if set_password is not None:
            _set_password(installation, set_password)
            return
        asyncio.run(_serve(installation, address, port, names or [], is_shown=not no_browser))
    finally:
        installation.close()


def _require_packages() -> None:
    try:
        import starlette  # noqa: F401
        import uvicorn  # noqa: F401
    except ImportError:
        raise UserError(MISSING) from None


def _installation(machine: str | None, store: Path | None, programs: Path | None) -> "Installation":
    import platformdirs

    from openacr.client.links import wire_to
    from openacr.controller import Controller
    from openacr.panel.control.installation import Installation
    from openacr.panel.machine import embedded
    from openacr.sysvar.location import open_to_write

    data = platformdirs.user_data_path("openacr") / "panel"
    if machine is None:
        return embedded(store.parent if store else data, store=store, programs=programs)
    folder = programs or data / "programs"
    if programs is not None and not programs.is_dir():
        raise UserError(f"--programs {programs}: there is no such folder")
    if not Path(machine).is_dir():
        wire_to(machine)  # what is no address is refused before anything is opened
        folder.mkdir(parents=True, exist_ok=True)
        return Installation.at(machine, open_to_write(store), folder)
    project = Path(machine)
    own = project / "programs"
    folder = programs or (own if own.is_dir() else folder)
    folder.mkdir(parents=True, exist_ok=True)
    kept = project / "sysvar.db"
    cells = open_to_write(store or (kept if kept.is_file() else None))
    try:
        controller = Controller.from_project(project)
    except BaseException:
        cells.close()
        raise
    controller.is_journalled = False
    return Installation.inside(
        controller, cells, folder, kind="project", name=project.resolve().name
    )


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


async def _serve(
    installation: "Installation", address: str, port: int, names: list[str], *, is_shown: bool
) -> None:
    from openacr.cli.run.journals import ring_root
    from openacr.io.server import is_loopback
    from openacr.panel.server.panel import Panel, require_password
    from openacr.panel.server.web import PanelServer

    panel = Panel(installation, journals=ring_root())
    require_password(panel, address, is_loopback=is_loopback(address))
    server = PanelServer(panel, address, port, names=[*names, address])
    panel.station.on_link = lambda why: _report_link(installation.name, why)

    async def started() -> None:
        print(f"panel {server.url}", flush=True)
        if is_shown and sys.stdout is not None:
            await asyncio.to_thread(webbrowser.open, server.url)

    stop_on_signals(server.stop)
    await server.serve(started)


def _report_link(name: str, why: str) -> None:
    """Say in the terminal why the machine cannot be used, and when it can again."""
    text = f"{name}: {why}; it is tried again" if why else f"{name}: connected"
    print(text, file=sys.stderr, flush=True)
