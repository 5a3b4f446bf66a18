"""Formulas, assignments and jumps executed together with other lines: the same as one by one."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cnc.programs import made
from tests.cnc.test_many_blocks import require_same
from tests.search import search

from openacr.cnc.canonical import Moves
from openacr.cnc.interpreter import execution
from openacr.cnc.interpreter.by_block import loops
from openacr.cnc.interpreter.by_line import formulas_cy
from openacr.cnc.interpreter.by_line.formula_code import OPERATIONS, FormulaWriter, NoCodeError
from openacr.cnc.interpreter.by_line.program_values import access
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.reading.expressions import ExpressionReader
from openacr.cnc.reading.formulas import HOT
from openacr.cnc.reading.grammar import ACROMILL, RS274NGC
from openacr.cnc.rows import plans, scans, values
from openacr.cnc.rows.room import doubles, integers
from openacr.compiled import pick

DIALECTS = ["acromill", "rs274ngc"]
NUMBERS = (
    "0 1 2 3 7 .5 0.1 1.5 2.5 30 45 60 90 120 135 150 180 210 225 240 270 300 330 360 720 .0"
    " 0.000001 123456.789 1000000 99999999 1000000000 710 1.0"
).split()
FAST = pick(formulas_cy.formula_run)


def formula(chance: random.Random, dialect: str, depth: int = 3) -> str:
    """A formula with every operator, function and kind of operand."""
    is_ours = dialect == "acromill"
    left, right = "()" if is_ours else "[]"
    grammar = ACROMILL if is_ours else RS274NGC
    kind = chance.random() if depth else 0.0
    if kind < 0.3:
        return chance.choice(["", "-"]) + chance.choice(NUMBERS)
    if kind < 0.5:
        letter = chance.choice("P#") if is_ours else "#"
        index = chance.choice([f"{chance.randrange(199, 205)}", f"{chance.randrange(34)}", "31"])
        if chance.random() < 0.2:
            index = f"{left}{formula(chance, dialect, depth - 1)}{right}"
        return f"{letter}{index}"
    inner = formula(chance, dialect, depth - 1)
    if kind < 0.65:
        name = chance.choice(sorted(grammar.functions))
        second = f"/[{formula(chance, dialect, depth - 1)}]" if name in grammar.pairs else ""
        return f"{name}{left}{inner}{right}{second}"
    if kind < 0.7:
        return f"NOT {inner}" if is_ours else f"[{inner}]"
    operator = chance.choice(sorted(grammar.operators))
    space = " " if operator.isalpha() or chance.random() < 0.3 else ""
    whole = f"{inner}{space}{operator}{space}{formula(chance, dialect, depth - 1)}"
    return f"{left}{whole}{right}" if chance.random() < 0.5 else whole


def line(chance: random.Random, dialect: str) -> str:
    """A line with formulas: words, assignments, both; remarks, labels, blanks."""
    left, right = "()" if dialect == "acromill" else "[]"

    def value() -> str:
        return f"{left}{formula(chance, dialect, 2)}{right}"

    number = chance.choice([200, 201, 202, 203, 204, 1, 2, 31, 33])
    sign = "P" if dialect == "acromill" and number > 99 else "#"
    texts = [
        f"{sign}{number}={formula(chance, dialect)}",
        f"#{number} = {formula(chance, dialect)} (kept)",
        f"#1={formula(chance, dialect)} #2=[#1+1]".replace("[", left).replace("]", right),
        f"X{value()} Y{chance.uniform(-2, 2):.3f}",
        f"G{chance.randrange(4)} X{value()} Y#200 R#201",
        f"G1 X#200 Z-{value()} F{value()}",
        f"{sign}{number}={value()} X{value()} G91",
        f"G90 X-#{number} A+#200 F20",
        f"N{chance.randrange(1, 99)} G2 X#1 Y#2 I{value()} J.5 (arc (1)",
        f"#{left}{number}+1{right}={value()}",
        f"X##{number}",
        "X1 Y1",
        "G20" if chance.random() < 0.3 else "G21",
    ]
    return chance.choice(texts)


@pytest.mark.parametrize("dialect", DIALECTS)
@search(120)
@given(seed=st.integers(0, 2**40))
def test_lines_with_formulas_do_what_each_does(dialect: str, seed: int) -> None:
    chance = random.Random(seed)
    different = [line(chance, dialect) for _ in range(chance.randrange(1, 12))]
    lines = [chance.choice(different) for _ in range(40)]
    for k, one in enumerate(lines):
        if chance.random() < 0.3:
            lines[k] = one.replace("2.5", f"{chance.randrange(9)}.25").replace("200", "202")
    require_same("\n".join(["F10", *lines, "M2"]) + "\n", dialect)


@pytest.mark.parametrize("dialect", DIALECTS)
@search(400)
@given(seed=st.integers(0, 2**40))
def test_a_formula_has_the_value_of_its_tree(dialect: str, seed: int) -> None:
    chance = random.Random(seed)
    run = made("M2\n", dialect=dialect).interpreter
    locals_, parameters = [0.0] * 34, run.parameters
    for n in range(1, 34):
        locals_[n] = chance.choice([0.0, -0.0, 1.0, 200.0, chance.uniform(-9, 9)])
    locals_[0] = 1.0 if dialect == "rs274ngc" or chance.random() < 0.5 else 0.0
    parameters.swap(locals_)
    cells, states = doubles(values.CELLS), integers(values.CELLS)
    for n in range(199, 205):
        number = chance.choice([0.0, 1.0, 201.0, chance.uniform(-400, 400)])
        cells[n], states[n] = number, values.IS_KNOWN
        if dialect == "acromill":
            run.cells.write(n, number)
        else:
            parameters.write("#", n, number)
    text = formula(chance, dialect, 4)
    grammar = ACROMILL if dialect == "acromill" else RS274NGC
    tree = ExpressionReader(text, grammar).expression()
    found = {at: (k, number) for k, (at, number) in enumerate(sorted(numbers(tree)))}
    try:
        code = FormulaWriter(parameters, found).code(tree)
    except NoCodeError:
        return
    F, I = run.memory.F, run.memory.I
    plan = plans.number[0]
    for at, step in enumerate(code, plan):
        I[at] = step
    for k, size in found.values():
        F[scans.number[k]] = size
    run.memory.wholes(values.access)[:] = access()
    try:
        wanted = tree.value(parameters)
    except Exception:
        wanted = math.nan
    for evaluate in (FAST, formulas_cy.formula_run):
        if evaluate(F, I, cells, states, plan):
            result = F[values.stack[0]]
            assert (result, math.copysign(1, result)) == (wanted, math.copysign(1, wanted)), text


def numbers(tree: object) -> list[tuple[int, float]]:
    """Place and size of the numbers of a formula."""
    at = getattr(tree, "at", None)
    if at is not None:
        return [(at, abs(tree.number))]  # type: ignore[attr-defined]
    parts = (*getattr(tree, "operands", ()), getattr(tree, "index", None))
    return [number for part in parts if part is not None for number in numbers(part)]


def test_every_function_and_operator_has_byte_code() -> None:
    for grammar in (ACROMILL, RS274NGC):
        for name, function in grammar.functions.items():
            assert function in OPERATIONS, name
        for name, operator in grammar.operators.items():
            assert operator.function in OPERATIONS, name


LOOPS = {
    "acromill": """\
F100
P200=0
N10 P200=P200+1
P201=SIN(P200)*10
X(P201) Y(COS(P200)*P201)
IF P201>5 THEN GOTO 20
P202=P202+P201
N20 IF P200<{passes} THEN GOTO 10
Z(P202/1000)
M2
""",
    "rs274ngc": """\
F100
#31=0
o100 while [#31 lt {passes}]
#31=[#31+1]
#32=[sin[#31]*10]
X[#32] Y[cos[#31]*#32]
o2 if [#32 gt 5]
#33=[#33+#32]
o2 else
#33=[#33-1]
o2 endif
o100 endwhile
Z[#33/1000]
M2
""",
}


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("passes", [1, 2, 3, 17, 300])
def test_a_loop_gives_the_moves_of_its_lines(dialect: str, passes: int) -> None:
    done = require_same(LOOPS[dialect].format(passes=passes), dialect)
    assert not done.error
    assert len(done.entries) > passes


def read_singly(monkeypatch: pytest.MonkeyPatch, text: str, dialect: str) -> int:
    """How many lines of a program are executed one by one."""
    count = 0
    fetch = execution.Execution._fetch

    def counting(self: execution.Execution) -> object:
        nonlocal count
        count += 1
        return fetch(self)

    monkeypatch.setattr(execution.Execution, "_fetch", counting)
    options = Options(collects_errors=True, has_batches=True)
    run = made(text, dialect=dialect, options=options).interpreter
    assert any(isinstance(entry, Moves) for entry in run.entries())
    return count


@pytest.mark.parametrize("dialect", DIALECTS)
def test_the_passes_of_a_loop_are_not_executed_line_by_line(
    monkeypatch: pytest.MonkeyPatch, dialect: str
) -> None:
    few = read_singly(monkeypatch, LOOPS[dialect].format(passes=100), dialect)
    many = read_singly(monkeypatch, LOOPS[dialect].format(passes=4000), dialect)
    assert few < 60
    assert many - few <= 12  # passes 128, 256 ... are looked at for states that come back


def test_lines_with_formulas_are_not_executed_line_by_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    text = "F10\nP200=2\n" + "".join(
        f"N{k + 1} G1 X(P200*{k}+.5) Y{k}.25 F(P200+{k})\n" for k in range(500)
    )
    assert read_singly(monkeypatch, text + "M2\n", "acromill") < 8


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("F10\nN1 X1\nX0\nGOTO 1\nM2\n", "acromill"),
        ("F10\nN1 P200=P200+1\nX(P200 MOD 3)\nGOTO 1\nM2\n", "acromill"),
        ("F10\nN1 P200=P200+1\nX(P200)\nIF P200>0 THEN GOTO 1\nM2\n", "acromill"),
        ("N1 P200=P200+1\nIF P200>0 THEN GOTO 1\nM2\n", "acromill"),
        ("F10\no1 while [1]\nX1\nX0\no1 endwhile\nM2\n", "rs274ngc"),
        ("F10\no1 while [1]\n#1=[#1+1]\nX#1\no1 endwhile\nM2\n", "rs274ngc"),
    ],
)
def test_endless_loops_are_found_as_before(
    text: str, dialect: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loops, "MOST_PASSES", 900)
    assert require_same(text, dialect).error is not None


@pytest.mark.parametrize(
    "text",
    [
        "P200=5\nP201=1\nP201=P201+1 P202=1/(P200-5)\nX(P201)\n",
        "P201=1\nP201=P201+1 F0\nX(P201)\n",
        "P200=1\nP200=P200+1 X(P200)\nP200=P200+1 X(SQRT(2.5-P200))\n",
        "P201=P100\nP201=P100\nP201=P5\nP902=1\n",
        "P200=1E3\n",
        "X(P200+)\n",
        "IF P200=0 THEN GOTO 10\nX1\nN10 X2\n",
        "IF #5=2 THEN GOTO 10\nIF #5=0 THEN GOTO 10\nX1\nN10 X2\n",
        "GOTO 20\nX1\nN20 X2\n",
        "X1 (SQRT(4)) Y2\nX2 (NO(4)) Y3\n",
        "X(1;2)\nX(1+2 ; 5)\n",
        "X1(a)2\nX(a)2\n",
        "X 1 Y( 2 + 3 )\nX 1Y(2+ 3)\n",
        "P 200=1\nP200 =2\nX P200\n",
        "P200=P200+1\n" * 20 + "X(P200)\n",
        "X(P(200))\nX(P(201))\nX(P(0.5))\n",
        "X#(1)\nX#(200)\nX#(-7.25)\nP(200)=1\nP(0.5)=1\nP( 9000)=1\n",
        "X(P(-1.5)) G91\nG90 X1\nX2\nX3\n",
        "(MSG, P200)\nX(P200)\n",
        "/X(P200+1)\nX(P200+1)\n",
        "P200=999999999999999\nP200=9999999999999999\nX(P200)\n",
        "G(80+1)\nX(1)\n",
        "GOTO(10)\nN10 X1\n",
        "G1.0 X(1)\nG 1 X(1)\nG01 X(1)\n",
    ],
)
def test_lines_that_only_the_tree_understands(text: str) -> None:
    require_same(f"F10\n{text}{text}M2\n", "acromill")


@pytest.mark.parametrize(
    "text",
    [
        "#1=1 #1=[#1+1] #2=#1\nX#1 Y#2\n",
        "#1=5 X#1\n",
        "#<a>=1\n#<a>=[#<a>+1]\nX#<a>\n",
        "X[1 2+3]\nX[1. 5]\nX1 2\n",
        "#5220=1\nX#5220\n#5421=3\n",
        "X[atan[1]/[2]]\nX[2**3]\nX[2 ** 3]\nX[2* *3]\n",
        "o1 if [1]\nX1\no1 elseif [0]\nX2\no1 else\nX3\no1 endif\nX4\n",
        "o1 do\n#1=[#1+1]\nX#1\no1 while [#1 lt 9]\n",
        "o1 repeat [3]\nX[#1]\no1 endrepeat\n",
        "o1 while [#1 lt 5]\n#1=[#1+1]\no2 if [#1 gt 3]\no1 break\no2 endif\nX#1\no1 endwhile\n",
        "o1 while [#1 lt 5]\n#1=[#1+1]\nX#1\no1 endwhile\n" * 2,
        "X[exists[#<_x>]]\n",
        "#31=-0\nX#31 Y-#31\n",
    ],
)
def test_the_same_in_rs274ngc(text: str) -> None:
    require_same(f"F10\n{text}{text}M2\n", "rs274ngc")


def test_a_formula_that_is_used_often_has_the_same_value() -> None:
    text = "P201=0\nN1 P201=P201+1\nP200=SIN(30*P201)\nX(P200)\n"
    require_same(f"F10\n{text}IF P201<{3 * HOT} THEN GOTO 1\nM2\n", "acromill")
