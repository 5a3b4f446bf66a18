"""Branches, loops and subroutines: all of them code of the VM."""

from __future__ import annotations

from functools import partial

from openacr.basic.language import registry
from openacr.basic.language.flow_forms import Destination, Step, Then, Value
from openacr.basic.language.grammar import Condition, Int, Lvalue, Mark, Rest
from openacr.basic.language.registry import ANY, BOTH, PLC, PROG, PROGRAM
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
command = partial(registry.command, group=GROUP, ref=REF)


@command("IF", levels=ANY, use=BOTH, grammar=(Condition(), Then()), emit=emit_if)
def if_(run: Run, *_: object) -> None:
    """Execute what follows only if a condition is true (not zero)."""


@command("ELSEIF", "ELSE IF", levels=PROG, use=PROGRAM, grammar=(Condition(),), emit=emit_elseif)
def elseif(run: Run, *_: object) -> None:
    """Another condition, tested if all before it were false."""


@command("ELSE", levels=PROG, use=PROGRAM, emit=emit_else)
def else_(run: Run) -> None:
    """Begin the statements that are executed if no condition was true."""


@command("ENDIF", levels=PROG, use=PROGRAM, emit=emit_endif)
def endif(run: Run) -> None:
    """End an IF."""


@command("WHILE", levels=PROG, use=PROGRAM, grammar=(Condition(),), emit=emit_while)
def while_(run: Run, *_: object) -> None:
    """Repeat the statements up to WEND while a condition is true."""


@command("WEND", levels=PROG, use=PROGRAM, emit=emit_wend)
def wend(run: Run) -> None:
    """End a WHILE."""


@command(
    "FOR",
    levels=PROG,
    use=PROGRAM,
    grammar=(Lvalue(), Mark("="), Value("first"), Mark("TO"), Value("last"), Step()),
    emit=emit_for,
)
def for_(run: Run, *_: object) -> None:
    """Repeat the statements up to NEXT for each value of a variable."""


@command("NEXT", levels=PROG, use=PROGRAM, grammar=(Lvalue(optional=True),), emit=emit_next)
def next_(run: Run, *_: object) -> None:
    """End a FOR."""


@command("BREAK", levels=PROG, use=PROGRAM, emit=emit_break)
def break_(run: Run) -> None:
    """Leave the innermost FOR or WHILE."""


@command(
    "GOTO",
    levels=PROG,
    use=PROGRAM,
    grammar=(Destination("label"),),
    emit=emit_jump(vm.DO_GOTO, vm.DO_GOTO_LINE),
)
def goto(run: Run, *_: object) -> None:
    """Go on at a label or line."""


@command(
    "GOSUB",
    levels=PROG,
    use=PROGRAM,
    grammar=(Destination("label"),),
    emit=emit_jump(vm.DO_GOSUB, vm.DO_GOSUB_LINE),
)
def gosub(run: Run, *_: object) -> None:
    """Execute a subroutine; RETURN continues after this statement."""


@command("RETURN", levels=PROG, use=PROGRAM, emit=emit_op(vm.DO_RETURN))
def return_(run: Run) -> None:
    """Continue after the latest GOSUB."""


@command("END", levels=PROG, use=PROGRAM, emit=emit_op(vm.DO_END))
def end(run: Run) -> None:
    """End the program; moves already issued finish."""


@command("ENDP", levels=PROG | PLC, use=BOTH, emit=emit_op(vm.DO_END))
def endp(run: Run) -> None:
    """Close the text of a program; reached at run time it ends the program."""


@command(
    "PROGRAM",
    levels=PROG | PLC,
    use=BOTH,
    grammar=(Int("number", optional=True), Rest()),
    emit=emit_nothing,
)
def program(run: Run, *_: object) -> None:
    """Open the text of a program."""
