"""Code of branches, loops and jumps, for the `emit=` of their commands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from openacr.basic.language.flow_forms import Conditional
from openacr.basic.language.nodes import Number, Statement
from openacr.basic.vm import flow_cy as flow
from openacr.basic.vm import opcodes_cy as vm

if TYPE_CHECKING:
    from openacr.basic.vm.compiler import CodeLevel, Emitter


def emit_if(e: Emitter, statement: Statement) -> None:
    """IF: with THEN a conditional rest of the line, else the beginning of a level."""
    condition, then = statement.arguments
    if isinstance(then, Conditional):
        if any(then.blocks):
            e.mark_condition()
        after_line = e.place()
        _condition(e, condition, after_line)
        e.blocks(then.blocks)
        e.put(after_line)
        return
    level = e.open(flow.FLOW_IF)
    e.op(vm.DO_ENTER, flow.FLOW_IF, level.start, level.stop)
    e.put(level.start)
    level.next_branch = e.place()
    _condition(e, condition, level.next_branch)


def _condition(e: Emitter, condition: Any, otherwise: Any) -> None:
    e.expression(condition)
    e.op(vm.DO_JUMP_IF_ZERO, otherwise)
    e.drop(1)


def _next_branch(e: Emitter, *, is_last: bool) -> CodeLevel:
    """End one branch of an IF: jump past the level, and begin the next branch."""
    level = e.levels.branch(e.line_number, is_last=is_last)
    e.op(vm.DO_JUMP, level.stop)
    if level.next_branch is not None:
        e.put(level.next_branch)
    return level


def emit_elseif(e: Emitter, statement: Statement) -> None:
    """ELSEIF."""
    (condition,) = statement.arguments
    level = _next_branch(e, is_last=False)
    e.begin_statement()
    level.next_branch = e.place()
    _condition(e, condition, level.next_branch)


def emit_else(e: Emitter, statement: Statement) -> None:
    """ELSE: the last branch."""
    _next_branch(e, is_last=True).next_branch = None


def emit_endif(e: Emitter, statement: Statement) -> None:
    """ENDIF."""
    level = e.levels.leave(flow.FLOW_IF, e.line_number)
    if level.next_branch is not None:
        e.put(level.next_branch)
    e.put(level.stop)
    e.op(vm.DO_LEAVE, level.start)


def emit_while(e: Emitter, statement: Statement) -> None:
    """WHILE: the condition is computed at each pass, which counts as a statement."""
    (condition,) = statement.arguments
    level = e.open(flow.FLOW_WHILE)
    test = e.place()
    e.op(vm.DO_ENTER, flow.FLOW_WHILE, level.start, level.stop)
    e.op(vm.DO_JUMP, test)
    e.put(level.start)
    e.begin_statement()
    e.put(test)
    _condition(e, condition, level.stop)


def emit_wend(e: Emitter, statement: Statement) -> None:
    """WEND."""
    level = e.levels.leave(flow.FLOW_WHILE, e.line_number)
    e.op(vm.DO_WEND, level.start, level.start)
    e.put(level.stop)
    e.op(vm.DO_LEAVE, level.start)


def emit_for(e: Emitter, statement: Statement) -> None:
    """FOR: limit and step are computed once, the test is made before each pass."""
    variable, first, last, step = statement.arguments
    if isinstance(first, str) or variable is None:
        raise TypeError(statement)
    e.store(variable, lambda: e.expression(first))  # type: ignore[arg-type]
    e.expression(last)  # type: ignore[arg-type]
    e.expression(step or Number(1))  # type: ignore[arg-type]
    level = e.open(flow.FLOW_FOR)
    level.data = variable  # type: ignore[assignment]
    e.op(vm.DO_ENTER_FOR, level.start, level.stop)
    e.drop(2)
    e.put(level.start)
    e.expression(variable)  # type: ignore[arg-type]
    e.op(vm.DO_TEST_FOR, level.stop)
    e.drop(1)


def emit_next(e: Emitter, statement: Statement) -> None:
    """NEXT: step the variable and test again."""
    level = e.levels.leave(flow.FLOW_FOR, e.line_number)
    variable = level.data
    if variable is None:
        raise TypeError(statement)

    def stepped() -> None:
        e.expression(variable)
        e.op(vm.DO_NEXT, level.start)

    e.store(variable, stepped)
    e.op(vm.DO_JUMP, level.start)
    e.put(level.stop)


def emit_break(e: Emitter, statement: Statement) -> None:
    """BREAK: leave the innermost loop."""
    level = e.levels.loop(e.line_number)
    e.op(vm.DO_BREAK, level.start, level.stop)


def emit_jump(direct: int, computed: int) -> Any:
    """The code of GOTO and GOSUB."""

    def emit(e: Emitter, statement: Statement) -> None:
        (destination,) = statement.arguments
        if isinstance(destination, str):
            e.op(direct, e.label(destination))
        elif isinstance(destination, Number):
            e.op(direct, e.numbered(int(destination.value)))
        else:
            e.expression(destination)  # type: ignore[arg-type]
            e.op(computed)
            e.drop(1)

    return emit


def emit_op(op: int) -> Any:
    """The code of a statement that is a single operation."""

    def emit(e: Emitter, statement: Statement) -> None:
        e.op(op)

    return emit


def emit_nothing(e: Emitter, statement: Statement) -> None:
    """A statement without effect at run time."""
