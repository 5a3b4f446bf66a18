"""`openacr bus` for a CAN bus: its nodes, found, asked and written down."""

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from openacr.errors import UserError, unwritable

if TYPE_CHECKING:
    from openacr.fieldbus.canopen.asking import Asking, Device

DEFAULT_KBIT = 125
MODELLED = {  # keys of machine.toml, and channels in one unit of what a node says
    "digital_inputs": 8,
    "digital_outputs": 8,
    "analog_inputs": 1,
    "analog_outputs": 1,
}
MOST_NODES = 4


def is_can(interface: str) -> bool:
    """Whether an interface is a CAN bus: can0, or socketcan:can0 and the like."""
    return ":" in interface or re.fullmatch(r"v?x?can\d+|slcan\d+", interface) is not None


def place_of(interface: str) -> tuple[str, str | None]:
    """Interface and channel as python-can has them."""
    kind, separator, channel = interface.partition(":")
    return (kind, channel or None) if separator else ("socketcan", interface)


@contextmanager
def asking(interface: str, kbit: int | None) -> Iterator["Asking"]:
    """A tool on a bus."""
    from openacr.fieldbus.canopen.asking import Asking
    from openacr.io.can_link import CanLink

    link = CanLink(*place_of(interface), kbit or DEFAULT_KBIT)
    try:
        yield Asking(link)
    finally:
        link.close()


def scan(interface: str, kbit: int | None, write: Path | None, *, as_json: bool) -> None:
    """List all nodes that answer."""
    with asking(interface, kbit) as tool:
        devices = tool.scan()
    if as_json:
        typer.echo(json.dumps([_record(device) for device in devices], indent=2))
    else:
        for device in devices:
            typer.echo(_line(device))
    if not devices:
        typer.echo(f"no node answers on {interface} at {kbit or DEFAULT_KBIT} kbit/s", err=True)
    if write is not None:
        try:
            text = "\n".join(machine_lines(interface, kbit or DEFAULT_KBIT, devices)) + "\n"
            write.write_text(text, "utf-8", newline="\n")
        except OSError as failure:
            raise unwritable(write, failure) from None
        typer.echo(f"wrote {write}: read it before you use it", err=True)


def show_states(interface: str, kbit: int | None, *, as_json: bool) -> None:
    """Show the state that each node reports."""
    from openacr.fieldbus.canopen.asking import state_name

    with asking(interface, kbit) as tool:
        states = tool.states(device.node for device in tool.scan())
    if as_json:
        rows = [{"node": node, "state": state} for node, state in states.items()]
        typer.echo(json.dumps(rows, indent=2))
        return
    for node, state in states.items():
        typer.echo(f"node {node}: {state_name(state)}")


def read(interface: str, kbit: int | None, node: int, index: int, subindex: int) -> bytes:
    """Read an object of a node."""
    from openacr.fieldbus.canopen import sdo

    with asking(interface, kbit) as tool:
        return tool.one(_valid(node), sdo.read(index, subindex))


def write(
    interface: str, kbit: int | None, node: int, index: int, subindex: int, data: bytes
) -> None:
    """Write an object of a node."""
    from openacr.fieldbus.canopen import sdo

    with asking(interface, kbit) as tool:
        tool.one(_valid(node), sdo.write(index, subindex, data))


def _valid(node: int) -> int:
    from openacr.fieldbus.canopen.frames import HIGHEST_NODE

    if not 1 <= node <= HIGHEST_NODE:
        raise UserError(f"node {node}: ids of nodes are 1 to {HIGHEST_NODE}")
    return node


def _record(device: "Device") -> dict[str, object]:
    return {
        "node": device.node,
        "name": device.name,
        "type": device.kind,
        "io": device.is_io,
        **device.identity,
        **{key: MODELLED[key] * count for key, count in device.counts.items()},
    }


def _line(device: "Device") -> str:
    what = "I/O node" if device.is_io else f"profile {device.kind & 0xFFFF}"
    who = " ".join(
        f"{key} {value}" if key == "serial" else f"{key} 0x{value:X}"
        for key, value in device.identity.items()
        if value is not None
    )
    has = "".join(
        f", {MODELLED[key] * count} {key.replace('_', ' ')}"
        for key, count in device.counts.items()
        if count
    )
    return f"node {device.node}: {device.name or 'a node without a name'}, {what}{has}, {who}"


def machine_lines(interface: str, kbit: int, devices: "list[Device]") -> Iterator[str]:
    """A first machine.toml: an entry for each I/O node."""
    kind, channel = place_of(interface)
    yield "# What `openacr bus scan` has found. Look at every line with the word: check."
    yield "[card]"
    yield 'model = "ACR9000"  # the one with a CANopen controller'
    yield ""
    yield "[canopen]"
    yield f'interface = "{kind}"'
    if channel is not None:
        yield f'channel = "{channel}"'
    yield f"bit_rate = {kbit}  # P32769 has to be the same"
    nodes = [device for device in devices if device.is_io]
    for device in devices:
        if device not in nodes[:MOST_NODES]:
            why = f"a card has {MOST_NODES} nodes" if device.is_io else "it is no I/O node"
            yield f"# {_line(device)}: {why}"
    for device in nodes[:MOST_NODES]:
        yield ""
        yield "[[canopen.node]]"
        yield f"id = {device.node}  # {device.name or 'a node without a name'}"
        yield f"bit_rate = {kbit}"
        for key in ("vendor", "product"):
            if device.identity[key] is not None:
                yield f"{key} = 0x{device.identity[key]:X}"
        for key, count in device.counts.items():
            yield f"{key} = {MODELLED[key] * count}  # check: of runs without the bus"
