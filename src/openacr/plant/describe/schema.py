"""The schema of `machine.toml`: the card, its motors and the wiring.

Positions are in user units of their axis (`units_per_rev` of them per motor revolution,
counted from the machine's own zero), everything about motors and drives is in SI units.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from msgspec import Meta, Struct
from msgspec.structs import replace

from openacr.models import DEFAULT_MODEL, MODELS, Model
from openacr.plant.describe.body_schema import Body, Sign
from openacr.plant.describe.bus_schema import Bus, BusDriveTable, Direction, FlagNumber
from openacr.plant.describe.network_schema import Canopen, TalkingDrive

AXES = 16
COUNTS_PER_LINE = 4
DEFAULT_UNITS = "units"

AxisNumber = Annotated[int, Meta(ge=0, le=AXES - 1)]
Lines = Annotated[int, Meta(ge=1, le=25_000_000)]
Counts = Annotated[int, Meta(ge=4, le=100_000_000)]
Position = Annotated[float, Meta(ge=-1e9, le=1e9)]
Scale = Annotated[float, Meta(gt=0, le=1e9)]
Inertia = Annotated[float, Meta(gt=0, le=1e6)]
LoadInertia = Annotated[float, Meta(ge=0, le=1e6)]
Friction = Annotated[float, Meta(ge=0, le=1e6)]
Factor = Annotated[float, Meta(gt=0, le=1e6)]
Offset = Annotated[float, Meta(ge=-10, le=10)]
Lag = Annotated[float, Meta(ge=0, le=10)]
Delay = Annotated[float, Meta(ge=0, le=3600)]
Period = Annotated[float, Meta(ge=0.0001, le=0.005)]
DacBits = Annotated[int, Meta(ge=8, le=16)]
PolePairs = Annotated[int, Meta(ge=1, le=1000)]
Phases = Annotated[int, Meta(ge=2, le=3)]
Channel = Annotated[int, Meta(ge=0, le=7)]
Volts = Annotated[float, Meta(ge=-1000, le=1000)]
VoltsPerUnit = Annotated[float, Meta(ge=-1e6, le=1e6)]
PulsesPerRev = Annotated[int, Meta(ge=4, le=100_000_000)]
FullSteps = Annotated[int, Meta(ge=4, le=100_000)]
Speed = Annotated[float, Meta(ge=0, le=1e6)]
Torque = Annotated[float, Meta(ge=0, le=1e6)]
Damping = Annotated[float, Meta(ge=0, le=2)]
Resonance = Annotated[float, Meta(gt=0, le=10_000)]
DampingRatio = Annotated[float, Meta(ge=0, le=0.9)]
DevicePeriod = Annotated[float, Meta(ge=0.0001, le=1)]
Degrees = Annotated[float, Meta(ge=-360, le=360)]


# The cards of `openacr.models` by name, so that a wrong name is reported with the right ones.
ModelName = StrEnum("ModelName", {name: name for name in MODELS})  # type: ignore[misc]


class Contact(StrEnum):
    """A normally open contact is on while active, a normally closed one while not."""

    OPEN = "open"
    CLOSED = "closed"


class Space(StrEnum):
    """Unit of the ranges of a region."""

    USER = "user"
    REVS = "revs"
    COUNTS = "counts"


class _Table(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A table of the file: unknown keys are errors."""


class Card(_Table, frozen=True):
    """The card itself."""

    model: ModelName = ModelName(DEFAULT_MODEL.name)
    period_s: Period = 0.0005
    dac_bits: DacBits = 16
    short_override_packets: bool = False  # FOV and ROV packets as in the first edition
    digits_in_names: bool = False  # names of aliases as in programs for the successors

    @property
    def board(self) -> Model:
        """The model, with what the machine says of its language."""
        return replace(MODELS[self.model], has_digits_in_names=self.digits_in_names)


class Motor(_Table, frozen=True):
    """The motor: rotor inertia, torque per ampere (steppers: from their curve), resistance.

    A brushless motor has `pole_pairs` electrical turns per mechanical turn, and is at the
    electrical angle `electrical_zero_deg` at position 0; its torque per ampere is that of
    phase currents with an amplitude of one ampere aligned with the rotor.
    """

    inertia_kgm2: Inertia
    torque_nm_per_a: Factor | None = None
    resistance_ohm: Factor | None = None
    pole_pairs: PolePairs | None = None
    phases: Phases = 3
    electrical_zero_deg: Degrees = 0.0


class Load(_Table, frozen=True):
    """The load of the motor, as seen at its shaft, which is rigid without a resonance."""

    inertia_kgm2: LoadInertia = 0.0
    viscous_nms: Friction = 0.0
    coulomb_nm: Friction = 0.0
    static_nm: Friction | None = None
    resonance_hz: Resonance | None = None
    damping_ratio: DampingRatio = 0.01


class _Drive(_Table, frozen=True):
    fault_input: FlagNumber | None = None
    fault_contact: Contact = Contact.OPEN


class _AnalogDrive(_Drive, frozen=True):
    offset_v: Offset = 0.0


class TorqueDrive(_AnalogDrive, frozen=True, kw_only=True, tag_field="mode", tag="torque"):
    """The voltage commands a current."""

    amps_per_volt: Factor
    peak_amps: Factor
    supply_v: Factor | None = None


class PhaseDrive(TorqueDrive, frozen=True, kw_only=True, tag_field="mode", tag="phases"):
    """Two voltages command the currents of two phases: a commutator of the card turns the field."""

    dacs: tuple[AxisNumber, AxisNumber]


class VelocityDrive(_AnalogDrive, frozen=True, kw_only=True, tag_field="mode", tag="velocity"):
    """The voltage commands a speed; the drive closes the velocity loop."""

    revs_per_s_per_volt: Factor
    peak_amps: Factor
    lag_s: Lag = 0.001


class IdealDrive(_AnalogDrive, frozen=True, kw_only=True, tag_field="mode", tag="ideal"):
    """The voltage commands a speed that is reached with a lag, whatever the load."""

    revs_per_s_per_volt: Factor
    lag_s: Lag = 0.001


class ExactDrive(_Drive, frozen=True, kw_only=True, tag_field="mode", tag="exact"):
    """Any voltage takes the motor to the commanded position within a servo period."""


class StepperDrive(_Drive, frozen=True, kw_only=True, tag_field="mode", tag="stepper"):
    """Pulses turn a field that pulls the rotor along, up to a torque that falls with the speed.

    `torque_nm` lists points of the pull-out torque: revolutions per second and newton metres.
    """

    output: AxisNumber
    steps_per_rev: PulsesPerRev
    torque_nm: Annotated[tuple[tuple[Speed, Torque], ...], Meta(min_length=1, max_length=8)]
    full_steps_per_rev: FullSteps = 200
    damping: Damping = 0.2


class BusDrive(_Drive, frozen=True, kw_only=True):
    """The drive of an axis while its bus is open; no key of the file, see `real_world`."""


Drive = TorqueDrive | VelocityDrive | IdealDrive | PhaseDrive | StepperDrive | ExactDrive
LOADLESS = (IdealDrive, ExactDrive, BusDrive)  # drives without a load model, which need no motor


class LimitSwitch(_Table, frozen=True):
    """An end-of-travel switch: active at and beyond a position."""

    at: Position
    input: FlagNumber | None = None
    contact: Contact = Contact.OPEN


class HomeSwitch(_Table, frozen=True):
    """A home switch: active between two positions."""

    between: tuple[Position, Position]
    input: FlagNumber | None = None
    contact: Contact = Contact.OPEN


class Axis(_Table, frozen=True):
    """Motor `number`: its encoder is on encoder input `number`, its drive on a DAC."""

    number: AxisNumber
    drive: Drive
    name: str = ""
    units: str = DEFAULT_UNITS
    encoder_lines: Lines | None = None
    counts_per_rev: Counts | None = None
    encoder_direction: Direction = Direction.UP
    units_per_rev: Scale = 1.0
    initial: Position = 0.0
    marker: Position | None = None
    travel: tuple[Position, Position] | None = None
    dac: AxisNumber | None = None
    motor: Motor | None = None
    load: Load = Load()
    positive_limit: LimitSwitch | None = None
    negative_limit: LimitSwitch | None = None
    home: HomeSwitch | None = None
    bus: BusDriveTable | None = None
    body: Body = Body()

    @property
    def counts(self) -> int:
        """Encoder counts per revolution, four per line; pulses of a stepper without encoder."""
        if isinstance(self.drive, StepperDrive) and not self.has_encoder:
            return self.drive.steps_per_rev
        return self.counts_per_rev or COUNTS_PER_LINE * (self.encoder_lines or 0)

    @property
    def has_encoder(self) -> bool:
        """Whether the axis has an encoder."""
        return self.counts_per_rev is not None or self.encoder_lines is not None

    @property
    def counts_per_unit(self) -> float:
        """Encoder counts per user unit."""
        return self.counts / self.units_per_rev

    @property
    def label(self) -> str:
        """The name of the axis, or its number if it has no name."""
        return self.name or str(self.number)


class Wire(_Table, frozen=True):
    """A further source of an input: a region of space or an output of the card."""

    input: FlagNumber
    name: str = ""
    contact: Contact = Contact.OPEN
    region: dict[str, tuple[Position, Position]] | None = None
    units: Space = Space.USER
    output: FlagNumber | None = None
    delay_s: Delay = 0.0


class Analog(_Table, frozen=True):
    """The voltage at an analog input: fixed, with the position of an axis, or an analog output."""

    input: Channel
    volts: Volts = 0.0
    axis: AxisNumber | None = None
    volts_per_unit: VoltsPerUnit = 0.0
    dac: AxisNumber | None = None


class Inputs(_Table, frozen=True):
    """Inputs with a constant level."""

    on: tuple[FlagNumber, ...] = ()
    off: tuple[FlagNumber, ...] = ()


class DeviceTable(_Table, frozen=True):
    """A device that is a Python class: its kind, and what of the card each name is wired to."""

    kind: str
    name: str = ""
    outputs: dict[str, FlagNumber] = {}
    dacs: dict[str, AxisNumber] = {}
    axes: dict[str, AxisNumber] = {}
    inputs: dict[str, FlagNumber] = {}
    analogs: dict[str, Channel] = {}
    settings: dict[str, bool | int | float | str] = {}
    period_s: DevicePeriod = 0.001
    sign: Sign | None = None

    @property
    def label(self) -> str:
        """The name of the device, or its kind if it has no name."""
        return self.name or self.kind


class World(_Table, frozen=True):
    """The machine around the card, and the card model."""

    card: Card = Card()
    axis: tuple[Axis, ...] = ()
    wire: tuple[Wire, ...] = ()
    analog: tuple[Analog, ...] = ()
    inputs: Inputs = Inputs()
    bus: Bus | None = None
    canopen: Canopen | None = None
    drive: tuple[TalkingDrive, ...] = ()
    device: tuple[DeviceTable, ...] = ()


@dataclass(frozen=True, slots=True)
class Switch:
    """A switch of an axis: its key in the file, its input and its active range."""

    key: str
    input: int
    contact: Contact
    low_u: float
    high_u: float


EVERYWHERE_U = float("inf")
EXACT_LIMIT_REV = 100.0
EXACT_HOME_REV = (-2.0, -1.5)


def switches(axis: Axis) -> Iterator[Switch]:
    """Yield the switches of an axis; the inputs default to 3n, 3n + 1 and 3n + 2."""
    first = 3 * axis.number
    if limit := axis.positive_limit:
        yield Switch(
            "positive_limit", _or(limit.input, first), limit.contact, limit.at, EVERYWHERE_U
        )
    if limit := axis.negative_limit:
        yield Switch(
            "negative_limit", _or(limit.input, first + 1), limit.contact, -EVERYWHERE_U, limit.at
        )
    if home := axis.home:
        yield Switch("home", _or(home.input, first + 2), home.contact, *home.between)


def _or(chosen: int | None, default: int) -> int:
    return default if chosen is None else chosen


# The machine of `openacr serve` without a project: exact axes with the switches on the inputs
# the manual names, so that a move ends on its target and homing finds its switch both ways.
def exact_world(model: Model = DEFAULT_MODEL) -> World:
    """Build eight exact axes with limit and home switches, in revolutions of 4000 counts."""
    return World(
        card=Card(model=ModelName(model.name)),
        axis=tuple(
            Axis(
                number=number,
                drive=ExactDrive(),
                units="rev",
                encoder_lines=DEFAULT_LINES,
                marker=0.0,
                positive_limit=LimitSwitch(at=EXACT_LIMIT_REV),
                negative_limit=LimitSwitch(at=-EXACT_LIMIT_REV),
                home=HomeSwitch(between=EXACT_HOME_REV),
            )
            for number in range(DEFAULT_AXES)
        ),
    )


# The motors of a card without a machine file. An ideal drive with this gain is critically
# damped by the card's default PGAIN of 0.002441 alone (0.002441 V/count * 25 rev/s/V * 4000
# counts/rev = 244 /s, lag 1 ms) and reaches 250 rev/s; there is nothing to run into.
_WELL_BEHAVED = IdealDrive(revs_per_s_per_volt=25.0, lag_s=0.001)
DEFAULT_LINES = 1000
DEFAULT_AXES = 8


def default_world(model: Model = DEFAULT_MODEL) -> World:
    """Build the world of a controller file without a machine: eight well-behaved axes."""
    return World(
        card=Card(model=ModelName(model.name)),
        axis=tuple(
            Axis(number=number, drive=_WELL_BEHAVED, encoder_lines=DEFAULT_LINES, marker=0.0)
            for number in range(DEFAULT_AXES)
        ),
    )
