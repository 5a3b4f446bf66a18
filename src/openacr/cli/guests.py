"""The options of servers that say which hosts may connect."""

from typing import TYPE_CHECKING, Annotated

import typer

from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.io.server import Guests

Allow = Annotated[
    str | None,
    typer.Option("--allow", metavar="CIDR,...", help="Networks that may connect: 192.168.10.0/24"),
]
Insecure = Annotated[
    bool, typer.Option("--insecure", help="Let every host that reaches the port connect.")
]


def admitted(address: str, allow: str | None, *, is_open: bool) -> "Guests":
    """The hosts that may connect; a non-loopback address requires --allow or --insecure."""
    from openacr.io.server import Guests, is_loopback

    if allow is not None:
        if is_open:
            raise UserError("--allow and --insecure exclude each other")
        return Guests.of(allow)
    if not is_open and not is_loopback(address):
        raise UserError(
            f"other machines reach {address}, and the card's protocols have no passwords: restrict"
            " hosts with --allow 192.168.10.0/24, or allow all with --insecure"
        )
    return Guests()
