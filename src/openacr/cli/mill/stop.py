"""`openacr mill stop`: the machine to rest and everything off, whichever program drives it."""

import typer

from openacr.cli.mill.check import AtStore, opened_store
from openacr.cli.mill.shop import AtHost
from openacr.errors import UserError

FAILED = 1


def stop_machine(host: AtHost, store: AtStore = None) -> None:
    """Stop a machine and switch everything off, even if another program drives it.

    All masters and jogs of the card come to rest, gears and cams are disengaged, programs are
    halted; spindle, coolant and beam go off. If it does not come to rest, all drives go off
    (exit code 1). Its axes move no more before `openacr mill acknowledge`.
    The position is computed with the pulses per unit of the store, the default ones if
    there is no store; those of the card are not asked for.
    """
    from openacr.cli.signals import deaf
    from openacr.client import Card, Options
    from openacr.map.rows import axes as axis_rows
    from openacr.mill.card.driver import LINK_ERRORS
    from openacr.mill.card.leftovers import machine_of
    from openacr.mill.card.stopping import stop_all
    from openacr.mill.config.readout import Readout
    from openacr.mill.config.settings import Settings

    with opened_store(store) as cells:
        settings = Settings(cells)
        timeout_s = settings.link_timeout_s
        try:
            with deaf(), Card.open(host, Options(timeout_s=timeout_s, reconnect_s=0.0)) as card:
                stopped = stop_all(card, settings)
                counts = machine_of(card, settings).axis_values(axis_rows.current_position)
        except LINK_ERRORS as lost:
            raise UserError(f"the card cannot be reached: {lost}") from None
        place = [0.0] * 8
        for axis, count in zip(settings.axes, counts, strict=True):
            place[axis.index] = count / axis.pulses_per_unit
        where = Readout(cells).place([axis.index for axis in settings.axes], tuple(place))
    if stopped.cause is not None:
        typer.echo(f"alarm {stopped.cause.code}: {stopped.cause.text}")
    for text in stopped.moved:
        typer.echo(f"stopped: {text}")
    for text in stopped.found:
        typer.echo(f"switched off: {text}")
    if not stopped.rests:
        typer.echo("the machine did not come to rest: all drives are switched off", err=True)
        raise typer.Exit(FAILED)
    typer.echo(f"the machine is at rest at {where}; `openacr mill acknowledge` lets it move again")
