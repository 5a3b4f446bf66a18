"""The set-up example of Drive Talk for two axes, line by line."""

import pytest
from tests.network.talk import VELOCITY, Bench, talking

SET_UP = (
    "OPEN DTALK “COM2:9600,N,8,1” AS #1 REM OPEN PORT",
    "P28672=1 : REM SET DEVICE NUMBER",
    "P28928=1 : REM SET DEVICE NUMBER",
    "P28673=0 : REM ARIES",
    "P28929=0 : REM ARIES",
    "CLR 11122 : REM RESET TIMEOUT",
    "CLR 11123 : REM RESET TIMEOUT",
    "CLR 11124 : REM RESET TIMEOUT",
    "SET 10505 : REM GET TPE AXIS0 USING GET DRIVE DATA",
    "SET 10500 : REM UPDATE DATA AXIS0 USING",
    "SET 10537 : REM GET TPE AXIS1",
    "SET 10532 : REM UPDATE DATA AXIS1",
)


def typed(bench: Bench, *lines: str) -> str:
    """What typed lines print; the quotes of the guide are typographic."""
    bench.card.type_lines(bench.card.console, "".join(f"{line}\r" for line in lines).encode())
    said = bench.card.take_output(bench.card.console).decode()
    return said.removesuffix("\r\n").replace("\r\n", "|")


@pytest.mark.req("ACR-DTALK-13", "ACR-DTALK-14")
def test_the_position_errors_of_two_axes_are_printed() -> None:
    bench = Bench(talking(0, address=1), talking(1, address=2))
    bench.type("PGAIN X0 Y0")
    bench.card.drag(0, -25.0)
    bench.card.drag(1, 40.0)
    for flag in (11122, 11123, 11124):
        bench.card.bit[flag] = True
    assert typed(bench, *SET_UP) == ""
    assert typed(bench, "?P28693", "?P28949") == "0|0", "the answers are still on their way"
    bench.card.advance(seconds=0.2)
    assert typed(bench, "?P28693", "?P28949") == "25|-40"
    bench.card.drag(0, -75.0)
    assert typed(bench, "SET 10500", "SET 10532", "?P28693") == "25"
    bench.card.advance(seconds=0.2)
    assert typed(bench, "?P28693", "?P28949") == "100|-40"
    assert bench.troubles() == []
    assert [bench.card.bit[flag] for flag in (10500, 10532)] == [False, False]


@pytest.mark.req("ACR-DTALK-13")
def test_the_position_error_is_that_of_a_moving_axis() -> None:
    bench = Bench(talking(0, address=1), axes=1, motor=VELOCITY)
    typed(bench, *SET_UP)
    typed(
        bench, "PPU X4000", "ACC 20 DEC 20 STP 20 VEL 2", "PGAIN X0.002", "DGAIN X0.00002", "X100"
    )
    bench.card.advance(seconds=3.0)
    typed(bench, "SET 10500")
    bench.card.advance(seconds=0.2)
    # 2 rev/s ask 0.2 V of a drive of 10 rev/s per volt, and these PGAIN makes of 100 counts
    assert int(typed(bench, "?P28693")) == pytest.approx(100, abs=2)
