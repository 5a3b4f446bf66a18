"""`openacr mill teach`: the position of the machine as the zero of a work system."""

from typing import Annotated

import typer

from openacr.cli.mill.check import AtStore, opened_store
from openacr.cli.mill.shop import AtHost, workshop


def teach_system(
    code: Annotated[str, typer.Argument(metavar="G54..G59.2", help="Work system.")],
    host: AtHost,
    axes: Annotated[str, typer.Option("--axes", help="Names of the axes, e.g. XY; else all.")] = "",
    store: AtStore = None,
) -> None:
    """TEACH: where the machine stands becomes the zero of a work system."""
    from openacr.mill.manual.teaching import teach

    with opened_store(store, is_written=True) as cells, workshop(host, cells) as shop:
        settings = shop.runner.settings
        chosen = [settings.named(name) for name in axes.upper() or settings.names()]
        here = shop.runner.stream.host.position()
        teach(shop.cells, settings, code, here, [axis.index for axis in chosen])
        names = " ".join(axis.name for axis in chosen)
        typer.echo(f"{code.upper()}: {names} read 0 here")
