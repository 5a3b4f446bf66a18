"""Assignments and the numeric functions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec import Struct

from openacr.basic.language.grammar import Form, Lvalue
from openacr.basic.language.nodes import Expr, Statement, is_text
from openacr.basic.language.registry import ANY, command, function
from openacr.basic.vm import functions_cy
from openacr.basic.vm.run import Run
from openacr.messages import TYPE_MISMATCH

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser
    from openacr.basic.vm.compiler import Emitter

for _name, _code, _summary in (
    ("ABS", functions_cy.FN_ABS, "Absolute value."),
    ("SQRT", functions_cy.FN_SQRT, "Square root."),
    ("LN", functions_cy.FN_LN, "Natural logarithm."),
    ("LOG", functions_cy.FN_LOG, "Base-10 logarithm."),
    ("EXP", functions_cy.FN_EXP, "e to the power x."),
    ("SIN", functions_cy.FN_SIN, "Sine of an angle in degrees."),
    ("COS", functions_cy.FN_COS, "Cosine of an angle in degrees."),
    ("TAN", functions_cy.FN_TAN, "Tangent of an angle in degrees."),
    ("ASIN", functions_cy.FN_ASIN, "Angle in degrees whose sine is x."),
    ("ACOS", functions_cy.FN_ACOS, "Angle in degrees whose cosine is x."),
    ("ATAN", functions_cy.FN_ATAN, "Angle in degrees, -90 to 90, whose tangent is x."),
    ("SINH", functions_cy.FN_SINH, "Hyperbolic sine."),
    ("COSH", functions_cy.FN_COSH, "Hyperbolic cosine."),
    ("TANH", functions_cy.FN_TANH, "Hyperbolic tangent."),
    ("ASINH", functions_cy.FN_ASINH, "Inverse hyperbolic sine."),
    ("ACOSH", functions_cy.FN_ACOSH, "Inverse hyperbolic cosine."),
    ("ATANH", functions_cy.FN_ATANH, "Inverse hyperbolic tangent."),
    ("RND", functions_cy.FN_RND, "Random integer 0 to n-1."),
    ("CEIL", functions_cy.FN_CEIL, "Next integer up."),
    ("FLOOR", functions_cy.FN_FLOOR, "Next integer down."),
    ("INT", functions_cy.FN_FLOOR, "Next integer down, as FLOOR."),
    ("ROUND", functions_cy.FN_ROUND, "Nearest integer, halves away from zero."),
    ("TRUNC", functions_cy.FN_TRUNC, "Integer part, toward zero."),
    ("SGN", functions_cy.FN_SGN, "Sign: -1, 0 or 1."),
    ("FRAC", functions_cy.FN_FRAC, "x without its integer part."),
):
    function(_name, code=_code, summary=_summary)


class Assigned(Struct, frozen=True):
    """`target = value` as it was read."""

    target: Expr
    value: Expr


class Assignment(Form):
    """`variable = expression` of the same type."""

    def starts(self, p: Parser) -> bool:
        """Whether a variable begins here."""
        return p.expressions.at_variable

    def parse(self, p: Parser) -> Assigned:
        """Read both sides."""
        target = Lvalue().parse(p)
        p.cursor.expect("=")
        start = p.cursor.position
        value = p.expressions.expression()
        if is_text(target) != is_text(value):
            raise p.cursor.error_from(start, TYPE_MISMATCH)
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
