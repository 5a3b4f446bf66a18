"""Write operations of the VM into a chunk of code, with places that become known later."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.code import Chunk
from openacr.basic.vm.levels import CompileError
from openacr.messages import STACK_OVERFLOW, Message

DEEPEST_EXPRESSION = 90


@dataclass(slots=True)
class CodePlace:
    """A place in the code that operations may refer to before it is known."""

    at: int = -1
    users: list[int] = field(default_factory=list)


Word: TypeAlias = int | CodePlace


class Assembler:
    """Appends operations and counts the numbers they leave on the stack."""

    def __init__(self, chunk: Chunk | None = None) -> None:
        self.chunk = chunk or Chunk()
        self.line_number = 0
        self._depth = 0

    def error(self, message: Message, detail: object = "") -> CompileError:
        """The error to raise for the present line."""
        return CompileError(message, self.line_number, detail)

    def op(self, *words: Word) -> None:
        """Append an operation with its operands."""
        self.chunk.begins.append(len(self.chunk.code))
        for word in words:
            if isinstance(word, CodePlace):
                word.users.append(len(self.chunk.code))
                self.chunk.code.append(word.at)
            else:
                self.chunk.code.append(word)

    def put(self, place: CodePlace) -> None:
        """Fix a place: it is here."""
        place.at = len(self.chunk.code)
        for user in place.users:
            self.chunk.code[user] = place.at

    def place(self) -> CodePlace:
        """A place that is not known yet."""
        return CodePlace()

    def fail(self, message: Message) -> None:
        """An error that is raised when execution gets here."""
        self.op(vm.DO_FAIL, message.number, 0)

    def push(self, value: float) -> None:
        """Push a constant."""
        self._grow(1)
        nums = self.chunk.nums
        self.op(vm.DO_PUSH, len(nums))
        nums.append(float(value))

    def _grow(self, count: int) -> None:
        self._depth += count
        if self._depth > DEEPEST_EXPRESSION:
            raise self.error(STACK_OVERFLOW)

    def drop(self, count: int) -> None:
        """Note that the operation just written takes `count` numbers from the stack."""
        self._depth -= count
