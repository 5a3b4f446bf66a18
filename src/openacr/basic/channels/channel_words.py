"""What a channel shows of itself in parameters and flags, and keeps there: ECHO, MODE, counts."""

from __future__ import annotations

from openacr.channels import BinaryMode, EchoMode
from openacr.map.memory import Memory
from openacr.map.numbers import (
    P_COM1_CHARACTER_BUFFER_COUNT,
    P_COM2_CHARACTER_BUFFER_COUNT,
    P_DPCB_CHARACTER_BUFFER_COUNT,
    P_FIFO_CHARACTER_BUFFER_COUNT,
    W_COM1,
    W_COM2,
    W_DPCB,
    W_FIFO,
)
from openacr.map.words import strm

LARGEST = 0x7FFFFFFF
ECHO_BITS, MODE_BITS = sum(EchoMode), sum(BinaryMode)
MODE_SHIFT = 20  # of the two flags Control Prefixing and High Bit Stripping
COUNTS = {  # characters and lines waiting, free space, lines executed
    "FIFO": P_FIFO_CHARACTER_BUFFER_COUNT,
    "COM1": P_COM1_CHARACTER_BUFFER_COUNT,
    "COM2": P_COM2_CHARACTER_BUFFER_COUNT,
    "DPCB": P_DPCB_CHARACTER_BUFFER_COUNT,
}
FLAG_WORDS = {"FIFO": W_FIFO, "COM1": W_COM1, "COM2": W_COM2, "DPCB": W_DPCB}


def take_escapes(memory: Memory) -> list[str]:
    """Channels whose Escape Request is set; it and the Open Request clear themselves.

    The manuals give the Open Request no effect: programs open channels with OPEN.
    """
    found = []
    for name, word in FLAG_WORDS.items():
        if memory.I[word] & strm.ESCAPE_REQUEST:
            found.append(name)
        memory.I[word] &= ~(strm.OPEN_REQUEST | strm.ESCAPE_REQUEST)
    return found


class ChannelWords:
    """The words of one channel; a network stream has none and keeps its modes here."""

    def __init__(self, name: str, memory: Memory) -> None:
        self._memory = memory
        self._counts = COUNTS.get(name)
        self._flags = FLAG_WORDS.get(name)
        self._own = EchoMode.CHARACTERS.value

    @property
    def echo(self) -> int:
        """Bits of EchoMode."""
        return self._word & ECHO_BITS

    @echo.setter
    def echo(self, mode: int) -> None:
        self._word = self._word & ~ECHO_BITS | int(mode)

    @property
    def mode(self) -> int:
        """Bits of BinaryMode."""
        return self._word >> MODE_SHIFT & MODE_BITS

    @mode.setter
    def mode(self, mode: int) -> None:
        self._word = self._word & ~(MODE_BITS << MODE_SHIFT) | int(mode) << MODE_SHIFT

    @property
    def _word(self) -> int:
        return self._own if self._flags is None else self._memory.I[self._flags]

    @_word.setter
    def _word(self, word: int) -> None:
        if self._flags is None:
            self._own = word
        else:
            self._memory.I[self._flags] = word

    def count_line(self) -> None:
        """One more line has been executed."""
        if self._counts is not None:
            row = self._counts + 3
            self._memory.I[row] = (self._memory.I[row] + 1) & LARGEST

    def show_waiting(self, characters: int, lines: int, size: int) -> None:
        """Show what waits in the buffer of the channel, and how much more it takes."""
        if self._counts is not None:
            shown = characters, lines, max(size - characters, 0)
            for row, value in enumerate(shown, self._counts):
                self._memory.I[row] = value
