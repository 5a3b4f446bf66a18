"""Encoders by their own number, whatever axis they belong to."""

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import feedback_cy
from openacr.map.numbers import (
    EF_ENCODER_SIGNAL_FAULT,
    EF_ENCODER_SIGNAL_LOST,
    EF_WORD,
    ENC_ENCODER_POSITION,
    ENI_BASE,
    ENI_DESTINATION,
    ENI_LOCKED_TO,
    ENI_SEEN,
    ENI_STRIDE,
    KRI_BASE,
    KRI_LINKED_ENCODERS,
)
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.settings import LONG_MAX

_encoder_set = pick(feedback_cy.encoder_set)


def position(card: Card, number: int) -> int:
    """The position in pulses."""
    return card.memory.I[feedback_cy.encoder_row(number) + ENC_ENCODER_POSITION]


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
    card.memory.I[_row(number, ENI_SEEN)] = position(card, to)
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


def _row(number: int, row: int) -> int:
    return ENI_BASE + number * ENI_STRIDE + row


def _link(card: Card, number: int, row: int, value: int) -> None:
    """Change a link, and count how many there are: without any the kernel looks at none."""
    old = card.memory.I[_row(number, row)]
    card.memory.I[_row(number, row)] = value
    card.memory.I[KRI_BASE + KRI_LINKED_ENCODERS] += bool(value) - bool(old)
