"""Memory control: CLEAR, DIM, MEM."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.basic.commands import targets
from openacr.basic.commands.character_io import Channel, channel_name
from openacr.basic.language.grammar import Form, Object, ObjectRef
from openacr.basic.language.nodes import Expr
from openacr.basic.language.registry import ANY, Level, command
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.storage import Storage
from openacr.basic.vm.run import Run
from openacr.errors import CardError
from openacr.lang.lexer import TokenKind
from openacr.messages import NOT_VALID_AT_THIS_LEVEL, PROGRAM_IN_MEMORY, SYNTAX_ERROR

if TYPE_CHECKING:
    from openacr.basic.language.parser import Parser

GROUP = "Memory Control"

_STREAMS = frozenset(("COM", "STREAM"))
_SINGLE_STREAMS = frozenset(("FIFO", "DPCB"))
_ARRAYS = frozenset(("LA", "SA", "DA", "$A"))
_SCALARS = frozenset(("LV", "SV", "DV"))
_SYSTEM = frozenset(("PROG", "PLC", "P", "DEF")) | _STREAMS | _SINGLE_STREAMS
_LOCAL = _ARRAYS | _SCALARS | {"$V", "MBUF"}
_INDEXED = frozenset(("PROG", "PLC")) | _STREAMS


class Dimension(Struct, frozen=True):
    """What is to be dimensioned: the word, the number of the object, the sizes."""

    word: str
    index: Expr | None
    sizes: tuple[Expr, ...]


class DimensionForm(Form):
    """`PROG n size`, `P(count)`, `LV(n)`, `LA(n)`, `LA i (m)`, `$V(n,len)`...

    Parentheses are optional around one number. An array word followed by one number gives
    the number of arrays, by two an array and its elements.
    """

    def starts(self, p: Parser) -> bool:
        """Whether a word that can be dimensioned stands here."""
        return p.cursor.is_word(*_SYSTEM, *_LOCAL)

    def parse(self, p: Parser) -> Dimension:
        """Read word and numbers."""
        word = str(p.cursor.advance().value)
        if word in _INDEXED:
            return Dimension(word, p.expressions.object_index(), self._sizes(p, 1))
        if word == "$V":
            return Dimension(word, None, self._sizes(p, 2))
        if word not in _ARRAYS:
            return Dimension(word, None, self._sizes(p, 1))
        first = self._sizes(p, 1)
        if not p.cursor.is_operator("(") and p.cursor.token.kind is not TokenKind.NUMBER:
            return Dimension(word, None, first)
        return Dimension(word, first[0], self._sizes(p, 2 if word == "$A" else 1))

    @staticmethod
    def _sizes(p: Parser, count: int) -> tuple[Expr, ...]:
        if count == 1:
            return (p.expressions.value(),)
        p.cursor.expect("(")
        sizes = [p.expressions.numeric()]
        while p.cursor.accept(","):
            sizes.append(p.expressions.numeric())
        p.cursor.expect(")")
        if len(sizes) != count:
            raise p.cursor.error(SYNTAX_ERROR)
        return tuple(sizes)


@command(
    "DIM",
    group=GROUP,
    levels=ANY,
    grammar=(DimensionForm("what", optional=True),),
    ref="PG Memory Allocations",
)
def dim(run: Run, what: Dimension | None) -> None:
    """Allocate memory: of the system at SYS, for variables at a program; alone, list it."""
    if what is None:
        _list(run)
        return
    index = None if what.index is None else run.integer(what.index)
    sizes = tuple(run.integer(size) for size in what.sizes)
    if what.word not in _SYSTEM:
        dimension_local(
            run.system.storage, run.needed_program(), what.word, index, sizes, repeat=run.stored
        )
    elif run.level is not Level.SYS:
        raise CardError(NOT_VALID_AT_THIS_LEVEL)
    else:
        dimension_system(run.system.storage, what.word, index, sizes)


def _list(run: Run) -> None:
    storage: Storage = run.system.storage
    lines = storage.system_lines()
    if run.level is not Level.SYS:
        owner = targets.needed_own(run)
        lines = storage.locals.lines(owner) if owner < PROGRAMS else iter(())
    for line in lines:
        run.print(line)


def dimension_system(
    storage: Storage, word: str, index: int | None, sizes: tuple[int, ...]
) -> None:
    """DIM at SYS: memory of a program or PLC, of P, aliases or the buffer of a stream."""
    size, number = sizes[0], -1 if index is None else index
    kinds: dict[str, Callable[[], None]] = {
        "PROG": lambda: storage.dimension_program(number, size),
        "PLC": lambda: storage.dimension_plc(number, size),
        "P": lambda: storage.dimension_globals(size),
        "DEF": lambda: storage.dimension_defines(size),
    }
    name = word if number < 0 else f"{word}{number}"
    kinds.get(word, lambda: storage.dimension_stream(name, size))()


def dimension_local(
    storage: Storage,
    program: int,
    word: str,
    index: int | None,
    sizes: tuple[int, ...],
    *,
    repeat: bool,
) -> None:
    """DIM at a program; a stored one may `repeat` its own DIM with unchanged sizes."""
    local = storage.locals
    first, *rest = sizes
    if index is not None:
        if word == "$A":
            local.string_array(program, index, first, *rest, repeat=repeat)
        else:
            local.array(program, word, index, first, repeat=repeat)
    elif word == "$V":
        local.string_variables(program, first, *rest, repeat=repeat)
    elif word == "MBUF":
        local.move_buffer(program, first, repeat=repeat)
    elif word in _SCALARS:
        local.variables(program, word, first, repeat=repeat)
    else:
        local.references(program, word, first, repeat=repeat)


def is_of_system(word: str) -> bool:
    """Whether DIM of this word belongs to SYS; the others belong to a program."""
    return word in _SYSTEM


@command(
    "CLEAR",
    group=GROUP,
    levels=ANY,
    grammar=(Channel(optional=True),),
    ref="PG Memory Allocations",
)
def clear(run: Run, stream: ObjectRef | None) -> None:
    """Free memory: everything at SYS, the locals at a program, or the buffer of a stream."""
    if stream is not None:
        run.system.storage.clear_stream(channel_name(stream))
    elif run.level is Level.SYS:
        _clear_system(run)
    elif run.program is not None:
        run.system.devices.close_all(run.program)
        run.system.storage.locals.clear(run.program)


def _clear_system(run: Run) -> None:
    if any(run.system.control.is_running(owner) for owner in run.system.owners()):
        raise CardError(PROGRAM_IN_MEMORY)
    run.system.storage.clear_system()
    run.system.aliases.clear()


@command(
    "MEM",
    group=GROUP,
    levels=ANY,
    grammar=(Object("PROG", "PLC", optional=True),),
    ref="PG Memory Allocations",
    units="bytes",
)
def mem(run: Run, target: ObjectRef | None) -> None:
    """Print the free memory of the level, or of a program or PLC."""
    owner = targets.own(run) if target is None else targets.named(target)
    storage: Storage = run.system.storage
    free = storage.free_system() if owner is None else storage.free_program(owner)
    run.print(str(free))
