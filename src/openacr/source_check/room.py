"""What files take of the memory of a card, by the arithmetic of the card itself."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from openacr.basic.commands import targets
from openacr.basic.commands.character_io import channel_name
from openacr.basic.commands.memory_control import (
    Dimension,
    dimension_local,
    dimension_system,
    is_of_system,
)
from openacr.basic.language.grammar import ObjectRef
from openacr.basic.language.nodes import Block, Statement
from openacr.basic.language.registry import Level
from openacr.basic.memory.known_lines import LineCost, line_cost
from openacr.basic.memory.memory_cost import PLC_INSTRUCTION, line_bytes
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.basic.memory.program_store import OWNERS
from openacr.basic.memory.storage import Storage
from openacr.errors import CardError
from openacr.map.memory import Memory
from openacr.messages import OUT_OF_DEFINE_SPACE, OUT_OF_MEMORY
from openacr.source_check.cutoffs import statements
from openacr.source_check.numbers import literal
from openacr.source_check.texts import Finding, Text, TextLine

RESIZING = frozenset((("DIM",), ("CLEAR",), ("DEF", "CLEAR"), ("NEW",)))
MOST_BYTES_PER_CHARACTER = 8  # of an instruction of a PLC; fewer of other lines


@dataclass(slots=True)
class Room:
    """The memory of a card that was new before, as it is after the lines read so far.

    It is known as long as all sizes are: one that is computed, or a DIM, CLEAR or NEW that
    depends on something, ends that.
    """

    storage: Storage = field(default_factory=lambda: Storage(Memory()))
    is_known: bool = True
    is_complete: bool = False  # what gives programs their memory has been read
    _names: set[str] = field(default_factory=set)  # of aliases
    _alike: dict[str, LineCost | None] = field(default_factory=dict)  # of all lines of a shape

    def note(self, level: Level, number: int, blocks: Iterable[Block]) -> CardError | None:
        """Execute the DIM and CLEAR commands of a line; what the card says against one."""
        for block in blocks:
            for statement in block:
                if isinstance(statement, Statement) and self.is_known:
                    try:
                        self._execute(level, number, statement)
                    except CardError as error:
                        return error
        return None

    def _execute(self, level: Level, number: int, statement: Statement) -> None:
        words, arguments = statement.command.words, statement.arguments
        if words == ("DIM",) and isinstance(arguments[0], Dimension):
            self._dimension(level, number, arguments[0])
        elif words in (("CLEAR",), ("NEW",)) and is_computed(arguments[0]):
            self.is_known = False
        elif words == ("CLEAR",) and (stream := _named(arguments[0])):
            self.storage.clear_stream(channel_name(stream))
        elif words == ("CLEAR",) and level is Level.SYS:
            self.storage.clear_system()
            self._names.clear()
        elif words == ("DEF", "CLEAR"):
            self._names.clear()
        elif words == ("CLEAR",) and level is Level.PROG:
            self.storage.locals.clear(number)
        elif any(_resizes(getattr(argument, "blocks", ())) for argument in arguments):
            self.is_known = False

    def _dimension(self, level: Level, number: int, what: Dimension) -> None:
        index = None if what.index is None else literal(what.index)
        sizes = tuple(map(literal, what.sizes))
        known = [size for size in sizes if size is not None]
        if len(known) < len(sizes) or (what.index is not None and index is None):
            self.is_known = False
        elif not is_of_system(what.word):
            if level is Level.PROG:
                dimension_local(self.storage, number, what.word, index, tuple(known), repeat=False)
        elif level is Level.SYS:
            dimension_system(self.storage, what.word, index, tuple(known))

    def define(self, name: str) -> None:
        """Account for an alias; CardError if the card has no space for one more."""
        count = self.storage.define_count
        self._names.add(name)
        if self.is_known and (self.is_complete or count) and len(self._names) > count:
            self._names.discard(name)
            raise CardError(OUT_OF_DEFINE_SPACE)

    def forget(self, level: Level, number: int) -> None:
        """NEW: the text of a program or PLC takes nothing any more."""
        for owner in owners(level, number, None):
            self.storage.set_code_bytes(owner, 0)

    def store(self, level: Level, number: int, text: Text) -> Iterator[Finding]:
        """Account for a text; the first line that finds no room, if there is one."""
        if not self.is_known or text.lost:
            return
        (owner,) = owners(level, number, None)
        if not self.is_complete and not self.storage.size(owner):
            return
        self.storage.set_code_bytes(owner, 0)
        lines, free = text.in_order(), self.storage.free_program(owner)
        if free >= sum(map(_most_bytes, lines)):
            return
        used = 0
        for line in lines:
            cost = self._bytes(line)
            if used + cost > free:
                whole = sum(map(self._bytes, lines))
                hint = f"the text takes {whole} bytes, there is room for {free}"
                if not self.storage.size(owner):
                    name = f"{level.name}{number}"
                    hint = f"{name} has no memory yet: DIM {name}({_ample(whole)}) at SYS"
                yield Finding(line.place, CardError(OUT_OF_MEMORY), hint=hint)
                break
            used += cost
        self.storage.set_code_bytes(owner, used)

    def _bytes(self, line: TextLine) -> int:
        """What the card stores of a line."""
        if line.rung is not None:
            return PLC_INSTRUCTION.bytes(line.rung.count)
        if line.outline.is_empty:
            return 0
        text, shape = line.place.text, line.place.shape
        known = self._alike.get(shape)
        if known is not None:
            return known.bytes(text)
        tokens = list(line.tokens)
        if shape and shape not in self._alike:
            self._alike[shape] = line_cost(text, shape, tokens)
        return line_bytes(tokens)


def owners(level: Level, number: int, target: object) -> Iterable[int]:
    """The programs (0-15) and PLCs (16-23) that a command with a target, or a text, belongs to."""
    if found := _named(target):
        return range(OWNERS) if found.word == "ALL" else (targets.named(found),)
    if level is Level.SYS or is_computed(target):
        return ()
    return (number + PROGRAMS if level is Level.PLC else number,)


def is_computed(target: object) -> bool:
    """Whether the number of an object, as written after a command, is not a literal."""
    return target is not None and _named(target) is None


def _named(target: Any) -> ObjectRef | None:
    """The object that is written after a command with a literal number or with none."""
    if not isinstance(target, tuple):
        return None
    word, number = target[0], literal(target[1])
    return None if number is None else ObjectRef(word, number)


def _ample(size: int) -> int:
    """A size for a text that may grow, in whole hundreds."""
    return -(-2 * size // 100) * 100


def _most_bytes(line: TextLine) -> int:
    """More than a line of a program can take; at once, for texts with room to spare."""
    return MOST_BYTES_PER_CHARACTER * (len(line.place.text) + 1)


def _resizes(blocks: Iterable[Block]) -> bool:
    """Whether there is a command among what may be executed that takes or gives memory."""
    return any(each.command.words in RESIZING for each in statements(blocks))
