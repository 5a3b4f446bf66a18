"""The two CANopen examples of the guide, line by line, and what else works with node I/O."""

import pytest
from tests.network.rig import DI, PANEL, output, running


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
