"""The arrays the scanner works on, and what is known of the shapes of lines (`scan_cy`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import ROTARY
from openacr.cnc.reading import rich_cy as rich
from openacr.cnc.reading import scan_cy as scan

if TYPE_CHECKING:
    from openacr.cnc.reading.text import Text
    from openacr.views import F64, I32

MOST_SHAPES = 700  # with this many slots a free one is found soon
MOST_ROWS = 8192  # lines, or moves, read together


def doubles(count: int) -> F64:
    """A view of doubles, 0."""
    return memoryview(bytearray(8 * count)).cast("d")


def integers(count: int) -> I32:
    """A view of integers, 0."""
    return memoryview(bytearray(4 * count)).cast("i")


class LineShapes:
    """Views for the scanner, with the axes of a machine; no shape is known at first.

    `bracket` opens expressions.
    """

    def __init__(
        self,
        axes: dict[str, int],
        bracket: str,
        w_size: int = scan.W_SCAN_SIZE,
        k_size: int = rich.K_RICH_SIZE,
        n_size: int = rich.MOST_NUMBERS,
    ) -> None:
        self.W, self.K = doubles(w_size), integers(k_size)
        self.N, self.Q = doubles(n_size), integers(rich.MOST_NUMBERS)
        self.K[rich.K_BRACKET] = ord(bracket)
        self.L, self.T = integers(rich.MOST_RICH), integers(scan.T_SIZE)
        for letter in range(26):
            self.K[letter] = -1
        for name, axis in axes.items():
            self.K[ord(name) - ord("A")] = axis
            if name in ROTARY:
                self.K[scan.K_ROTARY] |= 1 << axis
        self._shape_cnt = 0
        self._pool_end = scan.T_POOL
        self._window = b""
        self._bytes = memoryview(bytearray(1))

    def bytes(self, text: Text, offset: int) -> tuple[memoryview, int]:
        """Whole lines around an offset of the text, and the position of the offset in them."""
        window, place = text.window(offset)
        if window is not self._window:
            self._window = window
            self._bytes = memoryview(bytearray(window or b"\n"))
        return self._bytes, place

    @property
    def status(self) -> int:
        """Why the scanner ended (SCAN_...)."""
        return self.K[scan.K_STATUS]

    @property
    def is_full(self) -> bool:
        """Whether no more shapes can be kept: further ones are left to the parser."""
        room = scan.T_SIZE - self._pool_end
        return self._shape_cnt >= MOST_SHAPES or room < rich.MOST_RICH

    def tokens(self) -> list[int]:
        """The shape of the line the scanner read last."""
        return self.L[: self.K[scan.K_TOKENS]].tolist()

    @property
    def is_rich(self) -> bool:
        """Whether the line the scanner read last has formulas, or what else is more than words."""
        return bool(self.K[scan.K_TOKENS]) and self.L[0] == rich.RICH_LINE

    def numbers(self) -> dict[int, tuple[int, float]]:
        """The numbers of that line by their place in it, with their order."""
        count = self.K[rich.K_NUMBERS]
        return {self.Q[k]: (k, self.N[k]) for k in range(count)}

    def learn(self, tokens: list[int], meaning: int) -> bool:
        """Keep what a shape means; False where there is no room for it."""
        if self.is_full or not tokens:
            return False
        hashed = 0
        for k, token in enumerate(tokens):
            self.L[k] = token
            hashed = (hashed * 31 + token) & scan.HASH_MASK
        self.K[scan.K_TOKENS], self.K[scan.K_HASH] = len(tokens), hashed
        slot = scan.scan_slot(self.K, self.L, self.T)
        if not self.T[3 * slot + 1]:
            self.T[3 * slot], self.T[3 * slot + 1] = self._pool_end, len(tokens)
            for token in tokens:
                self.T[self._pool_end] = token
                self._pool_end += 1
            self._shape_cnt += 1
        self.T[3 * slot + 2] = meaning
        return True
