"""`openacr mill mdi`, `jog`, `home`, `acknowledge`: manual operation of the machine."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import AtStore, Dialect, opened_store
from openacr.cli.mill.shop import AtHost, ToHost, end_with_alarms, place_text, workshop
from openacr.cli.mill.terminal import Attendant
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.mill.session import MillSession


def jog_axes(
    distances: Annotated[list[str], typer.Argument(metavar="DISTANCE...", help="X0.5 Y-1")],
    host: AtHost,
    store: AtStore = None,
) -> None:
    """Move axes of a card by hand: X0.5 Y-1."""
    from openacr.mill.manual.jogging import distances as distances_of

    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        names = [axis.name for axis in shop.runner.settings.axes]
        shop.jog(distances_of(distances, names), Attendant())
        typer.echo(place_text(shop, shop.runner.stream.host.position()))
        end_with_alarms(shop)


def run_blocks(
    blocks: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[BLOCK]...", help='"G0 X1" "M3 S500"; default: from standard input.'
        ),
    ] = None,
    host: ToHost = None,
    store: AtStore = None,
    dialect: Dialect = None,
    save: Annotated[
        Path | None, typer.Option("--save", metavar="FILE", help="Save the blocks as a program.")
    ] = None,
) -> None:
    """Run single blocks on the virtual machine or on a card (MDI).

    Blocks are those of the command line, or lines of the terminal until an empty one.
    """
    from openacr.cli.run.output import require_writable, write_text
    from openacr.mill.config.dialects import dialect_of

    if save is not None:
        require_writable(save)
    attend = Attendant()
    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        name = dialect_of(None, cells, dialect)
        typed = blocks or (_piped() if shop.is_virtual or not attend.is_there else _typed(attend))
        try:
            for place in shop.run_blocks(typed, name, attend):
                typer.echo(place_text(shop, place))
        finally:
            if save is not None:
                write_text(save, "".join(f"{block}\n" for block in shop.typed))
        end_with_alarms(shop)


def _piped() -> "Iterator[str]":
    """Lines that are piped in; those of a terminal until an empty one."""
    if sys.stdin.isatty():
        while line := typer.prompt("MDI", default="", show_default=False):
            yield line
    else:
        yield from filter(None, map(str.strip, sys.stdin))


def _typed(attend: Attendant) -> "Iterator[str | None]":
    """Lines of the terminal until an empty one; None while the next one is not typed yet."""
    while True:
        try:
            line = attend.answer("MDI:", "")
        except UserError:
            return  # the terminal was closed
        if line == "":
            return
        yield line


def home_axes(
    host: AtHost,
    axes: Annotated[
        str, typer.Option("--axes", help="Axis names, e.g. XYZ; default: all with a priority.")
    ] = "",
    store: AtStore = None,
) -> None:
    """Home axes of a card."""
    with opened_store(store, is_written=host is not None) as cells, workshop(host, cells) as shop:
        homed = shop.home(axes, _telling(Attendant()))
        has_failed = shop.runner.alarms.active or shop.runner.was_aborted
        without = "none" if has_failed else "no axis has a priority"
        typer.echo(f"homed: {' '.join(homed) or without}")
        end_with_alarms(shop)


def acknowledge_alarms(host: AtHost, store: AtStore = None) -> None:
    """Acknowledge the alarms of a card: clear alarms whose cause is gone, clear kills.

    Nothing moves, and drives stay as they are. Exit code 1 if an alarm stays active.
    """
    with opened_store(store, is_written=True) as cells, workshop(host, cells) as shop:
        shop.step()
        found = {(alarm.kind.code, alarm.text) for alarm in shop.runner.alarms.active}
        shop.runner.acknowledge()
        shop.step()
        stay = {(alarm.kind.code, alarm.text) for alarm in shop.runner.alarms.active}
        for code, text in sorted(found - stay):
            typer.echo(f"cleared: alarm {code}: {text}")
        if not found | stay:
            typer.echo("no alarms")
        end_with_alarms(shop)


def _telling(attend: "Callable[[MillSession], None]") -> "Callable[[MillSession], None]":
    """Attend the machine, and report each new wait."""
    shown = ""

    def watch(shop: "MillSession") -> None:
        nonlocal shown
        if shop.runner.reason and shop.runner.reason != shown:
            shown = shop.runner.reason
            typer.echo(shown, err=True)
        attend(shop)

    return watch
