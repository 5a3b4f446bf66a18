"""How commands are written: case, signs, expressions, several axes, reports."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    """A card at PROG0 with the axes X and Y."""
    console = Console()
    console.type("DIM P(100)", "DIM DEF(5)", "PROG0", "ATTACH MASTER0")
    console.type('ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"', "PPU X1000 Y1000")
    console.type("VEL 100", "ACC 0", "DEC 0", "STP 0")
    return console


@pytest.mark.req("ACR-SYN-02")
def test_mnemonics_are_read_in_either_case(card: Console) -> None:
    assert card.type("vel 25", "VEL", "Vel 30", "vEl") == "25|30"
    assert card.type("print sqrt(4)", "Jog Vel x3", "JOG VEL X") == "2|3"


@pytest.mark.req("ACR-SYN-04")
def test_flash_needs_its_word() -> None:
    card = Console()
    assert card.type("SYS", "FLASH") == "Syntax error"
    assert card.type("FLASH BURN") == "Syntax error"
    for word in ("SAVE", "LOAD", "IMAGE", "RES", "ERASE"):
        assert card.type(f"FLASH {word}") != "Syntax error", word


@pytest.mark.req("ACR-SYN-06")
def test_named_axes_report_line_by_line(card: Console) -> None:
    assert card.type("FBVEL X 0.0001 Y 0.0002", "FBVEL X Y") == "0.0001|0.0002"
    assert card.type("FBVEL Y") == "0.0002"
    assert card.type("FBVEL") == "Syntax error"


@pytest.mark.req("ACR-SYN-07")
def test_one_value_sets_both_signs_and_two_set_them_apart(card: Console) -> None:
    card.type("IPB X 0.05 Y(3,-1)")
    assert card.type("IPB X", "IPB Y") == "0.05,-0.05|3,-1"
    assert card.type("?P12322", "?P12323") == "0.05|-0.05"  # plus and minus of axis 0
    assert card.type("?P12578", "?P12579") == "3|-1"


@pytest.mark.req("ACR-SYN-09")
@pytest.mark.parametrize("line", ["X(-30)", "X-30", "X -30"])
def test_signed_constants_need_no_parentheses(card: Console, line: str) -> None:
    card.type(line)
    card.card.advance(seconds=1)
    assert card.type("?P12288") == "-30000"


@pytest.mark.req("ACR-SYN-09")
def test_compound_expressions_stand_in_parentheses(card: Console) -> None:
    card.type("P0=1", "P2=2", "P30=3", "X(P0+P2*P30)")
    card.card.advance(seconds=1)
    assert card.type("?P12288") == "7000"
    assert card.type("RES Y -4.0", "?P12544") == "-4000"
    assert card.type("VEL P0+P2") == "Syntax error"


@pytest.mark.req("ACR-SYN-10")
def test_a_variable_or_alias_may_stand_alone(card: Console) -> None:
    card.type("P0=5", "P1=6", "#DEFINE Ramp P1")
    assert card.type("ACC P0", "ACC", "ACC Ramp", "ACC", "ACC (P0*2)", "ACC") == "5|6|10"


@pytest.mark.req("ACR-SYN-11")
def test_a_slash_makes_a_target_incremental(card: Console) -> None:
    for _ in range(2):
        card.type("X/2")
        card.card.advance(seconds=0.5)
    assert card.type("?P12288") == "4000"


@pytest.mark.req("ACR-SYN-17")
def test_one_command_takes_several_axes(card: Console) -> None:
    assert card.type("JOG VEL X10 Y20", "JOG VEL X Y", "JOG VEL Y") == "10|20|20"


@pytest.mark.req("ACR-PAR-14")
def test_aliases_stand_for_parameters_and_bits_everywhere(card: Console) -> None:
    card.type("#DEFINE Speed P5", "#DEFINE Lamp BIT33", "Speed=7", "SET Lamp")
    assert card.type("?Speed", "?P5", "?BIT33", "?Lamp") == "7|7|-1|-1"
    assert card.type("VEL (Speed*2)", "VEL", "CLR Lamp", "?BIT33") == "14|0"
    card.program(0, "IF (Lamp) THEN P6=1", "IF (NOT Lamp) THEN P6=2")
    card.type("RUN")
    card.card.advance(seconds=0.05)
    assert card.type("?P6") == "2"
