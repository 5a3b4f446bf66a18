"""The answers of a configuration: the card, its axes and its masters.

Positions are in user units of their axis, gains in the units of their commands.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from msgspec import Meta, Struct

from openacr.models import DEFAULT_MODEL, MODELS, Model
from openacr.plant.describe.schema import ModelName

EXCESS_ERROR_U = 1.0
CARD_LIMITS_SINCE = (1, 18, 15)  # first firmware that monitors the limits itself

AxisNumber = Annotated[int, Meta(ge=0, le=15)]
MasterNumber = Annotated[int, Meta(ge=0, le=15)]
AxisName = Annotated[str, Meta(pattern="^[A-Za-z]{1,4}$")]
Input = Annotated[int, Meta(ge=0, le=31)]
Positive = Annotated[float, Meta(gt=0, le=1e9)]
NotNegative = Annotated[float, Meta(ge=0, le=1e9)]
Finite = Annotated[float, Meta(ge=-1e9, le=1e9)]
Counts = Annotated[int, Meta(ge=1, le=100_000_000)]
Volts = Annotated[float, Meta(ge=0, le=10)]
UserPlcs = Annotated[int, Meta(ge=0, le=5)]  # generated limit code has the others
Moves = Annotated[int, Meta(ge=0, le=1000)]
Firmware = Annotated[str, Meta(pattern=r"^\d+\.\d+\.\d+$")]


class _Table(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A table of the file: unknown keys are errors."""


class CanOpen(_Table, frozen=True):
    """The network of CANopen nodes; its defaults are those of a card without nodes."""

    master_id: Annotated[int, Meta(ge=1, le=127)] = 5
    bit_rate_kbps: Annotated[int, Meta(ge=10, le=1000)] = 125
    cycle_ms: Annotated[int, Meta(ge=1, le=1000)] = 50
    nodes: Annotated[int, Meta(ge=0, le=4)] = 0


class CardAnswers(_Table, frozen=True):
    """The card: `minimal` omits the settings of analog inputs and CANopen nodes.

    `plcs` is how many PLCs of the user get memory, from PLC0 on, `moves` how many moves
    PROG0 has memory to buffer (DIM MBUF), beyond that for its lines.
    """

    model: ModelName = ModelName(DEFAULT_MODEL.name)
    option: str = ""
    firmware: Firmware = "1.18.15"
    minimal: bool = False
    plcs: UserPlcs = 0
    moves: Moves = 0
    canopen: CanOpen = CanOpen()

    @property
    def hardware(self) -> Model:
        """The hardware of the model."""
        return MODELS[self.model]

    @property
    def watches_limits(self) -> bool:
        """Whether the firmware monitors limits; older ones need generated programs."""
        return tuple(map(int, self.firmware.split("."))) >= CARD_LIMITS_SINCE


class Gains(_Table, frozen=True):
    """The servo loop."""

    pgain: Finite = 0.002441
    igain: Finite = 0
    ilimit: Volts = 0
    idelay: NotNegative = 0
    dgain: Finite = 0.00001
    dwidth: NotNegative = 0
    ffvel: Finite = 0
    ffacc: Finite = 0
    tlm: Volts = 10
    fbvel: Finite = 0


class Drive(_Table, frozen=True):
    """The signals of a drive and what disables it."""

    uses_signals: bool = True
    is_fault_inverted: bool = False
    step_and_direction: bool = False
    disable_on_excess_error: bool = True
    disable_on_excess_error_only: bool = False
    disable_on_kill: bool = False


class Limits(_Table, frozen=True):
    """Switches at the ends of travel, and ends of travel by position."""

    first_input: Input | None = None  # positive, negative and home switch follow each other
    contacts_are_closed: bool = True
    is_enabled: bool = True
    deceleration: NotNegative = 100
    soft: tuple[Finite, Finite] | None = None  # positive, negative
    soft_is_enabled: bool | None = None  # where positions are given
    soft_deceleration: NotNegative | None = None  # that of the switches

    @property
    def watches_soft(self) -> bool:
        """Whether ends of travel by position are on: by default as soon as they are given."""
        return self.soft is not None if self.soft_is_enabled is None else self.soft_is_enabled


class AxisAnswers(_Table, frozen=True, kw_only=True):
    """A servo axis with an encoder and an analog output."""

    number: AxisNumber
    name: AxisName
    units_per_rev: Positive
    counts_per_rev: Counts
    encoder: Annotated[int, Meta(ge=0, le=15)] | None = None  # that of the same number
    dac: Annotated[int, Meta(ge=0, le=15)] | None = None
    excess_error: Positive = EXCESS_ERROR_U
    gains: Gains = Gains()
    drive: Drive = Drive()
    limits: Limits = Limits()

    @property
    def feedback(self) -> int:
        """The encoder."""
        return self.number if self.encoder is None else self.encoder

    @property
    def output(self) -> int:
        """The analog output."""
        return self.number if self.dac is None else self.dac

    @property
    def limit_input(self) -> int:
        """The input of the positive limit switch."""
        first = self.limits.first_input
        return 3 * self.number if first is None else first


class MasterAnswers(_Table, frozen=True, kw_only=True):
    """A master, the axes it moves together and the profile of its moves."""

    number: MasterNumber
    axes: Annotated[tuple[AxisName, ...], Meta(min_length=1, max_length=16)]
    acc: NotNegative = 10
    dec: NotNegative = 10
    stp: NotNegative = 10
    vel: NotNegative = 5
    jrk: NotNegative = 0


class Answers(_Table, frozen=True, kw_only=True):
    """All answers."""

    axis: tuple[AxisAnswers, ...]
    card: CardAnswers = CardAnswers()
    master: tuple[MasterAnswers, ...] = ()

    @property
    def used_axes(self) -> set[int]:
        """The numbers of the axes."""
        return {axis.number for axis in self.axis}

    def named(self, name: str) -> AxisAnswers:
        """The axis of a name."""
        return next(axis for axis in self.axis if axis.name.upper() == name.upper())

    def master_of(self, axis: AxisAnswers) -> int | None:
        """The master that moves an axis."""
        for master in self.master:
            if axis.name.upper() in map(str.upper, master.axes):
                return master.number
        return None

    def program_of(self, master: int) -> int:
        """The program of a master: that of its number, but 7 is taken with older firmware."""
        return 8 if master == 7 and not self.card.watches_limits else master


def warnings(answers: Answers) -> Iterator[str]:
    """Report valid answers that are probably mistakes."""
    for axis in answers.axis:
        if answers.master_of(axis) is None:
            yield f"axis {axis.name} has no master: it can jog, but takes part in no move"
        soft = axis.limits.soft
        if soft is None and axis.limits.soft_is_enabled:
            yield f"axis {axis.name} has software limits enabled, but no positions for them"
    users: dict[int, str] = {}
    for axis in answers.axis:
        for number in (axis.limit_input, axis.limit_input + 1) if axis.limits.is_enabled else ():
            other = users.setdefault(number, axis.name)
            if other != axis.name:
                yield f"input {number} is a limit of both {other} and {axis.name}"
