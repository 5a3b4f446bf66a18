"""From a machine file to a bus in OP: find the devices, check who they are, map, synchronize."""

import logging
from contextlib import suppress
from dataclasses import dataclass

from openacr.fieldbus.cia402 import objects as of
from openacr.fieldbus.cia402.objects import Entry
from openacr.fieldbus.ethercat.master import mapping
from openacr.fieldbus.ethercat.master.device import Device, scan
from openacr.fieldbus.ethercat.master.master import Master, Member
from openacr.fieldbus.ethercat.master.port import BusError, Link, Port
from openacr.fieldbus.ethercat.master.sdo import Objects, SdoError
from openacr.fieldbus.machine import touch_probes
from openacr.plant.describe.bus_schema import Bus, BusDriveTable, CyclicMode, Terminal
from openacr.plant.describe.check_bus import MOST_V
from openacr.plant.describe.schema import Axis, World

log = logging.getLogger(__name__)

QUICK_STOP_THEN_OFF = 2  # of 0x605A: the ramp of the quick stop, then off
IDENTITY = ("vendor", "product", "revision", "serial")


@dataclass(frozen=True, slots=True)
class Brought:
    """A bus in OP: its master, and which member is the drive of which axis, or which terminal."""

    master: Master
    drives: dict[int, Member]
    terminals: list[Member]


def bring_up(link: Link, world: World, period_s: float) -> Brought:
    """Bring the bus of a machine into OP; nothing is enabled.

    BusError for a device that is missing, is another one than the file says, or refuses.
    """
    bus = world.bus or Bus()
    port = Port(link)
    devices = scan(port)
    drives = {axis.number: _found(devices, axis.bus, _what(axis)) for axis in _axes(world)}
    terminals = [_found(devices, each, f"terminal {each.label}") for each in bus.terminal]
    cycle_s = bus.cycle * period_s
    master = Master(port, devices)
    master.to_preop()
    members = {
        axis.number: _drive(axis, axis.bus, drives[axis.number], cycle_s)
        for axis in _axes(world)
        if axis.bus is not None
    }
    others = [
        _terminal(table, device) for table, device in zip(bus.terminal, terminals, strict=True)
    ]
    for member in (*members.values(), *others):
        master.join(member)
    master.to_safeop(cycle_s, with_clocks=bus.dc)
    master.to_op()
    return Brought(master, members, others)


def _axes(world: World) -> list[Axis]:
    return [axis for axis in world.axis if axis.bus is not None]


def _what(axis: Axis) -> str:
    return f"the drive of axis {axis.label}"


def _found(devices: list[Device], table: BusDriveTable | Terminal | None, what: str) -> Device:
    """The device the file means, which is who the file says."""
    if table is None:
        raise BusError(f"{what} is not on the bus")
    at = [device for device in devices if _is_at(device, table)]
    if len(at) != 1:
        number = "no device is" if not at else f"{len(at)} devices are"
        raise BusError(f"{what}: {number} at {table.place}; the bus has {_listed(devices)}")
    (device,) = at
    for key in IDENTITY:
        wanted, has = getattr(table, key), getattr(device.description.identity, key)
        if wanted is not None and wanted != has:
            raise BusError(
                f"{what}: {device.label} has {key} 0x{has:X}, machine.toml says 0x{wanted:X}:"
                " nothing is enabled"
            )
    return device


def _is_at(device: Device, table: BusDriveTable | Terminal) -> bool:
    if table.position is not None:
        return device.position == table.position
    if table.alias is not None:
        return device.alias == table.alias
    return device.description.identity.serial == table.serial


def _listed(devices: list[Device]) -> str:
    return ", ".join(f"{device.label} alias {device.alias}" for device in devices)


def _drive(axis: Axis, table: BusDriveTable, device: Device, cycle_s: float) -> Member:
    """Set up a drive in PREOP: its mode, its process data."""
    objects = Objects(device)
    mode = of.MODES[table.mode]
    with suppress(SdoError):  # a drive need not say what it can
        if not objects.number(of.SUPPORTED_MODES.object) >> mode.bit & 1:
            raise BusError(f"{_what(axis)}: {device.label} has no {table.mode.upper()}")
    objects.write(of.MODE.object, 0, mode.number.to_bytes(1, "little"))
    with suppress(SdoError):
        objects.write(of.QUICK_STOP_OPTION.object, 0, QUICK_STOP_THEN_OFF.to_bytes(2, "little"))
    with suppress(SdoError):
        _interpolate(objects, cycle_s)
    if table.mode is CyclicMode.CST:
        with suppress(SdoError):
            _compare_torque(axis, table, objects.number(of.MOST_TORQUE.object))
    outputs, inputs = _wanted(table, mode.target)
    has = device.description
    return Member(
        device,
        mapping.map_objects(
            objects, mapping.OUTPUTS_ASSIGNED, mapping.FIRST_OUTPUT_PDO, outputs, has.receive
        ),
        mapping.map_objects(
            objects, mapping.INPUTS_ASSIGNED, mapping.FIRST_INPUT_PDO, inputs, has.transmit
        ),
    )


def _compare_torque(axis: Axis, table: BusDriveTable, most: int) -> None:
    """Say where the card can ask for more torque than the drive gives."""
    asked = abs(table.per_volt or 0.0) * MOST_V
    if asked > most:
        log.warning(
            "%s: %g V ask for a torque of %g, the drive gives at most %d (0x6072)",
            _what(axis), MOST_V, asked, most,
        )  # fmt: skip


def _wanted(table: BusDriveTable, target: Entry) -> tuple[list[Entry], list[Entry]]:
    """The objects of the process data of a drive, outputs and inputs; whole words first."""
    outputs = [of.CONTROL_WORD, target]
    inputs = [of.STATUS_WORD, of.ACTUAL_POSITION, of.ERROR_CODE]
    if table.inputs:
        inputs.append(of.DIGITAL_INPUTS)
    if table.torque_limit is not None:
        outputs.append(of.MOST_TORQUE)
    if latches := touch_probes.inputs_of(table):
        outputs.append(of.PROBE_FUNCTION)
    return outputs, [*inputs, *latches, of.MODE_DISPLAY]


def _interpolate(objects: Objects, cycle_s: float) -> None:
    """Name the time between two targets: a byte times a power of ten."""
    for power in range(-3, -7, -1):
        units = cycle_s / 10.0**power
        if abs(units - round(units)) < 1e-6 and 1 <= round(units) <= 255:
            objects.write(of.INTERPOLATION_TIME.object, 1, round(units).to_bytes(1, "little"))
            objects.write(of.INTERPOLATION_TIME.object, 2, power.to_bytes(1, "little", signed=True))
            return


def _terminal(table: Terminal, device: Device) -> Member:
    """A terminal as its EEPROM describes it."""
    outputs = mapping.of_pdos(device.description.receive)
    inputs = mapping.of_pdos(device.description.transmit)
    for what, has, count in (
        ("digital outputs", outputs.contacts, table.outputs),
        ("digital inputs", inputs.contacts, table.inputs),
        ("analog outputs", outputs.words, table.dacs),
        ("analog inputs", inputs.words, table.adcs),
    ):
        if len(has) < count:
            raise BusError(
                f"the terminal {table.label}: {device.label} has {len(has)} {what},"
                f" machine.toml says {count}"
            )
    return Member(device, outputs, inputs)
