"""`openacr bus`: the devices of an EtherCAT bus, found, asked and written down."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.errors import UserError, unwritable

if TYPE_CHECKING:
    from openacr.fieldbus.ethercat.master.device import Device
    from openacr.fieldbus.ethercat.master.sdo import Objects

Interface = Annotated[str, typer.Argument(metavar="IFACE", help="Network interface: eth1.")]
Position = Annotated[
    int, typer.Argument(min=0, help="Position of the device on the cable, from 0.")
]
Object = Annotated[str, typer.Argument(metavar="INDEX[:SUB]", help="An object: 0x6041, 1018:4.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


class Type(StrEnum):
    """How the bytes of an object are understood."""

    U8 = "u8"
    U16 = "u16"
    U32 = "u32"
    I8 = "i8"
    I16 = "i16"
    I32 = "i32"
    TEXT = "text"

    @property
    def size(self) -> int:
        """Bytes of a number."""
        return int(self.value[1:]) // 8


def scan_bus(
    interface: Interface,
    write: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write a machine.toml of what was found: a new file."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List the devices of an EtherCAT bus in the order of the cable.

    Nothing is switched on: devices are only asked. --write makes a first machine.toml, an axis for
    each drive, inputs and outputs for each terminal.
    """
    from openacr.fieldbus.machine.written import machine_file

    if write is not None and write.exists():
        raise UserError(f"{write}: there is such a file already; give a new name")
    with _devices(interface) as devices:
        if as_json:
            typer.echo(json.dumps([_record(device) for device in devices], indent=2))
        else:
            for device in devices:
                typer.echo(_line(device))
        if write is not None:
            try:
                write.write_text(machine_file(interface, devices), "utf-8", newline="\n")
            except OSError as failure:
                raise unwritable(write, failure) from None
            typer.echo(f"wrote {write}: read it before you use it", err=True)


def show_states(interface: Interface, as_json: AsJson = False) -> None:
    """Show the states of all devices, and the reason of those with an error."""
    from openacr.fieldbus.ethercat.wire.registers import al_text

    with _devices(interface) as devices:
        found = [(device, *device.state()) for device in devices]
    if as_json:
        rows = [
            {"position": device.position, "state": state.name, "code": code}
            for device, state, code in found
        ]
        typer.echo(json.dumps(rows, indent=2))
        return
    for device, state, code in found:
        typer.echo(f"{device.label}: {state.name}" + (f", {al_text(code)}" if code else ""))


def read_object(
    interface: Interface,
    position: Position,
    name: Object,
    kind: Annotated[
        Type | None, typer.Option("--type", help="Default: by its size, without a sign.")
    ] = None,
) -> None:
    """Read an object of a device (SDO)."""
    index, subindex = _object(name)
    with _objects(interface, position) as objects:
        data = objects.read(index, subindex)
    typer.echo(_shown(data, kind))


def write_object(
    interface: Interface,
    position: Position,
    name: Object,
    value: Annotated[str, typer.Argument(help="A number (0x...) or a text.")],
    kind: Annotated[
        Type | None, typer.Option("--type", help="Default: as long as the object is now.")
    ] = None,
) -> None:
    """Write an object of a device (SDO).

    The device takes it at once; whether it keeps it without power is its own affair.
    """
    index, subindex = _object(name)
    with _objects(interface, position) as objects:
        if kind is None:
            size = len(objects.read(index, subindex))
            data = _number(value).to_bytes(size, "little", signed=value.startswith("-"))
        else:
            data = _packed(value, kind)
        objects.write(index, subindex, data)


@contextmanager
def _devices(interface: str) -> "Iterator[list[Device]]":
    from openacr.fieldbus.ethercat.master.device import scan
    from openacr.fieldbus.ethercat.master.port import Port
    from openacr.io.ethercat_link import RawLink

    link = RawLink(interface)
    try:
        yield scan(Port(link))
    finally:
        link.close()


@contextmanager
def _objects(interface: str, position: int) -> "Iterator[Objects]":
    """The objects of a device, which is brought into PREOP if it is in INIT."""
    from openacr.fieldbus.ethercat.master.master import Master
    from openacr.fieldbus.ethercat.master.sdo import Objects
    from openacr.fieldbus.ethercat.wire.registers import State

    with _devices(interface) as devices:
        if position >= len(devices):
            raise UserError(f"position {position}: the bus has {len(devices)}, counted from 0")
        device = devices[position]
        objects = Objects(device)
        if device.state()[0] is State.INIT:
            Master(device.port, [device]).to_preop()
        yield objects


def _record(device: "Device") -> dict[str, Any]:
    who = device.description.identity
    return {
        "position": device.position,
        "alias": device.alias,
        "name": device.description.name,
        "order": device.description.order,
        "vendor": who.vendor,
        "product": who.product,
        "revision": who.revision,
        "serial": who.serial,
        "drive": device.is_drive,
    }


def _line(device: "Device") -> str:
    who = device.description.identity
    what = "drive" if device.is_drive else "terminal"
    return (
        f"{device.position}: {device.description.name or device.description.order}, {what},"
        f" vendor 0x{who.vendor:X} product 0x{who.product:X} revision 0x{who.revision:X}"
        f" serial {who.serial} alias {device.alias}"
    )


def _object(text: str) -> tuple[int, int]:
    index, _, subindex = text.partition(":")
    try:
        found = int(index, 16), int(subindex or "0", 0)
    except ValueError:
        found = (-1, 0)
    if not (0 <= found[0] <= 0xFFFF and 0 <= found[1] <= 0xFF):
        raise UserError(f"{text!r} is no object: 0x6041, 1018:4 (index in hexadecimal, subindex)")
    return found


def _number(text: str) -> int:
    try:
        return int(text, 0)
    except ValueError:
        raise UserError(f"{text!r} is no whole number (0x... in hexadecimal)") from None


def _packed(text: str, kind: Type) -> bytes:
    if kind is Type.TEXT:
        return text.encode("latin-1", "replace")
    value, is_signed = _number(text), kind.value.startswith("i")
    low, high = (-(1 << 8 * kind.size - 1), (1 << 8 * kind.size - 1) - 1) if is_signed else (
        0, (1 << 8 * kind.size) - 1
    )  # fmt: skip
    if not low <= value <= high:
        raise UserError(f"{text}: {kind} takes {low} to {high}")
    return value.to_bytes(kind.size, "little", signed=is_signed)


def _shown(data: bytes, kind: Type | None) -> str:
    if kind is Type.TEXT or (kind is None and len(data) not in (1, 2, 4, 8)):
        return data.partition(b"\0")[0].decode("latin-1")
    signed = kind is not None and kind.value.startswith("i")
    size = len(data) if kind is None else kind.size
    if len(data) < size:
        raise UserError(f"the object has {len(data)} bytes, {kind} needs {size}")
    value = int.from_bytes(data[:size], "little", signed=signed)
    return f"{value} (0x{int.from_bytes(data[:size], 'little'):0{2 * size}X})"
