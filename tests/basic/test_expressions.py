"""Expressions: the published results, the errors, and Python as an independent judge."""

import math
import operator
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.basic.rig import Rig
from tests.search import search

from openacr.basic.vm import arith_cy, functions_cy
from openacr.compiled import counterpart, is_compiled
from openacr.errors import CardError
from openacr.map import numbers as at
from openacr.map.memory import Memory


@pytest.fixture(scope="module")
def rig() -> Rig:
    rig = Rig()
    rig.type("DIM LV(10)", "DIM SV(4)", "DIM DV(4)", "DIM LA(2)", "DIM LA0(5)", "DIM SA(1)")
    rig.type("DIM SA0(3)", "DIM DA(1)", "DIM DA0(4)", "DIM $V(4,20)")
    return rig


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("2**3**2**0.5", "8"),
        ("2**-1**2", "0.25"),
        ("-2**2**3", "-64"),
        ("2**-1", "0.5"),
        ("-6 MOD 3", "0"),
        ("7.5 MOD 2", "1.5"),
        ("1 << 31", "-2147483648"),
        ("2 >= 2", "-1"),
        ("2 <> 2", "0"),
        ("5 + NOT 1", "3"),
        ("1 OR 0 AND 0", "1"),
        ("4294967295 AND 255", "255"),
        ("3.9 AND 7", "3"),
        ("-3.9 AND -1", "-3"),
        ("ROUND(0.49999999999999994)", "0"),
        ("INT(-2.7)", "-3"),
        ("SGN(-3)", "-1"),
        ("FRAC(-2.75)", "-0.75"),
        ("ABS(-4)", "4"),
        ("SQRT(16)", "4"),
        ("COS(60)", "0.5"),
        ("COS(90)", "0"),
        ("TAN(45)", "1"),
        ("SIN(180)", "0"),
        ("SIN(-90)", "-1"),
        ("ASIN(1)", "90"),
        ("ACOS(0)", "90"),
        ("COS(-360)", "1"),
        ("LN(EXP(2))", "2"),
        ("LOG(1000)", "3"),
        ("TANH(0)", "0"),
        ("RND(1)", "0"),
        ('"ab" < "b"', "-1"),
        ('"a"+"b" = "ab"', "-1"),
        ('LEN("abc") * 2 + 1', "7"),
        ("BIT(24)", "0"),
        ("P(12288 + 2 * 256)", "0"),
    ],
)
def test_an_expression_has_the_published_value(rig: Rig, text: str, result: str) -> None:
    assert rig.value(text) == result


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1/0", "Divide by zero"),
        ("1 MOD 0", "Divide by zero"),
        ("0**-1", "Divide by zero"),
        ("(-2)**0.5", "Math error"),
        ("SQRT(-1)", "Math error"),
        ("LN(0)", "Math error"),
        ("LOG(-1)", "Math error"),
        ("ASIN(2)", "Math error"),
        ("EXP(1000)", "Math error"),
        ("SINH(1000)", "Math error"),
        ("10**400", "Math error"),
        ("TAN(90)", "Math error"),
        ("ACOSH(0)", "Math error"),
        ("ATANH(1)", "Math error"),
        ("1 << 32", "Math error"),
        ("1 << -1", "Math error"),
        ("4294967296 AND 1", "Math error"),
        ("NOT 1e10", "Math error"),
        ("-2147483649 OR 0", "Math error"),
        ("P100", "Undefined variable"),
        ("P(0-1)", "Invalid parameter"),
        ("P5000", "Invalid parameter"),
        ("P(1e12)", "Invalid parameter"),
        ("BIT 99999", "Invalid bit"),
        ("BIT(0-1)", "Invalid bit"),
        ("LV10", "Undefined variable"),
        ("LV(0-1)", "Subscript out of range"),
        ("LA0(5)", "Subscript out of range"),
        ("LA0(0-1)", "Subscript out of range"),
        ("LA2(0)", "Subscript out of range"),
        ("LA1(0)", "Undefined variable"),
        ("DA0(4)", "Subscript out of range"),
        ("$V4", "Undefined variable"),
        ("SV(4)", "Undefined variable"),
        ("P0+FOO", "Undefined symbol"),
    ],
)
def test_what_cannot_be_computed_says_why(rig: Rig, text: str, message: str) -> None:
    assert rig.value(text) == message


def test_stores_convert_to_the_kind_of_the_variable(rig: Rig) -> None:
    rig.type("LV0=3.99", "LV1=-3.99", "LV2=4294967295", "LV(1+2)=2147483648", "SV0=0.1", "DV0=0.1")
    assert [rig.value(f"LV{n}") for n in range(4)] == ["3", "-3", "-1", "-2147483648"]
    assert rig.value("SV0=DV0") == "0"
    assert rig.value("ABS(SV0-DV0) < 1e-8") == "-1"
    assert rig.type("SV0=1e39") == "Math error|"


def test_bits_read_minus_one_and_any_number_sets_them(rig: Rig) -> None:
    for command in ("SET 40", "SET BIT40", "BIT40=1", "BIT40=-1", "BIT(20*2)=0.5", "SET(40)"):
        rig.type("CLR 40", command)
        assert rig.value("BIT40") == "-1", command
    rig.type("BIT40=NOT BIT40")
    assert rig.value("BIT 40") == "0"
    rig.type("SET 32 SET 63", "CLR32")
    assert rig.value("P4097") == "-2147483648"
    rig.type("CLR 63")


def test_random_numbers_are_uniform_and_repeatable() -> None:
    def draws(limit: float) -> list[int]:
        memory = Memory()
        numbers = []
        for _ in range(4000):
            numbers.append(int(functions_cy.random_below(memory.I, limit)))
        return numbers

    assert draws(1000.0) == draws(1000.0)
    assert len(set(draws(1000.0))) > 950
    assert 470 < sum(draws(1000.0)) / 4000 < 530
    assert max(draws(4294967295.0)) > 4.2e9
    assert set(draws(0.0)) == {0}


# Python as the judge


def word(value: float) -> int:
    """The operand rule of the logical operators."""
    whole = math.trunc(value)
    if not -(2**31) <= whole < 2**32:
        raise ArithmeticError
    return (whole + 2**31) % 2**32 - 2**31


def logical(function: Callable[[int, int], int]) -> Callable[[float, float], float]:
    return lambda a, b: float(function(word(a), word(b)))


def relation(function: Callable[[float, float], bool]) -> Callable[[float, float], float]:
    return lambda a, b: -float(function(a, b))


JUDGE: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "MOD": math.fmod,
    "=": relation(operator.eq),
    "<>": relation(operator.ne),
    "<": relation(operator.lt),
    ">": relation(operator.gt),
    "<=": relation(operator.le),
    ">=": relation(operator.ge),
    "AND": logical(operator.and_),
    "OR": logical(operator.or_),
    "XOR": logical(operator.xor),
    "NAND": logical(lambda a, b: ~(a & b)),
    "NOR": logical(lambda a, b: ~(a | b)),
    "XNOR": logical(lambda a, b: ~(a ^ b)),
}

LITERALS = st.one_of(
    st.integers(0, 2**33),
    st.floats(0, 1e6).map(lambda x: round(x, 3)),
)
TREES = st.recursive(
    LITERALS.map(lambda value: (f"{value!r}", float(value))),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(sorted(JUDGE)), inner).map(lambda t: _join(*t)),
        inner.map(lambda t: (f"(-{t[0]})", None if t[1] is None else 0.0 - t[1])),
    ),
    max_leaves=8,
)


def _join(
    left: tuple[str, float | None], op: str, right: tuple[str, float | None]
) -> tuple[str, float | None]:
    text = f"({left[0]} {op} {right[0]})"
    if left[1] is None or right[1] is None:
        return text, None
    try:
        return text, JUDGE[op](left[1], right[1])
    except (ArithmeticError, ValueError):
        return text, None


@given(TREES)
@search(150)
def test_expressions_agree_with_python(rig: Rig, tree: tuple[str, float | None]) -> None:
    text, expected = tree
    if len(text) > 200:
        return
    from openacr.basic.language.cursor import Cursor
    from openacr.basic.language.expressions import ExpressionReader
    from openacr.basic.language.nodes import Number
    from openacr.lang.lexer import tokens

    node = ExpressionReader(Cursor(tokens(text)), {}).expression()
    try:
        value = node.value if isinstance(node, Number) else rig.executor.computing.value(0, node)
    except CardError:
        assert expected is None
        return
    assert expected is not None
    assert value == expected


# The two builds

REAL = st.floats(allow_nan=False, allow_infinity=False) | st.floats(-1e3, 1e3)


@pytest.mark.skipif(not is_compiled, reason="no compiled core")
@given(st.integers(1, 20), REAL, REAL)
@search(300)
def test_operators_give_the_same_bits_compiled(op: int, a: float, b: float) -> None:
    first, second = Memory(), Memory()
    for memory in (first, second):
        memory.F[at.USER_BASE], memory.F[at.USER_BASE + 1] = a, b
    plain = arith_cy.apply_operator(first.F, op, at.USER_BASE)
    assert counterpart(arith_cy.apply_operator)(second.F, op, at.USER_BASE) == plain
    assert first.digest() == second.digest()


@pytest.mark.skipif(not is_compiled, reason="no compiled core")
@given(st.integers(1, 26), REAL)
@search(300)
def test_functions_give_the_same_bits_compiled(function: int, x: float) -> None:
    first, second = Memory(), Memory()
    first.F[at.USER_BASE] = second.F[at.USER_BASE] = x
    plain = functions_cy.apply_function(first.F, first.I, function, at.USER_BASE)
    fast = counterpart(functions_cy.apply_function)(second.F, second.I, function, at.USER_BASE)
    assert fast == plain
    assert first.digest() == second.digest()
