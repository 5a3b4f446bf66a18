"""Numbers as PRINT and STR$ show them: it depends on where a value is stored."""

from openacr.basic.language.nodes import Element, Expr, Local, LocalKind, Parameter, resolved
from openacr.basic.language.number_format import double_text, single_text
from openacr.basic.vm.run import Run
from openacr.map import numbers as at
from openacr.map.kinds_cy import kind_of


def printed(run: Run, node: Expr) -> str:
    """The text of a number: seven digits for what is stored as FP32, else ten."""
    value = run.value(node)
    return single_text(value) if is_single(run, node) else double_text(value)


def is_single(run: Run, node: Expr) -> bool:
    """Whether the value of an expression is one FP32 parameter or variable."""
    match resolved(node):
        case Parameter(index):
            return kind_of(run.card.memory.I, run.integer(index)) == at.KIND_FP32
        case Local(LocalKind.SINGLE, _) | Element(LocalKind.SINGLE, _, _):
            return True
    return False
