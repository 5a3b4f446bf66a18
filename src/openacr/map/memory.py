"""The state of the card: one buffer seen as float64, int32 and float32.

Programs, packets, snapshots and the servo loop all work on this memory. `F`, `I` and `S`
are the raw views for those who know the places (`openacr.map.numbers`); `read`, `write`,
`bit` and `set_bit` behave as P and BIT do in a program.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from math import isnan, trunc

from openacr.errors import CardError, MapError, StoreError
from openacr.map.image import KINDS, POWER_UP
from openacr.map.kinds_cy import is_read_only, kind_of
from openacr.map.numbers import (
    FLAG_LAST,
    FLAG_WORD_BASE,
    KIND_FP32,
    KIND_FP64,
    KIND_LONG,
    KIND_NONE,
    MEMORY_BYTES,
    PUBLIC_COUNT,
    SYSI_BASE,
    SYSI_P_COUNT,
    USER_BASE,
)
from openacr.messages import INVALID_BIT, INVALID_PARAMETER, UNDEFINED_VARIABLE
from openacr.views import F32, F64, I32

KINDS_PER_WORD = 16
WALK_WORK = 2  # to find a reference, in the units of `controller/streams.py`
CHUNK = 1024  # words that are skipped together if all are 0
_ZEROS = bytes(4 * CHUNK)


NoteCall = Callable[[int, int, int, float], AbstractContextManager[None]]


class Memory:
    """All state of one card, as it is right after power-up."""

    __slots__ = ("F", "I", "S", "_buffer", "noted", "renewals", "work")

    F: F64
    I: I32
    S: F32

    def __init__(self) -> None:
        self._buffer = memoryview(bytearray(_power_up_image()))
        self.F = self._buffer.cast("d")
        self.I = self._buffer.cast("i")
        self.S = self._buffer.cast("f")
        self.noted: NoteCall | None = None  # where ticks go on while commands run
        self.renewals = 0  # how often the state was replaced as a whole
        self.work = 0  # beyond what a line or packet counts by itself, since a caller took it

    def read(self, number: int) -> int | float:
        """Value of parameter `number`; CardError if there is no such parameter."""
        kind = self._checked_kind(number)
        if kind == KIND_LONG:
            return self.I[number]
        return self.S[number] if kind == KIND_FP32 else self.F[USER_BASE + number]

    def write(self, number: int, value: float) -> None:
        """Store `value` as the parameter's kind demands.

        CardError if there is no such parameter, MapError if it is read-only.
        """
        kind = self._checked_kind(number)
        if is_read_only(number):
            raise MapError(f"P{number} is read-only")
        if kind == KIND_LONG:
            self.I[number] = long_of(value)
        elif kind == KIND_FP32:
            self.S[number] = value
        else:
            self.F[USER_BASE + number] = value

    def _checked_kind(self, number: int) -> int:
        kind = kind_of(self.I, number)
        if kind == KIND_NONE:
            raise CardError(INVALID_PARAMETER)
        if kind == KIND_FP64 and number >= self.I[SYSI_BASE + SYSI_P_COUNT]:
            raise CardError(UNDEFINED_VARIABLE)
        return kind

    def bit(self, number: int) -> bool:
        """State of flag `number`; CardError beyond the last flag."""
        word, mask = flag_place(number)
        return bool(self.I[word] & mask)

    def set_bit(self, number: int, on: bool) -> None:
        """Set or clear flag `number`; CardError beyond the last flag."""
        word, mask = flag_place(number)
        self.I[word] = self.I[word] | mask if on else self.I[word] & ~mask

    def calling(
        self, call: int, number: int, whole: int, value: float
    ) -> AbstractContextManager[None]:
        """Around a call of the kernel by a command (`kernel/calls_cy.py`), which may be noted."""
        return nullcontext() if self.noted is None else self.noted(call, number, whole, value)

    def references(self, first: int, count: int) -> list[int]:
        """Places in `I` of the words of a table that are not 0; long empty tables cost nothing."""
        found: list[int] = []
        for start in range(first, first + count, CHUNK):
            words = self.I[start : min(start + CHUNK, first + count)]
            if words.tobytes() != _ZEROS[: 4 * len(words)]:
                found += [start + k for k, word in enumerate(words) if word]
        self.work += WALK_WORK * len(found)
        return found

    def snapshot(self) -> bytes:
        """The whole state; `restore` brings it back."""
        return self._buffer.tobytes()

    def image(self) -> bytearray:
        """The same, to be changed."""
        return bytearray(self._buffer)

    def restore(self, snapshot: bytes | bytearray) -> None:
        """Return to a snapshot of a card with the same memory layout."""
        if len(snapshot) != len(self._buffer):
            raise StoreError(
                f"the snapshot has {len(snapshot)} bytes, this version needs {len(self._buffer)}"
            )
        self._buffer[:] = snapshot
        self.renewals += 1

    def replace(self, other: Memory) -> None:
        """Become a copy of another memory."""
        self._buffer[:] = other._buffer

    def power_up(self) -> None:
        """Forget everything: the state after switching the card on."""
        self._buffer[:] = _power_up_image()
        self.renewals += 1

    def digest(self) -> str:
        """Fingerprint of the state: equal digests, equal cards."""
        return digest_of(self._buffer)


def digest_of(image: bytes | bytearray | memoryview) -> str:
    """Fingerprint of the state in a snapshot."""
    from hashlib import blake2b  # OpenSSL: 2 ms of a start

    return blake2b(image, digest_size=16).hexdigest()


def long_of(value: float) -> int:
    """`value` without its fraction, wrapped to 32 bits.

    Beyond +-2**62, where the compiled core would overflow, and for NaN the result is 0.
    """
    if isnan(value) or not -(2**62) < value < 2**62:
        return 0
    return (trunc(value) + 2**31) % 2**32 - 2**31


def flag_place(number: int) -> tuple[int, int]:
    """Index of the word of a flag and its mask as a signed 32-bit number; CardError for none."""
    if not 0 <= number <= FLAG_LAST:
        raise CardError(INVALID_BIT)
    word, bit = divmod(number, 32)
    return FLAG_WORD_BASE + word, 1 << bit if bit < 31 else -(1 << 31)


@cache
def _power_up_image() -> bytes:
    buffer = memoryview(bytearray(MEMORY_BYTES))
    kinds = kind_table()
    longs = buffer.cast("i")
    for word in range(PUBLIC_COUNT // KINDS_PER_WORD):
        part = kinds[word * KINDS_PER_WORD : (word + 1) * KINDS_PER_WORD]
        longs[word] = long_of(sum(kind << 2 * place for place, kind in enumerate(part)))
    floats = buffer.cast("f")
    for first, stride, count, value in POWER_UP:
        for number in range(first, first + stride * count, stride):
            if kinds[number] == KIND_LONG:
                longs[number] = long_of(value)
            else:
                floats[number] = value
    return buffer.tobytes()


def kind_table() -> bytes:
    """Kind of every parameter number."""
    table = bytearray(PUBLIC_COUNT)
    for first, length, kind, stride, count in KINDS:
        for start in range(first, first + stride * count, stride):
            table[start : start + length] = bytes([kind]) * length
    return bytes(table)
