"""Assignments and the numeric functions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from openacr.basic import arith_cy as arith
from openacr.basic import strings
from openacr.basic.grammar import Form, Lvalue
from openacr.basic.nodes import Expr, Statement, is_text
from openacr.basic.registry import ANY, command, function
from openacr.basic.run import Run
from openacr.messages import TYPE_MISMATCH

if TYPE_CHECKING:
    from openacr.basic.compiler import Emitter
    from openacr.basic.parser import Parser

STRING_FUNCTIONS = strings.__name__  # importing the module registers them

for _name, _code, _summary in (
    ("ABS", arith.FN_ABS, "Absolute value."),
    ("SQRT", arith.FN_SQRT, "Square root."),
    ("LN", arith.FN_LN, "Natural logarithm."),
    ("LOG", arith.FN_LOG, "Base-10 logarithm."),
    ("EXP", arith.FN_EXP, "e to the power x."),
    ("SIN", arith.FN_SIN, "Sine of an angle in degrees."),
    ("COS", arith.FN_COS, "Cosine of an angle in degrees."),
    ("TAN", arith.FN_TAN, "Tangent of an angle in degrees."),
    ("ASIN", arith.FN_ASIN, "Angle in degrees whose sine is x."),
    ("ACOS", arith.FN_ACOS, "Angle in degrees whose cosine is x."),
    ("ATAN", arith.FN_ATAN, "Angle in degrees, -90 to 90, whose tangent is x."),
    ("SINH", arith.FN_SINH, "Hyperbolic sine."),
    ("COSH", arith.FN_COSH, "Hyperbolic cosine."),
    ("TANH", arith.FN_TANH, "Hyperbolic tangent."),
    ("ASINH", arith.FN_ASINH, "Inverse hyperbolic sine."),
    ("ACOSH", arith.FN_ACOSH, "Inverse hyperbolic cosine."),
    ("ATANH", arith.FN_ATANH, "Inverse hyperbolic tangent."),
    ("RND", arith.FN_RND, "Random integer 0 to n-1."),
    ("CEIL", arith.FN_CEIL, "Next integer up."),
    ("FLOOR", arith.FN_FLOOR, "Next integer down."),
    ("INT", arith.FN_FLOOR, "Next integer down, as FLOOR."),
    ("ROUND", arith.FN_ROUND, "Nearest integer, halves away from zero."),
    ("TRUNC", arith.FN_TRUNC, "Integer part, toward zero."),
    ("SGN", arith.FN_SGN, "Sign: -1, 0 or 1."),
    ("FRAC", arith.FN_FRAC, "x without its integer part."),
):
    function(_name, code=_code, summary=_summary)


@dataclass(frozen=True, slots=True)
class Assigned:
    """`target = value` as it was read."""

    target: Expr
    value: Expr


class Assignment(Form):
    """`variable = expression` of the same type."""

    def starts(self, p: Parser) -> bool:
        """Whether a variable begins here."""
        return p.at_variable

    def parse(self, p: Parser) -> Assigned:
        """Read both sides."""
        target = Lvalue().parse(p)
        p.expect("=")
        start = p.position
        value = p.expression()
        if is_text(target) != is_text(value):
            raise p.error_from(start, TYPE_MISMATCH)
        return Assigned(target, value)

    def evaluate(self, run: Run, read: Any) -> Assigned:
        """The pair itself: what it means depends on the type."""
        return read  # type: ignore[no-any-return]


def emit_assignment(e: Emitter, statement: Statement) -> None:
    """Numbers are stored by the VM, strings by Python."""
    (assigned,) = statement.arguments
    if not isinstance(assigned, Assigned) or is_text(assigned.value):
        e.trap(statement)
        return
    e.store(assigned.target, lambda: e.expression(assigned.value))


@command(
    "LET",
    group="Parametric Evaluation",
    levels=ANY,
    grammar=(Assignment(),),
    ref="PG Parametric Evaluation",
    emit=emit_assignment,
    typed=False,
)
def let(run: Run, assigned: Assigned) -> None:
    """Store the value of an expression in a variable, parameter, flag or array element."""
    run.assign(assigned.target, run.text(assigned.value))
