"""`openacr mill message`: texts shown while an input, output or flag has a state."""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.mill.check import AsJson, AtStore
from openacr.cli.printing import print_json
from openacr.cli.sysvar.change import Password, require_service
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.mill.card.messages import Message
    from openacr.sysvar import Store

# The sixteen colours of the screens, as a terminal calls them.
COLORS = (
    "black", "blue", "green", "cyan", "red", "magenta", "yellow", "white",
    "bright_black", "bright_blue", "bright_green", "bright_cyan", "bright_red", "bright_magenta",
    "bright_yellow", "bright_white",
)  # fmt: skip


def show_message(message: "Message", is_on: bool, *, to_stderr: bool = False) -> None:
    """Show a message in its colours, or report its end."""
    text = f"message {message.number}: "
    if is_on:
        shown = typer.style(
            message.shown, fg=COLORS[message.text_color], bg=COLORS[message.back_color]
        )
        typer.echo(text + shown, err=to_stderr)
    else:
        typer.echo(f"{text}{message.shown} (over)", err=to_stderr)


def list_messages(store: AtStore = None, as_json: AsJson = False) -> None:
    """List the messages."""
    from openacr.mill.card.messages import definitions
    from openacr.sysvar.location import open_to_read

    with open_to_read(store) as cells:
        found = list(definitions(cells))
    if as_json:
        records = [
            {
                "number": each.number,
                "bit": each.bit,
                "shown_while": "on" if each.is_shown_on else "off",
                "text": each.text,
                "text_color": each.text_color,
                "back_color": each.back_color,
                "size": each.size,
                "alarm": each.is_alarm,
            }
            for each in found
        ]
        print_json(records)
        return
    for each in found:
        state = "on" if each.is_shown_on else "off"
        kind = "  alarm" if each.is_alarm else ""
        typer.echo(f"{each.number:>2}  BIT{each.bit} {state:<4}{each.shown}{kind}")
    if not found:
        typer.echo("no messages are defined")


def set_message(
    text: Annotated[str, typer.Argument(metavar="TEXT", help="Text of the message.")],
    bit: Annotated[
        int, typer.Option("--bit", help="Input (0-31), output (32-63) or other flag of the card.")
    ],
    number: Annotated[
        int | None, typer.Option("--number", help="0 to 31; default: the lowest free number.")
    ] = None,
    is_shown_off: Annotated[
        bool, typer.Option("--off", help="Show while the bit is off instead of on.")
    ] = False,
    text_color: Annotated[int | None, typer.Option("--color", help="Text colour, 0 to 15.")] = None,
    back_color: Annotated[
        int | None, typer.Option("--back", help="Background colour, 0 to 15.")
    ] = None,
    is_alarm: Annotated[bool, typer.Option("--alarm", help="Also raise alarm 50.")] = False,
    store: AtStore = None,
    password: Password = None,
) -> None:
    """Define or change a message."""
    from openacr.mill.card.messages import Message, define, free_number
    from openacr.sysvar.location import open_to_write

    _require_flag(bit)
    _require_text(text)
    with open_to_write(store) as cells:
        _require_service(cells, password)
        place = free_number(cells) if number is None else number
        message = Message(place, bit, text, not is_shown_off, is_alarm=is_alarm)
        message = replace(message, size=len(text))
        if text_color is not None:
            message = replace(message, text_color=text_color)
        if back_color is not None:
            message = replace(message, back_color=back_color)
        with cells.transaction():
            define(cells, message)
    typer.echo(f"message {place}: {text}")


def remove_message(
    number: Annotated[int, typer.Argument(metavar="NUMBER", help="Message number, 0 to 31.")],
    store: AtStore = None,
    password: Password = None,
) -> None:
    """Remove a message."""
    from openacr.mill.card.messages import remove
    from openacr.sysvar.location import open_to_write

    with open_to_write(store) as cells:
        _require_service(cells, password)
        remove(cells, number)
    typer.echo(f"message {number} removed")


def _require_text(text: str) -> None:
    from openacr.mill.card.messages import LONGEST

    if not text.strip() or not text.isprintable():
        raise UserError(f"{text!r}: a message must be one line of printable text")
    if len(text) > LONGEST:
        raise UserError(f"{counted(len(text), 'character')}: a message has at most {LONGEST}")


def _require_flag(bit: int) -> None:
    from openacr.errors import MapError
    from openacr.map import flag

    try:
        flag(bit)
    except MapError:
        raise UserError(f"--bit {bit}: the card has no such flag") from None


def _require_service(cells: "Store", password: str | None) -> None:
    from openacr.sysvar.tabs import MESSAGES

    require_service(cells, [MESSAGES.defined[0]], password)
