"""What is real of a served card: whether it is opened, who agrees, how it begins and ends."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from openacr.cli.bus_report import Reporting
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.controller import Controller
    from openacr.fieldbus.machine.in_memory import EmulatedLink
    from openacr.fieldbus.machine.real_machine import RealMachine
    from openacr.io.drive_line import DriveLine
    from openacr.io.ethercat_link import RawLink
    from openacr.plant.describe.network_schema import Canopen
    from openacr.plant.describe.schema import World

    Link = RawLink | EmulatedLink

NO_BUS = "none"
EMULATED = "emulated"


def world_on_bus(path: Path | None, bus: str | None) -> "World | None":
    """The machine of a project with something real; None if all of it is modelled."""
    from openacr.plant.describe.load import load_world
    from openacr.plant.describe.real_world import is_real
    from openacr.project import find_project

    project = None if path is None else find_project(path)
    if bus == NO_BUS or project is None or project.machine is None:
        world = None
    else:
        world = load_world(project.machine)
    if world is None or world.bus is None:
        if bus not in (None, NO_BUS):
            raise UserError(f"--bus {bus}: the project has no machine.toml with [bus]")
    if world is None or not is_real(world):
        return None
    if EMULATED in (bus, world.bus and world.bus.interface):
        from openacr.fieldbus.machine.in_memory import with_positions

        return with_positions(world)
    return world


def agreed(
    world: "World | None", bus: str | None, speed: float, *, is_real: bool, is_sure: bool
) -> str:
    """The interface of EtherCAT, once the operator has agreed to all that is real; "" without."""
    if world is None:
        if is_real:
            raise UserError("--real: nothing of machine.toml is on a bus of this computer")
        return ""
    interface = bus or world.bus.interface if world.bus is not None else ""
    if world.bus is not None and not interface:
        raise UserError("[bus] of machine.toml names no interface: give --bus IFACE")
    sentences = list(what_can_happen(world, interface))
    if not sentences:
        return interface
    if speed != 1.0:
        raise UserError(f"--speed {speed:g}: a card with a bus runs in real time, 1.0")
    if is_real and not is_sure:
        if not sys.stdin.isatty():
            raise UserError("--real lets drives be enabled and outputs switched: say --yes")
        for sentence in sentences:
            typer.echo(sentence)
        typer.confirm("Is the emergency stop within reach, and are all people clear?", abort=True)
    return interface


def what_can_happen(world: "World", interface: str) -> Iterator[str]:
    """What an operator agrees to, a sentence for each bus that is real."""
    if world.bus is not None and interface != EMULATED:
        names = ", ".join(axis.label for axis in world.axis if axis.bus)
        yield f"Drives on {interface} can be enabled and axes {names} can move."
    if world.canopen is not None and world.canopen.interface is not None:
        yield f"CANopen nodes on {_can_name(world.canopen)} can switch their outputs."
    for drive in world.drive:
        if drive.serial is not None:
            yield f"The drive of axis {drive.axis} on {drive.serial} can be set and commanded."


def _can_name(canopen: "Canopen") -> str:
    return canopen.channel or canopen.interface or ""


class Served:
    """All that is real of a served card."""

    def __init__(
        self,
        card: "Controller",
        world: "World",
        interface: str,
        *,
        is_real: bool,
        is_reported: bool,
    ) -> None:
        self._parts: list[ServedBus | ServedCan | ServedDrives] = []
        try:
            if world.bus is not None:
                link = _link(card, world, interface)
                self._parts.append(ServedBus(card, world, link, is_real, is_reported))
            if world.canopen is not None and world.canopen.interface is not None:
                self._parts.append(ServedCan(card, world.canopen, is_real=is_real))
            if any(drive.serial for drive in world.drive):
                self._parts.append(ServedDrives(card, world, is_real=is_real))
        except BaseException:
            self.close()
            raise

    def begin(self) -> None:
        """Let the card attend everything; UserError if it is not as described."""
        for part in self._parts:
            part.begin()

    def close(self) -> None:
        """Let everything rest, and close the interfaces."""
        for part in reversed(self._parts):
            part.close()


class ServedCan:
    """The CAN bus of a served card."""

    def __init__(self, card: "Controller", canopen: "Canopen", *, is_real: bool) -> None:
        from openacr.fieldbus.canopen.real_nodes import RealNodes
        from openacr.io.can_link import CanLink

        self._card, self._is_real = card, is_real
        self._link = CanLink(canopen.interface or "", canopen.channel, canopen.bit_rate)
        self._nodes = RealNodes(card.networks.canopen, canopen.real, self._link)

    def begin(self) -> None:
        """Let the card look for its nodes on the bus, when a program starts the network."""
        if self._is_real:
            self._nodes.allow()
        self._card.networks.connect(self._nodes)
        state = "outputs are sent" if self._is_real else "read only, no output is sent"
        rate = self._link.bit_rate
        typer.echo(f"CAN {self._link.name}: {rate} kbit/s, {state}", err=True)

    def close(self) -> None:
        """Reset the nodes that were started, and close the bus."""
        self._nodes.close()
        self._link.close()


class ServedDrives:
    """The drives on serial lines of a served card; a port is opened when it is first talked to."""

    def __init__(self, card: "Controller", world: "World", *, is_real: bool) -> None:
        from openacr.fieldbus.drivetalk.real_drives import RealDrives
        from openacr.io.drive_line import DriveLine

        self._card, self._is_real = card, is_real
        self._ports: list[DriveLine] = []
        self._drives = RealDrives(world.drive, self._port)
        if is_real:
            self._drives.allow()

    def _port(self, path: str) -> "DriveLine":
        from openacr.io.drive_line import DriveLine

        self._ports.append(DriveLine(path))
        return self._ports[-1]

    def begin(self) -> None:
        """Let Drive Talk go to the real drives."""
        self._card.networks.connect_drives(self._drives)
        state = "all commands are sent" if self._is_real else "read only"
        names = ", ".join(port.path for port in self._ports)
        typer.echo(f"Drive Talk {names}: {state}", err=True)

    def close(self) -> None:
        """Close the ports."""
        for port in self._ports:
            port.close()


@dataclass
class ServedBus:
    """The bus of a served card."""

    _card: "Controller"
    _world: "World"
    _link: "Link"
    _is_real: bool
    _is_reported: bool
    _machine: "RealMachine | None" = None
    _reporting: Reporting | None = None

    def begin(self) -> None:
        """Bring the bus up and let the card attend it; BusError if it is not as described."""
        from openacr.fieldbus.machine.real_machine import RealMachine
        from openacr.plant.describe.real_world import real_world

        self._machine = machine = RealMachine(self._card.card, real_world(self._world), self._link)
        if self._is_real:
            machine.enable()
        self._card.devices.join(machine)
        state = "can be enabled" if self._is_real else "read only, none can be enabled"
        drives = counted(len(machine.drives), "drive")
        typer.echo(f"bus {self._link.name}: {drives}, {state}", err=True)
        if self._is_reported:
            self._reporting = Reporting(machine)

    def close(self) -> None:
        """Bring all devices into INIT and close the interface."""
        if self._reporting is not None:
            self._reporting.end()
        if self._machine is not None:
            self._machine.close()
            cycles = counted(self._machine.cycles, "cycle")
            bad = self._machine.bad_cycles
            typer.echo(f"bus {self._link.name}: {cycles}, {bad} lost or wrong", err=True)
        self._link.close()


def _link(card: "Controller", world: "World", interface: str) -> "Link":
    """What carries frames to the bus of a machine."""
    if interface == EMULATED:
        from openacr.fieldbus.machine.in_memory import EmulatedLink, segment_of

        return EmulatedLink(segment_of(world), lambda: round(card.lived_tk * card.period_s * 1e9))
    from openacr.io.ethercat_link import RawLink

    return RawLink(interface)
