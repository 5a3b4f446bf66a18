"""A first machine.toml of a card: what its set-up lets one guess of the machine around it.

The set-up names encoders, outputs, switch inputs and their contacts. It does not name motors or
where the switches are; what is put in their place is marked as a guess, line by line.
"""

import re
from collections.abc import Iterator, Sequence

from openacr.configure.queries import (
    PROGRAMS,
    Card,
    answer,
    attached_master,
    numbers,
)
from openacr.configure.recovered import turn_of
from openacr.configure.setup_code import CONTACT_FLAGS, FLAGS_PER_AXIS, SWITCH_FLAGS
from openacr.errors import UserError
from openacr.map.rows import axes

HOME_INVERT = 16146
COUNTS_PER_REV = 4000
FAR_REV = 100.0  # of a switch from the zero, where the set-up names no travel
HOME_REV = (-2.0, -1.5)
ROOM_REV, ROOM = 3.0, 0.05  # between a soft limit and its switch: turns at least, of the travel
INPUTS = range(32)
_ATTACHED = re.compile(r"ATTACH AXIS(\d+) ([A-Z]+)(\d+) ([A-Z]+)(\d+)")
_READ = re.compile(
    r"\b(?:BIT|INH|IHPOS|LD|AND|OR|LDN|ANDN|ORN)\s*-?\s*(?:BIT)?(\d+)", re.IGNORECASE
)


def first_machine(card: Card, model: str) -> str:
    """The text of machine.toml for a card that answers; nothing on the card changes."""
    return "".join(f"{line}\n" for line in _lines(card, model))


def _lines(card: Card, model: str) -> Iterator[str]:
    yield "# The machine around this card, guessed from its set-up. Lines with `guess` are not"
    yield "# known to the card: look at the machine and correct them (docs/machine.md)."
    yield ""
    yield "[card]"
    yield f'model = "{model}"'
    yield f"period_s = {answer(card, 'PERIOD') or '0.0005'}"
    names = {axis: name for program in PROGRAMS for name, axis in _slaves(card, program)}
    wired: set[int] = set()
    taken: set[int] = set()
    for number, feedback, encoder, signal, output in _attached(card):
        if answer(card, f"AXIS{number}") == "OFF":
            continue
        yield ""
        motor = encoder if feedback == "ENC" else output
        if motor in taken:
            yield f"# axis {number} shares the motor of number {motor}"
            continue
        taken.add(motor)
        ends = (feedback, encoder), (signal, output)
        yield from _axis(card, number, names.get(number, ""), *ends, wired)
    yield from _inputs(card, wired)


def _attached(card: Card) -> Iterator[tuple[int, str, int, str, int]]:
    for found in filter(None, map(_ATTACHED.match, card.command("ATTACH"))):
        yield int(found[1]), found[2], int(found[3]), found[4], int(found[5])


def _slaves(card: Card, program: int) -> Iterator[tuple[str, int]]:
    yield from attached_master(card, program)[1].items()


def _axis(
    card: Card,
    number: int,
    name: str,
    feedback: tuple[str, int],
    signal: tuple[str, int],
    wired: set[int],
) -> Iterator[str]:
    title = f"axis {number}{f' ({name})' if name else ''}"
    is_stepper = signal[0] == "STEPPER" and feedback[0] in ("STEPPER", "ENC")
    if not is_stepper and (feedback[0], signal[0]) != ("ENC", "DAC"):
        kinds = f"{feedback[0]}{feedback[1]} and {signal[0]}{signal[1]}"
        yield f"# {title} has {kinds}: no motor is guessed for these (docs/machine.md)"
        return
    motor = feedback[1] if feedback[0] == "ENC" else signal[1]
    units_per_rev, counts_per_rev = _turn(card, number)
    yield f"[[axis]]  # {title}"
    yield f"number = {motor}  # its encoder input" if feedback[0] == "ENC" else f"number = {motor}"
    if name:
        yield f'name = "{name}"'
    if feedback[0] == "ENC":
        counts = _raw(card, feedback[1], counts_per_rev)
        yield f"counts_per_rev = {counts}  # guess: the set-up has the ratio to units_per_rev only"
        yield "marker = 0.0  # guess: where the index pulse is, once in a revolution"
    yield f"units_per_rev = {units_per_rev:g}  # guess, as counts_per_rev"
    if not is_stepper and signal[1] != motor:
        yield f"dac = {signal[1]}"
    yield from _switches(card, number, units_per_rev, wired)
    if is_stepper:
        yield from ("", "[axis.motor]", "inertia_kgm2 = 1e-5  # guess", "", "[axis.drive]")
        yield 'mode = "stepper"'
        yield f"output = {signal[1]}"
        yield f"steps_per_rev = {counts_per_rev}  # guess, as units_per_rev"
        yield "torque_nm = [[0.0, 5.0], [50.0, 5.0]]  # guess: never loses a step"
    else:
        yield from ("", "[axis.drive]")
        yield 'mode = "exact"  # guess: follows its commands, whatever the gains of the card'


def _turn(card: Card, number: int) -> tuple[float, int]:
    ppu = card.read(axes.ppu[number])
    try:
        return turn_of(ppu, number)
    except UserError:
        return COUNTS_PER_REV / (abs(ppu) or 1.0), COUNTS_PER_REV


def _raw(card: Card, encoder: int, counts_per_rev: int) -> int:
    """Counts of all edges in a revolution: with MULT 1 or 2 the card counts some of them."""
    mult = abs(int((numbers(card, f"ENC{encoder} MULT") or [4.0])[0]))
    return max(4, counts_per_rev * 4 // mult) if mult in (1, 2) else max(4, counts_per_rev)


def _first_input(card: Card, number: int) -> int:
    return int(numbers(card, f"AXIS{number} HLBIT")[0])


def _flag(card: Card, first: int, number: int) -> bool:
    return card.read_bit(first + FLAGS_PER_AXIS * number)


def _switches(card: Card, number: int, units_per_rev: float, wired: set[int]) -> Iterator[str]:
    """The limit switches that are enabled, and a home switch on the input after them."""
    first = _first_input(card, number)
    for side, (key, at) in enumerate(_ends(card, number, units_per_rev)):
        if _flag(card, SWITCH_FLAGS[side], number):
            place = f"at = {at:g}, input = {first + side}"
            contact = _contact(_flag(card, CONTACT_FLAGS[side], number))
            yield from _switch(key, place, contact, first + side, wired)
    low, high = (turns * units_per_rev for turns in HOME_REV)
    contact = _contact(_flag(card, HOME_INVERT, number))
    place = f"between = [{low:g}, {high:g}], input = {first + 2}"
    yield from _switch("home", place, contact, first + 2, wired)


def _ends(card: Card, number: int, units_per_rev: float) -> Sequence[tuple[str, float]]:
    """Where the switches are guessed to be: beyond the soft limits, else far away."""
    positive, negative = numbers(card, f"AXIS{number} SLM")
    if positive <= negative:
        positive, negative, room = FAR_REV * units_per_rev, -FAR_REV * units_per_rev, 0.0
    else:
        room = max(ROOM_REV * units_per_rev, ROOM * (positive - negative))
    return ("positive_limit", positive + room), ("negative_limit", negative - room)


def _contact(is_closed: bool) -> str:
    return ', contact = "closed"' if is_closed else ""


def _switch(key: str, place: str, contact: str, number: int, wired: set[int]) -> Iterator[str]:
    line = f"{key} = {{ {place}{contact} }}"
    if number in wired:
        yield f"# input {number} has another switch: {line}"
    else:
        wired.add(number)
        where = "between" if key == "home" else "at"
        yield f"{line}  # guess: `{where}`; input and contact are of the set-up"


def _inputs(card: Card, wired: set[int]) -> Iterator[str]:
    """The inputs that programs read and nothing above switches."""
    readers: dict[int, list[str]] = {}
    for program in PROGRAMS:
        text = "\n".join(card.command("LIST", program=program))
        for number in {int(found) for found in _READ.findall(text)}:
            if number in INPUTS and number not in wired:
                readers.setdefault(number, []).append(f"PROG{program}")
    yield ""
    if readers:
        yield "# Inputs that programs read, off until something switches them: a scenario (docs/"
        yield "# scenario.md), a [[wire]], or this list where they are on all the time."
        yield from (f"#   {number}: {', '.join(readers[number])}" for number in sorted(readers))
    yield "[inputs]"
    yield "on = []"
