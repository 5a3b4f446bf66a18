"""Settings of axes, masters and objects: where each value lies and what it may be.

A setting that has a parameter is that parameter; the others lie in hidden rows. Values are
stored in the unit of their command, the kernel converts.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite

from msgspec import Struct

from openacr.errors import CardError
from openacr.map.block import Kind
from openacr.map.rows import axes, dacs, encoders, masters
from openacr.map.words import af5, mf2
from openacr.messages import INVALID_ARGUMENT, NO_MASTER_ATTACHED
from openacr.motion.axis.attach import Feedback, Signal
from openacr.motion.card import Card
from openacr.motion.interlocks import axes_of, master_of, needs_rest

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


def switch(value: float) -> bool:
    """0 or 1."""
    return value in (0.0, 1.0)


def multiplier(value: float) -> bool:
    """What a quadrature counter can be set to."""
    return value in MULTIPLIERS


class Setting(Struct, frozen=True):
    """One number per object, in a row of the view of its kind."""

    kind: Kind
    row: tuple[int, ...]
    allows: Callable[[float], bool] = anything

    def read(self, card: Card, number: int) -> float:
        """The value of object `number`."""
        place = self.row[number]
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
        place = self.row[number]
        memory = card.memory
        if self.kind is Kind.LONG:
            memory.I[place] = int(value)
        elif self.kind is Kind.FP32:
            memory.S[place] = value
        else:
            memory.F[place] = value


Place = tuple[Setting, int]  # a value: of which object
_Allowed = Callable[[float], bool]


def fp32(row: tuple[int, ...], allows: _Allowed = anything) -> Setting:
    """An FP32 parameter."""
    return Setting(Kind.FP32, row, allows)


def fp64(row: tuple[int, ...], allows: _Allowed = anything) -> Setting:
    """A hidden FP64 row."""
    return Setting(Kind.FP64, row, allows)


def long(row: tuple[int, ...], allows: _Allowed = anything) -> Setting:
    """A LONG parameter or hidden row."""
    return Setting(Kind.LONG, row, allows)


# end-of-travel limits: the mode of HLIM and SLIM is two flags


class LimitEnables(Struct, frozen=True):
    """The enable flags of the limits of one kind."""

    positive: int
    negative: int

    def read(self, card: Card, axis: int) -> int:
        """0 none, 1 positive, 2 negative, 3 both."""
        flags = card.memory.I[af5.word[axis]]
        return bool(flags & self.positive) + 2 * bool(flags & self.negative)

    def write(self, card: Card, axis: int, mode: int) -> None:
        """Enable by mode."""
        flags = card.memory.I[af5.word[axis]] & ~(self.positive | self.negative)
        positive = self.positive if mode & 1 else 0
        negative = self.negative if mode & 2 else 0
        card.memory.I[af5.word[axis]] = flags | positive | negative


HARD_LIMITS = LimitEnables(af5.POSITIVE_HARDWARE_LIMIT_ENABLE, af5.NEGATIVE_HARDWARE_LIMIT_ENABLE)
SOFT_LIMITS = LimitEnables(af5.POSITIVE_SOFTWARE_LIMIT_ENABLE, af5.NEGATIVE_SOFTWARE_LIMIT_ENABLE)


# MAXVEL

MAX_VELOCITY = fp32(axes.max_velocity_limit, not_negative)


def set_max_velocity(card: Card, axis: int, value_ups: float) -> None:
    """MAXVEL: limit the speed of an axis in coordinated moves, 0 is no limit."""
    MAX_VELOCITY.write(card, axis, value_ups)
    master = master_of(card, axis)
    if master is not None:
        refresh_max_velocity(card, master)


def refresh_max_velocity(card: Card, master: int) -> None:
    """Let SlaveMaxVel of a master say whether any of its axes has a limit."""
    word = mf2.word[master]
    limited = any(MAX_VELOCITY.read(card, axis) > 0.0 for axis in axes_of(card, master))
    flags = card.memory.I[word] & ~mf2.SLAVEMAXVEL
    card.memory.I[word] = flags | mf2.SLAVEMAXVEL if limited else flags


# VECDEF


def vector_weight(card: Card, axis: int) -> Place:
    """The weight of an axis in the length of moves; `No master attached` if it has none."""
    master = master_of(card, axis)
    if master is None:
        raise CardError(NO_MASTER_ATTACHED)
    slave = card.memory.I[axes.slave[axis]]
    return fp64((masters.vecdef[master] + slave,), not_negative), 0


# MULT

ENCODER_MULTIPLIER = long(encoders.mult, multiplier)


def multiplier_of(card: Card, axis: int) -> Place:
    """The one of the encoder that is the position feedback; `Invalid argument` if it is not."""
    if card.memory.I[axes.position_source[axis]] != Feedback.ENC:
        raise CardError(INVALID_ARGUMENT)
    return ENCODER_MULTIPLIER, card.memory.I[axes.position_index[axis]]


# DGAIN


def activate_derivative_smoothing(card: Card, axis: int) -> None:
    """Take over DGain Smooth: n averages the slope of the error over 2^n samples."""
    wanted = card.memory.I[axes.dgain_smooth[axis]]
    size = 1 << max(0, min(wanted, DEEPEST_SMOOTHING))
    if size == max(1, card.memory.I[axes.derivative_smooth[axis]]):
        return
    card.memory.I[axes.derivative_smooth[axis]] = size
    card.memory.I[axes.derivative_index[axis]] = 0
    card.memory.F[axes.derivative_sum[axis]] = 0.0
    for place in range(axes.DERIVATIVE_HISTORY_SIZE):
        card.memory.F[axes.derivative_history[axis] + place] = 0.0


# AXIS ON and OFF


def is_axis_on(card: Card, axis: int) -> bool:
    """Whether the axis is computed at all."""
    return bool(card.memory.I[axes.on[axis]])


def set_axis_on(card: Card, axis: int, on: bool) -> None:
    """AXIS ON and OFF; an axis that is off puts out 0 V."""
    needs_rest(card, axis)
    card.memory.I[axes.on[axis]] = int(on)
    if on:
        return
    card.memory.S[axes.output_signal[axis]] = 0.0
    if card.memory.I[axes.signal_source[axis]] == Signal.DAC:
        index = card.memory.I[axes.signal_index[axis]]
        card.memory.S[dacs.dac_output[index]] = 0.0
