"""An I/O node (CiA 401): what it has, and how it is set up for the master of the card.

The first 64 digital inputs are in the first process data of the node (0x1800), the analog inputs
in the next three, four in each; what is more follows from the fifth on with free identifiers.
Outputs are arranged equally (0x1400). Digital inputs are sent when they change, all else with each
synchronisation.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum

from openacr.fieldbus.canopen.frames import Cob
from openacr.fieldbus.canopen.sdo import NodeError, Read, RefusedError, Script, Write, number
from openacr.plant.bus.bus import Found
from openacr.plant.describe.network_schema import ANALOG, DIGITAL, Node

PROFILE = 401
IDENTITY = ("vendor", "product", "revision", "serial")
HEARTBEAT, GUARDING = 1, 2
ON_CHANGE, EACH_SYNC = 255, 1  # transmission types
INVALID, NO_REMOTE = 1 << 31, 1 << 30  # bits of the identifier in an object
PREDEFINED = 4
BYTES, CHANNELS = 8, 4  # in one frame
HIGHEST_TIME_MS = 65535


class Kind(Enum):
    """What process data carries: its object, bits of a value, values in a frame."""

    DIGITAL_INPUTS = (0x6000, 8, BYTES)
    DIGITAL_OUTPUTS = (0x6200, 8, BYTES)
    ANALOG_INPUTS = (0x6401, 16, CHANNELS)
    ANALOG_OUTPUTS = (0x6411, 16, CHANNELS)


@dataclass(frozen=True, slots=True)
class Part:
    """What one frame carries: values from `first` (from 0) on; `pdo` is its number on the node."""

    pdo: int
    kind: Kind
    first: int
    count: int


@dataclass(frozen=True, slots=True)
class IoNode:
    """A node that is set up: what it has, and which identifier carries what."""

    found: Found
    inputs: dict[int, Part]
    outputs: dict[int, Part]


@dataclass(frozen=True, slots=True)
class Wishes:
    """What the master asks of a node."""

    node: int
    master: int
    health_ms: int
    table: Node | None  # of the machine file: who it has to be
    free: Iterator[int]  # identifiers for more process data


def parts(digital: int, analog: int, kinds: tuple[Kind, Kind]) -> list[Part]:
    """How bytes of digital and channels of analog signals are divided into frames."""
    of_digital, of_analog = (
        [
            (kind, first, min(kind.value[2], count - first))
            for first in range(0, count, kind.value[2])
        ]
        for kind, count in zip(kinds, (digital, analog), strict=True)
    )
    more = [*of_digital[1:], *of_analog[PREDEFINED - 1 :]]
    return [
        *(Part(0, *each) for each in of_digital[:1]),
        *(Part(1 + place, *each) for place, each in enumerate(of_analog[: PREDEFINED - 1])),
        *(Part(PREDEFINED + place, *each) for place, each in enumerate(more)),
    ]


def set_up(wishes: Wishes) -> Script[IoNode]:
    """Check who a node is, ask what it has and set it up; NodeError if it is another one."""
    kind = yield from number(0x1000)
    if kind & 0xFFFF != PROFILE:
        raise NodeError(f"it is no I/O node: device type 0x{kind:08X}, not of CiA {PROFILE}")
    yield from _check_identity(wishes.table)
    counts = []
    for bit, each in enumerate(Kind):
        is_there = kind >> 16 + bit & 1
        counts.append((yield from number(each.value[0])) if is_there else 0)
    digital_in, digital_out, analog_in, analog_out = counts
    health = yield from _set_health(wishes)
    found = Found(digital_in, digital_out, analog_in, analog_out, health)
    if max(digital_in, digital_out) > DIGITAL // 8 or max(analog_in, analog_out) > ANALOG:
        return IoNode(found, {}, {})  # more than a card takes, which the card sees itself
    if analog_in:
        with suppress(RefusedError):  # analog inputs are sent at all
            yield Write(0x6423, 0, b"\1")
    inputs = parts(digital_in, analog_in, (Kind.DIGITAL_INPUTS, Kind.ANALOG_INPUTS))
    outputs = parts(digital_out, analog_out, (Kind.DIGITAL_OUTPUTS, Kind.ANALOG_OUTPUTS))
    return IoNode(
        found,
        (yield from _map(wishes, inputs, 0x1800, Cob.INPUTS)),
        (yield from _map(wishes, outputs, 0x1400, Cob.OUTPUTS)),
    )


def _check_identity(table: Node | None) -> Script[None]:
    for subindex, key in enumerate(IDENTITY, 1):
        wanted = None if table is None else getattr(table, key)
        if wanted is not None and (has := (yield from number(0x1018, subindex))) != wanted:
            raise NodeError(f"it has {key} 0x{has:X}, machine.toml says 0x{wanted:X}")


def _set_health(wishes: Wishes) -> Script[int]:
    """Have the node report its health, twice in a period; and let it watch the master.

    A node that no longer hears the master takes its outputs back as it is set up (0x1029, 0x6206).
    """
    half = max(1, min(wishes.health_ms // 2, HIGHEST_TIME_MS)).to_bytes(2, "little")
    health = HEARTBEAT
    try:
        yield Write(0x1017, 0, half)
    except RefusedError:
        health = GUARDING
        with suppress(RefusedError):
            yield Write(0x100C, 0, half)
            yield Write(0x100D, 0, b"\3")
        return health
    patience = min(wishes.health_ms * 3 // 2, HIGHEST_TIME_MS)
    with suppress(RefusedError):
        yield Write(0x1016, 1, (wishes.master << 16 | patience).to_bytes(4, "little"))
    return health


def _map(wishes: Wishes, wanted: Sequence[Part], first: int, base: int) -> Script[dict[int, Part]]:
    """Set up process data; NodeError if the node cannot have it so."""
    placed = {}
    for part in wanted:
        if part.pdo < PREDEFINED:
            identifier = base + 0x100 * part.pdo + wishes.node
        else:
            identifier = next(wishes.free)
        kind = ON_CHANGE if part.kind is Kind.DIGITAL_INPUTS else EACH_SYNC
        try:
            yield from _set_pdo(first + part.pdo, identifier, kind, part)
        except RefusedError as failure:
            text = f"its process data cannot be set up: {failure}"
            raise NodeError(text) from None
        placed[identifier] = part
    return placed


def _set_pdo(communication: int, identifier: int, kind: int, part: Part) -> Script[None]:
    index, bits, _ = part.kind.value
    entries = [index << 16 | part.first + place + 1 << 8 | bits for place in range(part.count)]
    now = yield from number(communication, 1)
    mapping = communication + 0x200
    has = yield from _mapping(mapping)
    if (now & ~NO_REMOTE) == identifier and has == entries:
        if (yield from number(communication, 2)) == kind:
            return
    wanted = identifier | now & NO_REMOTE
    yield Write(communication, 1, (wanted | INVALID).to_bytes(4, "little"))
    yield Write(communication, 2, bytes((kind,)))
    if has != entries:
        yield Write(mapping, 0, b"\0")
        for place, entry in enumerate(entries, 1):
            yield Write(mapping, place, entry.to_bytes(4, "little"))
        yield Write(mapping, 0, bytes((len(entries),)))
    yield Write(communication, 1, wanted.to_bytes(4, "little"))


def _mapping(mapping: int) -> Script[list[int]]:
    count = yield from number(mapping)
    entries = []
    for place in range(1, min(count, BYTES) + 1):
        entries.append((yield from number(mapping, place)))
    return entries


def read_inputs(count: int) -> Script[bytes]:
    """The digital inputs as they are: a node need not send those that do not change."""
    found = b""
    for place in range(1, count + 1):
        found += (yield Read(0x6000, place))[:1]
    return found
