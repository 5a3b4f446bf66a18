"""Commands of the pane World: inputs thrown by hand, faults of the machine, devices."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.panel.commands.registry import Args, command
from openacr.panel.control.orders import Order
from openacr.panel.control.station import Station
from openacr.panel.roles import Role
from openacr.plant.fault_kinds import MachineFault

Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
AxisNumber = Annotated[int, Meta(ge=0, le=15)]


class OfInput(Args, frozen=True):
    """An input and how it is switched by hand."""

    input: Annotated[int, Meta(ge=0)]
    state: Literal["on", "off", "released"]


class OfFault(Args, frozen=True):
    """A fault of an axis, by its number in machine.toml, with its quantity where it has one."""

    axis: AxisNumber
    kind: MachineFault
    value: Finite = 0.0


class OfMend(Args, frozen=True):
    """A fault of an axis that ends; without `kind` all of them."""

    axis: AxisNumber
    kind: MachineFault | None = None


class OfDevice(Args, frozen=True):
    """A command of a device, and its value: 1 and 0 of a contact."""

    device: str
    name: str
    value: Finite = 1.0


@command("world.input", Role.SERVICE, is_motion=True)
def world_input(station: Station, order: Order, args: OfInput) -> None:
    """Switch an input of the world on or off by hand, or release it."""
    station.world.set_input(order.person.data()["name"], args.input, args.state)


@command("world.fault", Role.SERVICE, is_motion=True)
def world_fault(station: Station, order: Order, args: OfFault) -> None:
    """Cause a fault of the machine, as scenarios do."""
    station.world.fault(order.person.data()["name"], args.axis, args.kind, args.value)


@command("world.mend", Role.SERVICE, is_motion=True)
def world_mend(station: Station, order: Order, args: OfMend) -> None:
    """End a fault of the machine."""
    station.world.mend(order.person.data()["name"], args.axis, args.kind)


@command("world.command", Role.SERVICE, is_motion=True)
def world_command(station: Station, order: Order, args: OfDevice) -> None:
    """Give a command to a device of the machine by hand."""
    station.world.command(order.person.data()["name"], args.device, args.name, args.value)
