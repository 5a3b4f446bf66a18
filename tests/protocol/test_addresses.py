"""Peek, poke and address packets on the real memory of a card."""

import struct
from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from openacr.basic.memory.storage import Storage
from openacr.errors import MapError
from openacr.map.memory import Memory
from openacr.protocol.addresses import AddressSpace
from openacr.protocol.execute import execute
from openacr.protocol.memory import (
    Conversion,
    Peek,
    Poke,
    VariableAddress,
    VariableKind,
)
from openacr.protocol.move import Move
from openacr.protocol.packet import Packet


class Card:
    """A host over real memory; moves and overrides are not its business."""

    def __init__(self) -> None:
        self.memory = Memory()
        self.storage = Storage(self.memory)
        self.space = AddressSpace(self.memory, lambda: self.storage.locals.strings)
        self.read_parameter = self.memory.read
        self.write_parameter = self.memory.write
        self.write_bit = self.memory.set_bit
        self.read_words = self.space.read_words
        self.write_words = self.space.write_words
        self.parameter_address = self.space.parameter_address
        self.variable_address = self.space.variable_address

    def override(self, masters: Sequence[int], value: float, *, rapid: bool) -> None:
        raise NotImplementedError

    def issue_move(self, move: Move) -> None:
        raise NotImplementedError

    def ask(self, packet: Packet) -> tuple[int, ...]:
        """The words after the repeated request."""
        reply = execute(self, packet)[len(packet.encode()) :]
        return struct.unpack(f"<{len(reply) // 4}I", reply)

    def peek(self, address: int, count: int = 1) -> tuple[int, ...]:
        return self.ask(Peek(Conversion.LONG, count, address))


@pytest.fixture
def card() -> Card:
    return Card()


def test_counts_and_references_cannot_be_poked(card: Card) -> None:
    card.storage.locals.references(2, "LA", 2)
    card.storage.locals.array(2, "LA", 1, 10)
    (address,) = card.ask(VariableAddress(2, VariableKind.LA))
    header = card.peek(address + 2)[0]
    before = card.memory.digest()
    for target in (address, address + 1, address + 2, header, header - 1, header + 11):
        card.ask(Poke.of(Conversion.LONG, target, (1000,)))
    assert card.memory.digest() == before


@pytest.mark.parametrize(
    "address",
    [
        0,
        0x411000 - 1,
        0x500001,
        0x840000,
        0x1000000,
        0x10000000,
        0x10800000,
        0x20000000,
        0xFFFFFFFF,
    ],
)
def test_addresses_without_memory_are_refused(card: Card, address: int) -> None:
    with pytest.raises(MapError):
        card.space.read_words(address, 1)
    with pytest.raises(MapError):
        card.space.write_words(address, [1])


def test_unknown_programs_and_kinds_have_no_address(card: Card) -> None:
    card.storage.locals.string_variables(7, 3, 10)
    for program, kind in ((7, 7), (7, 8), (16, 0), (16, 6), (16, 7), (255, 255)):
        assert card.ask(VariableAddress(program, kind)) == (0,)


@pytest.mark.req("BIN-092", "BIN-093", "BIN-094")
def test_string_variables_follow_their_count_and_addresses(card: Card) -> None:
    request = VariableAddress(7, VariableKind.STRING_VARIABLES)
    assert card.ask(request) == (0,)
    card.storage.locals.string_variables(6, 7, 9)
    card.storage.locals.string_variables(7, 3, 10)
    strings = card.storage.locals.strings[7].variables
    assert strings is not None
    strings.write(0, "ACR")
    strings.write(2, "0123456\xff89")
    (address,) = card.ask(request)
    assert address == 0x17000000
    assert card.peek(address) == (3,)
    first, second, third = card.peek(address + 1, 3)
    assert card.peek(first, 4) == (3, 0x00524341, 0, 0)
    assert card.peek(second, 4) == (0, 0, 0, 0)
    assert card.peek(third, 4) == (10, 0x33323130, 0xFF363534, 0x00003938)
    assert card.peek(address, 16) == (
        3, first, second, third,
        3, 0x00524341, 0, 0,
        0, 0, 0, 0,
        10, 0x33323130, 0xFF363534, 0x00003938,
    )  # fmt: skip
    with pytest.raises(MapError):
        card.space.read_words(address + 16, 1)


@pytest.mark.req("BIN-092", "BIN-093", "BIN-094")
def test_string_arrays_are_reached_through_their_addresses(card: Card) -> None:
    request = VariableAddress(0, VariableKind.STRING_ARRAYS)
    assert card.ask(request) == (0,)
    card.storage.locals.references(0, "$A", 4)
    card.storage.locals.string_array(0, 1, 2, 4)
    card.storage.locals.string_array(0, 3, 1, 5)
    card.storage.locals.strings[0].array(1).write(1, "left")
    card.storage.locals.strings[0].array(3).write(0, "right")
    (address,) = card.ask(request)
    assert address == 0x10800000
    assert card.ask(VariableAddress(0, VariableKind.STRING_VARIABLES)) == (0,)
    count, *arrays = card.peek(address, 5)
    assert count == 4
    assert [bool(each) for each in arrays] == [False, True, False, True]
    assert card.peek(arrays[1]) == (2,)
    assert card.peek(card.peek(arrays[1] + 2)[0], 2) == (4, 0x7466656C)
    assert card.peek(arrays[3]) == (1,)
    assert card.peek(card.peek(arrays[3] + 1)[0], 3) == (5, 0x68676972, 0x74)
    whole = [card.peek(address + n)[0] for n in range(17)]
    assert list(card.peek(address, 17)) == whole, "a block is read at once as word by word"
    with pytest.raises(MapError):
        card.space.read_words(address + 16, 2)


def test_strings_are_not_poked(card: Card) -> None:
    card.storage.locals.string_variables(0, 1, 10)
    (address,) = card.ask(VariableAddress(0, VariableKind.STRING_VARIABLES))
    before = card.peek(address, 4)
    for target in range(address, address + 4):
        card.ask(Poke.of(Conversion.LONG, target, (1,)))
    assert card.peek(address, 4) == before


def test_reading_the_heap_looks_at_no_array_and_writing_once(
    card: Card, monkeypatch: pytest.MonkeyPatch
) -> None:
    card.storage.locals.references(1, "LA", 50)
    for number in range(50):
        card.storage.locals.array(1, "LA", number, 4)
    (table,) = card.ask(VariableAddress(1, VariableKind.LA))
    header = card.peek(table + 50)[0]
    searches: list[int] = []
    search = card.space._array_at

    def counted(address: int) -> range:
        searches.append(address)
        return search(address)

    monkeypatch.setattr(card.space, "_array_at", counted)
    assert card.peek(header, 5) == (4, 0, 0, 0, 0)
    assert searches == []
    execute(card, Poke.of(Conversion.LONG, header + 1, (7, 8, 9, 10)))
    assert searches == [header + 1]
    assert card.peek(header, 5) == (4, 7, 8, 9, 10)


@pytest.mark.parametrize(("first", "count"), [(0, 1), (0, 2), (4, 2), (1, 5), (5, 1)])
def test_a_poke_over_the_end_of_an_array_stores_nothing(card: Card, first: int, count: int) -> None:
    card.storage.locals.references(0, "SA", 2)
    card.storage.locals.array(0, "SA", 0, 4)
    card.storage.locals.array(0, "SA", 1, 4)
    (table,) = card.ask(VariableAddress(0, VariableKind.SA))
    header = card.peek(table + 1)[0]
    before = card.peek(header, 10)
    execute(card, Poke.of(Conversion.LONG, header + first, tuple(range(1, count + 1))))
    assert card.peek(header, 10) == before


class Counted(list[Any]):
    """A list that counts how often it is looked into; it is never walked."""

    reads = 0

    def __getitem__(self, index: Any) -> Any:
        self.reads += 1
        return super().__getitem__(index)

    def __iter__(self) -> Iterator[Any]:
        raise AssertionError("walked")


def test_a_peek_of_string_arrays_does_not_walk_them(card: Card) -> None:
    card.storage.dimension_program(2, 500_000)
    card.storage.locals.references(2, "$A", 60_000)
    card.storage.locals.string_array(2, 59_999, 2, 5)
    card.storage.locals.string_array(2, 7, 1, 3)
    strings = card.storage.locals.strings[2]
    strings.array(59_999).write(1, "HELLO")
    (table,) = card.ask(VariableAddress(2, VariableKind.STRING_ARRAYS))
    counted = strings.arrays = Counted(strings.arrays)
    first = table + 60_001  # array 7: count, address, string of two words
    assert card.peek(table + 60_000) == (first + 4,)
    assert card.peek(table + 8, 2) == (first, 0)
    assert card.peek(first + 4, 3) == (2, first + 7, first + 10)
    assert card.peek(first + 10, 3) == (5, *struct.unpack("<2i", b"HELLO\0\0\0"))
    assert counted.reads < 40


def test_a_poke_walks_the_arrays_that_have_elements_alone(card: Card) -> None:
    card.storage.dimension_program(1, 500_000)
    card.storage.locals.references(1, "LA", 60_000)
    for number in (0, 1023, 1024, 59_999):
        card.storage.locals.array(1, "LA", number, 2)
    (table,) = card.ask(VariableAddress(1, VariableKind.LA))
    header = card.peek(table + 60_000)[0]
    card.memory.work = 0
    execute(card, Poke.of(Conversion.LONG, header + 2, (7,)))
    assert card.peek(header, 3) == (2, 0, 7)
    assert card.memory.work == 2 * 4
