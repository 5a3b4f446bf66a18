"""Program control: RUN, HALT, PAUSE, RESUME, LIST, LISTEN, LRUN, NEW and single steps."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.commands import targets
from openacr.basic.language.grammar import Form, Int, Object, ObjectRef, Target
from openacr.basic.language.lister import Lister, depth_after, opens_free_form
from openacr.basic.language.nodes import Expr
from openacr.basic.language.registry import (
    ANY,
    BY_TARGET,
    IMMEDIATE,
    PLC,
    PROG,
    command,
)
from openacr.basic.memory.program_store import HIGHEST_LINE_NUMBER, OWNERS, StoredLine
from openacr.basic.vm.run import Run, Wait, WaitKind
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.messages import PROGRAM_IS_RUNNING

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

GROUP = "Program Control"
FORCE_LINE_NUMBERS = 5651
SHOWN_LINE_WORK = 100  # to cut a line into words and write it
KNOWN_LINE_WORK = 1  # to pass over a line whose depth is known
WORK_PER_SLICE = 20 * SHOWN_LINE_WORK  # some 0.8 ms of the computer


@command(
    "RUN",
    group=GROUP,
    levels=BY_TARGET,
    grammar=(Int("line", 1, HIGHEST_LINE_NUMBER, optional=True), Target()),
    ref="PG Starting, Pausing, and Halting Programs",
)
def run_(run: Run, line: int | None, target: ObjectRef | None) -> None:
    """Start a program or PLC at its first line or at `line`; the prompt returns at once.

    ALL starts every one that can be started; the first that cannot is reported.
    """
    control, programs = run.system.control, run.system.programs
    is_all = target is not None and target.word == "ALL"
    refused: list[CardError] = []
    for owner in targets.owners(run, target):
        if is_all and programs.is_empty(owner):
            continue  # it was not asked for by its name
        if not programs.is_startable(owner, run.thread):
            continue
        try:
            if not control.is_running(owner):
                control.run(owner, line)
            elif not is_all:
                raise CardError(PROGRAM_IS_RUNNING)
        except CardError as error:
            refused.append(error)
    if refused:
        raise refused[0]


@command(
    "HALT",
    group=GROUP,
    levels=ANY,
    grammar=(Target(),),
    ref="PG Starting, Pausing, and Halting Programs",
)
def halt(run: Run, target: ObjectRef | None) -> None:
    """End a program or PLC and the coordinated motion of its master."""
    at_sys = target is None and targets.own(run) is None
    for owner in range(OWNERS) if at_sys else targets.owners(run, target):
        run.system.control.halt(owner)


@command(
    "PAUSE",
    group=GROUP,
    levels=BY_TARGET,
    grammar=(Target(),),
    ref="PG Starting, Pausing, and Halting Programs",
)
def pause(run: Run, target: ObjectRef | None) -> None:
    """Hold the motion of a program and the program before its next statement."""
    for owner in targets.owners(run, target):
        run.system.control.pause(owner)


@command(
    "RESUME",
    group=GROUP,
    levels=BY_TARGET,
    grammar=(Target(),),
    ref="PG Starting, Pausing, and Halting Programs",
)
def resume(run: Run, target: ObjectRef | None) -> None:
    """Go on where PAUSE has stopped."""
    for owner in targets.owners(run, target):
        run.system.control.resume(owner)


@command("BLK", group=GROUP, levels=BY_TARGET, grammar=(Target(),), ref="PG Program Control")
def blk(run: Run, target: ObjectRef | None) -> None:
    """Turn block mode on until AUT: a program waits before every line, also before its first."""
    for owner in targets.owners(run, target):
        run.system.control.block(owner)


@command("AUT", group=GROUP, levels=BY_TARGET, grammar=(Target(),), ref="PG Program Control")
def aut(run: Run, target: ObjectRef | None) -> None:
    """Leave block mode and go on."""
    for owner in targets.owners(run, target):
        run.system.control.auto(owner)


@command("STEP", group=GROUP, levels=BY_TARGET, grammar=(Target(),), ref="PG Program Control")
def step(run: Run, target: ObjectRef | None) -> None:
    """In block mode execute one line."""
    for owner in targets.owners(run, target):
        run.system.control.step(owner)


@command("TRON", group=GROUP, levels=BY_TARGET, grammar=(Target(),), ref="PG Program Control")
def tron(run: Run, target: ObjectRef | None) -> None:
    """Send the number of each line to the listening channels before it is executed."""
    for owner in targets.owners(run, target):
        run.system.control.trace(owner, True)


@command("TROFF", group=GROUP, levels=BY_TARGET, grammar=(Target(),), ref="PG Program Control")
def troff(run: Run, target: ObjectRef | None) -> None:
    """Stop tracing."""
    for owner in targets.owners(run, target):
        run.system.control.trace(owner, False)


@command(
    "NEW",
    group=GROUP,
    levels=BY_TARGET,
    use=IMMEDIATE,
    grammar=(Target(),),
    ref="PG Memory Allocations",
)
def new(run: Run, target: ObjectRef | None) -> None:
    """Erase the stored lines of a program or PLC; variables and dimensions stay."""
    owners = targets.owners(run, target)
    if any(run.system.control.is_running(owner) for owner in owners):
        raise CardError(PROGRAM_IS_RUNNING)
    for owner in owners:
        run.system.programs.erase(owner)


# LIST


class Range(Struct, frozen=True):
    """Lines from `first` to `last`; None is open."""

    first: Expr | None
    last: Expr | None


class LineRange(Form):
    """`n`, `n-m`, `n,m`, `n-`, `-m`."""

    def starts(self, p: Parser) -> bool:
        """Whether a number or a dash stands here."""
        return p.cursor.token.kind is TokenKind.NUMBER or p.cursor.is_operator("-")

    def parse(self, p: Parser) -> Range:
        """Read the range."""
        first = p.expressions.object_index() if p.cursor.token.kind is TokenKind.NUMBER else None
        if not p.cursor.accept("-") and not p.cursor.accept(","):
            return Range(first, first)
        return Range(
            first, p.expressions.object_index() if p.cursor.token.kind is TokenKind.NUMBER else None
        )


@command(
    "LIST",
    group=GROUP,
    levels=PROG | PLC,
    use=IMMEDIATE,
    grammar=(LineRange("lines", optional=True),),
    ref="PG Programs and Commands",
)
def list_(run: Run, lines: Range | None) -> Wait | None:
    """Show the stored program or PLC, or some of its lines."""
    store = run.system.programs
    store.check_readable()
    first = run.integer(lines.first) if lines and lines.first else 0
    last = run.integer(lines.last) if lines and lines.last else HIGHEST_LINE_NUMBER
    if not _list_on(run, store.texts[targets.needed_own(run)], first, last):
        return Wait(WaitKind.NEXT_SLICE, retry=True)
    run.channel.listed = 0, 0
    return None


def _list_on(run: Run, text: dict[int, StoredLine], first: int, last: int) -> bool:
    """Go on with the list for one time slice; whether it is complete.

    A long program is shown slice by slice, so that other channels are served between.
    """
    numbers = sorted(text)
    begin, depth = run.channel.listed
    lister = Lister(run.system.aliases.nodes)
    is_free_form = bool(numbers) and opens_free_form(text[numbers[0]])
    with_numbers = run.card.memory.bit(FORCE_LINE_NUMBERS)
    work = 0
    for number in numbers[bisect_left(numbers, begin) :]:
        line = text[number]
        if number > last:
            break
        if work >= WORK_PER_SLICE:
            run.channel.listed = number, depth
            return False
        if number >= first:
            shown = lister.stored(line, depth, is_free_form=is_free_form, numbers=with_numbers)
            run.print(shown)
        is_known = line.nesting is not None and number < first
        work += KNOWN_LINE_WORK if is_known else SHOWN_LINE_WORK
        depth = depth_after(line, depth)
    return True


@command(
    "LISTEN",
    group=GROUP,
    levels=BY_TARGET,
    use=IMMEDIATE,
    grammar=(Object("PROG", optional=True),),
    ref="PG Starting, Pausing, and Halting Programs",
)
def listen(run: Run, target: ObjectRef | None) -> None:
    """Show what the program prints, and its errors, until ESC."""
    run.channel.listen(targets.program(run, target))


@command(
    "LRUN",
    group=GROUP,
    levels=BY_TARGET,
    use=IMMEDIATE,
    grammar=(Int("line", 1, HIGHEST_LINE_NUMBER, optional=True), Object("PROG", optional=True)),
    ref="PG Starting, Pausing, and Halting Programs",
)
def lrun(run: Run, line: int | None, target: ObjectRef | None) -> None:
    """Start the program and listen to it until ESC or its end."""
    program = targets.program(run, target)
    if run.system.control.is_running(program):
        raise CardError(PROGRAM_IS_RUNNING)
    if run.system.programs.is_startable(program, run.thread):
        run.channel.listen(program, until_end=True)  # its first line may print an error
        try:
            run.system.control.run(program, line)
        except CardError:
            run.channel.stop_listening()
            raise
