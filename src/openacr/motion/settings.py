"""Settings of axes, masters and objects: where each value lies and what it may be.

A setting that has a parameter is that parameter; the others lie in hidden rows. Values are
stored in the unit of their command, the kernel converts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

from openacr.errors import CardError
from openacr.map.block import Kind
from openacr.map.numbers import (
    AF5_NEGATIVE_HARDWARE_LIMIT_ENABLE,
    AF5_NEGATIVE_SOFTWARE_LIMIT_ENABLE,
    AF5_POSITIVE_HARDWARE_LIMIT_ENABLE,
    AF5_POSITIVE_SOFTWARE_LIMIT_ENABLE,
    AF5_WORD,
    AX_BASE,
    AX_DGAIN_SMOOTH,
    AX_MAX_VELOCITY_LIMIT,
    AX_OUTPUT_SIGNAL,
    AX_STRIDE,
    AXF_BASE,
    AXF_DERIVATIVE_HISTORY,
    AXF_DERIVATIVE_HISTORY_SIZE,
    AXF_DERIVATIVE_SUM,
    AXF_STRIDE,
    AXI_BASE,
    AXI_DERIVATIVE_INDEX,
    AXI_DERIVATIVE_SMOOTH,
    AXI_ON,
    AXI_POSITION_INDEX,
    AXI_POSITION_SOURCE,
    AXI_SIGNAL_INDEX,
    AXI_SIGNAL_SOURCE,
    AXI_SLAVE,
    AXI_STRIDE,
    DAC_BASE,
    DAC_DAC_OUTPUT,
    DAC_STRIDE,
    ENI_BASE,
    ENI_MULT,
    ENI_STRIDE,
    MA_BASE,
    MA_STRIDE,
    MF2_SLAVEMAXVEL,
    MSF_BASE,
    MSF_STRIDE,
    MSF_VECDEF,
)
from openacr.messages import INVALID_ARGUMENT, NO_MASTER_ATTACHED
from openacr.motion.attach import Feedback, Signal
from openacr.motion.card import Card
from openacr.motion.permits import axes_of, master_of, needs_rest
from openacr.motion.rows import axis_ints, axis_parameter, axis_reals, master_reals, master_word2

LONG_MAX = 2**31 - 1
FP32_MAX = 3.4028234663852886e38
MULTIPLIERS = frozenset((-4, -2, -1, 0, 1, 2, 4))
DEEPEST_SMOOTHING = 5


def anything(value: float) -> bool:
    """No limits."""
    return True


def not_negative(value: float) -> bool:
    """0 and above."""
    return value >= 0.0


def not_zero(value: float) -> bool:
    """Anything but 0."""
    return value != 0.0


def multiplier(value: float) -> bool:
    """What a quadrature counter can be set to."""
    return value in MULTIPLIERS


@dataclass(frozen=True, slots=True)
class Setting:
    """One number per object, at `first + number * stride` of the view of its kind."""

    kind: Kind
    first: int
    stride: int
    allows: Callable[[float], bool] = anything

    def read(self, card: Card, number: int) -> float:
        """The value of object `number`."""
        place = self.first + number * self.stride
        memory = card.memory
        if self.kind is Kind.LONG:
            return memory.I[place]
        return memory.S[place] if self.kind is Kind.FP32 else memory.F[place]

    def check(self, value: float) -> None:
        """`Invalid argument` for a value that is not allowed or cannot be stored."""
        largest = LONG_MAX if self.kind is Kind.LONG else FP32_MAX
        if not isfinite(value) or abs(value) > largest or not self.allows(value):
            raise CardError(INVALID_ARGUMENT)

    def write(self, card: Card, number: int, value: float) -> None:
        """Store a value, as it is or (LONG) without its fraction."""
        self.check(value)
        place = self.first + number * self.stride
        memory = card.memory
        if self.kind is Kind.LONG:
            memory.I[place] = int(value)
        elif self.kind is Kind.FP32:
            memory.S[place] = value
        else:
            memory.F[place] = value


_Allowed = Callable[[float], bool]


def of_axis(row: int, allows: _Allowed = anything) -> Setting:
    """An FP32 parameter of each axis."""
    return Setting(Kind.FP32, AX_BASE + row, AX_STRIDE, allows)


def of_axis_long(row: int, allows: _Allowed = anything) -> Setting:
    """A LONG parameter of each axis."""
    return Setting(Kind.LONG, AX_BASE + row, AX_STRIDE, allows)


def of_axis_real(row: int, allows: _Allowed = anything) -> Setting:
    """A hidden FP64 row of each axis."""
    return Setting(Kind.FP64, AXF_BASE + row, AXF_STRIDE, allows)


def of_axis_int(row: int, allows: _Allowed = anything) -> Setting:
    """A hidden LONG row of each axis."""
    return Setting(Kind.LONG, AXI_BASE + row, AXI_STRIDE, allows)


def of_master(row: int, allows: _Allowed = not_negative) -> Setting:
    """An FP32 parameter of each master."""
    return Setting(Kind.FP32, MA_BASE + row, MA_STRIDE, allows)


def of_master_real(row: int, allows: _Allowed = not_negative) -> Setting:
    """A hidden FP64 row of each master."""
    return Setting(Kind.FP64, MSF_BASE + row, MSF_STRIDE, allows)


# end-of-travel limits: the mode of HLIM and SLIM is two flags


@dataclass(frozen=True, slots=True)
class LimitEnables:
    """The enable flags of the limits of one kind."""

    positive: int
    negative: int

    def read(self, card: Card, axis: int) -> int:
        """0 none, 1 positive, 2 negative, 3 both."""
        flags = card.memory.I[AF5_WORD + axis]
        return bool(flags & self.positive) + 2 * bool(flags & self.negative)

    def write(self, card: Card, axis: int, mode: int) -> None:
        """Enable by mode."""
        flags = card.memory.I[AF5_WORD + axis] & ~(self.positive | self.negative)
        positive = self.positive if mode & 1 else 0
        negative = self.negative if mode & 2 else 0
        card.memory.I[AF5_WORD + axis] = flags | positive | negative


HARD_LIMITS = LimitEnables(AF5_POSITIVE_HARDWARE_LIMIT_ENABLE, AF5_NEGATIVE_HARDWARE_LIMIT_ENABLE)
SOFT_LIMITS = LimitEnables(AF5_POSITIVE_SOFTWARE_LIMIT_ENABLE, AF5_NEGATIVE_SOFTWARE_LIMIT_ENABLE)


# MAXVEL

MAX_VELOCITY = of_axis(AX_MAX_VELOCITY_LIMIT, not_negative)


def set_max_velocity(card: Card, axis: int, value_ups: float) -> None:
    """MAXVEL: limit the speed of an axis in coordinated moves, 0 is no limit."""
    MAX_VELOCITY.write(card, axis, value_ups)
    master = master_of(card, axis)
    if master is not None:
        refresh_max_velocity(card, master)


def refresh_max_velocity(card: Card, master: int) -> None:
    """Let SlaveMaxVel of a master say whether any of its axes has a limit."""
    word = master_word2(master)
    limited = any(MAX_VELOCITY.read(card, axis) > 0.0 for axis in axes_of(card, master))
    flags = card.memory.I[word] & ~MF2_SLAVEMAXVEL
    card.memory.I[word] = flags | MF2_SLAVEMAXVEL if limited else flags


# VECDEF


def vector_weight(card: Card, axis: int) -> Setting:
    """The weight of an axis in the length of moves; `No master attached` if it has none."""
    master = master_of(card, axis)
    if master is None:
        raise CardError(NO_MASTER_ATTACHED)
    slave = card.memory.I[axis_ints(axis) + AXI_SLAVE]
    return Setting(Kind.FP64, master_reals(master) + MSF_VECDEF + slave, 0, not_negative)


# MULT

ENCODER_MULTIPLIER = Setting(Kind.LONG, ENI_BASE + ENI_MULT, ENI_STRIDE, multiplier)


def position_encoder(card: Card, axis: int) -> int:
    """The encoder that is the position feedback; `Invalid argument` if it is none."""
    ints = axis_ints(axis)
    if card.memory.I[ints + AXI_POSITION_SOURCE] != Feedback.ENC:
        raise CardError(INVALID_ARGUMENT)
    return card.memory.I[ints + AXI_POSITION_INDEX]


# DGAIN


def activate_derivative_smoothing(card: Card, axis: int) -> None:
    """Take over DGain Smooth: n averages the slope of the error over 2^n samples."""
    ints, reals = axis_ints(axis), axis_reals(axis)
    wanted = card.memory.I[axis_parameter(axis) + AX_DGAIN_SMOOTH]
    size = 1 << max(0, min(wanted, DEEPEST_SMOOTHING))
    if size == max(1, card.memory.I[ints + AXI_DERIVATIVE_SMOOTH]):
        return
    card.memory.I[ints + AXI_DERIVATIVE_SMOOTH] = size
    card.memory.I[ints + AXI_DERIVATIVE_INDEX] = 0
    card.memory.F[reals + AXF_DERIVATIVE_SUM] = 0.0
    for place in range(AXF_DERIVATIVE_HISTORY_SIZE):
        card.memory.F[reals + AXF_DERIVATIVE_HISTORY + place] = 0.0


# AXIS ON and OFF


def is_axis_on(card: Card, axis: int) -> bool:
    """Whether the axis is computed at all."""
    return bool(card.memory.I[axis_ints(axis) + AXI_ON])


def set_axis_on(card: Card, axis: int, on: bool) -> None:
    """AXIS ON and OFF; an axis that is off puts out 0 V."""
    needs_rest(card, axis)
    ints = axis_ints(axis)
    card.memory.I[ints + AXI_ON] = int(on)
    if on:
        return
    card.memory.S[axis_parameter(axis) + AX_OUTPUT_SIGNAL] = 0.0
    if card.memory.I[ints + AXI_SIGNAL_SOURCE] == Signal.DAC:
        index = card.memory.I[ints + AXI_SIGNAL_INDEX]
        card.memory.S[DAC_BASE + index * DAC_STRIDE + DAC_DAC_OUTPUT] = 0.0
