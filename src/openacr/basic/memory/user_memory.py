"""User memory as data that outlasts a version of this program: text, sizes and values.

Programs are kept as they were typed and read again when they come back; the names of axes
they use are kept with them, because at power-up nothing is attached yet. Variables are kept
as the bytes of their view (little-endian 32-bit words).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeAlias

from msgspec import Struct

from openacr.basic.language.nodes import AxisRef, parts
from openacr.basic.language.parser import Parser
from openacr.basic.language.registry import Command, Level
from openacr.basic.memory.heap import ARRAYS, SCALARS, ArrayType
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.memory.ranges import LineNumber, OwnerNumber, ProgramNumber
from openacr.basic.memory.retained import LONG_VARIABLES
from openacr.basic.memory.storage import PLCS
from openacr.basic.memory.string_storage import ProgramStrings, StringsState
from openacr.errors import CardError
from openacr.lang.lexer import spelled, tokens
from openacr.map import numbers as at
from openacr.map.rows import storage as storage_rows
from openacr.map.words import pf

if TYPE_CHECKING:
    from openacr.basic.execute.system import System
    from openacr.basic.memory.heap import Heap

_SCALARS = {kind.name: kind for kind in SCALARS}
_ARRAYS = {kind.name: kind for kind in ARRAYS}

Memo: TypeAlias = dict[int, tuple[StoredLine, str, frozenset[str]]]


class Text(Struct, frozen=True):
    """One program (0-15) or PLC (16-23): lines by number, and the axis names they use."""

    owner: OwnerNumber
    lines: list[tuple[LineNumber, str]]
    axes: list[str]


class Local(Struct, frozen=True):
    """What one program has dimensioned: variables and arrays as bytes, strings as lists."""

    program: ProgramNumber
    scalars: dict[str, bytes]
    arrays: dict[str, list[bytes]]
    strings: StringsState
    move_buffer: int


class Data(Struct, frozen=True):
    """Everything beside the texts; without values all variables are 0."""

    sizes: dict[int, int]
    streams: dict[str, int]
    alias_room: int
    aliases: list[str]
    password: str | None
    has_values: bool
    globals: bytes
    longs: bytes
    locals: list[Local]


class UserMemory(Struct, frozen=True):
    """All of it."""

    texts: list[Text]
    data: Data

    @property
    def line_count(self) -> int:
        """Lines of all programs and PLCs."""
        return sum(len(text.lines) for text in self.texts)


# taking


def take(system: System, *, values: bool) -> UserMemory:
    """User memory as it is now; without `values` all variables are 0."""
    owners = (owner for owner in system.owners() if not system.programs.is_empty(owner))
    texts = [take_text(system, owner) for owner in owners]
    return UserMemory(texts, take_data(system, values=values))


def take_text(system: System, owner: int, memo: Memo | None = None) -> Text:
    """The lines of one program or PLC; a `memo` kept by the caller saves work next time."""
    memo = {} if memo is None else memo
    lines = system.programs.lines(owner)
    for line in lines:
        if line.number not in memo or memo[line.number][0] is not line:
            memo[line.number] = line, spelled(line.tokens), frozenset(_axis_names(line.tree))
    names = frozenset[str]().union(*(memo[line.number][2] for line in lines))
    return Text(owner, [(line.number, memo[line.number][1]) for line in lines], sorted(names))


def take_data(system: System, *, values: bool) -> Data:
    """Sizes, aliases and variables."""
    storage, memory = system.storage, system.card.memory
    heap, first = storage.heap, at.USER_BASE
    global_values = memory.F[first : first + storage.global_count].tobytes()
    longs = memory.I[LONG_VARIABLES].tobytes()
    return Data(
        sizes={
            owner: storage.size(owner)
            for owner in system.owners()
            if storage.size(owner) and not heap.row(owner, storage_rows.is_share)
        },
        streams={name: size for name in storage.streams if (size := storage.dimensioned(name))},
        alias_room=storage.define_count,
        aliases=list(system.aliases.lines()),
        password=system.programs.password,
        has_values=values,
        globals=global_values if values else bytes(len(global_values)),
        longs=longs if values else b"",
        locals=list(_locals(system, values=values)),
    )


def _locals(system: System, *, values: bool) -> Iterator[Local]:
    heap = system.storage.heap
    for program in range(PROGRAMS):
        strings = system.storage.locals.strings[program]
        local = Local(
            program,
            {kind.name: heap.scalars(program, kind) for kind in SCALARS},
            {kind.name: list(heap.elements(program, kind)) for kind in ARRAYS},
            strings.state(),
            heap.row(program, storage_rows.mbuf_count),
        )
        has_any = any(local.scalars.values()) or any(local.arrays.values()) or strings.bytes
        if has_any or local.move_buffer:
            yield local if values else _blank(local)


def _blank(local: Local) -> Local:
    strings = ProgramStrings.from_state(local.strings)
    for block in filter(None, (strings.variables, *strings.arrays)):
        block.values = [""] * len(block.values)
    return Local(
        local.program,
        {name: bytes(len(held)) for name, held in local.scalars.items()},
        {name: [bytes(len(held)) for held in each] for name, each in local.arrays.items()},
        strings.state(),
        local.move_buffer,
    )


def _axis_names(node: Any) -> Iterator[str]:
    """The names of axes a line uses."""
    if isinstance(node, AxisRef) and node.number is None:
        yield node.name
    elif not isinstance(node, Command):
        for each in parts(node):
            yield from _axis_names(each)


# putting back


def put(system: System, image: UserMemory) -> list[str]:
    """Replace user memory; the lines that cannot be read any more are left out and listed.

    An image without values leaves P variables that exist before and after as they are.
    """
    memory, first = system.card.memory, at.USER_BASE
    kept = memory.F[first : first + system.storage.global_count].tolist()
    system.forget()
    refused = list(_put_data(system, image.data))
    if not image.data.has_values:
        for index, value in enumerate(kept[: system.storage.global_count]):
            memory.F[first + index] = value
    for text in image.texts:
        refused += _put_text(system, text)
    return refused


def _put_data(system: System, data: Data) -> Iterator[str]:
    storage = system.storage
    for owner, size in data.sizes.items():
        if owner < PROGRAMS:
            storage.dimension_program(owner, size)
        elif owner < PROGRAMS + PLCS:
            storage.dimension_plc(owner - PROGRAMS, size)
    for name, size in data.streams.items():
        storage.dimension_stream(name, size)
    if data.alias_room:
        storage.dimension_defines(data.alias_room)
    for line in data.aliases:
        try:
            _define(system, line)
        except CardError as error:
            yield f"{line}: {error.text}"
    system.programs.password = data.password
    _put_globals(system, data)
    for local in data.locals:
        _put_local(system, local)


def _define(system: System, line: str) -> None:
    read = Parser(tokens(line), system.scope(Level.SYS, None, stored=False)).line()
    statement: Any = read.blocks[0][0]
    item = statement.arguments[0]
    system.aliases.define(item.name, item.target, item.text)


def _put_globals(system: System, data: Data) -> None:
    memory = system.card.memory
    if data.globals:
        values = memoryview(data.globals).cast("d")
        system.storage.dimension_globals(len(values))
        memory.F[at.USER_BASE : at.USER_BASE + len(values)] = values
    if data.longs:
        memory.I[LONG_VARIABLES] = memoryview(data.longs).cast("i")


def _put_local(system: System, local: Local) -> None:
    local_memory, heap, program = system.storage.locals, system.storage.heap, local.program
    for name, held in local.scalars.items():
        kind = _SCALARS[name]
        if held:
            local_memory.variables(program, name, len(held) // (4 * kind.words))
            _write(heap, heap.row(program, kind.base_row) * kind.words, held)
    for name, each in local.arrays.items():
        _put_arrays(system, program, _ARRAYS[name], each)
    local_memory.strings[program] = ProgramStrings.from_state(local.strings)
    if local.move_buffer:
        local_memory.move_buffer(program, local.move_buffer)


def _put_arrays(system: System, program: int, kind: ArrayType, arrays: list[bytes]) -> None:
    heap = system.storage.heap
    if arrays:
        system.storage.locals.references(program, kind.name, len(arrays))
    for index, held in enumerate(arrays):
        if held:
            count = len(held) // (4 * kind.words)
            system.storage.locals.array(program, kind.name, index, count)
            header = heap.memory.I[heap.row(program, kind.base_row) + index]
            _write(heap, header + 1, held)


def _write(heap: Heap, start: int, held: bytes) -> None:
    heap.memory.I[start : start + len(held) // 4] = memoryview(held).cast("i")


def _put_text(system: System, text: Text) -> Iterator[str]:
    for number, written in text.lines:
        try:
            line = system.read_stored(text.owner, number, written, frozenset(text.axes))
            if line is not None:
                system.programs.put(text.owner, line)
        except CardError as error:
            is_plc = text.owner >= PROGRAMS
            name = f"PLC{text.owner - PROGRAMS}" if is_plc else f"PROG{text.owner}"
            yield f"{name} line {number}: {error.text}"
    if text.owner < PROGRAMS:
        system.card.memory.I[pf.word[text.owner]] &= ~pf.PROGRAM_MODIFIED
