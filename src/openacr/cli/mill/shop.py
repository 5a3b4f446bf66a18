"""The machine of a command: opened, and at rest behind it however the command ends."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.message import show_message
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.mill.session import MillSession
    from openacr.sysvar import Store

FAILED, INTERRUPTED = 1, 130
REST_S = 90.0  # longer than any wait of an ending: the card does not do what is commanded
LEFT_ALONE = "its watchdog stops it, if it has one; else it ends the moves it has, outputs stay on"

ToHost = Annotated[
    str | None,
    typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="A real card; else a virtual one."),
]
AtHost = Annotated[
    str, typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="The card of the machine.")
]


@contextmanager
def workshop(
    host: str | None, cells: "Store", *, to_stderr: bool = False
) -> "Iterator[MillSession]":
    """The machine of a command; it comes to rest however the command ends."""
    from openacr.cli.signals import deaf, terminations_as_interrupts
    from openacr.client import ConnectionLostError
    from openacr.mill.card.alarms import LINK_LOST, NO_CARD, AlarmError
    from openacr.mill.card.driver import LINK_ERRORS
    from openacr.mill.session import MillSession

    def say(text: str) -> None:
        typer.echo(text, err=to_stderr)

    with terminations_as_interrupts():
        try:
            shop = (
                MillSession.real(host, cells, say)
                if host is not None
                else MillSession.virtual(cells, say)
            )
        except ConnectionLostError as lost:
            raise AlarmError(NO_CARD, lost) from None
        except KeyboardInterrupt:
            typer.echo("interrupted: nothing was started", err=True)
            raise typer.Exit(INTERRUPTED) from None
        shop.show_message = partial(show_message, to_stderr=to_stderr)
        try:
            if host is not None:
                shop.step()  # what is wrong with the machine is known before anything is asked
            yield shop
        except KeyboardInterrupt:
            _break_off(shop)
            typer.echo(_at_rest(shop), err=True)
            raise typer.Exit(INTERRUPTED) from None
        except AlarmError as error:
            is_up = shop.runner.alarms.bars_start
            hint = "; `openacr mill acknowledge` clears what is over" if is_up else ""
            raise UserError(f"{error}{hint}") from None
        except LINK_ERRORS as lost:
            raise UserError(f"{AlarmError(LINK_LOST)} ({lost}); {LEFT_ALONE}") from None
        finally:
            with deaf():  # also for one more Ctrl-C
                try:
                    _break_off(shop)
                finally:
                    shop.close()


def _at_rest(shop: "MillSession") -> str:
    """What is known of a machine whose command was broken off."""
    from openacr.mill.card.driver import LINK_ERRORS

    try:
        place = place_text(shop, shop.runner.stream.host.position())
    except LINK_ERRORS:
        return f"interrupted: the card does not answer; {LEFT_ALONE}"
    return f"interrupted: the machine is at rest at {place}"


def _break_off(shop: "MillSession") -> None:
    """However the command ends, the machine does not go on moving by itself.

    Whoever presses Ctrl-C once more does not keep the spindle from being switched off.
    """
    from openacr.cli.signals import deaf
    from openacr.mill.card.driver import LINK_ERRORS

    with suppress(*LINK_ERRORS), deaf():
        shop.runner.bring_to_rest()
        end_s = shop.card.now_s() + REST_S
        while shop.runner.is_busy:
            if shop.card.now_s() > end_s:
                shop.runner.cut_power()
                raise UserError(
                    f"the machine has not come to rest within {REST_S:g} s: drives are switched off"
                )
            shop.step()


def place_text(shop: "MillSession", place: tuple[float, ...]) -> str:
    """A place as the read-out of the machine shows it."""
    from openacr.mill.config.readout import Readout

    axes = [axis.index for axis in shop.runner.settings.axes]
    readout = Readout(shop.cells)
    return f"{readout.line(axes, place)} {'mm' if readout.is_metric else 'inch'}"


def end_with_alarms(shop: "MillSession", *, is_shown: bool = True) -> None:
    """Say what went wrong; exit code 1 when anything did."""
    active = shop.runner.alarms.active
    block = shop.block
    for alarm in active if is_shown else ():
        where = f" (line {block[0]}: {block[1]})" if block else ""
        typer.secho(f"alarm {alarm.kind.code}: {alarm.text}{where}", fg=typer.colors.RED, err=True)
    if shop.runner.was_aborted:
        typer.echo("aborted by the operator", err=True)
    if shop.runner.alarms.bars_start or shop.runner.was_aborted:
        raise typer.Exit(FAILED)
