"""The two CANopen examples of the guide, line by line, and what else works with node I/O."""

import pytest
from tests.network.rig import DI, PANEL, STATE, card, converted, node, output, running

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
EXAMPLE_2 = """
#DEFINE ResetCANNetwork BIT151
PROGRAM
GOSUB EnableCANopen
END
_EnableCANopen
P32768 = 5
P32769 = 125
P32770 = 1
P33024 = 1
P32772 = 50
SET 11265
INH -11265
IF (NOT BIT 11269)
 SET 11266
 SET ResetCANNetwork
 INH -11266
 SET 11265
 INH -11265
 ENDIF
IF ((NOT BIT 11269) AND (ResetCANNetwork))
 PRINT "CANopen network problem occurred."
 ENDIF
RETURN
ENDP
"""


def enter(made: Controller, *lines: str) -> str:
    """Type lines as a terminal sends them; what they print."""
    made.type_lines(made.console, "".join(f"{line}\r" for line in lines).encode())
    return made.take_output(made.console).decode()


def first_example(world: str = TWO_NODES) -> Controller:
    """Example 1 stored as a program and running for 1.5 s."""
    made = card(world)
    lines = ["DIM PROG0(4000)", "PROG0", "PROGRAM", *EXAMPLE_1.strip().splitlines(), "ENDP", "RUN"]
    made.send("ECHO 4\r")
    assert enter(made, *lines) == ""
    made.advance(seconds=1.5)
    return made


@pytest.mark.req("ACR-CANEX-01")
@pytest.mark.parametrize(("volts", "written"), [(6.0, 2.5), (4.0, 0.0)])
def test_example_1_follows_the_first_input(volts: float, written: float) -> None:
    made = first_example()
    assert made.p[STATE] == 2
    made.set_analog(33288, volts)
    made.advance(seconds=0.5)
    assert not output(made, 0, 1), "it waits for the input"
    made.set_input(11520, True)
    made.advance(seconds=0.2)
    assert output(made, 0, 1) and output(made, 1, 1)
    assert made.p[33792] == written
    assert converted(made, 1, 0) == round(written * 3276.8)
    made.set_input(11520, False)
    made.advance(seconds=0.2)
    assert not output(made, 0, 1) and not output(made, 1, 1)
    assert (made.p[33792], converted(made, 1, 0)) == (0.0, 0)


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


@pytest.mark.req("ACR-CANEX-02")
def test_example_1_resets_a_network_that_is_not_operational_after_a_second() -> None:
    made = card(TWO_NODES.replace("id = 4", "id = 9"))
    made.send("PROG0\r")
    lines = EXAMPLE_1.strip().splitlines()
    enter(made, *lines[: lines.index("IF (NOT BIT 11269) THEN SET 11266")])
    made.advance(seconds=1.05)
    assert made.p[STATE] == 5
    made.send("IF (NOT BIT 11269) THEN SET 11266\r")
    made.advance(seconds=0.06)
    assert (made.p[STATE], made.bit[11266]) == (0, True)
    made.advance(seconds=0.3)
    assert (made.p[STATE], made.bit[11266]) == (1, False)
    assert not first_example().bit[11270], "with both nodes there is nothing to reset"


def second_example(world: str, seconds: float) -> tuple[Controller, str]:
    made = card(world)
    made.send("ECHO 4\rDIM DEF(1)\rDIM PROG0(4000)\rPROG0\r")
    made.send("".join(f"{line}\r" for line in EXAMPLE_2.strip().splitlines()))
    made.send("LRUN\r")
    made.advance(seconds=seconds)
    return made, made.take_output(made.console).decode()


@pytest.mark.req("ACR-CANEX-03")
def test_example_2_starts_the_network() -> None:
    made, printed = second_example(PANEL, 1.0)
    assert (made.p[STATE], made.bit[151], printed.strip()) == (2, False, "")


@pytest.mark.req("ACR-CANEX-03")
def test_example_2_resets_once_and_reports_the_problem() -> None:
    made, printed = second_example(PANEL.replace("id = 1", "id = 2"), 2.0)
    assert (made.p[STATE], made.bit[151]) == (5, True)
    assert printed.strip() == "CANopen network problem occurred."


@pytest.mark.req("ACR-CANEX-03")
def test_example_2_is_content_when_the_second_attempt_succeeds() -> None:
    late = '[[canopen.fault]]\nkind = "lost"\nnode = 1\nuntil_s = 0.5\n'
    made, printed = second_example(PANEL + late, 2.0)
    assert (made.p[STATE], made.bit[151], printed.strip()) == (2, True, "")


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
