"""Answers read back from a card: what it is set up for, however that was done."""

import struct
from collections.abc import Iterator, Mapping
from fractions import Fraction

from openacr.basic.memory.memory_cost import BUFFERED_MOVE
from openacr.configure.answers import (
    EXCESS_ERROR_U,
    Answers,
    AxisAnswers,
    CanOpen,
    CardAnswers,
    Drive,
    Gains,
    Limits,
    MasterAnswers,
)
from openacr.configure.files import DATA_PROGRAM
from openacr.configure.load import parse_answers
from openacr.configure.queries import (
    PROGRAMS,
    Card,
    attached_axes,
    attached_master,
    dimensioned_plcs,
    numbers,
    program_bytes,
)
from openacr.configure.setup_code import (
    CANOPEN_PARAMETERS,
    CONTACT_FLAGS,
    DRIVE_FLAGS,
    FIRST_PLC,
    FLAGS_PER_AXIS,
    PROFILE_WORDS,
    PROGRAM_BYTES,
    SOFT_FLAGS,
    SWITCH_FLAGS,
    WATCH_PROGRAM,
    ppu_word,
    pulses_per_unit,
)
from openacr.configure.watch_code import kept_answers
from openacr.errors import SourceError, UserError
from openacr.map.rows import axes as axis_rows
from openacr.plant.describe.schema import ModelName

LENGTHS = (1.0, 2.0, 4.0, 5.0, 10.0, 20.0, 25.0, 0.1, 0.2, 0.25, 0.5, 360.0)  # of a turn
MOST_COUNTS = 100_000_000  # of a turn
DENOMINATORS = [10**digits for digits in range(1, 9)]  # of PPU as a fraction, simple ones first


def recovered(card: Card, model: str) -> Answers:
    """Read the answers that the dialogs would show for a card of a model.

    Units and counts of a turn are one number on a card, their ratio: they are those of answers
    kept on the card where these have the same ratio, else a usual length that fits. UserError if
    no axis is set up, or where answers cannot describe one.
    """
    kept = _kept(card)
    masters = dict(_masters(card))
    names = {axis: name for _, axes in masters.values() for name, axis in axes.items()}
    axes = tuple(_axis(card, number, names[number], kept) for number in sorted(names))
    if not axes:
        raise UserError("no program has a master with axes: there is nothing to recover")
    return Answers(
        axis=axes,
        card=_card(card, model, kept),
        master=tuple(
            MasterAnswers(
                number=master,
                axes=tuple(slaves),
                **{word: numbers(card, word.upper(), program)[0] for word in PROFILE_WORDS},
            )
            for program, (master, slaves) in masters.items()
        ),
    )


def _kept(card: Card) -> Answers | None:
    """The answers that generated code keeps on the card, None without valid ones."""
    for program in (DATA_PROGRAM, WATCH_PROGRAM):
        text = kept_answers(card.command("LIST", program=program))
        try:
            if text.strip():
                return parse_answers(text)
        except SourceError:  # edited on the card
            return None
    return None


def _masters(card: Card) -> Iterator[tuple[int, tuple[int, Mapping[str, int]]]]:
    for program in PROGRAMS:
        master, slaves = attached_master(card, program)
        if master is not None and slaves:
            yield program, (master, slaves)


def _card(card: Card, model: str, kept: Answers | None) -> CardAnswers:
    known = CardAnswers() if kept is None else kept.card
    plcs = dimensioned_plcs(card)
    return CardAnswers(
        model=ModelName(model),
        option=known.option,
        firmware=known.firmware,
        minimal=numbers(card, "ADC MODE") == [0.0],
        plcs=next(n for n in range(FIRST_PLC + 1) if n not in plcs or n == FIRST_PLC),
        moves=max(0, (program_bytes(card, 0) - PROGRAM_BYTES[0]) // BUFFERED_MOVE.each),
        canopen=CanOpen(
            **{key: int(card.read(number)) for key, number in CANOPEN_PARAMETERS.items()}
        ),
    )


def _axis(card: Card, number: int, name: str, kept: Answers | None) -> AxisAnswers:
    attached = attached_axes(card)
    if number not in attached:
        raise UserError(f"axis {number} ({name}) is not attached to an encoder and an output")
    encoder, dac = attached[number]
    ppu = card.read(axis_rows.ppu[number])
    units_per_rev, counts_per_rev = turn_of(ppu, number, kept)
    words = Gains.__struct_fields__
    return AxisAnswers(
        number=number,
        name=name,
        units_per_rev=units_per_rev,
        counts_per_rev=counts_per_rev,
        encoder=None if encoder == number else encoder,
        dac=None if dac == number else dac,
        excess_error=_setting(card, number, "EXC")[0] or EXCESS_ERROR_U,
        gains=Gains(**{word: _setting(card, number, word.upper())[0] for word in words}),
        drive=Drive(**{key: _flag(card, first, number) for key, first in DRIVE_FLAGS.items()}),
        limits=_limits(card, number),
    )


def turn_of(ppu: float, number: int, kept: Answers | None = None) -> tuple[float, int]:
    """Units and counts of a turn that have a ratio; preferred are counts as encoders have them."""
    known = [
        (axis.units_per_rev, axis.counts_per_rev)
        for axis in (kept.axis if kept else ())
        if axis.number == number
    ]
    simple = [Fraction(ppu).limit_denominator(most).denominator for most in DENOMINATORS]
    possible = [(units, round(ppu * units)) for units in (*LENGTHS, *map(float, simple))]
    usual = [(units, counts) for units, counts in possible if _is_usual(counts)]
    for units, counts in (*known, *usual, *possible):
        is_allowed = 1 <= counts <= MOST_COUNTS
        if is_allowed and _single(ppu) in _stored(units, counts):
            return units, counts
    raise UserError(f"axis {number}: {ppu:g} pulses per unit are no whole counts per turn")


def _stored(units: float, counts: int) -> tuple[bytes, bytes]:
    """PPU of a turn on a card: that of the generated code, and that of the ratio itself."""
    return _single(float(ppu_word(units, counts))), _single(pulses_per_unit(units, counts))


def _single(value: float) -> bytes:
    return struct.pack("f", value)  # a card holds PPU in single precision


def _is_usual(counts: int) -> bool:
    return counts >= 1000 and (counts % 1000 == 0 or counts & (counts - 1) == 0)


def _limits(card: Card, number: int) -> Limits:
    first_input = int(_setting(card, number, "HLBIT")[0])
    deceleration, soft_deceleration = (
        _setting(card, number, word)[0] for word in ("HLDEC", "SLDEC")
    )
    positive, negative = _setting(card, number, "SLM")
    soft = None if positive == negative == 0.0 else (positive, negative)
    watches_soft = _flag(card, SOFT_FLAGS[0], number)
    return Limits(
        first_input=None if first_input == 3 * number else first_input,
        contacts_are_closed=_flag(card, CONTACT_FLAGS[0], number),
        is_enabled=_flag(card, SWITCH_FLAGS[0], number),
        deceleration=deceleration,
        soft=soft,
        soft_is_enabled=None if watches_soft == (soft is not None) else watches_soft,
        soft_deceleration=None if soft_deceleration == deceleration else soft_deceleration,
    )


def _setting(card: Card, number: int, word: str) -> list[float]:
    return numbers(card, f"AXIS{number} {word}")


def _flag(card: Card, first: int, number: int) -> bool:
    return card.read_bit(first + FLAGS_PER_AXIS * number)
