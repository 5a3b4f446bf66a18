"""Expressions: every operator and function, before and after their compilation."""

import math

import pytest
from tests.cnc.programs import errors, run

from openacr.cnc.reading.formulas import HOT


def value(expression: str, cells: dict[int, float] | None = None) -> float:
    """The value, the same as it stands and compiled."""
    cold = run(f"P200={expression}", cells).p(200)
    loop = f"P201=0\nN1 P200={expression}\nP201=P201+1\nIF P201<{HOT + 4} THEN GOTO 1"
    assert run(loop, cells).p(200) == cold
    return cold


@pytest.mark.parametrize(
    ("expression", "wanted"),
    [
        ("7 MOD 4", 3),
        ("-7 MOD 4", -3),
        ("10-4-3", 3),
        ("64/4/2", 8),
        ("2*-3", -6),
        ("1 (note) +2", 3),
        ("ASIN(1)", 90),
        ("ACOS(0)", 90),
        ("SQRT(16)", 4),
        ("ABS(-2.5)", 2.5),
        ("INT(-2.7)", -2),
        ("ROUND(2.5)", 3),
        ("ROUND(-2.5)", -3),
        ("FIX(-2.5)", -3),
        ("FUP(2.1)", 3),
        ("LN(EXP(2))", 2),
        ("cos(90)", 0),
        ("1 OR 0 AND 0", 1),
        ("1 XOR 1 OR 1", 1),
        ("NOT 0 AND 0", 0),
        (".5+5.", 5.5),
    ],
)
def test_an_expression_has_its_value(expression: str, wanted: float) -> None:
    got = value(expression)
    assert got == pytest.approx(wanted, abs=1e-12)


def test_parameters_may_be_indirect() -> None:
    cells = {150: 160.0, 160: 7.0, 161: 8.0}
    assert value("PP150", cells) == 7
    assert value("P(P150+1)", cells) == 8
    assert value("##150", cells) == 7
    assert run("P(P150+1)=3", cells).p(161) == 3


@pytest.mark.req("MILL-MATH-DIV")
@pytest.mark.parametrize(
    "expression",
    ["1/0", "SQRT(-1)", "LN(0)", "ASIN(1.1)", "TAN(90)", "TAN(270)", "5 MOD 0", "EXP(1000)",
     "EXP(700)*EXP(700)"],
)  # fmt: skip
def test_what_has_no_value_is_an_arithmetic_error(expression: str) -> None:
    assert errors(f"P200={expression}") == ["E210"]
    loop = f"P201=0\nN1 P201=P201+1\nP200=P201*0+1/({HOT + 5}-P201)\nGOTO 1"
    assert errors(loop) == ["E210"]


@pytest.mark.parametrize(
    ("expression", "reason"),
    [("1/0", "division by zero"), ("SQRT(-1)", "a function has no value there"),
     ("EXP(1000)", "too large a number"), ("TAN(90)", "TAN of a right angle")],
)  # fmt: skip
def test_the_reason_is_named(expression: str, reason: str) -> None:
    found = run(f"P200={expression}").error
    assert found is not None
    assert found.text == f"arithmetic error: {reason}"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("P200=SIN 30", "E107"),
        ("P200=(1+2", "E107"),
        ("P200=1..2", "E106"),
        ("P200=1.2.3", "E106"),
        ("P200=", "E105"),
        ("P200=1+", "E105"),
        ("P200=FOO(1)", "E104"),
        ("X5-3", "E104"),
        ("P200=" + "(" * 60 + "1" + ")" * 60, "E108"),
        ("P200=1 $", "E104"),
    ],
)
def test_a_malformed_expression_is_an_error(text: str, code: str) -> None:
    assert errors(text) == [code]


def test_sines_are_exact_where_they_can_be() -> None:
    for angle in range(-360, 361, 30):
        sine = value(f"SIN({angle})" if angle >= 0 else f"SIN(-{-angle})")
        assert sine == pytest.approx(math.sin(math.radians(angle)), abs=1e-15)
    assert value("SIN(180)") == 0


def test_several_assignments_see_each_other_from_left_to_right() -> None:
    assert value("1").is_integer()
    done = run("P200=1 P201=P200+1 P200=P201*10")
    assert (done.p(200), done.p(201)) == (20, 2)


def test_a_loop_of_several_assignments_acts_once_per_pass() -> None:
    """The card is read after a move: nothing of the block may act twice."""
    text = "F10 P200=0\nN1 X(P200)\nP200=P200+1 P201=P201+P5 P5=P5+1\nIF P200<40 THEN GOTO 1\nM2"
    done = run(text, {5: 0.0, 201: 0.0})
    assert done.p(200) == 40
    assert done.p(201) == sum(range(40))
