"""Whom RUN, HALT, MEM and their kin act on."""

from openacr.basic.language.grammar import ObjectRef
from openacr.basic.language.registry import Level
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import OWNERS
from openacr.basic.memory.storage import PLCS
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT, UNKNOWN_COMMAND


def own(run: Run) -> int | None:
    """The program (0-15) or PLC (16-23) a command without target means; None at SYS."""
    if run.level is Level.PLC:
        return PROGRAMS + int(run.channel.number)
    return run.program


def needed_own(run: Run) -> int:
    """The program or PLC whose prompt this is; `Unknown command` at SYS."""
    owner = own(run)
    if owner is None:
        raise CardError(UNKNOWN_COMMAND)
    return owner


def named(target: ObjectRef) -> int:
    """The program or PLC of `PROGn` or `PLCn`."""
    is_program = target.word == "PROG"
    if not 0 <= target.number < (PROGRAMS if is_program else PLCS):
        raise CardError(INVALID_ARGUMENT)
    return target.number if is_program else PROGRAMS + target.number


def program(run: Run, target: ObjectRef | None) -> int:
    """The one program a command acts on: the one named, else that of the prompt."""
    return run.needed_program() if target is None else named(target)


def owners(run: Run, target: ObjectRef | None) -> tuple[int, ...]:
    """All programs and PLCs a command acts on, lowest number first."""
    if target is None:
        return (needed_own(run),)
    if target.word == "ALL":
        return tuple(range(OWNERS))
    return (named(target),)
