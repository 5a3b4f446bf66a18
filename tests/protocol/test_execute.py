"""Packets acting on a card: a small memory that answers as the map would."""

from collections.abc import Sequence
from dataclasses import dataclass, field

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


def test_a_value_that_is_no_number_changes_nothing() -> None:
    card = FakeCard({8192: 1.0})
    assert ask(card, "00 8B 00 20 00 00 C0 7F") == ""
    assert ask(card, "07 01 00 00 00 00 C0 7F") == ""
    assert ask(card, "04 08 00 01 04 00 00 C0 7F") == ""
    assert (card.parameters, card.overrides, card.moves) == ({8192: 1.0}, [], [])


def test_an_unknown_conversion_code_is_not_answered() -> None:
    assert ask(FakeCard(), "00 90 03 01 01 00 60 00") == ""


def test_a_refused_move_sends_nothing_back() -> None:
    card = FakeCard()
    assert ask(card, "04 00 00 01 E8 03 00 00") == ""
    assert [move.targets for move in card.moves] == [((0, 1000),)]
    card.killed = True
    assert ask(card, "04 00 00 01 E8 03 00 00") == ""
    assert len(card.moves) == 1
