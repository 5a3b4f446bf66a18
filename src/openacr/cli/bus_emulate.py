"""`openacr bus emulate`: drives and terminals of EtherCAT, or nodes of CANopen, on a bus."""

import os
import select
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from openacr.cli import bus_can
from openacr.cli.signals import terminations_as_interrupts
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.plant.describe.schema import World

MACHINE = "machine.toml"
_MOST_TYPED = 4096
_POLL_S = 0.001


def emulate_bus(
    machine: Annotated[
        Path | None,
        typer.Argument(
            metavar="[MACHINE]", help="machine.toml, or a project with one: its motors or nodes."
        ),
    ] = None,
    interface: Annotated[
        str, typer.Option(help="Network interface, an end of a veth pair; or a CAN bus: can0.")
    ] = "veth1",
    drives: Annotated[
        int | None, typer.Option(help="Number of equal drives, instead of a machine.")
    ] = None,
    digital: Annotated[
        int, typer.Option(min=0, max=64, help="Digital terminals of 8 inputs and 8 outputs.")
    ] = 0,
    analog: Annotated[
        int, typer.Option(min=0, max=64, help="Analog terminals of 4 inputs and 4 outputs.")
    ] = 0,
    fault: Annotated[
        list[str] | None,
        typer.Option(help='A fault: "lose 100", or after seconds: "2.5 power-off 1".'),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of what faults draw.")] = 0,
) -> None:
    """Emulate EtherCAT drives and terminals on a network interface (Linux, root), or CANopen nodes.

    Lines that are typed are faults (`help` lists them); Ctrl-C ends it with counts.
    """
    from openacr.fieldbus.ethercat.emulated.build import segment_of
    from openacr.fieldbus.ethercat.emulated.faults import Line, helped
    from openacr.fieldbus.ethercat.emulated.port import Port

    if bus_can.is_can(interface):
        if machine is None or drives is not None or digital or analog:
            raise UserError(
                f"{interface}: nodes of a CAN bus are those of a MACHINE, without counts"
            )
        _emulate_nodes(_world(machine, None), interface, fault or [])
        return

    segment = segment_of(_world(machine, drives), digital, analog)
    if not segment.slaves:
        raise UserError("a segment has at least one drive or terminal: --drives 1")
    line = Line(segment, seed)
    later = _Later(line, fault or [])
    port = Port(line, interface)
    names = ", ".join(f"{n} {slave.name}" for n, slave in enumerate(segment.slaves))
    typer.echo(f"emulating on {interface}: {names}")
    typed = _Typed(line, helped)
    try:
        with terminations_as_interrupts():
            while True:
                if port.poll(others=typed.descriptors):
                    typed.read()
                later.act()
    except KeyboardInterrupt:
        pass
    finally:
        port.close()
        typer.echo(line.states())
        typer.echo(line.summary())


def _emulate_nodes(world: "World", interface: str, later: list[str]) -> None:
    """Emulate the CANopen nodes of a machine until Ctrl-C."""
    from openacr.fieldbus.canopen.emulated import EmulatedNodes
    from openacr.fieldbus.canopen.emulated_orders import Orders
    from openacr.io.can_link import CanLink

    if world.canopen is None or not world.canopen.node:
        raise UserError("the machine has no CANopen nodes: add [[canopen.node]]")
    link = CanLink(*bus_can.place_of(interface), world.canopen.bit_rate)
    try:
        nodes = EmulatedNodes(world, link)
        orders = Orders(nodes)
        waiting, typed = _Later(orders, later), _Typed(orders, Orders.help)
        typer.echo(f"emulating on {interface}: {', '.join(f'node {n.id}' for n in nodes.nodes)}")
        with terminations_as_interrupts():
            while True:
                if select.select(typed.descriptors, [], [], _POLL_S)[0]:
                    typed.read()
                nodes.attend()
                waiting.act()
    except KeyboardInterrupt:
        typer.echo(orders.states())
    finally:
        link.close()


class _Commanded(Protocol):
    """What takes lines of text."""

    def command(self, text: str) -> str:
        """Do one; what was done. UserError if it is not one."""

    def check(self, text: str) -> object:
        """UserError if it is not one."""


def _world(machine: Path | None, drives: int | None) -> "World":
    from openacr.fieldbus.ethercat.emulated.build import drives_world
    from openacr.plant.describe.load import load_world

    if machine is not None and drives is not None:
        raise UserError("a machine has its own drives: give MACHINE or --drives, not both")
    if machine is None:
        return drives_world(drives or 0)
    return load_world(machine / MACHINE if machine.is_dir() else machine)


class _Later:
    """Faults of the command line: those without a time act at once."""

    def __init__(self, line: _Commanded, texts: list[str]) -> None:
        self._line = line
        self._start = time.monotonic()
        self._waiting: list[tuple[float, str]] = []
        for text in texts:
            first, _, rest = text.partition(" ")
            try:
                self._waiting.append((float(first), rest))
            except ValueError:
                typer.echo(line.command(text))
        for _, text in self._waiting:
            line.check(text)
        self._waiting.sort()

    def act(self) -> None:
        """Do those whose time has come."""
        while self._waiting and time.monotonic() - self._start >= self._waiting[0][0]:
            typer.echo(self._line.command(self._waiting.pop(0)[1]))


class _Typed:
    """Faults that are typed, or come from a pipe."""

    def __init__(self, line: _Commanded, helped: Callable[[], str]) -> None:
        self._line, self._helped = line, helped
        self._begun = b""
        self.descriptors = [] if sys.stdin is None else [sys.stdin.fileno()]

    def read(self) -> None:
        """Do what was typed; at the end of the input there will be no more."""
        data = os.read(self.descriptors[0], _MOST_TYPED)
        if not data:
            self.descriptors = []
        *whole, self._begun = (self._begun + data).split(b"\n")
        for each in whole:
            self._act(each.decode("utf-8", "replace").strip())

    def _act(self, words: str) -> None:
        try:
            if words:
                typer.echo(self._helped() if words in ("help", "?") else self._line.command(words))
        except UserError as error:
            typer.echo(f"error: {error}", err=True)
