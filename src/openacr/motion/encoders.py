"""Encoders by their own number, whatever axis they belong to."""

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import feedback_cy
from openacr.map.numbers import (
    EF_ENCODER_SIGNAL_FAULT,
    EF_ENCODER_SIGNAL_LOST,
    EF_WORD,
    ENI_BASE,
    ENI_DESTINATION,
    ENI_LOCKED_TO,
    ENI_SEEN,
    ENI_STRIDE,
    ENXI_BASE,
    ENXI_LIMIT_HZ,
    ENXI_ROTARY,
    ENXI_STRIDE,
    KRI_BASE,
    KRI_FILTERED_ENCODERS,
    KRI_LINKED_ENCODERS,
)
from openacr.map.rows import encoders
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.settings import LONG_MAX

_encoder_set = pick(feedback_cy.encoder_set)
_encoder_roll = pick(feedback_cy.encoder_roll)
_encoder_limit = pick(feedback_cy.encoder_limit)
_encoder_count = pick(feedback_cy.encoder_count)


def position(card: Card, number: int) -> int:
    """The position in pulses."""
    return card.memory.I[encoders.encoder_position[number]]


def reset(card: Card, number: int, position_cnt: float) -> None:
    """ENC RES: set the position and clear the signal fault flags; no axis is told."""
    if not abs(position_cnt) <= LONG_MAX:
        raise CardError(INVALID_ARGUMENT)
    _encoder_set(card.memory.F, card.memory.I, number, int(position_cnt))
    card.memory.I[EF_WORD + number] &= ~(EF_ENCODER_SIGNAL_FAULT | EF_ENCODER_SIGNAL_LOST)


def leader(card: Card, number: int) -> int | None:
    """The encoder that one is locked to."""
    locked_to = card.memory.I[_row(number, ENI_LOCKED_TO)]
    return locked_to - 1 if locked_to else None


def lock(card: Card, number: int, to: int) -> None:
    """ENC LOCK: count what another encoder counts; a circle of locks is refused."""
    chain: int | None = to
    while chain is not None:
        if chain == number:
            raise CardError(INVALID_ARGUMENT)
        chain = leader(card, chain)
    card.memory.I[_row(number, ENI_SEEN)] = _encoder_count(card.memory.I, to)
    _link(card, number, ENI_LOCKED_TO, to + 1)


def unlock(card: Card, number: int) -> None:
    """ENC UNLOCK: count alone again."""
    _link(card, number, ENI_LOCKED_TO, 0)


def destination(card: Card, number: int) -> int | None:
    """The parameter that gets the position of an encoder."""
    return card.memory.I[_row(number, ENI_DESTINATION)] or None


def copy_to(card: Card, number: int, parameter: int | None) -> None:
    """ENC DST: copy the position to a parameter in every servo period, or to none."""
    _link(card, number, ENI_DESTINATION, parameter or 0)


def turn_length(card: Card, number: int) -> int:
    """The length of a turn, 0 for a linear encoder."""
    return card.memory.I[_extra(number, ENXI_ROTARY)]


def set_turn_length(card: Card, number: int, length_cnt: int) -> None:
    """ENC ROTARY: wrap the position into 0 .. length - 1; those who follow notice nothing."""
    if not 0 <= length_cnt <= LONG_MAX:
        raise CardError(INVALID_ARGUMENT)
    was = turn_length(card, number)
    _encoder_roll(card.memory.I, number, length_cnt)
    _count(card, KRI_LINKED_ENCODERS, was, length_cnt)


def edge_limit(card: Card, number: int) -> int:
    """The rate of the quickest edges that count, 0 for all."""
    return card.memory.I[_extra(number, ENXI_LIMIT_HZ)]


def set_edge_limit(card: Card, number: int, hz: int) -> None:
    """ENC LIMIT: filter the signals; the position stays."""
    if not 0 <= hz <= LONG_MAX:
        raise CardError(INVALID_ARGUMENT)
    was = edge_limit(card, number)
    _encoder_limit(card.memory.F, card.memory.I, number, hz)
    _count(card, KRI_FILTERED_ENCODERS, was, hz)


def _row(number: int, row: int) -> int:
    return ENI_BASE + number * ENI_STRIDE + row


def _extra(number: int, row: int) -> int:
    return ENXI_BASE + number * ENXI_STRIDE + row


def _link(card: Card, number: int, row: int, value: int) -> None:
    """Change a link."""
    old = card.memory.I[_row(number, row)]
    card.memory.I[_row(number, row)] = value
    _count(card, KRI_LINKED_ENCODERS, old, value)


def _count(card: Card, row: int, old: int, new: int) -> None:
    """Count how many encoders use something: without any the kernel looks at none."""
    card.memory.I[KRI_BASE + row] += bool(new) - bool(old)
