"""Encoders by their own number, whatever axis they belong to."""

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import calls_cy
from openacr.kernel.axis import feedback_cy
from openacr.map.rows import encoders, kernel
from openacr.map.words import ef
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis.settings import LONG_MAX
from openacr.motion.card import Card

_encoder_count = pick(feedback_cy.encoder_count)


def position(card: Card, number: int) -> int:
    """The position in pulses."""
    return card.memory.I[encoders.encoder_position[number]]


def reset(card: Card, number: int, position_cnt: float) -> None:
    """ENC RES: set the position and clear the signal fault flags; no axis follows."""
    if not abs(position_cnt) <= LONG_MAX:
        raise CardError(INVALID_ARGUMENT)
    card.call(calls_cy.ENCODER_SET, number, int(position_cnt))
    card.memory.I[ef.word[number]] &= ~(ef.ENCODER_SIGNAL_FAULT | ef.ENCODER_SIGNAL_LOST)


def leader(card: Card, number: int) -> int | None:
    """The encoder that one is locked to."""
    locked_to = card.memory.I[encoders.locked_to[number]]
    return locked_to - 1 if locked_to else None


def lock(card: Card, number: int, to: int) -> None:
    """ENC LOCK: count what another encoder counts; a circle of locks is refused."""
    chain: int | None = to
    while chain is not None:
        if chain == number:
            raise CardError(INVALID_ARGUMENT)
        chain = leader(card, chain)
    card.memory.I[encoders.seen[number]] = _encoder_count(card.memory.I, to)
    _link(card, encoders.locked_to[number], to + 1)


def unlock(card: Card, number: int) -> None:
    """ENC UNLOCK: count alone again."""
    _link(card, encoders.locked_to[number], 0)


def destination(card: Card, number: int) -> int | None:
    """The parameter that gets the position of an encoder."""
    return card.memory.I[encoders.destination[number]] or None


def copy_to(card: Card, number: int, parameter: int | None) -> None:
    """ENC DST: copy the position to a parameter in every servo period, or to none."""
    _link(card, encoders.destination[number], parameter or 0)


def turn_length(card: Card, number: int) -> int:
    """The length of a turn, 0 for a linear encoder."""
    return card.memory.I[encoders.rotary[number]]


def set_turn_length(card: Card, number: int, length_cnt: int) -> None:
    """ENC ROTARY: wrap the position into 0 .. length - 1; those who follow notice nothing."""
    if not 0 <= length_cnt <= LONG_MAX:
        raise CardError(INVALID_ARGUMENT)
    was = turn_length(card, number)
    card.call(calls_cy.ENCODER_ROLL, number, length_cnt)
    _count(card, kernel.linked_encoders, was, length_cnt)


def edge_limit(card: Card, number: int) -> int:
    """The rate of the quickest edges that count, 0 for all."""
    return card.memory.I[encoders.limit_hz[number]]


def set_edge_limit(card: Card, number: int, hz: int) -> None:
    """ENC LIMIT: filter the signals; the position stays."""
    if not 0 <= hz <= LONG_MAX:
        raise CardError(INVALID_ARGUMENT)
    was = edge_limit(card, number)
    card.call(calls_cy.ENCODER_LIMIT, number, hz)
    _count(card, kernel.filtered_encoders, was, hz)


def _link(card: Card, place: int, value: int) -> None:
    """Change a link."""
    old = card.memory.I[place]
    card.memory.I[place] = value
    _count(card, kernel.linked_encoders, old, value)


def _count(card: Card, place: int, old: int, new: int) -> None:
    """Count how many encoders use something: without any the kernel looks at none."""
    card.memory.I[place] += bool(new) - bool(old)
