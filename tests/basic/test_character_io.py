"""PRINT, INPUT, OPEN, CLOSE and the keys of devices, on a running card."""

import pytest
from tests.basic.machine import Machine


@pytest.fixture
def card() -> Machine:
    machine = Machine()
    machine.type("DIM P(100)", "PROG 0")
    return machine


def test_print_of_a_command_word_prints_its_report(card: Machine) -> None:
    assert card.type("? MEM") == "65536|P00>"
    assert card.type("?ECHO") == "1|P00>"
    assert card.type("PRINT STREAM") == "COM1|P00>"


@pytest.mark.parametrize("line", ["? SET 32", "? DWL 1", "? MASK P4097 (0,1)", "PRINT MOV X1"])
def test_commands_that_report_nothing_are_not_printed(card: Machine, line: str) -> None:
    card.type("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"')
    assert card.type(line) == "Syntax error|P00>"
    assert card.type("?P4097") == "0|P00>"


def test_print_of_nonsense_is_refused(card: Machine) -> None:
    assert card.type("?Nonsense") == "Undefined symbol|P00>"
    assert card.type('PRINT USING "x";1') == "Invalid argument|P00>"


def test_single_variables_print_with_seven_digits(card: Machine) -> None:
    assert card.type("DIM SV(2)", "SV0 = 0.1", '?SV0;" ";SV0+0') == (
        "P00>P00>0.1 0.1000000015|P00>"
    )


def test_print_of_a_program_goes_to_its_listeners(card: Machine) -> None:
    card.load(0, 'PRINT "hello"')
    assert card.type("RUN") == "P00>"
    card.advance()
    assert card.sent() == ""
    assert card.type("LRUN") == ""
    card.advance()
    assert card.sent() == "hello|P00>"


# devices


def test_getch_waits_for_a_key_as_an_inhibited_program(card: Machine) -> None:
    card.load(1, "DIM $V(1,10)", "$V0 = GETCH$(0)", "P5 = GETCH", "PRINT $V0;P5")
    card.type("PROG 1", "LRUN")
    card.advance()
    assert card.card.memory.bit(1024 + 32 + 2)
    card.key("xA")
    card.advance()
    assert card.sent() == "xA|".replace("A", "65") + "P01>"


# INPUT


def test_too_few_fields_are_asked_for_again(card: Machine) -> None:
    card.load(1, "INPUT P1,P2", "PRINT P1+P2")
    card.type("PROG 1", "LRUN")
    card.advance()
    card.key("5\r")
    card.advance()
    card.key("5,6\r")
    card.advance()
    assert card.sent() == "? Redo|11|P01>"


def test_backspace_takes_a_typed_character_back(card: Machine) -> None:
    card.load(1, "INPUT P1", "PRINT P1")
    card.type("PROG 1", "LRUN")
    card.key("12\x083\r")
    card.advance()
    assert card.sent() == "? 13|P01>"


def test_backspace_does_not_take_back_a_line_that_is_complete(card: Machine) -> None:
    card.load(1, "DWL 0.01", "INPUT P1", "INPUT P2", "PRINT P1,P2")
    card.type("PROG 1", "LRUN")
    card.key("5\r\x08\x087\x08\x08\x086\r")
    card.advance(200)
    assert card.sent() == "? ? 5\t6|P01>"


def test_input_from_a_device_ends_at_cr_or_cr_lf(card: Machine) -> None:
    network = card.connect("STREAM2")
    card.load(
        1, "DIM $V(2,20)", 'OPEN "STREAM2:" AS #1', "INPUT #1,$V0", "INPUT #1,$V1",
        "PRINT #1, $V0;$V1", "DWL 9",
    )  # fmt: skip
    card.type("PROG 1", "LRUN")
    card.advance()
    card.key("first\r\nsecond\r\n", on=network)
    card.advance()
    assert card.sent(network) == "? ? firstsecond|"


def test_the_first_line_typed_by_any_listener_is_taken(card: Machine) -> None:
    card.load(1, "INPUT P1", "PRINT P1")
    other = card.connect("COM2")
    card.type("PROG 1", "LISTEN", on=other)
    card.type("PROG 1", "LRUN")
    card.advance()
    card.key("7\r", on=other)
    card.advance()
    assert card.sent() == "? 7|P01>"
    assert card.sent(other).endswith("? 7|")


def test_a_line_that_dwells_is_answered_afterwards(card: Machine) -> None:
    assert card.type('PRINT "a" : DWL 0.01 : PRINT "b"') == "a|"
    card.advance(10)
    assert card.sent() == ""
    card.advance(30)
    assert card.sent() == "b|P00>"


def test_a_run_time_error_of_a_typed_line_is_its_answer(card: Machine) -> None:
    assert card.type('PRINT "a" : P200 = 1 : PRINT "b"') == "a|Undefined variable|P00>"
