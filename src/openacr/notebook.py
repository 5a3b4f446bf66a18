"""The extension of notebooks: `%load_ext openacr.notebook` brings the cell magic `%%acr`.

It asks IPython for nothing but a place for the magic, so it is imported without IPython, too.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from typing import Any, Protocol

from openacr.client import Card, Level
from openacr.controller import Controller
from openacr.errors import OpenacrError, UserError

USE = "%%acr [CARD] [PROGn | PLCn]"
DEFAULT = "card"


class Shell(Protocol):
    """What the extension needs of IPython."""

    user_ns: dict[str, Any]

    def register_magic_function(
        self, func: Callable[[str, str], None], magic_kind: str, magic_name: str
    ) -> None:
        """Make a function known as a magic."""


class CellError(UserError):
    """What a card or the magic refuses; notebooks show its sentence, without a traceback."""

    def _render_traceback_(self) -> list[str]:
        return [f"error: {self}"]


def load_ipython_extension(shell: Shell) -> None:
    """Register `%%acr`; IPython calls this at `%load_ext openacr.notebook`."""

    def acr(line: str, cell: str) -> None:
        """Type the lines of the cell on a card and print what it answers.

        `%%acr [CARD] [PROGn | PLCn]`: CARD is the name of a variable that holds a Controller or a
        client.Card (default `card`); lines are typed at SYS, or at the program or PLC that is
        named. Programs that the cell stores are compared with the listing of the card. The first
        line that the card refuses ends the cell.
        """
        try:
            _type(shell.user_ns, line.split(), cell)
        except OpenacrError as refused:
            raise CellError(str(refused)) from None

    shell.register_magic_function(acr, "cell", "acr")


def _type(names: dict[str, Any], words: list[str], cell: str) -> None:
    to = Level.of_line(words[-1]) if words else None
    asked = words if to is None else words[:-1]
    if len(asked) > 1:
        raise UserError(f"{' '.join(words)!r} is not understood; the magic is {USE}")
    name = asked[0] if asked else DEFAULT
    with _card(name, names.get(name)) as card:
        for remark in card.download(cell, path="cell", to=to).remarks:
            print(remark.text)


def _card(name: str, found: Any) -> Any:
    if isinstance(found, Card):
        return nullcontext(found)
    if isinstance(found, Controller):
        return Card.open(found)
    what = "is not defined" if found is None else f"is a {type(found).__name__}"
    raise UserError(f"{name} {what}; {USE} takes a variable with a Controller or a client.Card")
