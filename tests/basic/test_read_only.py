"""The board information, P7040 to P7046, keeps its values whatever is stored there."""

import pytest
from tests.basic.motion_bench import Bench

from openacr import Controller
from openacr.map.block import Access
from openacr.map.kinds_cy import is_read_only
from openacr.map.numbers import PUBLIC_COUNT
from openacr.map.tables import BLOCKS

BOARD = [90000000, 0, 11806, 15, 0, 0, 0]  # of an ACR9000
NUMBERS = range(7040, 7047)


def board(card: Controller) -> list[int | float]:
    return [card.p[number] for number in NUMBERS]


@pytest.fixture
def card() -> Controller:
    return Controller()


def test_the_guard_covers_the_board_information_of_the_map_and_nothing_else() -> None:
    (block,) = (block for block in BLOCKS if block.object == "BOARD")
    assert [row.access for row in block.rows.values()] == [Access.READ] * 7
    guarded = [number for number in range(PUBLIC_COUNT) if is_read_only(number)]
    assert guarded == list(NUMBERS)


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("line", ["P{}=9", "P({}+0)=9", "MASK P{} (0,-1)"])
def test_a_line_leaves_it_as_it_is(card: Controller, number: int, line: str) -> None:
    assert card.send(line.format(number) + "\r").endswith("\r\nSYS>")
    assert board(card) == BOARD


@pytest.mark.parametrize("number", [7039, 7047])
def test_beside_it_there_is_no_parameter(card: Controller, number: int) -> None:
    assert "Invalid parameter" in card.send(f"P{number}=9\r")


def test_a_program_goes_on_after_such_a_store(card: Controller) -> None:
    card.send("DIM PROG0(2000)\rDIM P(2)\rPROG0\r10 P7042=1\r20 P0=7042\r30 P(P0)=2\r40 P1=P7042\r")
    card.send("RUN\r")
    card.advance(seconds=0.1)
    assert (card.p[1], board(card)) == (11806, BOARD)


@pytest.mark.parametrize(
    "packet",
    [
        "00 89 80 1B 09 00 00 00",
        "00 8B 86 1B 00 00 10 41",
        "00 95 84 1B 00 00 00 00 FF 00 00 00",
        "00 94 00 00 84 1B 41 00 00 00 00 00 FF 00 00 00",
        "00 91 00 01 80 1B 41 00 09 00 00 00",
        "00 91 00 02 85 1B 41 00 09 00 00 00 09 00 00 00",
    ],
)
def test_a_packet_leaves_it_as_it_is(card: Controller, packet: str) -> None:
    card.receive(card.console, bytes.fromhex(packet))
    card.advance(1)
    assert board(card) == BOARD


@pytest.mark.parametrize(
    "lines",
    [
        ("ENC10 DST P7042",),
        ("FLT SRC X ENC10", "FLT COEF X1", "FLT OUT X P7042", "FLT ON X"),
        ("DIM LA(1)", "DIM LA0(1)", "LA0(0)=5", "PLS0 SRC ENC11", "PLS0 BASE LA0", "PLS0 DST P7042",
         "PLS0 ON"),
    ],
)  # fmt: skip
def test_what_copies_to_a_parameter_in_every_period_leaves_it(lines: tuple[str, ...]) -> None:
    made = Bench("X").all(*lines)
    made.memory.I[6144 + 16 * 10] = 77
    made.ticks(5)
    assert [made.p(number) for number in NUMBERS] == [80200000, *BOARD[1:]]


def test_a_captured_position_leaves_it() -> None:
    made = Bench("X").all("ACC 0 STP 0 VEL 1000", "SET 777", "INTCAP X2 P7042", "X500").ticks(100)
    made.all("SET 24").ticks(1)
    assert made.type("INTCAP X") == "OFF"
    assert made.p(7042) == 11806
