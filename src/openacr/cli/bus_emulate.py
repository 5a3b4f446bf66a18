"""`openacr bus emulate`: drives and terminals of EtherCAT on a network interface."""

import os
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.signals import terminations_as_interrupts
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.fieldbus.ethercat.emulated.faults import Line
    from openacr.plant.describe.schema import World

MACHINE = "machine.toml"
_MOST_TYPED = 4096


def emulate_bus(
    machine: Annotated[
        Path | None,
        typer.Argument(
            metavar="[MACHINE]", help="machine.toml, or a project with one: a drive for each motor."
        ),
    ] = None,
    interface: Annotated[
        str, typer.Option(help="Network interface, such as an end of a veth pair.")
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
    """Emulate EtherCAT drives and terminals on a network interface (Linux, root).

    Lines that are typed are faults (`help` lists them); Ctrl-C ends it with counts.
    """
    from openacr.fieldbus.ethercat.emulated.build import segment_of
    from openacr.fieldbus.ethercat.emulated.faults import Line
    from openacr.fieldbus.ethercat.emulated.port import Port

    segment = segment_of(_world(machine, drives), digital, analog)
    if not segment.slaves:
        raise UserError("a segment has at least one drive or terminal: --drives 1")
    line = Line(segment, seed)
    later = _Later(line, fault or [])
    port = Port(line, interface)
    names = ", ".join(f"{n} {slave.name}" for n, slave in enumerate(segment.slaves))
    typer.echo(f"emulating on {interface}: {names}")
    typed = _Typed(line)
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

    def __init__(self, line: "Line", texts: list[str]) -> None:
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

    def __init__(self, line: "Line") -> None:
        self._line = line
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
        from openacr.fieldbus.ethercat.emulated.faults import helped

        try:
            if words:
                typer.echo(helped() if words in ("help", "?") else self._line.command(words))
        except UserError as error:
            typer.echo(f"error: {error}", err=True)
