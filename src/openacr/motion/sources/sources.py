"""Sources of pulses by name, and what makes an axis follow them."""

from __future__ import annotations

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel.sources import source_cy
from openacr.kernel.sources.source_cy import (
    FROM_ANALOG,
    FROM_AXIS,
    FROM_CLOCK,
    FROM_COUNTER,
    FROM_LIMITER,
    FROM_NONE,
    FROM_PARAMETER,
    FROM_RATCHET,
    FROM_SELF,
    FROM_STEPS,
    USES,
)
from openacr.map.kinds_cy import kind_of
from openacr.map.numbers import KIND_NONE
from openacr.map.rows import followers, objects, ratchets, sources, triggers
from openacr.messages import INVALID_SOURCE
from openacr.motion.card import Card
from openacr.motion.follower_defaults import set_source

_prime = pick(source_cy.source_prime)
_value = pick(source_cy.source_reading)

_WORDS = {
    "NONE": FROM_NONE,
    "CLK": FROM_CLOCK,
    "CLOCK": FROM_CLOCK,
    "ENC": FROM_COUNTER,
    "STEPPER": FROM_STEPS,
    "AXIS": FROM_AXIS,
    "RATCH": FROM_RATCHET,
    "LIMIT": FROM_LIMITER,
    "ADC": FROM_ANALOG,
    "P": FROM_PARAMETER,
}
_NAMES = {number: word for word, number in _WORDS.items() if word != "CLOCK"}
_SINGLE = frozenset((FROM_NONE, FROM_CLOCK))
_OWN_SETPOINT = "PSP"


def axis_tap(axis: int, use: int) -> int:
    """The tap of one user (source_cy.USE_...) of an axis."""
    return axis * USES + use


def go_live(card: Card, axis: int) -> None:
    """From now on follow the sources of an axis, counting from where they are."""
    row = followers.live[axis]
    if card.memory.I[row]:
        return
    for use in range(USES):
        prime(card, axis_tap(axis, use))
    card.memory.I[row] = 1


def objects_go_live(card: Card) -> None:
    """From now on serve ratchets, limiters and the output objects."""
    card.memory.I[objects.live] = 1


def prime(card: Card, tap: int) -> None:
    """Let a tap count from the present value of its source."""
    _prime(card.memory.F, card.memory.I, card.memory.S, tap)


def value(card: Card, tap: int) -> float:
    """The present value of the source of a tap."""
    rows = card.memory.I
    memory = card.memory
    return _value(memory.F, rows, memory.S, rows[sources.kind[tap]], rows[sources.index[tap]])


def check(card: Card, word: str, number: int) -> None:
    """`Invalid source` for something the card does not have."""
    model = card.model
    counts = {
        "ENC": model.encoders,
        "STEPPER": model.axes,
        "AXIS": model.axes,
        "RATCH": ratchets.COUNT,
        "LIMIT": ratchets.COUNT,
        "ADC": model.adcs,
    }
    if word == "P":
        known = kind_of(card.memory.I, number) != KIND_NONE
    else:
        known = word not in counts or 0 <= number < counts[word]
    if not known:
        raise CardError(INVALID_SOURCE)


def choose(card: Card, tap: int, word: str, number: int) -> None:
    """Connect a source that has been checked; nothing jumps."""
    set_source(card.memory, tap, _WORDS[word], max(number, 0))
    prime(card, tap)


def connection(card: Card, tap: int) -> list[int]:
    """Kind and index of the source of a tap."""
    return [card.memory.I[sources.kind[tap]], card.memory.I[sources.index[tap]]]


def connect(card: Card, axis: int, use: int, kind: int, index: int) -> None:
    """Bring back what `connection` returned."""
    if kind != FROM_SELF:
        if kind not in _NAMES:
            raise CardError(INVALID_SOURCE)
        check(card, _NAMES[kind], index)
    go_live(card, axis)
    set_source(card.memory, axis_tap(axis, use), kind, index)
    prime(card, axis_tap(axis, use))


def text(card: Card, tap: int) -> str:
    """The source of a tap as it is typed."""
    kind = card.memory.I[sources.kind[tap]]
    if kind == FROM_SELF:
        return _OWN_SETPOINT
    name = _NAMES[kind]
    return name if kind in _SINGLE else f"{name}{card.memory.I[sources.index[tap]]}"


# triggers


def arm_passing(
    card: Card, trigger: int, parameter: int, setpoint: float, *, below: bool, timeout_s: float
) -> None:
    """Fire when a parameter passes a setpoint; give up after the timeout (0: never)."""
    memory = card.memory
    memory.F[triggers.setpoint[trigger]] = setpoint
    memory.I[triggers.parameter[trigger]] = parameter
    memory.I[triggers.ticks_left[trigger]] = card.clock.ticks(timeout_s) if timeout_s > 0.0 else 0
    memory.I[triggers.kind[trigger]] = source_cy.BELOW if below else source_cy.ABOVE


def arm_capture(
    card: Card, trigger: int, mode: int, copy_to: int = 0, register: int | None = None
) -> None:
    """Fire at the edge of a capture mode; `copy_to` receives the source position there.

    The signals are those of the source, or of the encoder whose `register` is named.
    """
    card.memory.I[triggers.mode[trigger]] = mode
    card.memory.I[triggers.copy[trigger]] = copy_to
    card.memory.I[triggers.register[trigger]] = 0 if register is None else register + 1
    card.memory.I[triggers.kind[trigger]] = source_cy.CAPTURE


def disarm(card: Card, trigger: int) -> None:
    """Wait for nothing."""
    card.memory.I[triggers.kind[trigger]] = source_cy.DISARMED
