"""`openacr mill zero set`, `clear` and `goto`: the floating zero of a machine."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import AtStore, opened_store
from openacr.cli.mill.shop import AtHost, end_with_alarms, place_text, workshop
from openacr.cli.mill.terminal import Attendant

if TYPE_CHECKING:
    from openacr.cnc.canonical import Point
    from openacr.mill.session import MillSession

OfAxes = Annotated[str, typer.Option("--axes", help="Axis names, e.g. XY; default: all.")]


def set_floating_zero(host: AtHost, axes: OfAxes = "", store: AtStore = None) -> None:
    """Set the floating zero of axes to their present position (SET ZERO); nothing moves.

    As G92: the shift applies to every work system and is kept until CLR ZERO.
    """
    from openacr.mill.zeroing import set_zero

    with opened_store(store, is_written=True) as cells, workshop(host, cells) as shop:
        _show(shop, [set_zero(shop, _chosen(shop, axes))])


def clear_floating_zero(host: AtHost, store: AtStore = None) -> None:
    """Clear the floating zero of all axes (CLR ZERO); nothing moves."""
    from openacr.mill.zeroing import clear_all

    with opened_store(store, is_written=True) as cells, workshop(host, cells) as shop:
        _show(shop, [clear_all(shop)])


def go_to_zero(host: AtHost, axes: OfAxes = "", store: AtStore = None) -> None:
    """Move to the floating zero in rapids (GOTO ZERO); Z first if upward, else last."""
    from openacr.mill.zeroing import goto_zero

    with opened_store(store, is_written=True) as cells, workshop(host, cells) as shop:
        _show(shop, goto_zero(shop, _chosen(shop, axes), Attendant()))
        end_with_alarms(shop)


def _chosen(shop: "MillSession", axes: str) -> list[int]:
    settings = shop.runner.settings
    return [settings.named(name).index for name in axes.upper() or settings.names()]


def _show(shop: "MillSession", places: "Iterable[Point]") -> None:
    """Print program positions."""
    for place in places:
        typer.echo(place_text(shop, place))
