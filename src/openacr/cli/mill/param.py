"""`openacr mill param`: the variables of the operator, P0 to P199."""

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.client import Card

FIRST_IN_STORE, LAST = 100, 199


def operate_parameters(
    settings: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[P5|P5=VALUE]...", help="Variables to show or change; default: show all."
        ),
    ] = None,
    host: Annotated[
        str | None,
        typer.Option("--host", metavar="HOST[:PORT]|SERIAL", help="Card for P0 to P99."),
    ] = None,
    store: Annotated[
        Path | None, typer.Option("--store", metavar="PATH", help="Store for P100 and up.")
    ] = None,
) -> None:
    """Show and change P0 to P99 of a card and P100 to P199 of the store."""
    from openacr.mill.config.pparm import OperatorParameters
    from openacr.sysvar.location import open_to_read, open_to_write

    requested = [_parsed(text) for text in settings or ()]
    changes = any(value is not None for _, value in requested)
    with ExitStack() as stack:
        cells = stack.enter_context((open_to_write if changes else open_to_read)(store))
        card = stack.enter_context(_card(host)) if host is not None else None
        values = OperatorParameters(cells, card)
        for n, value in requested:
            if value is not None:
                values.write(n, value)
        numbers = [n for n, _ in requested] or range(
            FIRST_IN_STORE if card is None else 0, LAST + 1
        )
        for n in numbers:
            typer.echo(f"P{n} = {values.read(n):.10g}")


def _parsed(text: str) -> tuple[int, float | None]:
    name, sign, value = text.partition("=")
    try:
        return int(name.strip().lstrip("Pp#")), _finite(value) if sign else None
    except ValueError:
        raise UserError(f"{text!r}: write P5 to see it, P5=1.5 to change it") from None


def _finite(text: str) -> float:
    value = float(text)
    if value - value != 0.0:  # an infinity, or no number
        raise ValueError
    return value


def _card(host: str) -> "Card":
    from openacr.client import Card, ConnectionLostError
    from openacr.mill.card.alarms import NO_CARD, AlarmError
    from openacr.mill.card.setup import user_variables

    try:
        card = Card.open(host)
    except ConnectionLostError as lost:
        raise AlarmError(NO_CARD, lost) from None
    user_variables(card)
    return card
