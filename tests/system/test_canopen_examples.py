"""The two CANopen examples of the guide, line by line, and what else works with node I/O."""

import pytest
from tests.network.rig import DI, PANEL, STATE, card, node, output, running

from openacr.controller import Controller

TWO_NODES = "".join(
    node(
        number, coupler=coupler, bit_rate=1000, digital_inputs=4, digital_outputs=4,
        analog_inputs=4, analog_outputs=2, input_range=[0.0, 10.0], output_range=[0.0, 10.0],
    )
    for number, coupler in ((3, "PIO-337"), (4, "PIO-347"))
)  # fmt: skip
EXAMPLE_1 = """
P32768 = 5  : REM THE CONTROLLER
P32769 = 1000 : REM 1 Mb
P32770 = 2 : REM TELL THE CONTROLLER THERE
:REM ARE 2 SLAVES ON THE NETWORK
P33024 = 3
P33040 = 4
P33056 = 0
P33072 = 0
P32772 = 50 : REM ms
SET11265
DWL1
IF (NOT BIT 11269) THEN SET 11266
INH 11520 : REM THE FIRST DIGITAL INPUT OF NODE 0
SET 12033
SET 13057
IF (P33288 > 5.0) THEN P33792 = 2.5
INH –11520
CLR 12033
CLR 13057
P33792 = 0
"""


def enter(made: Controller, *lines: str) -> str:
    """Type lines as a terminal sends them; what they print."""
    made.type_lines(made.console, "".join(f"{line}\r" for line in lines).encode())
    return made.take_output(made.console).decode()


@pytest.mark.req("ACR-CANEX-01")
def test_example_1_can_be_typed_at_a_prompt() -> None:
    made = card(TWO_NODES)
    made.send("PROG0\r")
    for line in EXAMPLE_1.strip().splitlines():
        enter(made, line)
        made.advance(seconds=0.5)
    assert made.p[STATE] == 2
    assert not output(made, 0, 1), "INH 11520 holds the channel"
    made.set_input(11520, True)
    made.advance(seconds=0.2)
    assert output(made, 0, 1) and output(made, 1, 1)


@pytest.mark.req("ACR-CANIO-10")
def test_node_io_works_in_every_command_that_takes_a_flag_or_parameter() -> None:
    made = running(PANEL)
    program = """
    PROGRAM
    INH 11521
    SET 12032
    WHILE (NOT BIT 11522)
    P0 = P0 + 1
    WEND
    IF (BIT 11523) THEN CLR 12032
    BIT12034 = BIT11521
    P33280 = P33288 / 2
    MASK P4472(0,8)
    ENDP
    """
    made.send("ECHO 4\rDIM P(5)\rDIM PROG0(2000)\rPROG0\r")
    made.send("".join(f"{line.strip()}\r" for line in program.strip().splitlines()) + "RUN\r")
    made.advance(seconds=0.1)
    assert not made.bit[12032], "it waits at INH"
    made.set_input(DI[0] + 1, True)
    made.advance(seconds=0.1)
    assert made.bit[12032] and made.p[0] > 0
    made.set_analog(33288, 5.0)
    made.advance(seconds=0.1)
    made.set_input(DI[0] + 3, True)
    made.advance(seconds=0.01)
    made.set_input(DI[0] + 2, True)
    made.advance(seconds=0.1)
    assert [made.bit[12032 + n] for n in range(4)] == [False, False, True, True]
    assert made.p[33280] == pytest.approx(2.5, abs=0.001)
    assert output(made, 0, 2) and output(made, 0, 3)
