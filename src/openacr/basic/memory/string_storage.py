"""Strings of the programs: the one part of their storage that lives in Python lists."""

from dataclasses import dataclass, field
from typing import TypeAlias

from openacr.basic.memory.memory_cost import (
    ARRAY_REFERENCES,
    STRING_ARRAY_CHARACTERS,
    string_bytes,
)
from openacr.basic.memory.ranges import StringLength, StringText
from openacr.basic.memory.running_sums import RunningSums
from openacr.errors import CardError
from openacr.messages import SUBSCRIPT_OUT_OF_RANGE, UNDEFINED_VARIABLE

LONGEST_STRING = 255
CHARACTERS_PER_WORD = 4

BlockState: TypeAlias = tuple[StringLength, list[StringText]]
StringsState: TypeAlias = tuple[BlockState | None, list[BlockState | None]]


@dataclass(slots=True)
class StringBlock:
    """Strings of one dimensioned length: all $V of a program, or one $A array."""

    length: int
    values: list[str]

    def read(self, index: int) -> str:
        """One string."""
        self._check(index)
        return self.values[index]

    def write(self, index: int, text: str) -> None:
        """Store a string, cut to the dimensioned length."""
        self._check(index)
        self.values[index] = text[: self.length]

    @property
    def shape(self) -> tuple[int, int]:
        """Number of strings and length of each."""
        return len(self.values), self.length

    @property
    def string_words(self) -> int:
        """Words of 32 bits of one string: the number of its characters, and four in each word."""
        return 1 - -self.length // CHARACTERS_PER_WORD

    @property
    def words(self) -> int:
        """Words of 32 bits of all: their count, then the address of each, then the strings."""
        return 1 + len(self.values) * (1 + self.string_words)

    def _check(self, index: int) -> None:
        if not 0 <= index < len(self.values):
            raise CardError(SUBSCRIPT_OUT_OF_RANGE)


@dataclass(slots=True)
class ProgramStrings:
    """Strings of one program: its $V, and its $A arrays (None until dimensioned)."""

    variables: StringBlock | None = None
    arrays: list[StringBlock | None] = field(default_factory=list)  # changed by `put` alone
    sizes: RunningSums = field(init=False)  # of the arrays, in words

    def __post_init__(self) -> None:
        self.sizes = RunningSums(len(self.arrays))
        for index, block in enumerate(self.arrays):
            if block:
                self.sizes.add(index, block.words)

    def dimension(self, count: int) -> None:
        """Make room for `count` $A arrays; none has strings yet."""
        self.arrays, self.sizes = [None] * count, RunningSums(count)

    def put(self, index: int, block: StringBlock) -> None:
        """Give a $A array without strings its strings."""
        self.arrays[index] = block
        self.sizes.add(index, block.words)

    def array(self, index: int) -> StringBlock:
        """One dimensioned $A array."""
        block = self.arrays[index] if 0 <= index < len(self.arrays) else None
        if block is None:
            raise CardError(UNDEFINED_VARIABLE)
        return block

    def variable(self, index: int) -> StringBlock:
        """The $V of the program, of which number `index` exists."""
        block = self.variables
        if block is None or not 0 <= index < len(block.values):
            raise CardError(UNDEFINED_VARIABLE)
        return block

    @property
    def bytes(self) -> int:
        """User memory taken by all of them."""
        used = ARRAY_REFERENCES.bytes(len(self.arrays))
        if self.variables:
            count, length = self.variables.shape
            used += count * string_bytes(length)
        for block in filter(None, self.arrays):
            count, length = block.shape
            used += STRING_ARRAY_CHARACTERS.bytes(count * length)
        return used

    def state(self) -> StringsState:
        """Everything as plain data, for snapshots and stored images."""
        return _block_state(self.variables), [_block_state(block) for block in self.arrays]

    @classmethod
    def from_state(cls, state: StringsState) -> "ProgramStrings":
        """What `state` described."""
        variables, arrays = state
        return cls(_state_block(variables), [_state_block(block) for block in arrays])


def _block_state(block: StringBlock | None) -> BlockState | None:
    return (block.length, list(block.values)) if block else None


def _state_block(state: BlockState | None) -> StringBlock | None:
    return StringBlock(state[0], list(state[1])) if state else None
