"""What answers do not hold of a card's set-up: found on a card that is set up by them."""

from collections.abc import Iterator

from openacr.configure.answers import Answers
from openacr.configure.files import SETUP, code_files
from openacr.configure.queries import (
    PROGRAMS,
    Card,
    Virtual,
    answer,
    axis_words,
    master_words,
)
from openacr.configure.setup_code import CONTACT_FLAGS, FLAGS_PER_AXIS, SOFT_FLAGS, SWITCH_FLAGS
from openacr.controller import Controller
from openacr.map import flag


def differences(card: Card, answers: Answers) -> Iterator[str]:
    """Compare a card with one that the answers set up, in what ESAVE keeps of axes and masters.

    A sentence for each setting that is another; words that a card does not know are left out.
    """
    other = Virtual(Controller(answers.card.model))
    other.type(code_files(answers, "")[SETUP].splitlines())
    for program in PROGRAMS:
        yield from _compared(card, other, "ATTACH", program)
    yield from _turned_off(card, answers)
    for axis in answers.axis:
        yield from _of_axis(card, other, axis.number)
    for master in answers.master:
        for word in master_words():
            yield from _compared(card, other, f"MASTER{master.number} {word}")


def _of_axis(card: Card, other: Card, number: int) -> Iterator[str]:
    found, wanted = (_attachment(each, number) for each in (card, other))
    if found != wanted:
        yield f"{found}; these answers make it {wanted}"
    for word in axis_words():
        yield from _compared(card, other, f"AXIS{number} {word}")
    for first in (*CONTACT_FLAGS, *SWITCH_FLAGS, *SOFT_FLAGS):
        bit = first + FLAGS_PER_AXIS * number
        is_set = card.read_bit(bit)
        if is_set != other.read_bit(bit):
            states = ("set", "clear") if is_set else ("clear", "set")
            yield f"BIT{bit} ({flag(bit).name}) is {states[0]}; these answers make it {states[1]}"


def _attachment(card: Card, number: int) -> str:
    lines = card.command("ATTACH")
    return next((line for line in lines if line.startswith(f"ATTACH AXIS{number} ")), "")


def _turned_off(card: Card, answers: Answers) -> Iterator[str]:
    unused = sorted(set(range(answers.card.hardware.axes)) - answers.used_axes)
    on = [f"AXIS{number}" for number in unused if answer(card, f"AXIS{number}") == "ON"]
    if on:
        yield f"on without a master: {', '.join(on)}; these answers turn them off"


def _compared(card: Card, other: Card, query: str, program: int | None = None) -> Iterator[str]:
    found, wanted = (answer(each, query, program) for each in (card, other))
    if found and found != wanted:
        at = "" if program is None else f"PROG{program}: "
        yield f"{at}{query} is {found}; these answers make it {wanted or 'nothing'}"
