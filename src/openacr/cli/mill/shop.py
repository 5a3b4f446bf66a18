"""Machine of a command: opened for it, and brought to rest however it ends."""

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
LEFT_ALONE = "its watchdog stops it, if installed; else it completes its moves and outputs stay on"

ToHost = Annotated[
    str | None,
    typer.Option(
        "--host", metavar="HOST[:PORT]|SERIAL", help="A real card; default: a virtual one."
    ),
]
AtHost = Annotated[
    str, typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="Card of the machine.")
]


@contextmanager
def workshop(
    host: str | None, cells: "Store", *, to_stderr: bool = False
) -> "Iterator[MillSession]":
    """Open the machine of a command; it comes to rest however the command ends."""
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
                shop.step()  # alarms are known before any question
            yield shop
        except KeyboardInterrupt:
            _end_at_rest(shop)
            typer.echo(_at_rest(shop), err=True)
            raise typer.Exit(INTERRUPTED) from None
        except AlarmError as error:
            is_up = shop.runner.alarms.bars_start
            hint = "; `openacr mill acknowledge` clears alarms whose cause is gone" if is_up else ""
            raise UserError(f"{error}{hint}") from None
        except LINK_ERRORS as lost:
            raise UserError(f"{AlarmError(LINK_LOST)} ({lost}); {LEFT_ALONE}") from None
        finally:
            with deaf():  # also for one more Ctrl-C
                try:
                    _end_at_rest(shop)
                finally:
                    shop.close()


def _at_rest(shop: "MillSession") -> str:
    """The report after an interrupted command."""
    from openacr.mill.card.driver import LINK_ERRORS

    try:
        place = place_text(shop, shop.runner.stream.host.position())
    except LINK_ERRORS:
        return f"interrupted: the card does not answer; {LEFT_ALONE}"
    return f"interrupted: the machine is at rest at {place}"


def _end_at_rest(shop: "MillSession") -> None:
    """Bring the machine to rest at the end of a command.

    Another Ctrl-C does not prevent the spindle from being switched off.
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
    """A position as text, in the formats of the machine."""
    from openacr.mill.config.readout import Readout

    axes = [axis.index for axis in shop.runner.settings.axes]
    return Readout(shop.cells).place(axes, place)


def end_with_alarms(shop: "MillSession", *, is_shown: bool = True) -> None:
    """Report alarms; exit code 1 if there are any."""
    active = shop.runner.alarms.active
    block = shop.block
    for alarm in active if is_shown else ():
        where = f" (line {block[0]}: {block[1]})" if block else ""
        typer.secho(f"alarm {alarm.kind.code}: {alarm.text}{where}", fg=typer.colors.RED, err=True)
    if shop.runner.was_aborted:
        typer.echo("aborted by the operator", err=True)
    if shop.runner.alarms.bars_start or shop.runner.was_aborted:
        raise typer.Exit(FAILED)
