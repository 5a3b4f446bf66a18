"""Packets acting on a card: a small memory that answers as the map would."""

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

import pytest

from openacr.errors import CardError, MapError
from openacr.messages import MASTER_KILL_ACTIVE
from openacr.protocol.execute import execute
from openacr.protocol.move import Move
from openacr.protocol.packets import decode


@dataclass
class FakeCard:
    parameters: dict[int, int | float] = field(default_factory=dict)
    bits: dict[int, bool] = field(default_factory=dict)
    words: dict[int, int] = field(default_factory=dict)
    overrides: list[tuple[list[int], float, bool]] = field(default_factory=list)
    moves: list[Move] = field(default_factory=list)
    killed: bool = False

    def read_parameter(self, number: int) -> int | float:
        if number not in self.parameters:
            raise MapError(f"there is no P{number}")
        return self.parameters[number]

    def write_parameter(self, number: int, value: int | float) -> None:
        kind = type(self.read_parameter(number))
        self.parameters[number] = kind(value)

    def write_bit(self, number: int, on: bool) -> None:
        self.bits[number] = on

    def override(self, masters: Sequence[int], value: float, *, rapid: bool) -> None:
        self.overrides.append((list(masters), value, rapid))

    def issue_move(self, move: Move) -> None:
        if self.killed:
            raise CardError(MASTER_KILL_ACTIVE)
        self.moves.append(move)

    def read_words(self, address: int, count: int) -> Sequence[int]:
        if address not in self.words:
            raise MapError(f"nothing at {address:X}")
        return [self.words[address + n] for n in range(count)]

    def write_words(self, address: int, words: Sequence[int]) -> None:
        self.words |= {address + n: word for n, word in enumerate(words)}

    def parameter_address(self, number: int) -> int:
        return 0x405031 if number in self.parameters else 0

    def variable_address(self, program: int, kind: int) -> int:
        return 0x408000 if (program, kind) == (5, 2) else 0


def ask(card: FakeCard, request: str) -> str:
    return execute(card, decode(bytes.fromhex(request))).hex(" ").upper()


@pytest.mark.req("BIN-040", "BIN-041", "BIN-042", "BIN-046")
def test_a_data_packet_returns_the_selected_axes() -> None:
    card = FakeCard({12802: 0x23222120, 13058: 0x33323130, 13570: 0x53525150})
    assert ask(card, "00 30 02 2C") == "00 30 02 2C 20 21 22 23 30 31 32 33 50 51 52 53"
    assert len(execute(card, decode(bytes.fromhex("003002FF")))) == 36


def test_unknown_fields_read_zero_and_unknown_groups_are_not_answered() -> None:
    card = FakeCard()
    assert ask(card, "00 10 7F 01") == "00 10 7F 01 00 00 00 00"
    assert ask(card, "00 77 00 01") == ""


@pytest.mark.req("BIN-070", "BIN-071", "BIN-072", "BIN-075")
def test_parameters_are_read_as_long_or_ieee() -> None:
    card = FakeCard({12288: 0x00121110, 8192: 2.5})
    assert ask(card, "00 88 00 30") == "00 88 00 30 10 11 12 00"
    assert ask(card, "00 88 00 20") == "00 88 00 20 02 00 00 00"
    assert ask(card, "00 8A 00 20") == "00 8A 00 20 00 00 20 40"


@pytest.mark.req("BIN-070", "BIN-074", "BIN-077")
def test_parameters_are_written_without_a_reply() -> None:
    card = FakeCard({12288: 0, 8192: 0.0})
    assert ask(card, "00 89 00 30 10 11 12 00") == ""
    assert ask(card, "00 8B 00 20 00 00 20 40") == ""
    assert card.parameters == {12288: 0x00121110, 8192: 2.5}


def test_a_value_that_is_no_number_changes_nothing() -> None:
    card = FakeCard({8192: 1.0})
    assert ask(card, "00 8B 00 20 00 00 C0 7F") == ""
    assert ask(card, "07 01 00 00 00 00 C0 7F") == ""
    assert ask(card, "04 08 00 01 04 00 00 C0 7F") == ""
    assert (card.parameters, card.overrides, card.moves) == ({8192: 1.0}, [], [])


def test_writing_what_does_not_exist_is_ignored() -> None:
    assert ask(FakeCard(), "00 89 00 30 10 11 12 00") == ""


@pytest.mark.req("BIN-079", "BIN-080", "BIN-083", "BIN-086", "BIN-087", "BIN-090")
def test_long_words_are_poked_and_peeked_unchanged() -> None:
    card = FakeCard()
    poke = "00 91 00 03 00 50 40 00 10 11 12 13 20 21 22 23 30 31 32 33"
    assert ask(card, poke) == ""
    assert card.words == {0x405000: 0x13121110, 0x405001: 0x23222120, 0x405002: 0x33323130}
    assert ask(card, "00 90 00 03 00 50 40 00") == poke.replace("91", "90")


@pytest.mark.req("BIN-081", "BIN-088")
def test_fp64_values_take_two_words_and_travel_as_singles() -> None:
    card = FakeCard()
    ask(card, "00 91 01 02 01 00 60 00 00 00 00 3F 00 00 20 40")
    raw = struct.pack("<4i", *(card.words[0x600001 + n] for n in range(4)))
    assert struct.unpack("<2d", raw) == (0.5, 2.5)
    assert ask(card, "00 90 01 01 03 00 60 00") == "00 90 01 01 03 00 60 00 00 00 20 40"


@pytest.mark.req("BIN-082", "BIN-089")
def test_fp32_values_take_one_word() -> None:
    card = FakeCard()
    ask(card, "00 91 02 01 01 00 60 00 00 00 20 40")
    assert ask(card, "00 90 02 01 01 00 60 00")[-11:] == "00 00 20 40"
    assert len(card.words) == 1


def test_an_unknown_conversion_code_is_not_answered() -> None:
    assert ask(FakeCard(), "00 90 03 01 01 00 60 00") == ""


def test_memory_that_is_not_there_reads_zero() -> None:
    assert ask(FakeCard(), "00 90 00 01 01 00 60 00") == "00 90 00 01 01 00 60 00 00 00 00 00"


@pytest.mark.req("BIN-091", "BIN-097", "BIN-098", "BIN-099", "BIN-100")
def test_addresses_are_reported_and_zero_means_none() -> None:
    card = FakeCard({12288: 0})
    assert ask(card, "00 92 05 02") == "00 92 05 02 00 80 40 00"
    assert ask(card, "00 92 05 03") == "00 92 05 03 00 00 00 00"
    assert ask(card, "00 93 00 30") == "00 93 00 30 31 50 40 00"
    assert ask(card, "00 93 01 30") == "00 93 01 30 00 00 00 00"


@pytest.mark.req("BIN-102", "BIN-103", "BIN-104", "BIN-106", "BIN-107", "BIN-108")
def test_masks_clear_first_and_then_set() -> None:
    card = FakeCard({4097: -1, 8192: 1.0}, words={0x406043: -1})
    assert ask(card, "00 95 01 10 FF FF FF FF 01 00 00 00") == ""
    assert ask(card, "00 94 00 00 43 60 40 00 FF FF FF FF 01 00 00 00") == ""
    assert ask(card, "00 95 00 20 FF FF FF FF 01 00 00 00") == ""
    assert (card.parameters, card.words) == ({4097: 1, 8192: 1.0}, {0x406043: 1})
    ask(card, "00 95 01 10 01 00 00 00 00 00 00 80")
    assert card.parameters[4097] == -(1 << 31)


@pytest.mark.req("BIN-158", "BIN-159", "BIN-161", "BIN-162")
def test_single_bits_are_set_and_cleared() -> None:
    card = FakeCard()
    assert ask(card, "1C 08 02") == ""
    assert ask(card, "1D 20 00") == ""
    assert card.bits == {520: True, 32: False}


@pytest.mark.req("BIN-164", "BIN-165", "BIN-167", "BIN-168", "BIN-170", "BIN-171", "BIN-173")
def test_overrides_reach_the_selected_masters() -> None:
    card = FakeCard()
    sent = {
        "07 08 00 00 00 00 00 3F": ([3], 0.5, False),
        "1F 08 00 00 00 00 00 3F": ([3], 0.5, True),
        "1F 05 00 00 6D E7 FB 3D": ([0, 2], pytest.approx(0.123), True),
        "1F 00 01 80 00 00 00 3F": ([0, 15], 0.5, True),
    }
    assert [ask(card, request) for request in sent] == [""] * 4
    assert card.overrides == list(sent.values())


def test_a_refused_move_sends_nothing_back() -> None:
    card = FakeCard()
    assert ask(card, "04 00 00 01 E8 03 00 00") == ""
    assert [move.targets for move in card.moves] == [((0, 1000),)]
    card.killed = True
    assert ask(card, "04 00 00 01 E8 03 00 00") == ""
    assert len(card.moves) == 1
