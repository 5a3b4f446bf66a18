"""Parameters, bits and requests as programs and terminals see them."""

import struct

import pytest
from tests.system.terminal import Console

from openacr.map import flags, parameters

SQUARE = ("RES X Y", "_LOOP", "ACC 50", "DEC 50", "STP 50", "VEL 5", "X5", "Y5", "X0", "Y0")
FEEDHOLD, CYCLE_START, IN_FEEDHOLD, FEEDHOLDING = 520, 521, 519, 518
VECTOR_VELOCITY = 8193


@pytest.fixture
def card() -> Console:
    """A card at PROG0 with the axes X and Y and the square program of the guide."""
    console = Console()
    console.type("DIM P(10)", "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"')
    console.type('ATTACH SLAVE1 AXIS1 "Y"', "PPU X1000 Y1000")
    console.program(0, *SQUARE, "GOTO LOOP")
    return console


def bits(card: Console, *numbers: int) -> list[bool]:
    return [card.card.bit[number] for number in numbers]


@pytest.mark.req("ACR-PAR-13", "ACR-SYN-18", "ACR-PAR-09")
def test_the_square_program_goes_round_its_corners(card: Console) -> None:
    card.type("RUN")
    corners: list[tuple[float, float]] = []
    for _ in range(60):
        card.card.advance(seconds=0.1)
        here = card.card.p[6144], card.card.p[6160]
        near = round(here[0] / 5000, 1), round(here[1] / 5000, 1)
        if near in {(1, 0), (1, 1), (0, 1), (0, 0)} and near not in corners[-1:]:
            corners.append(near)
    assert corners[:5] == [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]
    assert card.card.p[6144] == card.card.p[12290]  # encoder and actual position of axis 0


@pytest.mark.req("ACR-PAR-01", "ACR-PAR-02")
def test_request_bits_start_and_stop_a_program_and_clear_themselves(card: Console) -> None:
    card.type("SET 1032")
    card.card.advance(seconds=0.1)
    assert bits(card, 1024, 1032) == [True, False]
    card.type("SET 1033")
    card.card.advance(seconds=0.1)
    assert bits(card, 1024, 1033) == [False, False]
    card.type("SET 40")  # no request: stays
    card.card.advance(seconds=0.1)
    assert bits(card, 40) == [True]


@pytest.mark.req("ACR-PAR-12")
def test_feedhold_ramps_down_with_dec_and_cycle_start_up_with_acc(card: Console) -> None:
    card.type("ACC 20", "DEC 10", "STP 0", "VEL 5", "X100")
    card.card.advance(seconds=1.0)
    card.card.bit[FEEDHOLD] = True
    ramp_s, distance = ramp(card, until=0.0)
    assert bits(card, FEEDHOLD, FEEDHOLDING, IN_FEEDHOLD) == [False, True, True]
    assert (ramp_s, distance) == pytest.approx((5 / 10, 5**2 / (2 * 10)), abs=0.01)
    at_rest = card.card.p[12288]
    card.card.advance(seconds=0.5)
    assert card.card.p[12288] == at_rest
    card.card.bit[CYCLE_START] = True
    ramp_s, distance = ramp(card, until=5.0)
    assert bits(card, CYCLE_START, IN_FEEDHOLD) == [False, False]
    assert (ramp_s, distance) == pytest.approx((5 / 20, 5**2 / (2 * 20)), abs=0.01)


def ramp(card: Console, until: float) -> tuple[float, float]:
    """Time and distance from the first change of the vector velocity until it has a value."""
    speed = card.card.p[VECTOR_VELOCITY]
    while card.card.p[VECTOR_VELOCITY] == speed:
        card.card.advance(ticks=1)
    tick, position = card.card.tick, card.card.p[12288]
    while card.card.p[VECTOR_VELOCITY] != until:
        card.card.advance(ticks=1)
    return (card.card.tick - tick) * 0.0005, (card.card.p[12288] - position) / 1000


@pytest.mark.req("ACR-PAR-03", "ACR-PAR-07")
def test_p_and_bit_work_in_programs_and_at_the_terminal(card: Console) -> None:
    card.program(0, "P1=P6916", "BIT40=1", "IF (BIT40) THEN P2=7")
    card.type("RUN")
    card.card.advance(seconds=0.05)
    assert card.type("?P2", "PRINT P2", "?BIT40") == "7|7|-1"
    assert int(card.type("?P1")) > 0


@pytest.mark.req("ACR-PAR-08")
def test_system_floats_have_32_bits_and_user_variables_64(card: Console) -> None:
    assert card.type("P0=1/3", "P12304=1/3", "?P0", "?P12304") == "0.3333333333|0.3333333"
    assert card.card.p[0] == 1 / 3
    assert card.card.p[12304] == struct.unpack("f", struct.pack("f", 1 / 3))[0]
    assert card.type("P0=2", "?P0", "P4097=7", "?P4097") == "2|7"


@pytest.mark.req("ACR-PAR-10", "ACR-TRB-25")
def test_inputs_are_bits_0_to_31_and_outputs_32_to_63(card: Console) -> None:
    card.card.bit[24] = True
    assert card.type("?BIT24", "?P4096") == f"-1|{1 << 24}"
    assert card.type("SET 32", "SET 63", "?P4097") == str(1 - (1 << 31))
    assert card.type("?P4096") == str(1 << 24)  # no output is wired to an input


@pytest.mark.req("ACR-PAR-11")
def test_the_card_may_change_a_value_again_after_a_write(card: Console) -> None:
    card.type("P6916=5", "P6400=7")  # a clock goes on from there, a servo output comes back
    assert card.card.p[6916] == 5
    card.card.advance(seconds=0.01)
    assert card.type("?P6916", "?P6400") == "15|0"


@pytest.mark.req("ACR-PAR-15")
def test_every_group_of_parameters_and_flags_is_there() -> None:
    objects = {row.object for row in parameters().values()}
    assert {"MASTER", "AXIS", "ENC", "DAC", "ADC", "PROG"} <= objects
    assert {"MASTER", "AXIS", "PROG"} <= {row.object for row in flags().values()}
