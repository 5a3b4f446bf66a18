"""Commands of the pane World: inputs thrown by hand, faults of the machine, devices."""

from typing import Annotated, Literal

from msgspec import Meta

from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.world import WorldPane
from openacr.panel.control.operator.people import Person
from openacr.panel.roles import Role
from openacr.plant.world.fault_kinds import MachineFault

Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
AxisNumber = Annotated[int, Meta(ge=0, le=15)]


@command("world.input", Role.SERVICE, is_motion=True)
def world_input(
    person: Person,
    world: WorldPane,
    *,
    input: Annotated[int, Meta(ge=0)],
    state: Literal["on", "off", "released"],
) -> None:
    """Switch an input of the world on or off by hand, or release it."""
    world.set_input(person.data()["name"], input, state)


@command("world.release", Role.SERVICE, is_motion=True)
def release_all(person: Person, world: WorldPane) -> dict[str, int]:
    """Release all inputs that are forced; the machine drives them again."""
    return {"released": world.release_all(person.data()["name"])}


@command("world.fault", Role.SERVICE, is_motion=True)
def world_fault(
    person: Person, world: WorldPane, *, axis: AxisNumber, kind: MachineFault, value: Finite = 0.0
) -> None:
    """Cause a fault of the machine, as scenarios do."""
    world.fault(person.data()["name"], axis, kind, value)


@command("world.mend", Role.SERVICE, is_motion=True, en="MEND", de="BEHEBEN")
def world_mend(
    person: Person, world: WorldPane, *, axis: AxisNumber, kind: MachineFault | None = None
) -> None:
    """End a fault of the machine."""
    world.mend(person.data()["name"], axis, kind)


@command("world.command", Role.SERVICE, is_motion=True)
def world_command(
    person: Person, world: WorldPane, *, device: str, name: str, value: Finite = 1.0
) -> None:
    """Give a command to a device of the machine by hand."""
    world.command(person.data()["name"], device, name, value)
