"""Global objects: commutators (CMTn), which share an axis output out to two motor phases."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.commands.global_objects import adcs, dacs, encoder_count
from openacr.basic.commands.value_commands import ObjectValue, check_number, object_values
from openacr.basic.language import registry
from openacr.basic.language.grammar import Form, Group, Int
from openacr.basic.language.nodes import Expr
from openacr.basic.language.number_format import NumberKind, number_text
from openacr.basic.language.registry import ANY
from openacr.basic.memory.saving import each, kept
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.map.rows import commutators as rows
from openacr.map.words import cmf
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.axis.settings import fp32, long, not_negative
from openacr.motion.card import Card

if TYPE_CHECKING:
    from collections.abc import Callable

    from openacr.basic.language.parser import Parser

GROUP = "Global Objects"
REF = "PG Global Objects"
command = partial(registry.command, group=GROUP, ref=REF)
FAULTS = cmf.CMT_MOTOR_OVERSPEED | cmf.CMT_ENCODER_FAULT | cmf.CMT_FOLLOWING_ERROR


class Channel(Form):
    """The number of a `channel`; its word may stand in front again, as in ENC0."""

    def __init__(self, word: str) -> None:
        super().__init__(word, optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether a number, or the word with one, stands here."""
        return p.expressions.at_value or (
            p.cursor.is_word(self.name) and p.cursor.ahead(1).kind is TokenKind.NUMBER
        )

    def parse(self, p: Parser) -> Expr:
        """Read the number."""
        p.cursor.accept(self.name)
        return p.expressions.value()

    def evaluate(self, run: Run, read: Expr | None) -> int | None:
        """The channel."""
        return None if read is None else run.integer(read)


def commutators(card: Card) -> int:
    """How many commutators there are."""
    return card.model.commutators


object_values(
    (
        ObjectValue("CMT # PPR", long(rows.pulseperrevolution), commutators,
                    "Set the pulses the encoder gives in one revolution of the motor."),
        ObjectValue("CMT # ERPMR", long(rows.elecrevpermechrev), commutators,
                    "Set the electrical cycles of one revolution of the motor.", "", "1"),
        ObjectValue("CMT # ANG", long(rows.anglebetweenphases), commutators,
                    "Set the angle from phase A to phase B.", "deg", "120"),
        ObjectValue("CMT # SHIFT", long(rows.phasemarkeroffset), commutators,
                    "Set the encoder counts from the marker to the zero of phase A.", "counts"),
        ObjectValue("CMT # MAXRPM", fp32(rows.maxmotorrpm, not_negative), commutators,
                    "Set the speed that turns a commutator off; 0 never turns it off.", "1/min"),
        ObjectValue("CMT # MAXAMP", fp32(rows.maxmotorcurrent, not_negative), commutators,
                    "Set the highest current of the phases; 0 is no limit.", "A"),
        ObjectValue("CMT # HSEN", long(rows.halleffectchannel), commutators,
                    "Choose the Hall inputs of a commutator."),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


class Channels(Struct, frozen=True):
    """Two channels of one kind."""

    word: str
    rows: tuple[tuple[int, ...], tuple[int, ...]]
    count: Callable[[Card], int]
    doc: str

    def read(self, card: Card, number: int) -> list[int]:
        """Both channels."""
        return [card.memory.I[row] for row in self._places(number)]

    def write(self, card: Card, number: int, channels: Sequence[int]) -> None:
        """Store those given; one the card does not have changes nothing."""
        for channel in channels:
            check_number(channel, self.count(card))
        for row, channel in zip(self._places(number), channels, strict=False):
            card.memory.I[row] = channel

    def _places(self, number: int) -> list[int]:
        return [row[number] for row in self.rows]


def _register(channels: Channels) -> None:
    def handler(run: Run, number: int, first: int | None, second: int | None) -> None:
        check_number(number, commutators(run.card))
        if first is None:
            run.print(",".join(map(str, channels.read(run.card, number))))
        else:
            channels.write(run.card, number, [n for n in (first, second) if n is not None])

    handler.__doc__ = channels.doc
    words = f"CMT # {channels.word}"
    grammar = (Channel(channels.word), Channel(channels.word))
    command(words, levels=ANY, grammar=grammar, saved=True)(handler)
    kept[words] = each(words, commutators, channels.read, channels.write)


for _channels in (
    Channels("ENC", (rows.feedbackencoder, rows.halleffectchannel), encoder_count,
             "Choose the feedback encoder and the Hall inputs of a commutator."),
    Channels("DAC", (rows.phaseadacchannel, rows.phasebdacchannel), dacs,
             "Choose the analog outputs of both phases."),
    Channels("ADC", (rows.phaseaadccchannel, rows.phasebadccchannel), adcs,
             "Choose the analog inputs that measure both phases."),
):  # fmt: skip
    _register(_channels)


def _offsets(card: Card, number: int) -> list[float]:
    return [card.memory.S[_first_offset(number) + phase] for phase in range(2)]


def _set_offsets(card: Card, number: int, offsets: Sequence[float]) -> None:
    for phase, offset_v in enumerate(offsets):
        card.memory.S[_first_offset(number) + phase] = offset_v


def _first_offset(number: int) -> int:
    return rows.phaseaoffset[number]


@command(
    "CMT # OFFSET",
    levels=ANY,
    units="V",
    default="0,0",
    saved=True,
    grammar=(Group("a", "b", optional=True),),
)
def cmt_offset(run: Run, number: int, offsets: tuple[float, float] | None) -> None:
    """Set what is added to the signal of each phase."""
    check_number(number, commutators(run.card))
    if offsets is None:
        run.print(",".join(number_text(v, NumberKind.SINGLE) for v in _offsets(run.card, number)))
    else:
        _set_offsets(run.card, number, offsets)


kept["CMT # OFFSET"] = each("CMT # OFFSET", commutators, _offsets, _set_offsets)


def _mode(card: Card, number: int) -> int:
    return int(card.memory.I[cmf.word[number]] & cmf.CMT_SINUSOIDAL_ON != 0)


def _set_mode(card: Card, number: int, mode: int) -> None:
    if mode not in (0, 1):
        raise CardError(INVALID_ARGUMENT)
    flags = card.memory.I[cmf.word[number]] & ~cmf.CMT_SINUSOIDAL_ON
    card.memory.I[cmf.word[number]] = flags | mode * cmf.CMT_SINUSOIDAL_ON


@command(
    "CMT # MODE", levels=ANY, default="0", saved=True, grammar=(Int("mode", 0, 1, optional=True),)
)
def cmt_mode(run: Run, number: int, mode: int | None) -> None:
    """Choose trapezoidal (0) or sinusoidal (1) commutation."""
    check_number(number, commutators(run.card))
    if mode is None:
        run.print(str(_mode(run.card, number)))
    else:
        _set_mode(run.card, number, mode)


kept["CMT # MODE"] = each("CMT # MODE", commutators, _mode, _set_mode)


@command("CMT # ON", levels=ANY)
def cmt_on(run: Run, number: int) -> None:
    """Turn a commutator on and forget what has turned it off."""
    check_number(number, commutators(run.card))
    flags = run.card.memory.I[cmf.word[number]] & ~FAULTS
    run.card.memory.I[cmf.word[number]] = flags | cmf.CMT_COMMUTATOR_ON


@command("CMT # OFF", levels=ANY)
def cmt_off(run: Run, number: int) -> None:
    """Turn a commutator off: both phases are 0 V."""
    check_number(number, commutators(run.card))
    run.card.memory.I[cmf.word[number]] &= ~cmf.CMT_COMMUTATOR_ON


@command("CMT #", levels=ANY)
def cmt_report(run: Run, number: int) -> None:
    """Report whether a commutator is on."""
    check_number(number, commutators(run.card))
    is_on = run.card.memory.I[cmf.word[number]] & cmf.CMT_COMMUTATOR_ON
    run.print("ON" if is_on else "OFF")
