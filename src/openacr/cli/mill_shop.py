"""The machine of a command: opened, attended while it runs, and at rest behind it."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill_message import show_message
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.cnc.canonical import Ask
    from openacr.mill.workshop import Workshop
    from openacr.sysvar import Store

FAILED, INTERRUPTED = 1, 130

ToHost = Annotated[
    str | None,
    typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="A real card; else a virtual one."),
]
AtHost = Annotated[
    str, typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="The card of the machine.")
]


@contextmanager
def workshop(host: str | None, cells: "Store", *, to_stderr: bool = False) -> "Iterator[Workshop]":
    """The machine of a command; it comes to rest however the command ends."""
    from openacr.cli.signals import terminations_as_interrupts
    from openacr.client import ConnectionLostError
    from openacr.mill.workshop import Workshop

    def say(text: str) -> None:
        typer.echo(text, err=to_stderr)

    try:
        shop = Workshop.real(host, cells, say) if host is not None else Workshop.virtual(cells, say)
        shop.show_message = partial(show_message, to_stderr=to_stderr)
    except ConnectionLostError as lost:
        raise UserError(f"alarm 1: NO CARD FOUND ({lost})") from None
    try:
        with terminations_as_interrupts():
            yield shop
    except KeyboardInterrupt:
        _break_off(shop)
        place = place_text(shop, shop.runner.course.host.position())
        typer.echo(f"interrupted: the machine is at rest at {place}", err=True)
        raise typer.Exit(INTERRUPTED) from None
    finally:
        _break_off(shop)
        shop.close()


def _break_off(shop: "Workshop") -> None:
    """However the command ends, the machine does not go on moving by itself."""
    from openacr.client import ConnectionLostError

    with suppress(ConnectionLostError):
        shop.runner.break_off()
        while shop.runner.is_busy:
            shop.step()


def attend(shop: "Workshop") -> None:
    """Where the machine waits for somebody: nobody on a virtual one, the terminal else."""
    from openacr.mill.states import State

    if shop.is_virtual:
        shop.carry_on()
    elif shop.runner.state is State.HOLD:
        _ask(shop)
    elif shop.runner.asking is not None:
        _answer_to(shop, shop.runner.asking)


def _ask(shop: "Workshop") -> None:
    if not sys.stdin.isatty():
        shop.runner.abort()
        raise UserError(f"{shop.runner.reason}: nobody is at the terminal to go on")
    if typer.confirm(f"{shop.runner.reason}: go on?", default=True):
        shop.runner.start()
    else:
        shop.runner.abort()


def _answer_to(shop: "Workshop", ask: "Ask") -> None:
    if not sys.stdin.isatty():
        shop.runner.abort()
        raise UserError(f"nobody is at the terminal to answer {ask.text!r}; use --answer")
    shop.runner.course.host.answers[ask.parameter] = typer.prompt(ask.text, type=float)


def place_text(shop: "Workshop", place: tuple[float, ...]) -> str:
    """A place as the read-out of the machine shows it."""
    from openacr.mill.readout import Readout

    axes = [axis.index for axis in shop.runner.settings.axes]
    return Readout(shop.cells).line(axes, place)


def end_with_alarms(shop: "Workshop", *, is_shown: bool = True) -> None:
    """Say what went wrong; exit code 1 when anything did."""
    active = shop.runner.alarms.active
    block = shop.block
    for alarm in active if is_shown else ():
        where = f" (line {block[0]}: {block[1]})" if block else ""
        typer.secho(f"alarm {alarm.kind.code}: {alarm.text}{where}", fg=typer.colors.RED, err=True)
    if shop.runner.alarms.bars_start:
        raise typer.Exit(FAILED)
