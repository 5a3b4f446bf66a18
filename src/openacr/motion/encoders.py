"""Encoders by their own number, whatever axis they belong to."""

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import feedback_cy
from openacr.map.numbers import (
    EF_ENCODER_SIGNAL_FAULT,
    EF_ENCODER_SIGNAL_LOST,
    EF_WORD,
    ENC_ENCODER_POSITION,
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
