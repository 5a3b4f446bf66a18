"""What paces a master: time of moves (TMOV), factor (TOV) and source (SRC) of its time base."""

from __future__ import annotations

from dataclasses import dataclass

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import timebase_cy
from openacr.map.kinds_cy import kind_of
from openacr.map.numbers import (
    ADC_ADC_INPUT,
    ADC_BASE,
    ADC_COUNT,
    ADC_STRIDE,
    AX_BASE,
    AX_COUNT,
    AX_PRIMARY_SETPOINT,
    AX_STRIDE,
    ENC_BASE,
    ENC_COUNT,
    ENC_ENCODER_POSITION,
    ENC_HIGH_BASE,
    ENC_STRIDE,
    KIND_FP32,
    KIND_LONG,
    MA_MOVE_TIME,
    MA_TIME_OVER_VELOCITY,
    MF2_MASTER_IN_TMOV,
    MF2_MASTER_TOV,
    MSI_PACED,
    MSI_SOURCE_INDEX,
    MSI_SOURCE_KIND,
    STPR_BASE,
    STPR_STEPPER_COUNT,
    STPR_STRIDE,
    USER_BASE,
    USER_COUNT,
)
from openacr.messages import INVALID_ARGUMENT, INVALID_SOURCE
from openacr.motion.card import Card
from openacr.motion.rows import master_ints, master_parameter, master_word2

FASTEST = 2.0
_source_reset = pick(timebase_cy.source_reset)


# TMOV


def set_move_time(card: Card, master: int, time_s: float) -> None:
    """Let every move take this time; 0 lets them take what they need."""
    card.memory.S[master_parameter(master) + MA_MOVE_TIME] = time_s
    switch_move_time(card, master, on=time_s > 0.0)


def switch_move_time(card: Card, master: int, *, on: bool) -> None:
    """Switch timed moves on, which needs a time, or off."""
    if on and not card.memory.S[master_parameter(master) + MA_MOVE_TIME] > 0.0:
        raise CardError(INVALID_ARGUMENT)
    _switch(card, master, MF2_MASTER_IN_TMOV, on=on)


# TOV


def set_factor(card: Card, master: int, factor: float) -> None:
    """Multiply the pace of the time base, 0 to 2."""
    if not 0.0 <= factor <= FASTEST:
        raise CardError(INVALID_ARGUMENT)
    card.memory.S[master_parameter(master) + MA_TIME_OVER_VELOCITY] = factor
    switch_factor(card, master, on=True)


def switch_factor(card: Card, master: int, *, on: bool) -> None:
    """Switch the factor on or off."""
    _switch(card, master, MF2_MASTER_TOV, on=on)
    card.memory.I[master_ints(master) + MSI_PACED] = 1


def _switch(card: Card, master: int, flag: int, *, on: bool) -> None:
    word = master_word2(master)
    flags = card.memory.I[word] & ~flag
    card.memory.I[word] = flags | flag if on else flags


# SRC


@dataclass(frozen=True, slots=True)
class _Pulses:
    """Parameters that count pulses, known by a word and a number."""

    word: str
    first: int
    stride: int
    numbers: range
    kind: int = timebase_cy.FROM_LONG

    def row(self, number: int) -> int:
        return self.first + (number - self.numbers[0]) * self.stride


_PULSES = (
    _Pulses("ENC", ENC_BASE + ENC_ENCODER_POSITION, ENC_STRIDE, range(16)),
    _Pulses("ENC", ENC_HIGH_BASE + ENC_ENCODER_POSITION, ENC_STRIDE, range(16, ENC_COUNT)),
    _Pulses("STEPPER", STPR_BASE + STPR_STEPPER_COUNT, STPR_STRIDE, range(16)),
    _Pulses("AXIS", AX_BASE + AX_PRIMARY_SETPOINT, AX_STRIDE, range(AX_COUNT)),
    _Pulses("ADC", ADC_BASE + ADC_ADC_INPUT, ADC_STRIDE, range(ADC_COUNT), timebase_cy.FROM_VOLTS),
)
_SINGLES = {
    "CLK": timebase_cy.FROM_CLOCK,
    "CLOCK": timebase_cy.FROM_CLOCK,
    "NONE": timebase_cy.FROM_NOTHING,
}


def set_source(card: Card, master: int, word: str, number: int) -> None:
    """Count the time of a master by a source: 1000 of its pulses are one second."""
    kind, row = _place(card, word, number)
    rows = master_ints(master)
    card.memory.I[rows + MSI_SOURCE_KIND] = kind
    card.memory.I[rows + MSI_SOURCE_INDEX] = row
    card.memory.I[rows + MSI_PACED] = 1
    _source_reset(card.memory.F, card.memory.I, card.memory.S, master)


def _place(card: Card, word: str, number: int) -> tuple[int, int]:
    """Kind and row of a source; `Invalid source` if there is none."""
    if word in _SINGLES:
        return _SINGLES[word], 0
    if word == "P":
        return _parameter(card, number)
    for pulses in _PULSES:
        if pulses.word == word and number in pulses.numbers:
            return pulses.kind, pulses.row(number)
    raise CardError(INVALID_SOURCE)


def _parameter(card: Card, number: int) -> tuple[int, int]:
    kind = kind_of(card.memory.I, number)
    if 0 <= number < USER_COUNT:
        return timebase_cy.FROM_DOUBLE, USER_BASE + number
    if kind == KIND_LONG:
        return timebase_cy.FROM_LONG, number
    if kind == KIND_FP32:
        return timebase_cy.FROM_SINGLE, number
    raise CardError(INVALID_SOURCE)


def source_text(card: Card, master: int) -> str:
    """The source of a master as it is written."""
    rows = master_ints(master)
    kind, row = card.memory.I[rows + MSI_SOURCE_KIND], card.memory.I[rows + MSI_SOURCE_INDEX]
    for word, single in _SINGLES.items():
        if single == kind:
            return word
    for pulses in _PULSES:
        for number in pulses.numbers:
            if (kind, row) == (pulses.kind, pulses.row(number)):
                return f"{pulses.word}{number}"
    return f"P{row - USER_BASE if kind == timebase_cy.FROM_DOUBLE else row}"
