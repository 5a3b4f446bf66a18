"""`openacr ip`: what an address means, and whether a host reaches it without a router."""

from typing import Annotated

import typer

from openacr.errors import CardError, UserError


def explain_address(
    address: Annotated[str, typer.Argument(help="The address of a card, e.g. 192.168.10.40.")],
    mask: Annotated[str, typer.Option(help="The mask of its network.")] = "255.255.255.0",
    host: Annotated[str, typer.Option(help="The address of the host that connects.")] = "",
) -> None:
    """Explain an address of the network: class, network, host, reach."""
    from openacr.basic.memory.ip_address import IpAddress

    def read(text: str) -> IpAddress:
        try:
            return IpAddress.read(text)
        except CardError:
            raise UserError(f"{text}: an address has four numbers from 0 to 255") from None

    card, net = read(address), read(mask)
    if not net.is_mask:
        raise UserError(f"{mask}: a mask is ones before zeros, e.g. 255.255.255.0 or 255.255.252.0")
    kind = card.network_class
    where = f"class {kind[0]}, {kind[1]} network bits" if kind else "no class for hosts"
    typer.echo(f"{card}: {where}, {'private' if card.is_private else 'public'}")
    typer.echo(f"network {card.subnet(net)}, host {card.host(net)} (mask {net})")
    try:
        card.check_host(net)
    except CardError:
        typer.echo("no card can have it: its host part is zero, or an octet is 255")
    if host:
        other = read(host)
        near = card.shares_network(other, net)
        typer.echo(
            f"{other} is in the same network"
            if near
            else f"{other} is in network {other.subnet(net)}: a router has to be between them"
        )
