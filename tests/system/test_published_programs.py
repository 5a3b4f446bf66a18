"""Sample programs of the guide, run as they are used there."""

import pytest
from tests.system.terminal import Console


def two_axes() -> Console:
    console = Console()
    console.type("DIM P(100)", "DIM DEF(20)", "PROG0", "ATTACH MASTER0")
    assert console.type('ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"') == ""
    return console


@pytest.mark.req("ACR-FLOW-18")
def test_the_goto_example_repeats_a_jog_free_move_an_output_pulse_and_a_two_second_wait() -> None:
    console = two_axes()
    console.type("PROG0", "ACC 100 DEC 100 STP 100 VEL 10")
    console.program(0, "_LOOP1", "SET 32", "X/1", "INH -516", "CLR 32", "DWL 2", "GOTO LOOP1")
    console.type("RUN")
    move_s = 1 / 10 + 10 / 100  # trapezoid of 1 unit
    for cycle in range(1, 4):
        assert console.card.until(32, True, timeout_s=2.1)
        started = console.card.time_s
        assert console.card.until(32, False, timeout_s=1)
        assert console.card.time_s - started == pytest.approx(move_s, abs=0.005)
        assert console.card.p[12288] == cycle


@pytest.mark.req("ACR-FLOW-08")
@pytest.mark.parametrize(("on", "x", "y"), [(True, 25, 0), (False, 0, 5)])
def test_the_if_else_example_moves_x_or_y_by_input_24(on: bool, x: int, y: int) -> None:
    console = two_axes()
    console.program(0, "IF (BIT 24)", "X/25", "ELSE", "Y5", "ENDIF")
    console.card.bit[24] = on
    console.type("RUN")
    console.card.advance(seconds=1)
    assert (console.card.p[12288], console.card.p[12288 + 256]) == (x, y)


@pytest.mark.req("ACR-EVAL-10", "ACR-EVAL-15")
def test_a_target_is_any_expression_of_constants_variables_bits_and_aliases() -> None:
    console = two_axes()
    console.type("SYS", "#DEFINE Pitch P30", "#DEFINE Gate BIT130", "SET 130", "PROG0")
    assert console.type("P0 = 10", "P2 = 3", "Pitch = 4", "X(P0 + P2 * P30)") == ""
    console.card.advance(seconds=1)
    assert console.card.p[12288] == 22
    console.type("X(Pitch * 2 - Gate + P12288)")
    console.card.advance(seconds=1)
    assert console.card.p[12288] == 22 + 9
