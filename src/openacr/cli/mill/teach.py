"""`openacr mill teach`: set the zero of a work system to the present position."""

from typing import Annotated

import typer

from openacr.cli.mill.check import AtStore, opened_store
from openacr.cli.mill.shop import AtHost, workshop


def teach_system(
    code: Annotated[str, typer.Argument(metavar="G54..G59.2", help="Work system.")],
    host: AtHost,
    axes: Annotated[str, typer.Option("--axes", help="Axis names, e.g. XY; default: all.")] = "",
    store: AtStore = None,
) -> None:
    """Set the zero of a work system to the present position (TEACH)."""
    from openacr.mill.manual.teaching import teach

    with opened_store(store, is_written=True) as cells, workshop(host, cells) as shop:
        settings = shop.runner.settings
        chosen = [settings.named(name) for name in axes.upper() or settings.names()]
        here = shop.runner.stream.host.position()
        teach(shop.cells, settings, code, here, [axis.index for axis in chosen])
        names = " ".join(axis.name for axis in chosen)
        typer.echo(f"{code.upper()}: {names} read 0 here")
