"""The bus of a served card: whether it is opened, who agrees, how it begins and ends."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.plant.describe.schema import World

NO_BUS = "none"


def world_on_bus(path: Path | None, bus: str | None) -> "World | None":
    """The machine of a project with its bus open; None if it has none, or all is modelled."""
    from openacr.plant.describe.load import load_world
    from openacr.plant.describe.real_world import real_world
    from openacr.project import find_project

    project = None if path is None else find_project(path)
    if bus == NO_BUS or project is None or project.machine is None:
        world = None
    else:
        world = load_world(project.machine)
    if world is None or world.bus is None:
        if bus not in (None, NO_BUS):
            raise UserError(f"--bus {bus}: the project has no machine.toml with [bus]")
        return None
    return real_world(world)


def agreed(
    world: "World | None", bus: str | None, speed: float, *, is_real: bool, is_sure: bool
) -> str:
    """The interface of the bus, once the operator has agreed to real drives; "" without a bus."""
    if world is None or world.bus is None:
        if is_real:
            raise UserError("--real: no drive is on a bus (machine.toml has no [bus])")
        return ""
    interface = bus or world.bus.interface
    if not interface:
        raise UserError("[bus] of machine.toml names no interface: give --bus IFACE")
    if speed != 1.0:
        raise UserError(f"--speed {speed:g}: a card with a bus runs in real time, 1.0")
    if is_real and not is_sure:
        if not sys.stdin.isatty():
            raise UserError("--real lets drives be enabled: say --yes")
        names = ", ".join(axis.label for axis in world.axis if axis.bus)
        typer.confirm(
            f"Drives on {interface} can be enabled and axes {names} can move."
            " Is the emergency stop within reach, and are all people clear?",
            abort=True,
        )
    return interface


class ServedBus:
    """The bus of a served card."""

    def __init__(
        self, card: "Controller", world: "World", interface: str, *, is_real: bool
    ) -> None:
        from openacr.fieldbus.machine.real_machine import RealMachine
        from openacr.io.ethercat_link import RawLink

        self._make = RealMachine
        self._card, self._world, self._is_real = card, world, is_real
        self._link = RawLink(interface)
        self._machine: RealMachine | None = None

    def begin(self) -> None:
        """Bring the bus up and let the card attend it; BusError if it is not as described."""
        self._machine = machine = self._make(self._card.card, self._world, self._link)
        if self._is_real:
            machine.enable()
        self._card.devices.join(machine)
        state = "can be enabled" if self._is_real else "read only, none can be enabled"
        drives = counted(len(machine.drives), "drive")
        typer.echo(f"bus {self._link.name}: {drives}, {state}", err=True)

    def close(self) -> None:
        """Bring all devices into INIT and close the interface."""
        if self._machine is not None:
            self._machine.close()
            cycles = counted(self._machine.cycles, "cycle")
            bad = self._machine.bad_cycles
            typer.echo(f"bus {self._link.name}: {cycles}, {bad} lost or wrong", err=True)
        self._link.close()
