"""The part of a `machine.toml` that is on an EtherCAT bus: drives of axes, terminals.

A motor keeps its modelled drive for runs without the bus; `[axis.bus]` says which drive takes its
place where the bus is open.
"""

from enum import StrEnum
from typing import Annotated

from msgspec import Meta, Struct

from openacr.map.numbers import FLAG_LAST

Place = Annotated[int, Meta(ge=0, le=65534)]
Alias = Annotated[int, Meta(ge=1, le=65535)]
Number = Annotated[int, Meta(ge=0, le=4294967295)]
Periods = Annotated[int, Meta(ge=1, le=100)]
Frames = Annotated[int, Meta(ge=1, le=1000)]
Seconds = Annotated[float, Meta(ge=0.001, le=10)]
DriveCounts = Annotated[int, Meta(ge=4, le=1_073_741_824)]
PerVolt = Annotated[float, Meta(ge=-1e9, le=1e9)]
TorquePerVolt = Annotated[float, Meta(gt=0, le=65535)]
Speed = Annotated[float, Meta(gt=0, le=100_000)]
FlagNumber = Annotated[int, Meta(ge=0, le=FLAG_LAST)]
Adc = Annotated[int, Meta(ge=0, le=7)]
Dac = Annotated[int, Meta(ge=0, le=15)]
FullVolts = Annotated[float, Meta(gt=0, le=1000)]
Points = Annotated[int, Meta(ge=0, le=256)]
Interface = Annotated[str, Meta(min_length=1, max_length=15)]

# Bits of the digital inputs of a drive (0x60FD) by name; the maker's own follow from 16 on.
INPUT_BITS = {
    "negative_limit": 0,
    "positive_limit": 1,
    "home": 2,
    "interlock": 3,
    **{f"in{number}": 15 + number for number in range(1, 17)},
}


class CyclicMode(StrEnum):
    """What the card commands every cycle: a position, a speed or a torque."""

    CSP = "csp"
    CSV = "csv"
    CST = "cst"


class Direction(StrEnum):
    """How an encoder counts at a positive voltage, or a drive on the bus as that counts up."""

    UP = "up"
    DOWN = "down"

    @property
    def sign(self) -> int:
        """1 or -1."""
        return 1 if self is Direction.UP else -1


class _OnTheBus(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    position: Place | None = None
    alias: Alias | None = None
    serial: Number | None = None
    vendor: Number | None = None
    product: Number | None = None
    revision: Number | None = None

    @property
    def place(self) -> str:
        """How the file finds the device."""
        for key in ("position", "alias", "serial"):
            if getattr(self, key) is not None:
                return f"{key} {getattr(self, key)}"
        return "no place"


class BusDriveTable(_OnTheBus, frozen=True):
    """The drive of an axis: where it is, what it is commanded, in which units."""

    mode: CyclicMode
    counts_per_rev: DriveCounts | None = None
    direction: Direction = Direction.UP
    per_volt: PerVolt | None = None
    fastest_rev_s: Speed = 200.0
    probe: bool = False
    marker: bool = False
    torque_limit: TorquePerVolt | None = None
    inputs: dict[str, FlagNumber] = {}

    @property
    def most(self) -> int:
        """The largest target, in units of the drive: torques have 16 bits, all others 32."""
        return 0x7FFF if self.mode is CyclicMode.CST else 0x7FFFFFFF


class Terminal(_OnTheBus, frozen=True):
    """A terminal: the first number on the card of each kind of channel, and how many, in order."""

    name: str = ""
    inputs_from: FlagNumber | None = None
    inputs: Points = 0
    outputs_from: FlagNumber | None = None
    outputs: Points = 0
    adcs_from: Adc | None = None
    adcs: Points = 0
    dacs_from: Dac | None = None
    dacs: Points = 0
    full_v: FullVolts = 10.0

    @property
    def label(self) -> str:
        """The name of the terminal, or its place if it has no name."""
        return self.name or self.place


class Bus(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The bus: its network interface, its cycle, what may be lost of it."""

    interface: Interface = ""
    cycle: Periods = 1
    dc: bool = True
    lost_frames: Frames = 3
    late_s: Seconds = 0.1
    enable_s: Seconds = 5.0
    terminal: tuple[Terminal, ...] = ()
