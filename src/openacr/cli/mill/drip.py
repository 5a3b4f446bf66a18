"""`openacr mill drip` and `receive`: part programs received over a serial line."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import AtStore, Dialect, Dry, opened_store
from openacr.cli.mill.shop import ToHost, end_with_alarms, workshop
from openacr.cli.mill.terminal import Attendant
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.mill.session import MillSession

STARVED_S = 0.02

FromPort = Annotated[
    str, typer.Option("--port", metavar="SERIAL", help="Serial port; default: that of the store.")
]


def drip_program(
    port: FromPort = "",
    host: ToHost = None,
    store: AtStore = None,
    dialect: Dialect = None,
    is_dry: Dry = False,
) -> None:
    """Run a part program while it arrives over a serial line.

    Line and handshake are those of P750000 and up. The machine starts when DripFeed
    Threshold blocks have arrived, waits on its path while the sender stalls, and ends with M2
    or Ctrl-Z.
    """
    from openacr.mill.config.communications import Line
    from openacr.mill.config.dialects import dialect_of
    from openacr.mill.config.folders import folders_of
    from openacr.mill.run.dripping import Drip
    from openacr.mill.session import Start

    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        name = dialect_of(None, cells, dialect)
        folders = folders_of(cells, cells.path.parent if cells.path else None)
        drip = Drip(Line.of(cells, port), shop.cells, name, is_dry=is_dry, folders=folders)
        shop.keep_drip(drip)
        shop.start_drip(drip, Start(dialect=name, is_dry=is_dry))
        _run(shop)
        typer.echo(counted(shop.runner.stream.moves, "move"))
        end_with_alarms(shop)


def _run(shop: "MillSession") -> None:
    attend = Attendant()
    while shop.runner.is_busy:
        shop.step()
        attend(shop)
        if shop.runner.stream.is_starved:
            time.sleep(STARVED_S)  # a virtual machine would wait at full speed


def receive_program(
    file: Annotated[Path, typer.Argument(metavar="FILE.TXT", help="File for the program.")],
    port: FromPort = "",
    store: AtStore = None,
    replaces: Annotated[bool, typer.Option("--force", help="Replace a file.")] = False,
) -> None:
    """Receive a part program over a serial line and store it as a file (LINK)."""
    from openacr.cli.run.output import write_whole
    from openacr.mill.config.communications import Line
    from openacr.mill.run.receiving import Patience, Reception

    if file.exists() and not replaces:
        raise UserError(f"{file} exists; --force replaces it")
    with opened_store(store) as cells:
        line = Line.of(cells, port)
    program = Reception(line, Patience()).run() or b""  # never cancelled: Ctrl-C ends the command
    write_whole(file, lambda partial: _write(partial, program))
    typer.echo(f"{file}: {len(program)} bytes")


def _write(file: Path, program: bytes) -> None:
    file.write_bytes(program)
