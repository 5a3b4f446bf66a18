"""Read and write parameters, flags and variables: by number, by name, one or many."""

import re
import struct
from collections.abc import Iterable
from functools import lru_cache
from typing import TypeAlias

from msgspec import Struct

from openacr.client.effects import Op
from openacr.client.errors import RefusedError
from openacr.client.names import What, flag_number, parameter_number
from openacr.client.requests import Ask, Level
from openacr.client.talk import Talk
from openacr.errors import UserError
from openacr.map import parameters
from openacr.map.block import FLAG_WORD_BASE, Kind
from openacr.protocol.data import DataRequest, locate
from openacr.protocol.memory import Conversion, Peek, VariableAddress, VariableKind
from openacr.protocol.packet import WORD_BYTES
from openacr.protocol.packets import Packet
from openacr.protocol.parameter import GetIeee, GetLong

Number: TypeAlias = int | float

BITS_PER_WORD = 32
TOGETHER = 16  # packets in transit at once: a small buffer holds them
PEEKED_MOST = 255  # values of one packet
ARRAY_WORDS = frozenset(("LA", "SA", "DA"))
_PEEKED = {
    "LA": (VariableKind.LA, Conversion.LONG),
    "SA": (VariableKind.SA, Conversion.FP32),
}
_INTEGER = re.compile(r"-?\d+")
_DIMENSION = re.compile(r"DIM (\w+?)\((\d+)\)")


def number_of(line: str, text: str) -> Number:
    """The number in an answer; RefusedError for anything else."""
    try:
        return int(text) if _INTEGER.fullmatch(text) else float(text)
    except ValueError:
        raise RefusedError(line, text) from None


def number_text(value: Number) -> str:
    """Format a number for a card, with all its digits."""
    return repr(value).upper() if isinstance(value, float) else str(int(value))


# --- reading ------------------------------------------------------------------------------


def ask(talk: Talk, expression: str, *, at: Level | None = None) -> Op[Number]:
    """Return the value that `?expression` prints."""
    line = f"?{expression}"
    lines = yield from talk.query(line, at=at)
    if len(lines) != 1:
        raise RefusedError(line, " / ".join(lines) or "no value")
    return number_of(line, lines[0])


def read(talk: Talk, what: What) -> Op[Number]:
    """Read one parameter: exactly, by packet, where one reaches it, otherwise by text."""
    number = parameter_number(what)
    kind = _packet_kind(talk, number)
    if kind is None:
        return (yield from ask(talk, f"P{number}"))
    packet = GetLong(number) if kind is Kind.LONG else GetIeee(number)
    return (yield from _fetch(talk, (packet,), (kind,)))[0]


def read_many(talk: Talk, whats: Iterable[What]) -> Op[list[Number]]:
    """Read several parameters in order; those of one packet group with one packet."""
    numbers = tuple(parameter_number(what) for what in whats)
    plan = _plan(numbers if talk.uses_packets else ())
    found: dict[int, Number] = {}
    for part in plan:
        got = yield from _fetch(talk, part.packets, part.kinds)
        found.update(zip(part.numbers, got, strict=True))
    for number in dict.fromkeys(numbers):
        if number not in found:
            found[number] = yield from read(talk, number)
    return [found[number] for number in numbers]


class _Part(Struct, frozen=True):
    """Packets sent together, with the parameters they return."""

    packets: tuple[DataRequest, ...]
    numbers: tuple[int, ...]
    kinds: tuple[Kind, ...]


@lru_cache(maxsize=256)
def _plan(numbers: tuple[int, ...]) -> tuple[_Part, ...]:
    """The data packets that read these parameters; cached, since hosts repeat requests."""
    packets = _packets(numbers)
    parts = []
    for at in range(0, len(packets), TOGETHER):
        chosen = tuple(packets[at : at + TOGETHER])
        asked = tuple(number for packet in chosen for number in packet.parameters())
        kinds = tuple(parameters()[number].kind for number in asked)
        parts.append(_Part(chosen, asked, kinds))
    return tuple(parts)


def _packets(numbers: Iterable[int]) -> list[DataRequest]:
    """Packets for these parameters, those of one group index in one."""
    masks: dict[tuple[int, int], int] = {}
    for number in numbers:
        packet = locate(number) if _kind(number) is not None else None
        if packet is not None:
            key = (packet.group, packet.index)
            masks[key] = masks.get(key, 0) | packet.mask
    return [DataRequest(group, index, mask) for (group, index), mask in masks.items()]


def _packet_kind(talk: Talk, number: int) -> Kind | None:
    """How a packet carries a parameter without loss; None where only text does."""
    return _kind(number) if talk.uses_packets else None


def _kind(number: int) -> Kind | None:
    known = parameters().get(number)
    return known.kind if known is not None and known.kind is not Kind.FP64 else None


def _fetch(talk: Talk, packets: tuple[Packet, ...], kinds: tuple[Kind, ...]) -> Op[list[Number]]:
    answer = yield from talk.exchange(Ask(packets))
    if len(answer.data) != WORD_BYTES * len(kinds):
        raise RefusedError(", ".join(map(str, packets)), "the reply has the wrong length")
    return list(_layout(kinds).unpack(answer.data))


@lru_cache(maxsize=256)
def _layout(kinds: tuple[Kind, ...]) -> struct.Struct:
    return struct.Struct("<" + "".join("i" if kind is Kind.LONG else "f" for kind in kinds))


def next_due_s(due_s: float, every_s: float, now_s: float) -> float:
    """When the next sample is due; missed samples are skipped."""
    missed = max(0.0, (now_s - due_s) // every_s) if every_s > 0 else 0.0
    return due_s + (missed + 1.0) * every_s


def read_bit(talk: Talk, what: What) -> Op[bool]:
    """Whether a flag is set."""
    return (yield from read_bits(talk, [what]))[0]


def read_bits(talk: Talk, whats: Iterable[What]) -> Op[list[bool]]:
    """Read several flags in order; each flag word is read once."""
    numbers = [flag_number(what) for what in whats]
    words = list(dict.fromkeys(FLAG_WORD_BASE + number // BITS_PER_WORD for number in numbers))
    found = dict(zip(words, (yield from read_many(talk, words)), strict=True))
    return [
        bool(int(found[FLAG_WORD_BASE + number // BITS_PER_WORD]) >> number % BITS_PER_WORD & 1)
        for number in numbers
    ]


# --- writing ------------------------------------------------------------------------------


def write(talk: Talk, what: What, value: Number) -> Op[None]:
    """Set one parameter; by text, since the card acknowledges no packet."""
    yield from talk.order(f"P{parameter_number(what)}={number_text(value)}")


def write_bit(talk: Talk, what: What, on: bool) -> Op[None]:
    """Set or clear a flag."""
    yield from talk.order(f"{'SET' if on else 'CLR'} {flag_number(what)}")


# --- variables and arrays of programs -----------------------------------------------------


def array_length(talk: Talk, program: int, array: str) -> Op[int]:
    """Count of elements of `LA0` (SA, DA likewise) of a program; 0 if not dimensioned."""
    lines = yield from talk.query("DIM", at=Level.program(program))
    found = (_DIMENSION.fullmatch(line) for line in lines)
    sizes = {match[1]: int(match[2]) for match in found if match}
    return sizes.get(_array_name(array), 0)


def read_array(talk: Talk, program: int, array: str, part: range | None = None) -> Op[list[Number]]:
    """Read the elements of an array of a program, all unless a range is given.

    LA and SA arrays are peeked where packets are used; a packet would round those of DA.
    """
    name = _array_name(array)
    if part is None:
        part = range((yield from array_length(talk, program, name)))
    if talk.uses_packets and name[:2] in _PEEKED:
        peeked = yield from _peek_array(talk, program, name, part)
        if peeked is not None:
            return peeked
    values: list[Number] = []
    for index in part:
        values.append((yield from ask(talk, f"{name}({index})", at=Level.program(program))))
    return values


def _peek_array(talk: Talk, program: int, name: str, part: range) -> Op[list[Number] | None]:
    """Read elements with packets; None where the program has no such elements (1:L846)."""
    kind, conversion = _PEEKED[name[:2]]
    table = yield from _word(talk, VariableAddress(program, kind))
    number = int(name[2:])
    if table == 0 or number >= (yield from _word(talk, Peek(Conversion.LONG, 1, table))):
        return None
    array = yield from _word(talk, Peek(Conversion.LONG, 1, table + 1 + number))
    length = (yield from _word(talk, Peek(Conversion.LONG, 1, array))) if array else 0
    if not part or min(part) < 0 or max(part) >= length:
        return None
    low, high = min(part), max(part) + 1
    packets = [
        Peek(conversion, min(PEEKED_MOST, high - first), array + 1 + first)
        for first in range(low, high, PEEKED_MOST)
    ]
    data = b""
    for first in range(0, len(packets), TOGETHER):
        data += (yield from talk.exchange(Ask(tuple(packets[first : first + TOGETHER])))).data
    values = struct.unpack(f"<{high - low}{conversion.stored}", data)
    return [values[index - low] for index in part]


def _word(talk: Talk, packet: Packet) -> Op[int]:
    """The word that a packet returns."""
    answer = yield from talk.exchange(Ask((packet,)))
    return int.from_bytes(answer.data, "little")


def write_array(
    talk: Talk, program: int, array: str, values: Iterable[Number], first: int = 0
) -> Op[None]:
    """Set elements of an array of a program, starting at an index."""
    name = _array_name(array)
    for index, value in enumerate(values, start=first):
        line = f"{name}({index})={number_text(value)}"
        yield from talk.order(line, at=Level.program(program))


def _array_name(array: str) -> str:
    name = array.replace(" ", "").upper()
    if name[:2] not in ARRAY_WORDS or not name[2:].isdigit():
        raise UserError(f"{array!r} is not a numeric array: use LA0, SA0, DA0 and so on")
    return name
