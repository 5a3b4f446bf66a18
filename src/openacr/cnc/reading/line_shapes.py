"""What is known of the shapes of lines, and the rows in which they are read (`scan_cy`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.canonical import ROTARY
from openacr.cnc.reading import rich_cy as rich
from openacr.cnc.reading import scan_cy as scan
from openacr.cnc.rows import scans
from openacr.cnc.rows.room import Memory

if TYPE_CHECKING:
    from openacr.cnc.reading.text import Text

MOST_SHAPES = 700  # with this many slots a free one is found soon
MOST_ROWS = 8192  # lines, or moves, read together


class LineShapes:
    """The shapes of lines, with the axes of a machine; none is known at first.

    `bracket` opens expressions; `memory` has rows for all that is read of lines.
    """

    def __init__(self, axes: dict[str, int], bracket: str, memory: Memory | None = None) -> None:
        memory = memory or Memory(scans.SIZE)
        self.F, self.I = memory.F, memory.I
        self.I[scans.bracket] = ord(bracket)
        for name, axis in axes.items():
            if name in ROTARY:
                self.I[scans.rotary_axes] |= 1 << axis
        self._shape_cnt = 0
        self._tokens_end = scans.shape_token.start
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
        """Why the scanner ended (`scans`)."""
        return self.I[scans.status]

    @property
    def is_full(self) -> bool:
        """Whether no more shapes can be kept: further ones are left to the parser."""
        room = scans.shape_token.stop - self._tokens_end
        return self._shape_cnt >= MOST_SHAPES or room < scans.MOST_RICH

    def tokens(self) -> list[int]:
        """The shape of the line the scanner read last."""
        first = scans.token.start
        return self.I[first : first + self.I[scans.token_cnt]].tolist()

    @property
    def is_rich(self) -> bool:
        """Whether the line the scanner read last has formulas, or what else is more than words."""
        return bool(self.I[scans.token_cnt]) and self.I[scans.token[0]] == rich.RICH_LINE

    def numbers(self) -> dict[int, tuple[int, float]]:
        """The numbers of that line by their place in it, with their order."""
        F, I = self.F, self.I
        return {I[scans.number_at[k]]: (k, F[scans.number[k]]) for k in range(I[scans.number_cnt])}

    def learn(self, tokens: list[int], meaning: int) -> bool:
        """Keep what a shape means; False where there is no room for it."""
        if self.is_full or not tokens:
            return False
        I, hashed = self.I, 0
        for k, token in enumerate(tokens):
            I[scans.token[k]] = token
            hashed = (hashed * 31 + token) & scan.HASH_MASK
        I[scans.token_cnt], I[scans.token_hash] = len(tokens), hashed
        slot = scan.scan_slot(I)
        if not I[slot + scans.SLOT_COUNT]:
            I[slot + scans.SLOT_FIRST], I[slot + scans.SLOT_COUNT] = self._tokens_end, len(tokens)
            for token in tokens:
                I[self._tokens_end] = token
                self._tokens_end += 1
            self._shape_cnt += 1
        I[slot + scans.SLOT_MEANING] = meaning
        return True
