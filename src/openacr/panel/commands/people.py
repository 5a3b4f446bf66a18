"""Commands of operators among each other: control, names."""

from typing import Annotated

from msgspec import Meta

from openacr.errors import UserError
from openacr.io.server import is_loopback
from openacr.panel.commands.registry import Args, NoArgs, command
from openacr.panel.control.orders import Order
from openacr.panel.control.presses import End
from openacr.panel.control.station import Station
from openacr.panel.roles import Role


class Take(Args, frozen=True):
    """Whether control is taken from an operator who has it."""

    force: bool = False


class Give(Args, frozen=True):
    """The client that gets control."""

    client: int


class Named(Args, frozen=True):
    """A name that others see."""

    name: Annotated[str, Meta(max_length=40, pattern=r"^[^\x00-\x1f]*$")]


@command("control.take", needs_control=False)
def take(station: Station, order: Order, args: Take) -> dict[str, object]:
    """Take control of the machine."""
    before = station.people.take(order.person.client, force=args.force)
    if before is not None:
        station.hand_motion.presses.end_all(End.CONTROL, "another operator has taken control")
    return {"holder": station.people.data()["holder"]}


@command("control.give", needs_control=False)
def give(station: Station, order: Order, args: Give) -> None:
    """Hand control over to another operator."""
    station.people.give(order.person.client, args.client)
    station.hand_motion.presses.end_all(End.CONTROL, "control was handed over")


@command("control.release", needs_control=False)
def release(station: Station, order: Order, args: NoArgs) -> None:
    """Give control up."""
    if station.people.holder == order.person.client:
        station.hand_motion.presses.end_all(End.CONTROL, "control was given up")
    station.people.release(order.person.client)


@command("name", Role.VIEW, needs_control=False)
def name(station: Station, order: Order, args: Named) -> None:
    """Choose the name that others see."""
    station.people.rename(order.person.client, args.name.strip())


@command("app.end")
def end(station: Station, order: Order, args: NoArgs) -> None:
    """EXIT: end the controller program; at rest, and from its own computer only."""
    if not is_loopback(order.person.address):
        raise UserError("the controller program is ended at its own computer")
    if station.link.session is not None and station.interlocks.is_moved:
        raise UserError("the machine is working: stop it first")
    station.on_end()
