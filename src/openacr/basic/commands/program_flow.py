"""Branches, loops and subroutines: all of them code of the VM."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from openacr.basic import flow_cy as flow
from openacr.basic import opcodes_cy as vm
from openacr.basic import registry
from openacr.basic.grammar import Condition, Form, Int, Lvalue, Mark, Rest
from openacr.basic.nodes import Block, Expr, Number, Statement
from openacr.basic.registry import ANY, BOTH, PLC, PROG, PROGRAM, Level, command
from openacr.basic.run import Run
from openacr.lang.lexer import Kind
from openacr.messages import (
    NOT_VALID_AT_THIS_LEVEL,
    SYNTAX_ERROR,
    UNKNOWN_COMMAND,
)

if TYPE_CHECKING:
    from openacr.basic.compiler import CodeLevel, Emitter
    from openacr.basic.parser import Parser

GROUP = "Program Flow"
REF = "PG Program Flow"


# forms


@dataclass(frozen=True, slots=True)
class Conditional:
    """What stands behind THEN."""

    blocks: tuple[Block, ...]


class Then(Form):
    """`THEN statements`: everything up to the end of the line; `THEN 100` means GOTO 100."""

    def __init__(self) -> None:
        super().__init__("THEN", optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether THEN stands here; the block form belongs to programs only."""
        if p.is_word("THEN"):
            return True
        if not p.at_block_end:
            raise p.error(SYNTAX_ERROR)
        if not p.scope.stored:
            at_sys = p.scope.level is Level.SYS
            raise p.error(UNKNOWN_COMMAND if at_sys else NOT_VALID_AT_THIS_LEVEL)
        return False

    def parse(self, p: Parser) -> Conditional:
        """Read the statements."""
        p.advance()
        if p.token.kind is Kind.NUMBER and p.scope.stored:
            column = p.token.column
            goto_line = Statement(registry.find("GOTO"), (Destination().parse(p),), column=column)
            first, *others = p.rest_of_line()
            return Conditional(((goto_line, *first), *others))
        if p.at_block_end and p.token.kind is not Kind.REMARK:
            raise p.error(SYNTAX_ERROR)
        return Conditional(p.rest_of_line())


class Destination(Form):
    """A label, a line number, or `(expr)` that computes a line number."""

    def starts(self, p: Parser) -> bool:
        """Whether one of them stands here."""
        return p.token.kind in (Kind.LABEL, Kind.NUMBER) or p.is_operator("(")

    def parse(self, p: Parser) -> str | Expr:
        """Read it."""
        if p.token.kind is Kind.LABEL:
            return str(p.advance().value)
        return p.object_index()


class Value(Form):
    """A numeric expression, as far as it goes."""

    def starts(self, p: Parser) -> bool:
        """Whether anything stands here."""
        return not p.at_block_end

    def parse(self, p: Parser) -> Expr:
        """Read it."""
        return p.numeric()


class Step(Form):
    """`STEP expr` of FOR."""

    def __init__(self) -> None:
        super().__init__("STEP", optional=True)

    def starts(self, p: Parser) -> bool:
        """Whether STEP stands here."""
        return p.is_word("STEP")

    def parse(self, p: Parser) -> Expr:
        """Read it."""
        p.advance()
        return p.numeric()


# code


def emit_if(e: Emitter, statement: Statement) -> None:
    """IF: with THEN a conditional rest of the line, else the beginning of a level."""
    condition, then = statement.arguments
    if isinstance(then, Conditional):
        behind = e.place()
        _condition(e, condition, behind)
        e.blocks(then.blocks)
        e.put(behind)
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
    """End one branch of an IF: jump behind the level, and begin the next branch."""
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


# commands


@command(
    "IF", group=GROUP, levels=ANY, use=BOTH, grammar=(Condition(), Then()), ref=REF, emit=emit_if
)
def if_(run: Run, *_: object) -> None:
    """Execute what follows only if a condition is true (not zero)."""


@command(
    "ELSEIF",
    "ELSE IF",
    group=GROUP,
    levels=PROG,
    use=PROGRAM,
    grammar=(Condition(),),
    ref=REF,
    emit=emit_elseif,
)
def elseif(run: Run, *_: object) -> None:
    """Another condition, tested if all before it were false."""


@command("ELSE", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_else)
def else_(run: Run) -> None:
    """Begin the statements that are executed if no condition was true."""


@command("ENDIF", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_endif)
def endif(run: Run) -> None:
    """End an IF."""


@command(
    "WHILE", group=GROUP, levels=PROG, use=PROGRAM, grammar=(Condition(),), ref=REF, emit=emit_while
)
def while_(run: Run, *_: object) -> None:
    """Repeat the statements up to WEND while a condition is true."""


@command("WEND", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_wend)
def wend(run: Run) -> None:
    """End a WHILE."""


@command(
    "FOR",
    group=GROUP,
    levels=PROG,
    use=PROGRAM,
    grammar=(Lvalue(), Mark("="), Value("first"), Mark("TO"), Value("last"), Step()),
    ref=REF,
    emit=emit_for,
)
def for_(run: Run, *_: object) -> None:
    """Repeat the statements up to NEXT for each value of a variable."""


@command(
    "NEXT",
    group=GROUP,
    levels=PROG,
    use=PROGRAM,
    grammar=(Lvalue(optional=True),),
    ref=REF,
    emit=emit_next,
)
def next_(run: Run, *_: object) -> None:
    """End a FOR."""


@command("BREAK", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_break)
def break_(run: Run) -> None:
    """Leave the innermost FOR or WHILE."""


@command(
    "GOTO",
    group=GROUP,
    levels=PROG,
    use=PROGRAM,
    grammar=(Destination("label"),),
    ref=REF,
    emit=emit_jump(vm.DO_GOTO, vm.DO_GOTO_LINE),
)
def goto(run: Run, *_: object) -> None:
    """Go on at a label or line."""


@command(
    "GOSUB",
    group=GROUP,
    levels=PROG,
    use=PROGRAM,
    grammar=(Destination("label"),),
    ref=REF,
    emit=emit_jump(vm.DO_GOSUB, vm.DO_GOSUB_LINE),
)
def gosub(run: Run, *_: object) -> None:
    """Execute a subroutine; RETURN comes back behind this statement."""


@command("RETURN", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_op(vm.DO_RETURN))
def return_(run: Run) -> None:
    """Go back behind the latest GOSUB."""


@command("END", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_op(vm.DO_END))
def end(run: Run) -> None:
    """End the program; moves already issued finish."""


@command("ENDP", group=GROUP, levels=PROG | PLC, use=BOTH, ref=REF, emit=emit_op(vm.DO_END))
def endp(run: Run) -> None:
    """Close the text of a program; reached at run time it ends the program."""


@command(
    "PROGRAM",
    group=GROUP,
    levels=PROG | PLC,
    use=BOTH,
    grammar=(Int("number", optional=True), Rest()),
    ref=REF,
    emit=emit_nothing,
)
def program(run: Run, *_: object) -> None:
    """Open the text of a program."""
