"""The network part of a `machine.toml`: CANopen nodes and communicating drives.

The n-th node of the file is the one whose inputs scenarios and wires reach at the flags the
card shows for its node n: digital inputs from 11520 + 1024 n on, digital outputs from
12032 + 1024 n on, analog input k at P33288 + 512 n + 16 k.
"""

from enum import IntEnum, StrEnum
from typing import Annotated

from msgspec import Meta, Struct

from openacr.plant.describe.bus_schema import Number

NODES = 4
DIGITAL = 512
ANALOG = 32
FAULTS = 16
SIGNALS = 16

DriveAxis = Annotated[int, Meta(ge=0, le=15)]
Address = Annotated[int, Meta(ge=0, le=99)]
Celsius = Annotated[float, Meta(ge=-60, le=300)]
BusVolts = Annotated[float, Meta(ge=0, le=1000)]
Revision = Annotated[str, Meta(pattern=r"^\d\.\d\d$")]
NodeId = Annotated[int, Meta(ge=1, le=127)]
Digital = Annotated[int, Meta(ge=0, le=DIGITAL)]
Analog = Annotated[int, Meta(ge=0, le=ANALOG)]
AnalogBits = Annotated[int, Meta(ge=8, le=16)]
Level = Annotated[float, Meta(ge=-1e6, le=1e6)]
Parameter = Annotated[int, Meta(ge=33280, le=35327)]
Moment = Annotated[float, Meta(ge=0, le=1e9)]
Share = Annotated[float, Meta(gt=0, le=1)]


Name = Annotated[str, Meta(min_length=1, max_length=200)]


class BitRate(IntEnum):
    """The bit rates of CANopen, in kbit/s."""

    KBIT_10 = 10
    KBIT_20 = 20
    KBIT_50 = 50
    KBIT_125 = 125
    KBIT_250 = 250
    KBIT_500 = 500
    KBIT_800 = 800
    MBIT_1 = 1000


class Coupler(StrEnum):
    """The bus coupler of a node, which determines its speed."""

    PIO_337 = "PIO-337"
    PIO_347 = "PIO-347"


class Health(StrEnum):
    """How a node reports that it is alive."""

    HEARTBEAT = "heartbeat"
    GUARDING = "guarding"


class FaultKind(StrEnum):
    """The kinds of faults on the bus."""

    SILENT = "silent"  # a node stops sending; its outputs stay
    LOST = "lost"  # a node without power: its outputs drop, it restarts later
    NOISE = "noise"  # a share of all messages is destroyed
    CONTROLLER = "controller"  # the network hardware of the card is broken
    SOFTWARE_OVERFLOW = "software overflow"  # received messages are lost in the card
    HARDWARE_OVERFLOW = "hardware overflow"


class Node(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One node: its coupler, its switches, and the terminals plugged into it.

    Where the bus of the computer is open, a real node takes its place, unless it is `modelled`.
    """

    id: NodeId
    name: str = ""
    modelled: bool = False
    vendor: Number | None = None
    product: Number | None = None
    revision: Number | None = None
    serial: Number | None = None
    coupler: Coupler = Coupler.PIO_337
    bit_rate: BitRate = BitRate.KBIT_125
    health: Health = Health.HEARTBEAT
    digital_inputs: Digital = 0
    digital_outputs: Digital = 0
    analog_inputs: Analog = 0
    analog_outputs: Analog = 0
    analog_bits: AnalogBits = 16
    input_range: tuple[Level, Level] = (-10.0, 10.0)
    output_range: tuple[Level, Level] = (-10.0, 10.0)
    analog_values: tuple[Level, ...] = ()


class Fault(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A fault that begins at a given time and ends at another, if given."""

    kind: FaultKind
    node: NodeId | None = None
    at_s: Moment = 0.0
    until_s: Moment | None = None
    rate: Share = 0.5


class Signal(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The source of an analog input: the position of an axis or an analog output, scaled."""

    input: Parameter
    axis: DriveAxis | None = None
    output: Parameter | None = None
    scale: Level = 1.0
    offset: Level = 0.0


class Canopen(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The CANopen bus; without this table the card has no CANopen controller.

    `interface` and `channel` name a CAN bus of the computer as python-can does.
    """

    interface: Name | None = None
    channel: Name | None = None
    bit_rate: BitRate = BitRate.KBIT_125
    node: tuple[Node, ...] = ()
    fault: tuple[Fault, ...] = ()
    signal: tuple[Signal, ...] = ()

    @property
    def real(self) -> tuple[Node, ...]:
        """The nodes for which real ones are on the bus of the computer."""
        return tuple(node for node in self.node if not node.modelled) if self.interface else ()


class DriveType(StrEnum):
    """Drives that can talk."""

    ARIES = "aries"


class DrivePort(StrEnum):
    """The port of the card to which the serial lines of drives lead."""

    COM1 = "COM1"
    COM2 = "COM2"


PORTS = {DrivePort.COM1: 1, DrivePort.COM2: 2}  # as the card numbers its ports


class Baud(IntEnum):
    """Speeds of a serial line."""

    B4800 = 4800
    B9600 = 9600
    B19200 = 19200
    B38400 = 38400
    B57600 = 57600
    B115200 = 115200


class TalkingDrive(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The serial port of the drive of an axis; what it drives is defined at the axis.

    With `serial`, a serial port of the computer, `serve` talks to a real drive.
    """

    axis: DriveAxis
    type: DriveType
    port: DrivePort = DrivePort.COM2
    serial: Name | None = None
    baud: Baud = Baud.B9600
    address: Address = 0
    revision: Revision = "2.00"
    connected_s: Moment = 0.0
    powered_s: Moment = 0.0
    lost_s: Moment | None = None
    back_s: Moment | None = None
    drive_temp_c: Celsius = 35.0
    motor_temp_c: Celsius = 30.0
    bus_v: BusVolts = 320.0
