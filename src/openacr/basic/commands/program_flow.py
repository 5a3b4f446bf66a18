"""Branches, loops and subroutines: all of them code of the VM."""

from __future__ import annotations

from openacr.basic.language.flow_forms import Destination, Step, Then, Value
from openacr.basic.language.grammar import Condition, Int, Lvalue, Mark, Rest
from openacr.basic.language.registry import ANY, BOTH, PLC, PROG, PROGRAM, command
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.flow_code import (
    emit_break,
    emit_else,
    emit_elseif,
    emit_endif,
    emit_for,
    emit_if,
    emit_jump,
    emit_next,
    emit_nothing,
    emit_op,
    emit_wend,
    emit_while,
)
from openacr.basic.vm.run import Run

GROUP = "Program Flow"
REF = "PG Program Flow"


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
    """Execute a subroutine; RETURN continues after this statement."""


@command("RETURN", group=GROUP, levels=PROG, use=PROGRAM, ref=REF, emit=emit_op(vm.DO_RETURN))
def return_(run: Run) -> None:
    """Continue after the latest GOSUB."""


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
