"""`openacr bus`: the devices of an EtherCAT or CAN bus, found, asked and written down."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli import bus_can
from openacr.errors import UserError, unwritable
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.fieldbus.ethercat.master.device import Device
    from openacr.fieldbus.ethercat.master.esi import Described
    from openacr.fieldbus.ethercat.master.sdo import Objects
    from openacr.fieldbus.ethercat.wire.sii import Pdo

NO_SYNC = 0xFF
Interface = Annotated[
    str,
    typer.Argument(
        metavar="IFACE",
        help="Network interface (eth1), or a CAN bus: can0, socketcan:can0, pcan:X.",
    ),
]
Position = Annotated[
    int, typer.Argument(min=0, help="Position of the device on the cable, from 0; or id of a node.")
]
BitRate = Annotated[
    int | None,
    typer.Option("--bit-rate", min=10, max=1000, help="Of a CAN bus, in kbit/s; default 125."),
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
    bit_rate: BitRate = None,
    esi: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE", help="Description by the maker (ESI): names and PDOs; repeatable."
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List the devices of an EtherCAT bus in the order of the cable, or the nodes of a CAN bus.

    Nothing is switched on: devices are only asked. --write makes a first machine.toml, an axis for
    each drive, inputs and outputs for each terminal, an entry for each I/O node of CANopen. With
    --esi each device is listed with its PDOs and their objects, and one that is not described is
    refused with the objects it names itself.
    """
    from openacr.fieldbus.ethercat.master.esi import read_esi
    from openacr.fieldbus.machine.written import machine_file

    if write is not None and write.exists():
        raise UserError(f"{write}: there is such a file already; give a new name")
    if _is_can(interface, bit_rate):
        if esi:
            raise UserError("--esi describes devices of EtherCAT: a CAN bus has none")
        bus_can.scan(interface, bit_rate, write, as_json=as_json)
        return
    files = [device for path in esi or () for device in read_esi(path)]
    with open_bus(interface) as devices:
        if as_json:
            typer.echo(json.dumps([_record(device) for device in devices], indent=2))
        else:
            for device in devices:
                typer.echo(_line(device))
                for line in _explained(device, files) if esi else ():
                    typer.echo(line)
        if esi:
            _need_described(devices, files)
        if write is not None:
            try:
                write.write_text(machine_file(interface, devices), "utf-8", newline="\n")
            except OSError as failure:
                raise unwritable(write, failure) from None
            typer.echo(f"wrote {write}: read it before you use it", err=True)


def show_states(interface: Interface, bit_rate: BitRate = None, as_json: AsJson = False) -> None:
    """Show the states of all devices, and the reason of those with an error."""
    from openacr.fieldbus.ethercat.wire.registers import al_text

    if _is_can(interface, bit_rate):
        bus_can.show_states(interface, bit_rate, as_json=as_json)
        return
    with open_bus(interface) as devices:
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
    bit_rate: BitRate = None,
) -> None:
    """Read an object of a device (SDO)."""
    index, subindex = _object(name)
    if _is_can(interface, bit_rate):
        data = bus_can.read(interface, bit_rate, position, index, subindex)
    else:
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
    bit_rate: BitRate = None,
) -> None:
    """Write an object of a device (SDO).

    The device takes it at once; whether it keeps it without power is its own affair.
    """
    index, subindex = _object(name)
    if _is_can(interface, bit_rate):
        size = len(bus_can.read(interface, bit_rate, position, index, subindex)) if not kind else 0
        data = _written(value, kind, size)
        bus_can.write(interface, bit_rate, position, index, subindex, data)
        return
    with _objects(interface, position) as objects:
        size = len(objects.read(index, subindex)) if kind is None else 0
        objects.write(index, subindex, _written(value, kind, size))


def _written(value: str, kind: Type | None, size: int) -> bytes:
    """The bytes of a value: of its type, else as many as the object has."""
    if kind is not None:
        return _packed(value, kind)
    try:
        return _number(value).to_bytes(size, "little", signed=value.startswith("-"))
    except OverflowError:
        raise UserError(f"{value}: the object has {counted(size, 'byte')}") from None


def _is_can(interface: str, bit_rate: int | None) -> bool:
    """Whether the bus is a CAN bus; UserError for a bit rate of another one."""
    if bus_can.is_can(interface):
        return True
    if bit_rate is not None:
        hint = "of a CAN bus: can0, socketcan:can0"
        raise UserError(f"--bit-rate {bit_rate}: {interface} is no CAN bus ({hint})")
    return False


@contextmanager
def open_bus(interface: str) -> "Iterator[list[Device]]":
    """The devices at a network interface, until the end; UserError where no device answers."""
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

    with open_bus(interface) as devices:
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
        "after": None if device.place is None else device.place.device,
        "port": None if device.place is None else device.place.port,
    }


def _line(device: "Device") -> str:
    who = device.description.identity
    what = "drive" if device.is_drive else "terminal"
    return (
        f"{device.position}: {device.description.name or device.description.order}, {what},"
        f" vendor 0x{who.vendor:X} product 0x{who.product:X} revision 0x{who.revision:X}"
        f" serial {who.serial} alias {device.alias}{_branch(device)}"
    )


def _explained(device: "Device", files: "list[Described]") -> "Iterator[str]":
    """The name of a device by its maker, and its PDOs; else those that it names itself."""
    from openacr.fieldbus.ethercat.master.esi import described

    one = described(device.description.identity, files)
    if one is not None:
        revision = device.description.identity.revision
        note = "" if one.who.revision == revision else f", as of revision 0x{one.who.revision:X}"
        yield f"   {one.maker} {one.name}{note}"
    found = one or device.description
    for what, pdos in (("outputs", found.receive), ("inputs", found.transmit)):
        for pdo in pdos:
            used = "" if pdo.sync == NO_SYNC else ", assigned"
            yield f"   {what} 0x{pdo.index:04X} {pdo.name}{used}: {_objects_of(pdo)}"


def _objects_of(pdo: "Pdo") -> str:
    return ", ".join(
        f"0x{one.index:04X}:{one.subindex} {one.name} ({one.bits} bits)".replace("  ", " ")
        for one in pdo.entries
        if one.index
    )


def _need_described(devices: "list[Device]", files: "list[Described]") -> None:
    from openacr.fieldbus.ethercat.master.esi import described

    unknown = [one for one in devices if described(one.description.identity, files) is None]
    if unknown:
        names = ", ".join(
            f"{one.label} (vendor 0x{one.description.identity.vendor:X}"
            f" product 0x{one.description.identity.product:X})"
            for one in unknown
        )
        raise UserError(f"{names}: not in the ESI files; the objects above are its own account")


def _branch(device: "Device") -> str:
    """Where a device is that does not follow the one before it."""
    if device.is_in_line or device.place is None:
        return ""
    return f", in a branch at port {device.place.port} of device {device.place.device}"


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
